"""Flow through an orifice, and vessels that fill and empty, against closed forms."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import quad

import saleg
from saleg import laws
from saleg.engine.start import AtRest
from saleg.kernel.flow import NEARLY_EQUAL, flow_function, orifice_flow

GAMMA, R = 1.4, 287.0


@pytest.mark.parametrize("g", [1.15, 1.3, 1.4, 1.66])
def test_choked_flow_is_that_of_the_critical_ratio(g):
    choked = math.sqrt(g) * (2.0 / (g + 1.0)) ** ((g + 1.0) / (2.0 * (g - 1.0)))
    critical = (2.0 / (g + 1.0)) ** (g / (g - 1.0))
    for ratio in (0.01, 0.3, critical):
        assert flow_function(ratio, g) == pytest.approx(choked, rel=1e-12)
    assert flow_function(critical + 0.05, g) < choked


@pytest.mark.parametrize("ratio", [0.6, 0.8, 0.95, 0.998])
def test_flow_below_the_speed_of_sound_is_density_times_velocity(ratio):
    p, T, area = 2e5, 400.0, 1e-4
    cold = T * ratio ** ((GAMMA - 1.0) / GAMMA)
    velocity = math.sqrt(2.0 * GAMMA / (GAMMA - 1.0) * R * (T - cold))
    flow = area * ratio * p / (R * cold) * velocity
    assert orifice_flow(area, p, T, ratio * p, GAMMA, R) == pytest.approx(flow, rel=1e-12)


def test_flow_next_to_equal_pressures_is_smooth_and_odd():
    edge = 1.0 - NEARLY_EQUAL
    below, above = (flow_function(edge + d, GAMMA) for d in (-1e-9, 1e-9))
    assert below == pytest.approx(above, rel=1e-5)
    slopes = [
        (flow_function(edge + d + 1e-7, GAMMA) - flow_function(edge + d - 1e-7, GAMMA)) / 2e-7
        for d in (-2e-7, 2e-7)
    ]
    assert slopes[0] == pytest.approx(slopes[1], rel=5e-3)
    assert flow_function(1.0, GAMMA) == 0.0


def vessels(pressure, leak, other, duration):
    """Two equal vessels at rest with equal openings; the right one's is that of a valve."""
    chamber = saleg.BounceChamber(
        bore=0.06,
        half_stroke=0.1,
        pressure=pressure,
        temperature=500.0,
        gas_properties=laws.ConstantGamma(value=GAMMA, gas_constant=R),
    )
    left, right = (dataclasses.replace(chamber, leak=one) for one in (leak, other))
    engine = saleg.Engine(
        saleg.Translator(2.0), left, right, alternator=laws.LinearLoad(), start=AtRest()
    )
    run = saleg.simulate(engine, duration, rtol=1e-9, history=1)
    return chamber, run.history


def rings(gap, **beyond):
    """A gap past the rings, and a valve that never opens beside one."""
    return laws.RingLeak(gap=gap, **beyond), laws.MakeUpValve(valve=0.0, gap=gap, **beyond)


def choked_constant():
    return math.sqrt(GAMMA) * (2.0 / (GAMMA + 1.0)) ** ((GAMMA + 1.0) / (2.0 * (GAMMA - 1.0)))


def test_a_vessel_empties_through_a_choked_opening_as_the_closed_form_has_it():
    p0, T0, gap = 40e5, 500.0, 2e-5
    chamber, history = vessels(p0, *rings(gap, pressure=1e5), 0.06)
    volume = chamber.area * chamber.half_stroke
    rate = 0.5 * (GAMMA - 1.0) * choked_constant() * gap * math.sqrt(R * T0) / volume
    t, p, T = (history[name].to_numpy() for name in ("t", "p_left", "T_left"))
    choked = p > 2.0e5
    assert p[choked].min() < 0.5 * p0
    expected = p0 * (1.0 + rate * t) ** (-2.0 * GAMMA / (GAMMA - 1.0))
    np.testing.assert_allclose(p[choked], expected[choked], rtol=1e-7)
    # What stays behind has expanded without heat, all the way to the pressure beyond.
    np.testing.assert_allclose(T, T0 * (p / p0) ** ((GAMMA - 1.0) / GAMMA), rtol=1e-7)


def test_a_vessel_below_the_critical_pressure_empties_in_the_time_of_the_integral():
    p0, T0, gap, beyond = 1.5e5, 500.0, 2e-5, 1e5
    chamber, history = vessels(p0, *rings(gap, pressure=beyond), 0.02)
    volume = chamber.area * chamber.half_stroke
    t, p = history["t"].to_numpy(), history["p_left"].to_numpy()

    def time_per_pressure(pressure):
        T = T0 * (pressure / p0) ** ((GAMMA - 1.0) / GAMMA)
        flow = orifice_flow(gap, pressure, T, beyond, GAMMA, R)
        return volume / (GAMMA * R * T * flow)

    k = int(np.argmin(np.abs(p - 1.1e5)))
    assert t[k] > 1e-3
    assert quad(time_per_pressure, p[k], p0)[0] == pytest.approx(t[k], rel=1e-6)


def test_a_vessel_fills_through_a_choked_opening_at_a_constant_rate():
    supply, hot = 80e5, 350.0
    p0, T0 = 2e5, 500.0
    leak, valve = rings(2e-5, pressure=supply, temperature=hot)
    chamber, history = vessels(p0, leak, valve, 0.025)
    volume = chamber.area * chamber.half_stroke
    flow = leak.gap * supply / math.sqrt(R * hot) * choked_constant()
    t, p, T = (history[name].to_numpy() for name in ("t", "p_left", "T_left"))
    choked = p < 0.52 * supply
    assert p[choked].max() > 20e5
    np.testing.assert_allclose(p[choked], (p0 + GAMMA * R * hot * flow / volume * t)[choked], 1e-7)
    mass = p0 * volume / (R * T0) + flow * t
    np.testing.assert_allclose(T[choked], (p * volume / (R * mass))[choked], rtol=1e-7)


def test_a_make_up_valve_lets_gas_in_and_none_out():
    supply = {"pressure": 10e5, "temperature": 300.0}
    valve = laws.MakeUpValve(valve=2e-5, **supply)
    _, low = vessels(2e5, laws.RingLeak(gap=2e-5, **supply), valve, 0.3)
    _, high = vessels(20e5, laws.RingLeak(gap=0.0, **supply), valve, 0.05)
    assert low["p_right"].iloc[-1] == pytest.approx(10e5, rel=2e-3)
    assert (high["p_right"] == high["p_right"].iloc[0]).all()
