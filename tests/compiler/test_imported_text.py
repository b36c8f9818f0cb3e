"""The kernel runs the law that was imported, whatever its file has become since."""

import dataclasses
import functools
import importlib.util
import linecache
import math

import numpy as np
import pytest

import saleg
from helpers import compiled_method
from saleg import Controller, LawError, SalegWarning
from saleg.batch.identity import code_hash
from saleg.compiler.compiled_engine import kernel_for
from saleg.compiler.controllers import control_of
from saleg.compiler.imported_text import NoSource, block_of, found_text
from saleg.laws import LinearSprings, Motion
from saleg.laws.control.base import FuelControl

MOTION = Motion(0.0, 0.02, 3.0, 1.0)
LAW = """\
from dataclasses import dataclass
from saleg.laws import Springs

FACTOR = 2.0

def weight(x):
    return {factor} * x

def other(x):
    return 0.0 * x

@dataclass(frozen=True)
class Own(Springs):
    def force(self, motion):
        return -FACTOR * weight(motion.x)

    def energy(self, motion):
        return FACTOR * weight(motion.x) * motion.x
"""
#: A file after an edit: another number, lines moved, functions turned round, half an edit, nothing.
EDITS = {
    "number": LAW.format(factor=5.0),
    "moved": "# one\n# two\n\n\n\n" + LAW.format(factor=3.0),
    "moved and changed": "# one\n# two\n\n\n\n" + LAW.format(factor=5.0),
    "turned": LAW.format(factor=3.0).replace("weight", "new").replace("other", "weight"),
    "half": LAW.format(factor=3.0) + "\ndef (",
    "string": '"""' + LAW.format(factor=3.0),
    "empty": "",
}


def imported(file, text):
    """A module as another process would import it."""
    file.write_text(text)
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    exec(compile(text, str(file), "exec"), module.__dict__)  # no stale .pyc within a second
    return module


@pytest.fixture(params=[False, True], ids=["unread", "read"])
def own(tmp_path, request):
    """A module of the user's, its file read before by someone or not."""
    file = tmp_path / "own_law.py"
    module = imported(file, LAW.format(factor=3.0))
    if request.param:
        linecache.getlines(str(file))
    return module


@pytest.mark.parametrize("edit", EDITS)
def test_an_edited_file_changes_nothing(own, tmp_path, edit):
    (tmp_path / "own_law.py").write_text(EDITS[edit])
    law = own.Own()
    assert law.force(MOTION) == pytest.approx(-0.12)
    for method in ("force", "energy"):
        assert compiled_method(law, method)(MOTION) == getattr(law, method)(MOTION)


def test_lines_that_moved_are_found(tmp_path):
    own = imported(tmp_path / "own_law.py", LAW.format(factor=3.0))
    before = block_of(own.weight)
    (tmp_path / "own_law.py").write_text(EDITS["moved"])
    linecache.clearcache()
    assert found_text(own.weight).first == 11
    assert block_of(own.weight) == before == "def weight(x):\n    return 3.0 * x\n"
    (tmp_path / "own_law.py").write_text(EDITS["moved and changed"])
    linecache.clearcache()
    with pytest.raises(NoSource, match=r"weight.*own_law\.py, line 6.*not the code"):
        found_text(own.weight)


def test_a_reloaded_function_is_the_new_one(own, tmp_path):
    """As IPython reloads: the old function gets the new code, the lines may be the old ones."""
    new = imported(tmp_path / "own_law.py", "#\n" * 4 + LAW.format(factor=5.0))
    own.weight.__code__ = new.weight.__code__
    law = own.Own()
    assert law.force(MOTION) == pytest.approx(-0.2)
    assert compiled_method(law, "force")(MOTION) == law.force(MOTION)


def test_an_edited_law_in_an_engine_is_said_once(base, tmp_path):
    own = imported(tmp_path / "own_law.py", LAW.format(factor=3.0))
    (tmp_path / "own_law.py").write_text(EDITS["number"])
    engine = base.replace(springs=own.Own())
    with pytest.warns(SalegWarning, match=r"weight.*own_law\.py.*reload") as caught:
        module = kernel_for(engine).module
    assert len(caught) == 1
    assert not module.__file__.endswith(".py")
    assert module.engine_springs_force.py_func(None, MOTION) == own.Own().force(MOTION)
    assert kernel_for(engine).module is module  # no second warning


def test_a_hash_is_of_the_code_that_runs(tmp_path):
    """Before, results of the old code were kept under the hash of the new file."""
    file = tmp_path / "own_law.py"
    old = imported(file, LAW.format(factor=3.0)).Own
    first = code_hash(old, "law")
    file.write_text(EDITS["number"])
    linecache.clearcache()
    edited = code_hash(old, "law")
    new = imported(file, EDITS["number"]).Own
    assert len({first, edited, code_hash(new, "law")}) == 3
    assert code_hash(imported(file, LAW.format(factor=3.0)).Own, "law") == first


K = 1.0


def with_default(x, factor=K):
    return factor * x


K = 100.0


@dataclasses.dataclass(frozen=True)
class Defaulted(LinearSprings):
    def force(self, motion):
        return with_default(motion.x) + K


def doubled(method):
    @functools.wraps(method)
    def twice(self, motion):
        return 2.0 * method(self, motion)

    return twice


@dataclasses.dataclass(frozen=True)
class Doubled(LinearSprings):
    @doubled
    def force(self, motion):
        return -self.stiffness * motion.x


def by_steps(x):
    return x if x < 1.0 else by_steps(x - 1.0)


@dataclasses.dataclass(frozen=True)
class Recursive(LinearSprings):
    def force(self, motion):
        return by_steps(motion.v + 0.5)


@dataclasses.dataclass(frozen=True)
class OddText(LinearSprings):
    def force(self, motion):
        """Text
        that is not indented."""
        return motion.x


@pytest.mark.parametrize(
    ("law", "value"),
    [(Defaulted(), 100.02), (Doubled(3.0), -0.12), (Recursive(), 0.5), (OddText(), 0.02)],
    ids=lambda item: type(item).__name__,
)
def test_the_compiled_law_is_the_python_law(law, value):
    assert law.force(MOTION) == pytest.approx(value)
    assert compiled_method(law, "force")(MOTION) == pytest.approx(value)


def test_a_law_derived_from_one_in_another_file(tmp_path):
    base = imported(tmp_path / "own_law.py", LAW.format(factor=3.0))
    text = "FACTOR = 7.0\n@dataclass(frozen=True)\nclass Own(Base):\n    pass\n"
    names = {"Base": base.Own, "dataclass": dataclasses.dataclass, "__name__": "derived"}
    exec(compile(text, str(tmp_path / "derived.py"), "exec"), names)
    law = names["Own"]()
    assert compiled_method(law, "force")(MOTION) == law.force(MOTION) == pytest.approx(-0.12)


TYPED = """
import math
def loop(x):
    return loop(x - 1.0) if x > 1.0 else x

class Typed(dataclass_base):
    def force(self, motion):
        return -self.stiffness * math.sin(motion.x)

class Looping(dataclass_base):
    def force(self, motion):
        return loop(motion.x)

class Fuel(FuelControl):
    def equivalence_ratio(self, memory, signals):
        return 0.5
"""


def typed():
    """Classes without a text, as typed into a plain interpreter."""
    names = {"dataclass_base": LinearSprings, "FuelControl": FuelControl, "__name__": "typed"}
    exec(TYPED, names)
    return [dataclasses.dataclass(frozen=True)(names[it]) for it in ("Typed", "Looping", "Fuel")]


def test_laws_without_a_text():
    straight, looping, fuel = typed()
    law = straight(3.0)
    assert compiled_method(law, "force")(MOTION) == pytest.approx(-3.0 * math.sin(0.02))
    with pytest.raises(LawError, match="loop calls itself"):
        compiled_method(looping(), "force")
    assert control_of(Controller(fuel_control=fuel())).address != 0  # before, refused


def test_our_own_text_is_that_of_inspect():
    import inspect

    for name in ("force", "energy"):
        method = getattr(saleg.laws.PreloadedSprings, name)
        assert block_of(method) == inspect.getsource(method)
    assert np.array_equal(found_text(method).lines, inspect.findsource(method)[0])
