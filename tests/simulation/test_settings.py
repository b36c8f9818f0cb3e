import dataclasses
import inspect

import pytest

import saleg
from saleg.simulation.settings import Settings, SettingsError


def test_simulate_takes_the_settings_with_their_defaults():
    _, *taken = inspect.signature(saleg.simulate).parameters.values()
    fields = dataclasses.fields(Settings)
    assert [one.name for one in taken] == [item.name for item in fields]
    for one, item in zip(taken[1:], fields[1:], strict=True):
        assert one.default == item.default


def test_all_mistakes_are_named_together():
    with pytest.raises(SettingsError) as error:
        Settings(-1.0, method="euler", order=7, history=0).checked()
    for name in ("duration = -1.0", "method = 'euler'", "order = 7", "history = 0"):
        assert name in str(error.value)


def test_a_step_asks_for_a_fixed_one():
    assert Settings(1.0).adaptive
    assert not Settings(1.0, step=1e-6).adaptive
    assert Settings(1.0, method="fixed").fixed_step == 5e-6
