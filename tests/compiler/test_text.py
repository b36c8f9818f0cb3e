"""The text of composed modules."""

import ast
import re
from functools import partial
from pathlib import Path

import pytest

import saleg
import saleg.compiler
from saleg import LawError
from saleg.compiler import machine_code, search
from saleg.compiler.compiled_engine import IDLE_COMMANDED, kernel_for
from saleg.compiler.module import digest, load
from saleg.compiler.needs import Needs
from saleg.compiler.shared_kernel import shared_kernel
from saleg.compiler.text import (
    INTEGRATOR,
    REFERENCE,
    SHOWN,
    compose,
    compose_kernel,
    compose_laws,
    compose_search,
    own_text,
)
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS


@pytest.fixture(scope="module")
def kernel(base):
    """The half without laws."""
    return compose_kernel(Needs.of(classes_of(base), False))


@pytest.fixture(scope="module")
def laws(base):
    """The half of the laws, as it is loaded."""
    text = Path(kernel_for(base).module.__file__).read_text(encoding="utf-8")
    return text.removeprefix(f"{text.splitlines()[0]}\n")  # that of the lengths of series


@pytest.fixture(scope="module")
def whole(base):
    """Both in one, as where numba has no halves."""
    return compose(classes_of(base))


def classes_of(engine):
    sides = [type(side.laws[slot]) for side in engine.chambers for slot in CHAMBER_SLOTS]
    rest = [*(getattr(engine, slot) for slot in ENGINE_SLOTS), *IDLE_COMMANDED]
    return tuple([*sides, *map(type, rest)])


def parts_of(text):
    return re.findall(r"^# --- (\S+)\.py$", text, flags=re.MULTILINE)


def top_level(text):
    """Functions of a text by their names, as they are written."""
    found = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
    return {node.name: ast.unparse(node) for node in found}


def test_the_text_holds_the_law_as_written(laws, whole):
    for text in (laws, whole):
        assert re.search(r"def engine_springs_force\(self, motion\)", text)
        assert "from saleg" not in text


def test_the_kernel_holds_no_law(kernel):
    assert "from saleg" not in kernel
    assert not re.search(r"^def (both|left|right|engine)_", kernel, flags=re.MULTILINE)


def test_the_laws_loaded_name_the_kernel_they_are_composed_for(base, laws, kernel):
    assert digest(kernel) == shared_kernel(Needs.of(classes_of(base), False)).digest
    assert laws == compose_laws(classes_of(base), digest(kernel))


def test_the_laws_fill_every_slot_the_kernel_declares(kernel, laws):
    declared = re.findall(
        r"^(\w+) = DECLARED\(\"(\w+)\", globals\(\)\)$", kernel, flags=re.MULTILINE
    )
    assert len(declared) == kernel.count("DECLARED(") > 40
    assert {name for name, _ in declared} == {name for _, name in declared} <= set(top_level(laws))


def test_the_halves_hold_together_what_one_module_holds(kernel, laws, whole):
    halves, one = top_level(kernel) | top_level(laws), top_level(whole)
    # The entry point stands in both halves: that of the laws calls the kernel's.
    halves["run_on"] = top_level(kernel)["run_on"]
    assert {**halves, "run_on": ""} == {**one, "run_on": ""}
    assert halves["run_on"] == one["run_on"]


def test_the_samples_in_the_docstring_are_of_the_halves(kernel, laws):
    samples = re.findall(r"::\n\n((?:    .*\n)+)", saleg.compiler.__doc__)
    for sample, text in zip(samples, (kernel, laws), strict=True):
        assert len(sample.splitlines()) >= 10
        rest = text.splitlines()
        for line in sample.splitlines():  # in this order, in the text
            assert line[4:] in rest, line
            rest = rest[rest.index(line[4:]) + 1 :]


def test_the_parts_stand_in_the_order_of_the_docstring(kernel, laws, whole):
    for text in (kernel, whole):
        parts = parts_of(text)
        assert parts[0] == "laws/arguments"
        first = parts.index(f"kernel/{INTEGRATOR[0]}")
        assert parts[first : first + len(INTEGRATOR)] == [f"kernel/{one}" for one in INTEGRATOR]
    assert parts_of(laws) == [name.removesuffix(".py") for name in SHOWN]


def test_alike_sides_share_their_functions_and_others_do_not(base):
    mixed = base.replace(**{"left.heat_transfer": saleg.laws.NoHeatTransfer()})
    for composed in (compose, partial(compose_laws, kernel="")):
        assert "def left_heat_transfer_" not in composed(classes_of(base))
        found = composed(classes_of(mixed))
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
