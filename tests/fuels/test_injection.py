"""Direct injection: conservation, closed forms, the reference, the mirror, where it never comes."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import brentq

import saleg
from agreement import ORBIT_ONLY, assert_agree, assert_balanced, assert_rows_agree
from fuel_cases import energy
from saleg import fuels, laws, reference
from saleg.engine.start import charge_mass
from saleg.fuels.species import MOLAR_GAS_CONSTANT
from saleg.kernel import layout

PEAKS = (*ORBIT_ONLY, "peak_pressure", "peak_temperature", "peak_velocity")
PLACE, LATENT = 0.06, 3e5


@pytest.fixture(scope="module")
def direct(base):
    """The base case with liquid fuel injected directly, richer and later on the right."""
    engine = base.replace(injection=laws.DirectInjection(clearance=PLACE, latent_heat=LATENT))
    right = {"right.injection.clearance": 0.05, "right.equivalence_ratio": 0.65}
    return engine.replace(**right)


@pytest.fixture(scope="module")
def hydrogen(base):
    """Hydrogen injected into air, all of which is exchanged and burns; its gas follows."""
    engine = base.replace(
        injection=laws.DirectInjection(clearance=PLACE, fuel_temperature=280.0, latent_heat=2e5),
        egr=0.0,
        combustion_efficiency=1.0,
    )
    return fuels.fill(engine, fuels.hydrogen, equivalence_ratio=0.5, follows=True)


def injections(run, side=0):
    """History right before and after each injection into a chamber."""
    rows, events = run.history_rows, run.event_rows
    times = events["t"][(events["kind"] == layout.EVENT_INJECTION) & (events["side"] == side)]
    places = [np.flatnonzero(rows["t"] == t) for t in times]
    return [(rows[place[0]], rows[place[-1]]) for place in places]


def test_mass_and_energy_of_fuel_and_air_are_those_of_the_mixture(hydrogen):
    """With the enthalpy of the vapour, less the latent heat, from the polynomials by hand."""
    run = saleg.simulate(hydrogen, 0.05, rtol=1e-9, history=1)
    fuel, injection = fuels.hydrogen, hydrogen.left.injection
    found = injections(run)
    assert len(found) > 1
    for before, after in found:
        moles = before["mass"][0] / fuels.mixtures.mass_of(fuel.fresh(0.0))
        added = 0.5 * moles * fuel.molar_mass
        air, mixture = ({k: moles * n for k, n in fuel.fresh(r).items()} for r in (0.0, 0.5))
        assert after["mass"][0] - before["mass"][0] == pytest.approx(added, rel=1e-11)
        T = injection.fuel_temperature
        work = MOLAR_GAS_CONSTANT * T * 0.5 * moles
        brought = energy({"hydrogen": 0.5 * moles}, T) + work - added * injection.latent_heat
        wanted = energy(air, before["T"][0]) + brought
        mixed = brentq(lambda T, m=mixture, w=wanted: energy(m, T) - w, 200.0, 999.0, xtol=1e-10)
        assert after["T"][0] == pytest.approx(mixed, rel=1e-9)
        more = sum(mixture.values()) / sum(air.values())
        rise = more * mixed / before["T"][0]
        assert after["p"][0] / before["p"][0] == pytest.approx(rise, rel=1e-9)
        assert after["V"][0] == pytest.approx(before["V"][0], rel=1e-14)


def test_the_ports_close_on_air_alone(hydrogen):
    """It holds so much hydrogen less; port-mixed the fuel takes a sixth of the room at phi 0.5."""
    p, T, clearance = hydrogen.left.reference_state
    moles = p * clearance * hydrogen.left.area / (MOLAR_GAS_CONSTANT * T)
    air = fuels.hydrogen.fresh(0.0)
    trapped = moles / sum(air.values()) * fuels.mixtures.mass_of(air)
    fuel = 0.5 * moles / sum(air.values()) * fuels.hydrogen.molar_mass
    last = saleg.simulate(hydrogen, 0.03).strokes[-1]
    assert last["charge_mass"].max() == pytest.approx(trapped + fuel, rel=1e-12)
    heat = fuel * fuels.hydrogen.lower_heating_value
    assert last["fresh_fuel_energy"].max() == pytest.approx(heat, rel=1e-12)


def test_energy_is_kept_and_the_reference_agrees(direct, hydrogen):
    for engine, tolerance in ((direct, 1e-9), (hydrogen, 1e-8)):
        run = saleg.simulate(engine, 0.08, rtol=1e-10)
        check = reference.simulate(engine, 0.08, rtol=1e-11)
        assert run.fired
        assert "injection" in set(run.events["event"])
        assert_agree(run, check, 1e-6)
        assert_rows_agree(run.strokes, check.strokes, 1e-6, but=PEAKS)
        assert_balanced(run, tolerance)
        assert_balanced(check, tolerance)


def test_fuel_is_kept(direct):
    """What is injected burns or leaves, to rounding."""
    energy = saleg.simulate(direct, 0.5, rtol=1e-9).energy
    used = energy.released + energy.unburnt + energy.stored_fuel
    assert used == pytest.approx(energy.fuel, rel=1e-9)


def test_ports_that_let_gas_flow_lose_no_fuel(base):
    """Fuel that is injected is short-circuited by none; air is, as before."""
    ports = laws.PortFlow(exhaust_width=0.1, intake_width=0.1, intake_delay=0.012)
    engine = base.replace(
        gas_exchange=ports,
        injection=laws.DirectInjection(clearance=PLACE),
        **{"intake.pressure": 1.5e5},
    )
    run = saleg.simulate(engine, 0.06, rtol=1e-10)
    check = reference.simulate(engine, 0.06)
    assert_agree(run, check, 1e-6)
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=PEAKS)
    assert_balanced(run)
    last = run.strokes[-2:]
    assert last["expelled_fresh"].sum() > 1e-5
    whole = engine.left.combustion_efficiency * engine.left.heat_release.burnt_fraction(1.0)
    leaves = (1.0 - whole) * last["fresh_fuel_energy"].sum()
    assert last["exhaust_fuel_energy"].sum() == pytest.approx(leaves, rel=0.05)
    side = int(np.argmax(last["fresh_fuel_energy"][-1]))
    fuel = last["fresh_fuel_energy"][-1][side] / engine.left.fuel.lower_heating_value
    trapped = last["charge_mass"][-1][side] - fuel
    assert last["closing_mass"][-1][side] == pytest.approx(trapped, rel=1e-12)


def test_the_mirror_image_runs_alike_to_the_last_bit(direct):
    run = saleg.simulate(direct, 0.1)
    start = dataclasses.replace(direct.start, position=-direct.start.position)
    image = dataclasses.replace(direct, left=direct.right, right=direct.left, start=start)
    seen = saleg.simulate(image, 0.1)
    assert len(run.event_rows) == len(seen.event_rows)
    np.testing.assert_array_equal(run.event_rows["t"], seen.event_rows["t"])
    np.testing.assert_array_equal(run.event_rows["x"], -seen.event_rows["x"])
    np.testing.assert_array_equal(run.strokes["charge_mass"], seen.strokes["charge_mass"][:, ::-1])


def test_a_steady_state_is_the_one_a_long_run_reaches(direct):
    found, later = saleg.steady_state(direct), saleg.simulate(direct, 1.5).performance
    assert found.stable
    assert found.performance.power == pytest.approx(later.power, rel=1e-5)
    assert found.energy.residual == pytest.approx(0.0, abs=1e-6 * found.energy.fuel)
    phis = (0.55, 0.6)
    engines = [direct.replace(**{"left.equivalence_ratio": phi}) for phi in phis]
    together = saleg.steady_states(engines)
    for row, engine in zip(together["power"], engines, strict=True):
        assert row == pytest.approx(saleg.steady_state(engine).performance.power, rel=1e-5)


def test_what_evaporates_cools_the_charge(direct):
    """By the latent heat over the heat capacity of the charge, in the first injection."""
    dry = direct.replace(**{f"{side}.injection.latent_heat": 0.0 for side in ("left", "right")})
    (before, wet_gas), (_, dry_gas) = (
        injections(saleg.simulate(engine, 0.02, history=1), 1)[0] for engine in (direct, dry)
    )
    law, mass = direct.left.gas_properties, dry_gas["mass"][1]
    fuel = mass - before["mass"][1]
    lost = law.internal_energy(dry_gas["T"][1]) - law.internal_energy(wet_gas["T"][1])
    assert mass * lost == pytest.approx(fuel * LATENT, rel=1e-9)


def test_a_spark_comes_where_it_is_set_though_fuel_came_late(base):
    engine = base.replace(
        injection=laws.DirectInjection(clearance=0.05), ignition=laws.SparkAtClearance(0.02)
    )
    check = reference.simulate(engine, 0.012)
    x = check.event_rows["x"][check.event_rows["kind"] == layout.EVENT_IGNITION]
    assert len(x)
    np.testing.assert_allclose(engine.left.half_stroke - np.abs(x), 0.02, rtol=1e-9)


def test_a_piston_that_does_not_come_so_far_has_no_fuel(direct):
    """The engine stalls; nothing is raised."""
    late = {f"{side}.injection.clearance": 2e-4 for side in ("left", "right")}
    run = saleg.simulate(direct.replace(**late), 2.0)
    assert run.status is saleg.Status.STALLED
    assert "injection" not in set(run.events["event"])
    assert not saleg.steady_state(direct.replace(**late)).found


@pytest.mark.parametrize("clearance", [0.2, 1e-5])
def test_a_place_before_the_ports_close_or_beyond_the_head_is_refused(base, clearance):
    engine = base.replace(injection=laws.DirectInjection(clearance=clearance))
    with pytest.raises(saleg.InvalidEngine) as error:
        engine.validate()
    assert len(error.value.problems) == 1
    assert error.value.problems[0].path == "injection.clearance"
    assert "port_closing" in str(error.value)


def test_more_latent_heat_than_the_charge_has_ends_a_run_with_a_status(direct):
    cold = {f"{side}.injection.latent_heat": 1e8 for side in ("left", "right")}
    run = saleg.simulate(direct.replace(**cold), 0.05)
    assert run.status is saleg.Status.STEP_FAILURE


def test_fuel_can_be_metered_by_heat(hydrogen):
    """The heat asked for is what is injected, though the charge has no fuel as it closes."""
    run = saleg.simulate(fuels.fill(hydrogen, fuels.hydrogen, heat=600.0, follows=True), 0.03)
    assert run.strokes["fresh_fuel_energy"][-1].max() == pytest.approx(600.0, rel=1e-10)


def test_heat_is_that_of_the_whole_charge_with_what_is_retained(hydrogen):
    """Half of what did not burn is retained: it counts as fuel of the next charge."""
    leaky = hydrogen.replace(egr=0.5, combustion_efficiency=0.8)
    steady = saleg.steady_state(fuels.fill(leaky, fuels.hydrogen, heat=600.0, follows=True))
    burnt = 0.8 * hydrogen.left.heat_release.burnt_fraction(1.0)
    assert steady.strokes["heat_released"].sum(axis=0) == pytest.approx(600.0 * burnt, rel=1e-6)


def test_a_gas_of_another_way_of_mixing_is_told(base, hydrogen):
    mixed = fuels.fill(base, fuels.hydrogen, equivalence_ratio=0.5)
    injection = hydrogen.left.injection
    left, right = (dataclasses.replace(one, injection=injection) for one in mixed.chambers)
    (told, _) = dataclasses.replace(mixed, left=left, right=right).unusual()
    assert told.path == "left.injection"
    assert "another way of mixing" in str(told)
    assert not mixed.replace(injection=injection).unusual()  # its gas follows


def test_a_charger_delivers_no_fuel_that_is_injected(direct):
    steady = saleg.steady_state(direct)
    closed_on = sum(charge_mass(one) * (1.0 - one.gas_exchange.egr) for one in direct.chambers)
    wanted = closed_on * steady.performance.frequency
    assert steady.net_output().delivered == pytest.approx(wanted, rel=1e-6)
