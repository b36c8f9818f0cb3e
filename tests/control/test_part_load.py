"""Part load at the best efficiency, beside steady states found one by one."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import saleg
from saleg import control
from saleg.control import Demand
from saleg.errors import InvalidController, WrongArguments
from saleg.files.tables import read_table

VALUES = {
    "equivalence_ratio": (0.2, 0.3, 0.4, 0.5, 0.655),
    "intake.temperature": (263.0, 303.0),
}


@pytest.fixture(scope="module")
def transient():
    return saleg.machines.thesis_transient()


@pytest.fixture(scope="module")
def known(transient):
    return control.part_load_map(transient, VALUES)


def efficiency_at(engine, power, path, low, high):
    """Efficiency where one quantity alone, found by bisection, gives a power."""

    def state(value):
        return saleg.steady_state(engine.replace(**{path: value})).performance

    return state(brentq(lambda value: state(value).power - power, low, high, rtol=1e-6)).efficiency


@pytest.mark.parametrize("power", [1952.0, 2928.0])
def test_the_best_at_a_power_is_no_worse_than_either_quantity_alone(transient, power):
    best = control.part_load_map(transient, VALUES, powers=[power, power + 300.0]).table.iloc[0]
    assert best.power == pytest.approx(power, rel=5e-3)
    lean = efficiency_at(transient, power, "equivalence_ratio", 0.2, 0.655)
    heated = efficiency_at(transient, power, "intake.temperature", 263.0, 400.0)
    assert best.efficiency == pytest.approx(max(lean, heated), rel=2e-3)
    assert lean > heated + 0.02


def test_every_row_is_a_steady_state_within_the_margins(transient, known):
    table = known.table
    assert (np.diff(table.power) > 0.0).all()
    assert table.largest_multiplier.max() <= 0.9
    assert table.compression_ratio.min() >= 12.2
    row = table.iloc[len(table) // 2]
    found = saleg.steady_state(transient.replace(**{path: row[path] for path in known.paths}))
    assert found.performance.power == pytest.approx(row.power, rel=1e-6)


def test_a_map_ends_where_its_margins_do(transient, known):
    margins = {"compression_ratio": (14.0, 25.0)}
    stricter = control.part_load_map(transient, VALUES, margins=margins)
    assert stricter.column("power")[0] > known.column("power")[0]
    assert stricter.table.compression_ratio.min() == pytest.approx(14.0, abs=0.3)
    with pytest.raises(InvalidController, match="at least two"):
        control.part_load_map(transient, VALUES, margins={"compression_ratio": (90.0, 99.0)})


def test_the_map_is_followed_faster_than_the_compression_ratio(transient, known):
    step = Demand.step(1.5, 3900.0, 1900.0)
    run = control.demand_by_map(transient, step, known, duration=3.0)
    answer = control.step_response(run, step)
    assert run.performance.power == pytest.approx(1900.0, rel=0.02)
    after = run.dead_centres[run.dead_centres.t > 1.5]
    lowest = after.power.min()
    assert answer.overshoot == pytest.approx((1900.0 - lowest) / 2000.0, rel=1e-9)
    last_outside = after.t[(after.power - 1900.0).abs() > 100.0].max()
    assert 0.0 < answer.settling_time - (last_outside - 1.5) < 0.013  # one stroke later
    slower = control.demand_by_fuel(transient, step, duration=3.0)
    assert answer.settling_time < 0.5 * control.step_response(slower, step).settling_time
    assert math.isinf(control.step_response(run, step, band=1e-9).settling_time)


def test_what_no_controller_commands_cannot_be_followed(transient):
    values = {"equivalence_ratio": (0.4, 0.6), "intake.pressure": (1.1e5, 1.2e5)}
    known = control.part_load_map(transient, values)
    with pytest.raises(InvalidController, match=r"intake\.pressure"):
        control.demand_by_map(transient, Demand.step(2.0, 3900.0, 1900.0), known)


def test_a_saved_map_is_read_back(tmp_path, known):
    known.save(tmp_path / "map.csv")
    rows = read_table(tmp_path / "map.csv", lambda name: name.split(" ")[0] in TEXTS)
    assert len(rows) == len(known.table)
    np.testing.assert_array_equal(rows["power [W]"], known.table.power)


TEXTS = ("status", "message", "method", "kind", "stable")


def test_all_that_makes_no_map_is_named(transient):
    """Before, an error of numpy or pandas about the first."""
    with pytest.raises(WrongArguments, match=r"values = {}: must have at least one quantity"):
        control.part_load_map(transient, {})
    wrong = {"foo": (1, 2), "equivalence_ratio": ("x",), "bore": (), "friction": (1.0,)}
    margins = {"bar": (0, 1), "power": (2.0, 1.0), "status": (0, 1), "bore": (0, math.inf)}
    with pytest.raises(WrongArguments) as caught:
        control.part_load_map(transient, wrong, margins=margins)
    text = str(caught.value)
    assert [problem.path for problem in caught.value.problems] == [
        "values['foo']",
        "values['equivalence_ratio']",
        "values['bore']",
        "values['friction']",
        "margins['bar']",
        "margins['power']",
        "margins['status']",
    ]
    assert "item 0 is 'x'" in text
    for call in (
        lambda: control.operating_line(transient, []),
        lambda: control.operating_map(transient, "bore", []),
        lambda: control.operating_grid(transient, [], [0.6]),
        lambda: control.part_load_map(transient, {"bore": (0.06,)}, powers=[]),
    ):
        with pytest.raises(WrongArguments, match="1 wrong field"):
            call()
