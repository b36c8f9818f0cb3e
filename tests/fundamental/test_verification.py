"""The numeric engine under the assumptions of Chapter 2, beside its closed form."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import saleg
from agreement import ORBIT_ONLY, assert_balanced, assert_rows_agree
from saleg import Status, laws, reference
from saleg import fundamental as fm
from saleg.errors import OutsideModel

AGREEMENT = 1e-6

EARLY = fm.AtPressure(8.0)
LOSSY = fm.Polytropic(1.4, compression=1.35, expansion=1.45)
FIRED = fm.System(pressure=0.5, heat=1.0)


def fired(load, **changes):
    return dataclasses.replace(FIRED, load=load, **changes)


def base_like(load, **changes):
    return fm.System(pressure=0.17, heat=2.2, load=load, **changes)


# System, start, strokes, and what becomes of it; all deviations seen are below 1e-8 but in the
# last strokes of a decay, which are tiny.
CASES = {
    "springs alone": (fm.System(pressure=0.0), -0.8, 20, "equilibrium"),
    "springs and gas": (fm.System(pressure=0.3), -0.8, 20, "equilibrium"),
    "below the attracting equilibrium": (fired(fm.ConstantLoad(0.36)), -0.2, 120, "rising"),
    "above it": (fired(fm.ConstantLoad(0.36)), -0.5, 120, "falling"),
    "at a repelling equilibrium": (
        fm.at_equilibrium(base_like(fm.ConstantLoad()), -0.9),
        -0.9,
        8,
        "equilibrium",
    ),
    "runaway": (fired(fm.ConstantLoad(0.30)), -0.5, 100, "runaway"),
    "decay": (fired(fm.ConstantLoad(0.42)), -0.5, 100, "decay"),
    "held by its load": (fired(fm.ConstantLoad(3.0)), -0.3, 10, "decay"),
    "cosine at equilibrium": (fm.at_equilibrium(fired(fm.CosineLoad()), -0.6), -0.6, 20, None),
    "cosine, unequal strokes": (fired(fm.CosineLoad(0.5)), -0.8, 10, "falling"),
    "early": (base_like(fm.ConstantLoad(0.75), ignition=EARLY), -0.9, 20, None),
    "early, until it misses": (base_like(fm.ConstantLoad(0.9), ignition=EARLY), -0.97, 20, "decay"),
    "combined": (
        base_like(fm.CosineLoad(0.9), ignition=EARLY, gas=LOSSY),
        -0.9,
        40,
        "falling",
    ),
}


def finished(history):
    """Strokes that neither end in a head nor never begin."""
    return sum(float(s.impact) == 0.0 < float(s.duration) for s in history.strokes)


@pytest.mark.parametrize("name", CASES)
def test_numeric_engine_agrees_with_the_closed_form(name):
    system, start, strokes, outcome = CASES[name]
    verification = fm.verify(system, start, strokes)
    assert verification.strokes == finished(verification.history)
    if outcome is not None:
        assert verification.history.outcome == outcome
    for quantity, deviation in verification.deviations.items():
        assert deviation.max(initial=0.0) < AGREEMENT, quantity
    if verification.strokes > 1:
        closed, numeric = verification.frequencies
        assert numeric == pytest.approx(closed, rel=AGREEMENT)


KINDS = st.sampled_from(
    [
        (fm.ConstantLoad, False, False),
        (fm.CosineLoad, False, False),
        (fm.ConstantLoad, True, False),
        (fm.CosineLoad, True, True),
    ]
)
EXPONENTS = st.floats(1.15, 1.67)
SCALES = st.builds(
    fm.Scales,
    half_stroke=st.floats(0.02, 0.3),
    bore=st.floats(0.02, 0.2),
    stiffness=st.floats(1e3, 1e6),
    mass=st.floats(0.2, 50.0),
)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    KINDS,
    st.tuples(EXPONENTS, EXPONENTS, EXPONENTS),
    st.floats(0.02, 3.0),
    st.floats(0.0, 5.0),
    st.floats(0.0, 0.5),
    st.floats(1.5, 30.0),
    st.floats(0.1, 0.97),
    SCALES,
)
def test_random_systems_agree(kind, exponents, pressure, heat, share, ratio, depth, scales):
    load, burns_early, loses_heat = kind
    system = fm.System(
        pressure=pressure,
        heat=heat,
        load=load(share * heat),
        gas=fm.Polytropic(*exponents) if loses_heat else fm.Isentropic(exponents[0]),
        ignition=fm.AtPressure(ratio) if burns_early else fm.AtDeadCentre(),
    )
    verification = fm.verify(system, -depth, 6, scales=scales)
    depths = np.array([float(stroke.depth) for stroke in verification.history.strokes])
    lit = system.ignition.position(system.gas)
    # Left out: a charge that all but misses its threshold, a stroke that all but hits the head.
    assume(np.all(np.abs(depths - lit) > 1e-4) and not np.any((depths > 0.999) & (depths < 1.0)))
    assert verification.strokes == finished(verification.history)
    assert verification.worst < AGREEMENT


def test_the_energies_are_those_of_the_balance():
    """Nothing is compared with itself: heat, work and losses add up on either side."""
    system, start, _, _ = CASES["combined"]
    verification = fm.verify(system, start, 6)
    for side in (verification.closed_form, verification.numeric):
        before = np.diff(side["stored"])
        spent = (side["work"] + side["heat_transfer"] + side["rejected"])[1:]
        np.testing.assert_allclose(before, side["heat"][1:] - spent, atol=1e-8)
    assert verification.numeric["heat_transfer"].min() > 0.01
    assert verification.numeric["rejected"][1:].min() > 0.1


def test_the_numeric_engine_settles_where_the_closed_form_does():
    """At the attracting equilibrium the balances of a cycle are the same, term by term."""
    system, start, _, _ = CASES["combined"]
    (equilibrium,) = fm.equilibria(system)
    verification = fm.verify(system, start, 200)
    run, energy = verification.run, verification.scales.energy
    assert run.status is Status.STEADY
    stroke = 2.0 * equilibrium.depth * verification.scales.length
    assert run.performance.stroke == pytest.approx(stroke, rel=AGREEMENT)
    balance = fm.cycle_balance(verification.history)
    for name, wanted in (
        ("released", balance.heat),
        ("alternator", balance.work),
        ("heat_transfer", balance.heat_transfer),
        ("exhaust", balance.rejected),
    ):
        assert getattr(run.energy, name) == pytest.approx(wanted * energy, rel=AGREEMENT)
    assert_balanced(run)
    # The numeric loops are sampled, and an instant combustion makes a step in them.
    assert run.performance.adverse_work == pytest.approx(balance.adverse_work * energy, rel=0.01)


def test_deviations_fall_with_the_tolerance():
    system, start, strokes, _ = CASES["cosine, unequal strokes"]
    worst = [fm.verify(system, start, strokes, rtol=rtol).worst for rtol in (1e-6, 1e-8, 1e-10)]
    assert worst[0] > 10.0 * worst[1] > 100.0 * worst[2]


def test_a_wrong_engine_is_noticed():
    """A part in a million of the load, of gamma or of the heat is seen."""
    system, start, strokes, _ = CASES["cosine, unequal strokes"]
    verification = fm.verify(system, start, strokes)
    for path, factor in (
        ("alternator.amplitude", 1.0 + 1e-6),
        ("fuel.lower_heating_value", 1.0 + 1e-6),
        ("gas_properties.value", 1.0 + 1e-6),
    ):
        engine = verification.run.engine
        wrong = engine.replace(**{path: factor * engine.get(path)})
        run = saleg.simulate(wrong, verification.run.duration, rtol=1e-11, history=1)
        assert 1e-8 < dataclasses.replace(verification, run=run).worst < 1e-3


def test_to_engine_and_back():
    system = base_like(fm.ConstantLoad(0.8), gas=fm.Isentropic(1.3))
    scales = fm.Scales(half_stroke=0.12, bore=0.07, stiffness=20e3, mass=3.0)
    groups = fm.from_engine(fm.to_engine(system, -0.7, scales=scales))
    assert groups.scales.energy == pytest.approx(scales.energy, rel=1e-12)
    again = groups.system(system.load)
    assert again.pressure == pytest.approx(system.pressure, rel=1e-12)
    assert again.heat == pytest.approx(system.heat, rel=1e-12)
    assert again.gas == system.gas


def test_the_base_case_as_chapter_2_has_it(base):
    """The way there and back: groups of an engine, its system, and that system as an engine."""
    groups = fm.from_engine(base)
    verification = fm.verify(groups.equilibrium(0.1807), -0.9035, 6, scales=groups.scales)
    assert verification.worst < AGREEMENT
    assert verification.frequencies[1] == pytest.approx(43.7, abs=0.05)
    performance = verification.run.performance
    assert performance.stroke == pytest.approx(0.1807, rel=1e-6)
    ideal = fm.otto_efficiency(-0.9035, 0.9035, gamma=groups.gamma)
    law = verification.run.engine.alternator
    assert performance.efficiency == pytest.approx(law.efficiency * ideal, rel=1e-6)


def test_what_the_numeric_engine_cannot_express_is_said():
    with pytest.raises(OutsideModel, match="load"):
        fm.to_engine(fired(fm.OttoLoad()))
    with pytest.raises(OutsideModel, match="start"):
        fm.to_engine(FIRED, 0.5)
    with pytest.raises(OutsideModel, match="start"):
        fm.verify(FIRED, math.nan)


# ---- the sealed cylinder, for itself -------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["above it", "cosine, unequal strokes", "early, until it misses", "combined"]
)
def test_the_reference_solver_agrees(name):
    system, start, _, _ = CASES[name]
    engine = fm.to_engine(system, start)
    run = saleg.simulate(engine, 0.1, rtol=1e-11, stall_stroke=1e-9)
    check = reference.simulate(engine, 0.1, rtol=1e-12, stall_stroke=1e-9)
    assert len(run.strokes) > 5
    np.testing.assert_array_equal(run.event_rows["kind"], check.event_rows["kind"])
    np.testing.assert_array_equal(run.event_rows["side"], check.event_rows["side"])
    assert run.status == check.status
    # Of fuel that is all burnt only rounding is left.
    fuel = ("exhaust_fuel_energy", "fuel_energy")
    assert_rows_agree(run.strokes, check.strokes, 1e-8, but=(*ORBIT_ONLY, *fuel))
    for name in fuel:
        np.testing.assert_allclose(run.strokes[name], check.strokes[name], atol=1e-9)


def test_a_load_that_holds_the_translator_stalls_it_at_once():
    """Neither solver runs on from dead centre to dead centre at one instant."""
    system, start, _, _ = CASES["held by its load"]
    engine = fm.to_engine(system, start)
    for run in (saleg.simulate(engine, 0.1), reference.simulate(engine, 0.1)):
        assert run.status is Status.STALLED
        assert (len(run.strokes), run.duration) == (0, 0.0)


def sealed(base, **changes):
    """The base case without its ports."""
    cylinder = saleg.SealedCylinder(
        bore=0.064, half_stroke=0.1, pressure=1.5e5, equivalence_ratio=0.4, **changes
    )
    return dataclasses.replace(base, left=cylinder, right=cylinder)


def test_sealed_cylinders_with_the_laws_of_the_base_case(base):
    """Combustion that takes its time, heat loss, variable gamma, retained gas, misfires."""
    engine = sealed(base, gas_exchange=laws.InstantExchange(0.2))
    run = saleg.simulate(engine, 0.3, rtol=1e-9)
    check = reference.simulate(engine, 0.3, rtol=1e-11, jitted=True)
    assert run.status is Status.COMPLETED
    np.testing.assert_array_equal(run.event_rows["kind"], check.event_rows["kind"])
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=ORBIT_ONLY)
    assert_balanced(run)
    assert_balanced(check)


def test_a_charge_is_renewed_at_bottom_dead_centre(base):
    """One event a stroke, on the side about to be compressed; mass stays, ports do not exist."""
    engine = sealed(base)
    run = saleg.simulate(engine, 0.2, rtol=1e-8, history=1)
    events = run.events
    renewed = events[events.event == "charge renewal"]
    turned = events[events.event == "dead centre"]
    assert not events.event.isin(["port opening", "port closing"]).any()
    assert len(renewed) == len(turned) > 10
    np.testing.assert_array_equal(renewed.t, turned.t)
    assert (renewed.side.to_numpy() == np.where(renewed.x < 0.0, "right", "left")).all()
    masses = run.strokes["charge_mass"]
    np.testing.assert_allclose(masses, masses[0, 0], rtol=1e-13)
    # After it the charge lies on the curve through the midpoint state.
    rows = run.history_rows
    for _, event in renewed.iterrows():
        side = 0 if event.side == "left" else 1
        after = rows[rows["t"] == event.t][-1]
        squeeze = 0.1 / (0.1 + (1 - 2 * side) * after["x"])
        assert after["p"][side] == pytest.approx(1.5e5 * squeeze**1.4, rel=1e-12)
        assert after["T"][side] == pytest.approx(300.0 * squeeze**0.4, rel=1e-12)


def beside_a_bounce_chamber(base, **share):
    """One sealed cylinder, and friction by the fuel it gets."""
    bounce = saleg.BounceChamber(bore=0.064, half_stroke=0.1, pressure=3e5)
    return dataclasses.replace(sealed(base), right=bounce, friction=laws.FrictionShare(**share))


def test_one_sealed_side_beside_another_kind(base):
    """Either side may be sealed, and the mirror image runs as a mirror image."""
    engine = beside_a_bounce_chamber(base)
    mirrored = dataclasses.replace(engine, left=engine.right, right=engine.left)
    run, mirror = (saleg.simulate(each, 0.2, rtol=1e-9) for each in (engine, mirrored))
    assert run.fired
    assert_balanced(run)
    np.testing.assert_allclose(run.strokes["x_end"], -mirror.strokes["x_end"], rtol=1e-8)


def test_a_start_through_the_midpoint(base):
    engine = sealed(base).replace(start=saleg.engine.start.MidpointVelocity(frequency=30.0))
    run = saleg.simulate(engine, 0.1, rtol=1e-9)
    check = reference.simulate(engine, 0.1, rtol=1e-11, jitted=True)
    np.testing.assert_array_equal(run.event_rows["kind"], check.event_rows["kind"])
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=ORBIT_ONLY)


def test_the_cycle_of_a_steady_state_has_its_first_instant_too():
    """What happens at its first dead centre counts: charge renewal and instant release."""
    load = 0.814
    system = base_like(fm.ConstantLoad(load))
    depth = max(equilibrium.depth for equilibrium in fm.equilibria(system))
    found = saleg.steady_state(fm.to_engine(system))
    work = 2.0 * (2.0 * depth) * load  # a constant force along two strokes
    efficiency = found.engine.alternator.efficiency * work / (2.0 * system.heat)
    assert found.found
    assert found.performance.efficiency == pytest.approx(efficiency, rel=AGREEMENT)
    assert abs(found.energy.residual) < 1e-6 * found.energy.released
    np.testing.assert_allclose(found.strokes["heat_released"].max(axis=1), found.energy.fuel / 2)
    np.testing.assert_allclose(found.strokes["heat_released"], found.orbit.strokes["heat_released"])


def test_a_law_sees_the_fuel_of_a_charge_renewed_at_a_dead_centre(base):
    found = saleg.steady_state(beside_a_bounce_chamber(base, share=0.02, initial=5.0))
    assert found.method == "fixed point"
    assert found.energy.friction == pytest.approx(0.02 * found.energy.fuel, rel=1e-5)
