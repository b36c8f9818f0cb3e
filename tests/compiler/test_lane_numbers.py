"""Numbers of several engines side by side: each lane calculates what a float does."""

import math

import numpy as np
import pytest
from numba import njit

from saleg.compiler.lanes import functions  # noqa: F401  (numba learns them)
from saleg.compiler.lanes.storage import numbers_of
from saleg.laws.choice import any_of, where

WIDTH, ROWS = 4, 64
COUNT = WIDTH * ROWS
ODD = [0.0, -0.0, math.inf, -math.inf, math.nan, 5e-324, 1e-310, -1.0, 709.9, -745.2, -746.0, 1e300]


def on_lanes(function):
    """A function of two numbers, of arrays, calculated side by side."""
    one = njit(function, error_model="numpy", _nrt=False, forceinline=True)

    @njit(error_model="numpy", _nrt=False)
    def calculate(a, b, result):
        x, y = numbers_of(a, ROWS, WIDTH), numbers_of(b, ROWS, WIDTH)
        z = numbers_of(result, ROWS, WIDTH)
        for n in range(ROWS):
            z[n] = one(x[n], y[n])

    def of_arrays(a, b):
        result = np.empty(COUNT)
        calculate(a, b, result)
        return result

    return of_arrays


def as_floats(function):
    """The same, one number after the other, as compiled code has it."""
    one = njit(function, error_model="numpy")
    return lambda a, b: np.array([one(float(x), float(y)) for x, y in zip(a, b, strict=True)])


def units_apart(a, b):
    """Greatest distance of numbers in units of the last place."""
    return np.max(np.abs(a - b) / np.spacing(np.abs(b)))


@pytest.fixture(scope="module")
def numbers():
    rng = np.random.default_rng(3)
    return rng.uniform(-700.0, 700.0, COUNT), rng.uniform(-3.0, 3.0, COUNT)


def exponential(x, y):
    return math.exp(x)


def logarithm(x, y):
    return math.log(x)


def power(x, y):
    return x**y


@pytest.mark.parametrize(
    ("function", "most"), [(exponential, 2.0), (logarithm, 2.0)], ids=["exp", "log"]
)
def test_exp_and_log_are_right_to_the_last_places(numbers, function, most):
    x, y = numbers
    if function is logarithm:
        x = np.exp(x)
        x[::2] = np.linspace(0.5, 2.0, COUNT // 2)
    wanted = np.array([function(one, 0.0) for one in x])
    assert units_apart(on_lanes(function)(x, y), wanted) <= most


def test_a_power_is_right_for_its_size(numbers):
    x, y = np.exp(numbers[0] / 100.0), numbers[1]
    wanted = x**y
    assert np.abs(on_lanes(power)(x, y) / wanted - 1.0).max() < 20.0 * np.finfo(float).eps
    assert np.array_equal(on_lanes(power)(x, np.full(COUNT, 2.0)), x * x)


@pytest.mark.parametrize("function", [exponential, logarithm, power])
def test_odd_numbers_are_left_to_the_library_and_no_lane_sees_another(numbers, function):
    x, y = np.exp(numbers[0] / 100.0), numbers[1]
    usual = on_lanes(function)(x, y)
    places = np.arange(len(ODD)) * 5
    x[places] = ODD
    found = on_lanes(function)(x, y)
    wanted = as_floats(function)(x[places], y[places])
    np.testing.assert_allclose(found[places], wanted, rtol=1e-13, atol=0.0)
    others = np.delete(np.arange(COUNT), places)
    assert np.array_equal(found[others], usual[others])


def arithmetic(x, y):
    z = -x / y + 2 * abs(x) - (y - 1.0) * x
    z += min(x, y, 1.0) * max(0.5, y) + math.copysign(x, y)
    return z + math.sqrt(abs(y)) + y**3 + y**-2


def others(x, y):
    return math.sin(x) * math.cos(y) + math.tanh(y) - math.expm1(y) + math.log1p(abs(x))


def choices(x, y):
    result = 0.0
    low = (x < y) & (y <= 1.0) | (x == 0.0)
    if any_of(low):
        result = where(low, x * y, 0)
    return where(math.isfinite(x), result, -1.0)


@pytest.mark.parametrize("function", [arithmetic, others, choices])
def test_all_else_is_what_floats_give_exactly(numbers, function):
    x, y = numbers[0] / 100.0, numbers[1].copy()
    y[:2] = math.nan, math.inf
    np.testing.assert_array_equal(on_lanes(function)(x, y), as_floats(function)(x, y))


def test_a_choice_is_ordinary_python_for_one_engine():
    assert where(True, 1.0, 2.0) == 1.0
    assert where(False, 1.0, 2.0) == 2.0
    assert any_of(2.0 > 1.0) is True
