"""Gas whose composition follows the combustion: closed forms, the reference, conservation."""

import numpy as np
import pytest
from scipy.optimize import brentq

import saleg
from agreement import assert_agree, assert_balanced
from fuel_cases import BLENDS, FUELS, cantera_gas, energy
from saleg import fuels, laws, reference
from saleg.fuels import mixtures
from saleg.laws import Parts

BASE = saleg.machines.thesis_base().replace(
    **{
        "egr": 0.0,
        "combustion_efficiency": 1.0,
        "right.heat_release": laws.InstantRelease(),
        "right.ignition": laws.IgnitionAtDeadCentre(),
    }
)


def burnt_at_constant_volume(fuel, ratio, T):
    """Temperature to which a charge of a temperature burns completely in a closed vessel [K]."""
    before = energy(fuel.fresh(ratio), T)
    return brentq(lambda hot: energy(fuel.burnt(ratio), hot) - before, 1000.5, 6000.0, xtol=1e-9)


def jumps(run, side):
    """State of a chamber before and after each of its charges burns at once."""
    rows = run.history_rows
    T = rows["T"][:, side]
    found = np.flatnonzero((np.diff(rows["t"]) == 0.0) & (np.diff(T) > 300.0))
    return [(rows[n], rows[n + 1]) for n in found]


@pytest.mark.parametrize("fuel", [*FUELS, *BLENDS], ids=lambda fuel: fuel.name)
def test_a_charge_burns_at_constant_volume_to_the_temperature_of_the_closed_form(fuel):
    for ratio in (0.5, 1.3):
        engine = fuels.fill(BASE, fuel, equivalence_ratio=ratio, follows=True)
        run = saleg.simulate(engine, 0.04, rtol=1e-9, history=1)
        p, T, clearance = engine.right.reference_state
        gas_constant = fuel.charge(ratio).gas_constant
        filled = p * clearance * engine.right.area / (gas_constant * T)
        assert run.strokes["charge_mass"][-1][1] == pytest.approx(filled, rel=1e-12)
        before, after = jumps(run, 1)[-1]
        cold, hot = before["T"][1], after["T"][1]
        assert hot == pytest.approx(burnt_at_constant_volume(fuel, ratio, cold), rel=2e-8)
        moles = [sum(gas.values()) for gas in (fuel.fresh(ratio), fuel.burnt(ratio))]
        rise = moles[1] / moles[0] * hot / cold
        assert after["p"][1] / before["p"][1] == pytest.approx(rise, rel=2e-8)
        assert before["V"][1] == after["V"][1]


def test_that_temperature_is_the_one_of_cantera():
    fuel, ratio, T = fuels.hydrogen, 0.8, 900.0
    _, gas = cantera_gas(fuel.fresh(ratio))
    gas.TP = T, 50e5
    energy_before, volume = gas.int_energy_mass, gas.volume_mass
    _, gas = cantera_gas(fuel.burnt(ratio))
    gas.UV = energy_before, volume
    assert burnt_at_constant_volume(fuel, ratio, T) == pytest.approx(gas.T, rel=1e-6)


@pytest.mark.parametrize("fuel", [*FUELS, *BLENDS], ids=lambda fuel: fuel.name)
def test_parts_add_up_to_the_gas_of_the_charge(fuel):
    law = fuel.burning_gas(0.6)
    fuel_share = 0.6 / (0.6 + fuel.air_fuel_ratio)
    fresh = Parts(fuel_share, 1.0 - fuel_share, 0.0)
    gone = Parts(0.0, 1.0 - fuel_share * (1.0 + fuel.air_fuel_ratio), 0.0)
    gone = gone._replace(burnt=1.0 - gone.air)
    for parts, moles in ((fresh, fuel.fresh(0.6)), (gone, fuel.burnt(0.6))):
        gas = fuels.gas_of(moles)
        assert np.dot(law.gas_constants, parts) == pytest.approx(gas.gas_constant, rel=1e-12)
        for T in (400.0, 999.0, 1001.0, 2600.0):
            heat_capacity = gas.gas_constant / (gas.gamma(T) - 1.0)
            assert law.heat_capacity_of(T, parts) == pytest.approx(heat_capacity, rel=1e-12)
            rise = law.energy_of(T, parts) - law.energy_of(298.15, parts)
            assert rise == pytest.approx(gas.internal_energy(T), rel=1e-10, abs=1e-6)
    # The heating value at 298.15 K and constant pressure is what burning gives.
    n = 1.0 / mixtures.mass_of(fuel.fresh(0.6))
    given = n * (energy(fuel.fresh(0.6), 298.15) - energy(fuel.burnt(0.6), 298.15))
    ours = law.energy_of(298.15, fresh) - law.energy_of(298.15, gone)
    assert ours + fuel_share * fuel.lower_heating_value == pytest.approx(given, rel=1e-9)


def test_an_engine_agrees_with_the_reference_and_keeps_its_energy():
    engine = fuels.fill(BASE.replace(egr=0.12), fuels.hydrogen, equivalence_ratio=0.5, follows=True)
    engine = engine.replace(combustion_efficiency=0.95)
    run = saleg.simulate(engine, 0.2, rtol=1e-10)
    check = reference.simulate(engine, 0.2, jitted=True, rtol=1e-11)
    assert run.fired
    assert_agree(run, check, 1e-6)
    assert_balanced(run, 1e-8)
    steady = saleg.steady_state(engine).performance
    later = saleg.simulate(engine, 1.5).performance
    assert steady.power == pytest.approx(later.power, rel=1e-4)


def test_gas_may_not_flow_in_or_out_of_it(base):
    engine = fuels.fill(base, fuels.methane, follows=True)
    for changes in ({"leak": laws.RingLeak()}, {"gas_exchange": laws.PortFlow()}):
        with pytest.raises(saleg.InvalidEngine, match="gas_properties"):
            engine.replace(**changes).validate()
