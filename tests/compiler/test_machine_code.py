"""Numba's inside, and the longer way round where it has changed."""

import math
import subprocess
import sys
import types

import numba
import numpy as np
import pytest

from saleg.compiler import machine_code
from saleg.compiler.kernel import Kernel
from saleg.compiler.text import COMPILED_HEADER, own_text

RUN_AT, RUN_PLAINLY = "compiler/run_at.py", "kernel/run_plainly.py"

TOY = """
import numba
import numpy as np
Integration = tuple
{header}
cached = numba.njit(error_model="numpy", nogil=True)

@cached
def double(a):
    return 2.0 * a[0]

{run_at}
@cached
def run_on(run):
    y, step = run
    y[0] += step
    return 7

@cached
def outer(address, run):
    return run_at(address, run) + 1
"""


def toy(run_at):
    module = types.ModuleType("toy")
    module.INNER = machine_code.inner_compiler()
    exec(TOY.format(header=COMPILED_HEADER, run_at=own_text(run_at)), module.__dict__)
    return Kernel(module, None)


@pytest.fixture
def no_addresses(monkeypatch):
    gone = "numba.core.codegen:JITCodeLibrary.gone"
    monkeypatch.setattr(machine_code, "ADDRESS_NEEDS", (*machine_code.ADDRESS_NEEDS, gone))


class Changed:
    """A dispatcher of a numba that has kept nothing but the call."""

    def __init__(self, function):
        self._function = function

    def __call__(self, *arguments):
        return self._function(*arguments)


def test_this_numba_has_addresses():
    assert machine_code.has_addresses()


def test_this_numba_compiles_inner_functions_with_their_callers():
    assert machine_code.inner_compiler() is not None


@pytest.mark.parametrize("name", machine_code.INNER_NEEDS)
def test_all_that_inner_functions_need_is_asked_for(name, monkeypatch):
    monkeypatch.setattr(machine_code, "INNER_NEEDS", (name + "_gone",))
    assert machine_code.inner_compiler() is None
    assert machine_code.entry_compiler() is None


INNER = """
import numba
{header}
cached = numba.njit(error_model="numpy", _nrt=False, nogil=True, pipeline_class=ENTRY)

@inline
def root(a):
    if a < 0.0:
        raise ValueError("negative")
    return a**0.5

@compiled
def sum_of_roots(n):
    def of(i):
        return root(float(i))
    total = 0.0
    for i in range(n):
        total += of(i)
    return total

@cached
def both(n):
    return sum_of_roots(n), root(n - 5.0)
"""


@pytest.mark.parametrize("has_changed", [False, True])
def test_inner_functions_return_and_raise_as_numba_does(has_changed):
    inner, entry = machine_code.inner_compiler(), machine_code.entry_compiler()
    names = {"INNER": None if has_changed else inner, "ENTRY": None if has_changed else entry}
    exec(INNER.format(header=COMPILED_HEADER), names)
    assert names["both"](9) == (sum(math.sqrt(i) for i in range(9)), 2.0)
    with pytest.raises(ValueError, match="negative"):
        names["both"](4)
    (inner,) = names["root"].overloads.values()
    address = inner.library.get_pointer_to_function(inner.fndesc.llvm_func_name)
    assert (address != 0) is has_changed


@pytest.mark.parametrize("name", machine_code.ADDRESS_NEEDS)
def test_all_that_is_needed_is_asked_for(name, monkeypatch):
    monkeypatch.setattr(machine_code, "ADDRESS_NEEDS", (name + "_gone",))
    assert not machine_code.has_addresses()


def test_entry_points_are_called_directly():
    kernel = toy(RUN_AT)
    assert kernel.call("double", np.array([1.5])) == 3.0
    assert kernel.call("double", np.array([2.0])) == 4.0
    assert machine_code.is_compiled(kernel.function("double"), (numba.float64[::1],))


def test_without_entry_points_numba_is_called():
    kernel = toy(RUN_AT)
    kernel.module.double = Changed(kernel.module.double)
    assert kernel.call("double", np.array([1.5])) == 3.0
    assert kernel.call("double", np.array([2.0])) == 4.0


def integrated(kernel):
    """Two calls of the toy's integrator from the toy's search."""
    y = np.zeros(1)
    address = kernel.address("run_on", ((y, 0.5),))
    assert kernel.call("outer", address, (y, 0.5)) == 8
    assert kernel.call("outer", address, (y, 0.25)) == 8
    assert math.isclose(y[0], 0.75)
    return address


def test_the_integrator_is_called_by_its_address():
    kernel = toy(RUN_AT)
    assert integrated(kernel) != 0
    # Its caller knows the address only: it has not compiled the integrator for itself.
    del kernel.module.run_on
    assert kernel.call("outer", kernel.address("run_on", ()), (np.zeros(1), 0.5)) == 8


def test_without_addresses_it_is_called_by_name(no_addresses):
    assert integrated(toy(RUN_PLAINLY)) == 0


ARRAYS = """
import sys
import numba, numpy
from numba.np import linalg
from saleg.compiler.machine_code import import_arrays
asked = linalg.ensure_blas
import_arrays()
assert "numba.np.arraymath" in sys.modules and "scipy.linalg" not in sys.modules
assert linalg.ensure_blas is asked
product = numba.njit(lambda a: numpy.dot(a, a))
assert (product(2.0 * numpy.eye(2)) == 4.0 * numpy.eye(2)).all() and "scipy.linalg" in sys.modules
"""


def test_arrays_are_imported_without_blas_until_somebody_asks_for_it():
    subprocess.run([sys.executable, "-c", ARRAYS], check=True)
