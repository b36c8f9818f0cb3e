"""The text of composed modules."""

import re

import pytest

import saleg
import saleg.compiler
from saleg import LawError
from saleg.compiler import machine_code, search
from saleg.compiler.compiled_engine import IDLE_COMMANDED
from saleg.compiler.module import load
from saleg.compiler.text import INTEGRATOR, REFERENCE, compose, compose_search, own_text
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS


@pytest.fixture(scope="module")
def text(base):
    return compose(classes_of(base))


def classes_of(engine):
    sides = [type(side.laws[slot]) for side in engine.chambers for slot in CHAMBER_SLOTS]
    rest = [*(getattr(engine, slot) for slot in ENGINE_SLOTS), *IDLE_COMMANDED]
    return [*sides, *map(type, rest)]


def test_the_text_holds_the_law_as_written(text):
    assert re.search(r"def engine_springs_force\(self, motion\)", text)
    assert "from saleg" not in text


def test_the_sample_in_the_docstring_is_of_the_text(text):
    sample = re.search(r"::\n\n((?:    .*\n)+)", saleg.compiler.__doc__)[1].splitlines()
    assert len(sample) >= 20
    rest = text.splitlines()
    for line in sample:  # in this order, in the text
        assert line[4:] in rest, line
        rest = rest[rest.index(line[4:]) + 1 :]


def test_the_parts_stand_in_the_order_of_the_docstring(text):
    parts = re.findall(r"^# --- (\S+)\.py$", text, flags=re.MULTILINE)
    assert parts[0] == "laws/arguments"
    first = parts.index(f"kernel/{INTEGRATOR[0]}")
    assert parts[first : first + len(INTEGRATOR)] == [f"kernel/{name}" for name in INTEGRATOR]


def test_alike_sides_share_their_functions_and_others_do_not(base):
    mixed = base.replace(**{"left.heat_transfer": saleg.laws.NoHeatTransfer()})
    assert "def left_heat_transfer_" not in compose(classes_of(base), REFERENCE)
    found = compose(classes_of(mixed), REFERENCE)
    assert "def left_heat_transfer_coefficient(" in found
    assert "def right_heat_transfer_coefficient(" in found
    assert "def both_ignition_rate(" in found


@pytest.mark.parametrize("keeps", [True, False])
def test_what_is_not_kept_asks_for_no_cache(base, keeps, tmp_path, monkeypatch):
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path))
    text = compose(classes_of(base), REFERENCE)
    loaded = load(text, "kernel", keeps=keeps)
    place = loaded.module.rates_of_records.stats.cache_path
    assert place == (str(loaded.kept.code) if keeps else None)
    assert bool(list(tmp_path.iterdir())) == keeps


def test_a_name_that_stands_for_two_things_is_refused(base):
    with pytest.raises(LawError, match=r"two parts of the kernel define FUEL_SHARE"):
        compose(classes_of(base), ("step", "step"))


def test_docstrings_of_modules_and_our_imports_are_stripped():
    step = own_text("kernel/step.py")
    assert step.startswith("# --- kernel/step.py\n")
    assert "from saleg" not in step
    assert "def take_step" in step


def test_the_search_is_composed_once_without_any_law(base):
    found = compose_search()
    assert "# --- compiler/run_at.py" in found
    assert "# --- kernel/orbit.py" in found
    assert "# --- kernel/rhs.py" not in found
    assert "# --- kernel/orbit.py" not in compose(classes_of(base))


def test_without_addresses_the_integrator_is_called_by_name(base, monkeypatch):
    assert search.modules() == INTEGRATOR
    gone = "numba.core.codegen:JITCodeLibrary.gone"
    monkeypatch.setattr(machine_code, "ADDRESS_NEEDS", (*machine_code.ADDRESS_NEEDS, gone))
    found = compose(classes_of(base), search.modules())
    assert "# --- compiler/run_at.py" not in found
    assert "# --- kernel/orbit.py" in found
    assert "# --- kernel/run_plainly.py" in found
