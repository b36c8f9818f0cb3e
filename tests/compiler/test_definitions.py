"""Definitions that composed modules of one process have in common."""

import itertools
import types

import pytest

from saleg.compiler import definitions, machine_code
from saleg.compiler.needs import Needs
from saleg.compiler.text import compose_kernel

numbers = itertools.count()
TEXT = """
LIMIT = {limit}
class Point:
    x = 1
def inner(LIMIT):
    return other(LIMIT) - 1
def other(n):
    return inner(n - 1) if n > LIMIT else {value}
def alone(n):
    return n + {more} + GIVEN
def entry_of(function):
    return function
cached = entry_of
@cached
def entry(n):
    return alone(n)
"""


@pytest.fixture(autouse=True)
def nothing_known(monkeypatch):
    monkeypatch.setattr(definitions, "_known", {})
    monkeypatch.setattr(definitions, "_waiting", [])


def executed(limit=3, value=10, more=1, given=100):
    module = types.ModuleType(f"toy_{next(numbers)}")
    module.__file__ = "toy.py"
    module.GIVEN = given
    definitions.execute(TEXT.format(limit=limit, value=value, more=more), module)
    return module


def test_what_is_the_same_with_all_it_uses_is_taken_over():
    first, second = executed(), executed(more=2)
    assert second.Point is first.Point
    assert second.other is first.other
    assert second.inner is first.inner
    assert second.inner is not second.other  # which use each other, and the same names
    assert second.alone is not first.alone
    assert (first.alone(0), second.alone(0)) == (101, 102)


def test_a_function_is_a_modules_own_if_a_constant_or_a_helper_of_it_differs():
    modules = [executed(), executed(limit=0), executed(value=20)]
    assert [one.inner(2) for one in modules] == [9, 7, 19]
    assert len({id(one.inner) for one in modules}) == 3


def test_a_function_is_a_modules_own_if_what_the_module_is_given_differs():
    first, second, third = executed(), executed(given=object()), executed()
    assert second.alone is not first.alone
    assert third.alone is first.alone


def test_entry_points_are_a_modules_own():
    first, second = executed(), executed()
    assert second.entry is not first.entry
    assert second.alone is first.alone


def test_kernels_share_what_does_not_depend_on_the_needs():
    modules = []
    for needs in (Needs(False, False), Needs(True, False)):
        module = types.ModuleType(f"kernel_{next(numbers)}")
        module.__file__ = "kernel.py"
        module.INNER, module.DECLARED = machine_code.inner_compiler(), machine_code.declared
        definitions.execute(compose_kernel(needs), module)
        modules.append(module)
    plain, motored = modules
    for name in ("clearance_of", "orifice_flow", "cubic_root", "heat_loss"):
        assert getattr(motored, name) is getattr(plain, name)
    # These ask for the motored pressure themselves, step it, or call what does.
    for name in ("chamber_rates", "error_norm", "take_adaptive_step", "locate", "watch_step"):
        assert getattr(motored, name) is not getattr(plain, name)
    assert motored.MOTORED_PRESSURE_IS_WANTED is True
    assert plain.MOTORED_PRESSURE_IS_WANTED is False
