"""Ignition delays from chemistry, and Livengood-Wu's integral over them."""

import dataclasses
import math

import numpy as np
import pytest

import saleg
from saleg import fuels, laws
from saleg.fuels import FuelError, delays
from saleg.laws import Charge, Gas

MECHANISMS = {"methane": "gri30.yaml", "propane": "gri30.yaml", "hydrogen": "h2o2.yaml"}


def rate_of(law, p, T, ratio, burnt):
    gas = Gas(p, T, 1.0, p, 1.0, 1.0, 1.0, 500.0, 0.0, 0.0, 0.0)
    charge = Charge(1.0, 0.0, 0.0, burnt, ratio, p, T, 1.0, 1.0)
    return law.rate(gas, charge)


def test_table_over_burnt_gas_is_interpolated():
    law = laws.TabulatedDelay(
        pressures=(1e6, 4e6),
        temperatures=(1000.0,),
        equivalence_ratios=(0.5, 1.0),
        delays=(4e-3, 2e-3, 1e-3, 5e-4, 16e-3, 8e-3, 4e-3, 2e-3),
        burnt_shares=(0.0, 0.4),
    )
    for (p, ratio, burnt), delay in (
        ((1e6, 0.5, 0.0), 4e-3),
        ((1e6, 1.0, 0.4), 8e-3),
        ((4e6, 1.0, 0.9), 2e-3),
        ((2e6, 0.5, 0.0), 2e-3),
        ((2e6, 0.75, 0.2), 2.0 * 2.0**0.5 * 1e-3),
    ):
        assert rate_of(law, p, 1000.0, ratio, burnt) == pytest.approx(1.0 / delay, rel=1e-12)


def test_table_follows_a_curved_formula_without_corners():
    """Between points and at them the slope over the temperature is that of the formula."""

    def delay(p, T):
        return 1e-6 * math.exp(6e3 / T + 6e6 / T**2) * (p / 1e6) ** -0.9

    pressures = tuple(np.geomspace(5e5, 1e7, 9))
    temperatures = tuple(1.0 / np.linspace(1 / 750.0, 1 / 1500.0, 17))
    grid = tuple(delay(p, T) for p in pressures for T in temperatures)
    law = laws.TabulatedDelay(pressures, temperatures, (0.6,), grid)
    for p in (7e5, 3.3e6):
        for T in np.linspace(820.0, 1400.0, 30):
            assert rate_of(law, p, T, 0.6, 0.0) * delay(p, T) == pytest.approx(1.0, abs=2e-3)
        for T in temperatures[2:-2]:
            below, here, above = (math.log(rate_of(law, p, t, 0.6, 0.0)) for t in (T - 1, T, T + 1))
            slope = 6e3 / T**2 + 12e6 / T**3
            assert here - below == pytest.approx(slope, rel=6e-3)
            assert above - here == pytest.approx(slope, rel=6e-3)


def test_a_law_may_hold_numbers_that_follow_from_its_own(base):
    law = laws.TabulatedDelay()
    assert law.ln_delays == tuple(math.log(delay) for delay in law.delays)
    assert law == laws.TabulatedDelay()
    again = dataclasses.replace(law, delays=(0.2, 1e-4, 0.01, 1e-5))
    assert again.ln_delays[0] == math.log(0.2)
    assert "ln_delays" not in base.replace(ignition=law).to_toml()


@pytest.mark.parametrize("fuel", [fuels.methane, fuels.propane, fuels.hydrogen], ids=str)
def test_kept_delays_are_computed_again(fuel):
    pytest.importorskip("cantera", reason="needs the extra 'chemistry'")
    kept = fuels.ignition_delays(fuel)
    law = fuels.compute_delays(
        fuel,
        MECHANISMS[fuel.name],
        pressures=kept.pressures[3:4],
        temperatures=kept.temperatures[8:10],
        equivalence_ratios=(0.5,),
        burnt_shares=(0.2,),
    )
    for T, delay in zip(law.temperatures, law.delays, strict=True):
        assert rate_of(kept, law.pressures[0], T, 0.5, 0.2) == pytest.approx(1 / delay, rel=2e-3)


def compressed(fuel, ratio, T, compression, reacting):
    """Times, temperatures and pressures of a charge compressed harmonically at 47 Hz (Cantera)."""
    cantera = pytest.importorskip("cantera", reason="needs the extra 'chemistry'")
    gas = cantera.Solution(MECHANISMS[fuel.name])
    names = delays.FORMULAS
    gas.TPX = T, 1.05e5, {names[key]: n for key, n in fuel.fresh(ratio).items()}
    if not reacting:
        gas.set_multiplier(0.0)
    reactor = cantera.IdealGasReactor(gas, clone=False)
    reactor.volume = 1.0
    air = cantera.Reservoir(cantera.Solution("air.yaml"), clone=False)
    wall = cantera.Wall(reactor, air)
    wall.area, omega = 1.0, 2.0 * np.pi * 47.0
    wall.velocity = lambda t: -0.5 * (1.0 - 1.0 / compression) * omega * np.sin(omega * t)
    net = cantera.ReactorNet([reactor])
    net.rtol, net.atol, net.max_time_step = 1e-8, 1e-15, 2e-5
    rows = [(0.0, T, 1.05e5)]
    while net.time < 1.2 * np.pi / omega:
        net.step()
        rows.append((net.time, reactor.T, reactor.phase.P))
    return np.array(rows).T


@pytest.mark.parametrize(
    ("fuel", "T", "compression"),
    [
        (fuels.methane, 325.0, 28.0),
        (fuels.methane, 420.0, 28.0),
        (fuels.methane, 460.0, 20.0),
        (fuels.propane, 460.0, 20.0),
        (fuels.hydrogen, 325.0, 20.0),
        (fuels.hydrogen, 400.0, 16.0),
    ],
    ids=str,
)
def test_integral_over_the_table_lights_when_chemistry_does(fuel, T, compression):
    t, hot, _ = compressed(fuel, 0.6, T, compression, reacting=True)
    t_inert, warm, p = compressed(fuel, 0.6, T, compression, reacting=False)
    law = fuels.ignition_delays(fuel)
    rates = np.array([rate_of(law, *state, 0.6, 0.0) for state in zip(p, warm, strict=True)])
    steps = 0.5 * (rates[1:] + rates[:-1]) * np.diff(t_inert)
    integral = np.concatenate([[0.0], np.cumsum(steps)])
    lit = hot.max() > warm.max() + 500.0
    assert lit == bool(integral[-1] >= 1.0)
    if lit:
        chemistry = t[np.argmax(np.gradient(hot, t))]
        ours = np.interp(1.0, integral, t_inert)
        assert abs(ours - chemistry) < 0.06e-3


def test_chemistry_does_not_light_the_base_case(base):
    """Methane at 325 K does not ignite at the compression ratio of the thesis' engine."""
    engine = fuels.fill(base, fuels.methane).replace(ignition=fuels.ignition_delays(fuels.methane))
    run = saleg.simulate(engine, 0.3)
    assert "ignition" not in set(run.events["event"].iloc[3:])


def test_hydrogen_runs_at_less_compression_than_methane(base):
    """Published for simulated dual engines: natural gas 43, hydrogen 29 (Fredriksson, Denbratt)."""
    ratios = {}
    for fuel in (fuels.hydrogen, fuels.methane):
        engine = fuels.fill(base, fuel, equivalence_ratio=0.5).replace(
            ignition=fuels.ignition_delays(fuel),
            **{"intake.temperature": 560.0, "alternator.load_constant": 20.0},
        )
        steady = saleg.steady_state(engine)
        assert steady.status == saleg.Status.STEADY
        ratios[fuel.name] = steady.performance.compression_ratio
    assert ratios["hydrogen"] < ratios["methane"]


def exits_of(engine):
    """Ranges an engine leaves, for its left ignition, by quantity."""
    rows = saleg.simulate(engine, 0.6).range_exits
    return {row["quantity"]: row for row in rows if row["slot"] == "ignition"}


def test_a_table_that_is_left_is_told(base):
    """Kept tables end at phi 1, 200 bar and half of burnt gas, and each has its fuel."""
    hot = base.replace(**{"intake.temperature": 480.0, "alternator.load_constant": 45.0})
    hot = hot.replace(ignition=fuels.ignition_delays(fuels.hydrogen))
    inside = exits_of(fuels.fill(hot, fuels.hydrogen, equivalence_ratio=0.5))
    assert inside == {}
    rich = exits_of(fuels.fill(hot, fuels.hydrogen, equivalence_ratio=1.5))["equivalence_ratio"]
    assert (rich["low"], rich["high"], rich["seen_high"]) == (0.3, 1.0, 1.5)
    assert rich["time_share"] == 1.0
    boosted = hot.replace(**{"intake.pressure": 20e5, "alternator.load_constant": 300.0})
    pressure = exits_of(fuels.fill(boosted, fuels.hydrogen, equivalence_ratio=0.5))["pressure"]
    assert pressure["high"] == 200e5 < pressure["seen_high"]
    light = hot.replace(egr=0.7, **{"alternator.load_constant": 25.0})
    diluted = exits_of(fuels.fill(light, fuels.hydrogen, equivalence_ratio=1.0))
    assert diluted["burnt_share"]["high"] == 0.5 < diluted["burnt_share"]["seen_high"]
    other = exits_of(fuels.fill(hot, fuels.methane, equivalence_ratio=0.5))["air_fuel_ratio"]
    assert other["seen_low"] == pytest.approx(17.12, abs=0.01)
    assert 34.06 < other["high"] < 36.0


def test_tables_are_of_molecules_whatever_they_are_called():
    named = fuels.blend({"hydrogen": 1.0}, name="methane")
    assert fuels.ignition_delays(named) == fuels.ignition_delays(fuels.hydrogen)
    with pytest.raises(FuelError, match="no ignition delays are kept"):
        fuels.ignition_delays(fuels.blend({"hydrogen": 1.0, "methane": 1.0}, name="methane"))


def test_delays_of_other_molecules_are_refused():
    """Dodecane for heptane would run 1.7 times as rich."""
    pytest.importorskip("cantera", reason="needs the extra 'chemistry'")
    names = {"methane": "C2H6", "hydrogn": "H2"}
    with pytest.raises(FuelError, match="'hydrogn'; did you mean 'hydrogen'"):
        fuels.compute_delays(fuels.methane, "gri30.yaml", species=names)
    with pytest.raises(FuelError, match=r"C2H6 of gri30\.yaml is C2H6, and methane is C1H4"):
        fuels.compute_delays(fuels.methane, "gri30.yaml", species={"methane": "C2H6"})
    grid = {"temperatures": [1200.0], "equivalence_ratios": [1.0], "burnt_shares": [0.0]}
    rising = fuels.compute_delays(
        fuels.hydrogen, "h2o2.yaml", pressures=np.geomspace(1e6, 4e6, 2), **grid
    )
    assert rising.pressures == (1e6, pytest.approx(4e6))


def test_every_wrong_argument_of_a_table_is_named():
    with pytest.raises(FuelError) as caught:
        fuels.compute_delays(
            "methane", None, temperatures=[2.0, 1.0], burnt_shares=[1.5], species=["H2"]
        )
    for words in ("fuel = ", "mechanism = None", "temperatures", "burnt_shares", "species = "):
        assert words in str(caught.value)


def test_wrong_tables_are_named():
    for call, words in (
        (lambda: fuels.ignition_delays(fuels.toluene), "no ignition delays are kept for 'toluene'"),
        (lambda: fuels.compute_delays("methane", "gri30.yaml"), "must be a fuel"),
        (
            lambda: fuels.compute_delays(fuels.methane, "x", pressures=[2e5, 1e5], temperatures=[]),
            "temperatures = ",
        ),
    ):
        with pytest.raises(FuelError, match=words):
            call()
    pytest.importorskip("cantera", reason="needs the extra 'chemistry'")
    with pytest.raises(FuelError, match="Cantera cannot read it"):
        fuels.compute_delays(fuels.methane, "no_such.yaml")
    with pytest.raises(FuelError, match=r"h2o2\.yaml has no CH4"):
        fuels.compute_delays(fuels.methane, "h2o2.yaml", burnt_shares=(0.0,))
