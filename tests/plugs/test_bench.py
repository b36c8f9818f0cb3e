"""An alternator along a given motion, beside closed forms."""

import numpy as np
import pytest

from saleg.errors import WrongArguments
from saleg.laws import CircuitAlternator, ConstantForce, LinearLoad
from saleg.plugs.bench import MotionError, prescribed_motion

OMEGA = 2.0 * np.pi * 40.0
T = np.linspace(0.0, 0.2, 4001)
X = 0.04 * np.sin(OMEGA * T)


def test_a_sine_through_a_coil_has_the_current_of_the_textbook():
    """``L i' + R i = k X w cos(w t)``: a sine that lags, and what switching on leaves dies out."""
    law = CircuitAlternator(flux_gradient=50.0, inductance=0.02, coil_resistance=1.8)
    resistance, reactance = 1.8 + law.load_resistance / 0.8, OMEGA * law.inductance
    lag = np.arctan2(reactance, resistance)
    amplitude = 50.0 * 0.04 * OMEGA / np.hypot(resistance, reactance)
    steady = amplitude * np.cos(OMEGA * T - lag)
    current = steady + (2.0 - steady[0]) * np.exp(-resistance / law.inductance * T)
    bench = prescribed_motion(law, T, X, load_weight=0.8, current=2.0)
    np.testing.assert_allclose(bench.current, current, atol=1e-7 * amplitude)
    np.testing.assert_allclose(bench.force, 50.0 * current, atol=1e-5 * amplitude)
    load = law.load_resistance / 0.8
    np.testing.assert_allclose(bench.voltage, load * current, atol=1e-5 * amplitude)
    np.testing.assert_allclose(
        bench.electrical_power, load * current**2, atol=1e-5 * load * amplitude**2
    )
    assert bench.attrs["units"]["voltage"] == "V"


def test_the_work_of_the_force_is_what_load_and_coil_take():
    """Over whole periods the coil stores nothing: work = (r + R) times the integral of i^2."""
    law = CircuitAlternator()
    bench = prescribed_motion(law, T, X)
    late = bench[(bench.t >= 0.1 - 1e-9)]
    work = np.trapezoid(late.force * late.v, late.t)
    heat = law.coil_resistance * np.trapezoid(late.current**2, late.t)
    assert work == pytest.approx(heat + np.trapezoid(late.electrical_power, late.t), rel=1e-6)


def test_a_linear_load_follows_the_velocity():
    bench = prescribed_motion(LinearLoad(load_constant=70.0, efficiency=0.9), T, X)
    v = 0.04 * OMEGA * np.cos(OMEGA * T)
    np.testing.assert_allclose(bench.force, 70.0 * v, atol=1e-4)
    np.testing.assert_allclose(bench.electrical_power, 0.9 * 70.0 * v**2, rtol=1e-6, atol=1e-4)
    assert "current" not in bench


def test_a_constant_force_turns_at_the_dead_centres():
    bench = prescribed_motion(ConstantForce(amplitude=100.0), T, X)
    inside = np.abs(np.cos(OMEGA * T)) > 1e-6
    np.testing.assert_array_equal(bench.force[inside], 100.0 * np.sign(np.cos(OMEGA * T[inside])))


def test_what_is_no_motion_is_named():
    with pytest.raises(MotionError, match="t must rise"):
        prescribed_motion(LinearLoad(), [0.0, 0.2, 0.1, 0.3], [0.0, 1.0, 2.0, 3.0])
    with pytest.raises(MotionError, match="at least four"):
        prescribed_motion(LinearLoad(), [0.0, 0.1, 0.2], [0.0, 1.0, 2.0])
    odd = X.copy()
    odd[17] = np.nan
    with pytest.raises(WrongArguments, match=r"x = .*finite numbers, or the like; item 17 is nan"):
        prescribed_motion(LinearLoad(), T, odd)
    with pytest.raises(WrongArguments, match="alternator"):
        prescribed_motion(None, T, X)
