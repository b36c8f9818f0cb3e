"""Laws at work in engines: the integrator against the reference, a few laws to an engine."""

import dataclasses

import numpy as np
import pytest

import saleg
from agreement import assert_agree, assert_balanced
from saleg import Status, laws, reference

BASE = saleg.machines.thesis_base()

ENGINES = {
    "annand, double Wiebe, circuit": BASE.replace(
        **{
            "heat_transfer": laws.Annand(),
            "heat_release": laws.DoubleWiebe(premixed_end=0.4, diffusion_start=0.0),
            "left.ignition": laws.SparkBeforeDeadCentre(1.2e-3),
            "right.ignition": laws.SparkAtClearance(0.016),
            "alternator": laws.CircuitAlternator(),
            "springs": laws.ProgressiveSprings((0.0, 0.05, 0.1), (25e3, 30e3, 60e3)),
            "friction": laws.CoulombViscousFriction(),
        }
    ),
    "woschni, profile, flux": BASE.replace(
        **{
            "heat_transfer": laws.Woschni(),
            "heat_release": laws.BurnProfile(
                times=(0.0, 0.2, 0.5, 0.8, 1.0), fractions=(0.0, 0.05, 0.6, 0.95, 1.0)
            ),
            "ignition": laws.IgnitionAtPressure(30e5),
            "alternator": laws.FluxProfile(cosines=(0.1,), sines=(0.05,), cogging=(20.0,)),
            "springs": laws.EndStops(gap=0.088),
            "friction": laws.ConstantFriction(60.0),
            "completeness": laws.CompletenessByRatio((0.4, 0.7), (0.7, 1.0)),
        }
    ),
    "instant, late, misfires": BASE.replace(
        **{
            "heat_transfer": laws.Chang(),
            "heat_release": laws.InstantRelease(),
            "left.ignition": laws.IgnitionAtDeadCentre(),
            "right.ignition": laws.SparkAfterDelay(8.6e-3),
            "right.late_ignition": 1.0,
            "left.misfires": laws.ScheduledMisfires(first=3, count=1),
            "alternator": laws.ForceMap(),
            "springs": laws.PreloadedSprings(preload=1e3),
            "friction": laws.NoFriction(),
        }
    ),
}


@pytest.mark.parametrize("name", ENGINES)
def test_laws_at_work_agree_with_the_reference(name):
    engine = ENGINES[name]
    run = saleg.simulate(engine, 0.25, rtol=1e-10)
    check = reference.simulate(engine, 0.25, jitted=True, rtol=1e-11)
    assert run.fired
    assert_agree(run, check, 1e-6)
    assert_balanced(run, 1e-7)


def test_a_misfire_happens_when_it_is_scheduled():
    engine = ENGINES["instant, late, misfires"]
    run = saleg.simulate(engine, 0.25, rtol=1e-8)
    left = run.events[run.events.side == "left"]
    numbers = (left.event == "port closing").cumsum()
    assert list(numbers[left.event == "misfire"]) == [3]


def test_late_ignition_lights_a_charge_after_its_dead_centre():
    spark = laws.SparkAfterDelay(9.2e-3)  # after the piston has turned
    late = ENGINES["instant, late, misfires"].replace(**{"right.ignition": spark})
    strict = late.replace(**{"right.late_ignition": 0.0})
    events = [saleg.simulate(engine, 0.06, rtol=1e-7).events for engine in (strict, late)]
    lit = [((e.event == "ignition") & (e.side == "right")).sum() for e in events]
    missed = [((e.event == "misfire") & (e.side == "right")).sum() for e in events]
    assert min(missed) > 0
    assert lit[0] == 0
    assert lit[1] > 0


def test_spark_comes_at_its_clearance():
    run = saleg.simulate(ENGINES["annand, double Wiebe, circuit"], 0.25, rtol=1e-7)
    sparks = run.events[(run.events.event == "ignition") & (run.events.side == "right")]
    clearance = BASE.get("half_stroke") - sparks.x
    assert len(sparks) > 5
    np.testing.assert_allclose(clearance, 0.016, rtol=1e-12)


def test_spark_comes_a_time_before_the_dead_centre_foreseen():
    run = saleg.simulate(ENGINES["annand, double Wiebe, circuit"], 0.25, rtol=1e-9)
    sparks = run.events[(run.events.event == "ignition") & (run.events.side == "left")].t.values
    ends, durations = run.strokes["t"], run.strokes["duration"]
    strokes = np.searchsorted(ends, sparks[1:])  # the first is the start's
    foreseen = ends[strokes - 1] + durations[strokes - 1] - 1.2e-3
    assert len(strokes) > 5
    np.testing.assert_allclose(sparks[1:], foreseen, rtol=0, atol=1e-9)
    assert np.ptp(durations) > 1e-4  # it was not steady


def test_pressure_is_what_lights_a_charge():
    run = saleg.simulate(ENGINES["woschni, profile, flux"], 0.25, rtol=1e-10)
    lit = run.events[run.events.event == "ignition"]
    assert len(lit) > 10
    np.testing.assert_allclose(lit.pressure, 30e5, rtol=1e-7)


def test_what_does_not_burn_leaves_with_the_exhaust():
    engine = ENGINES["woschni, profile, flux"].replace(egr=0.0, equivalence_ratio=0.55)
    p, T, clearance = engine.left.reference_state
    mass = p * engine.left.area * clearance / (287.0 * T)
    fuel = mass * 0.55 / (0.55 + engine.left.fuel.air_fuel_ratio)
    gives = engine.left.fuel.lower_heating_value
    energy = saleg.simulate(engine, 0.4).energy
    released = 2.0 * 0.95 * 0.85 * fuel * gives  # both cylinders; at 0.55 the curve says 0.85
    assert energy.released == pytest.approx(released, rel=1e-6)
    assert energy.unburnt == pytest.approx(2.0 * fuel * gives - released, rel=1e-6)


def test_instant_release_at_dead_centre_is_constant_volume_combustion():
    """Heat over mass is the rise of internal energy across the event, at no change of volume."""
    engine = ENGINES["instant, late, misfires"].replace(**{"left.misfires.first": 1e6})
    run = saleg.simulate(engine, 0.3, rtol=1e-9, history=1)
    history = run.history_rows
    jumps = np.flatnonzero((np.diff(history["t"]) == 0.0) & (np.diff(history["T"][:, 0]) > 100.0))
    assert len(jumps) >= 8
    before, after = history[jumps], history[jumps + 1]
    np.testing.assert_array_equal(before["V"], after["V"])
    energy = BASE.left.gas_properties.internal_energy
    rise = [energy(b) - energy(a) for a, b in zip(before["T"][:, 0], after["T"][:, 0], strict=True)]
    mass = (before["p"] * before["V"] / (287.0 * before["T"]))[:, 0]
    released = np.array([row["heat_released"][0] for row in run.strokes if row["heat_released"][0]])
    np.testing.assert_allclose(mass * rise, released[: len(jumps)], rtol=1e-9)


def test_circuit_tends_to_the_linear_load_at_first_order():
    """Eq. 47 is the limit of Eq. 43-46; the distance falls with the inductance."""
    k, r, load = 50.0, 1.8, 33.9
    fixed = {"regulator_gain": 0.0}
    wanted = BASE.replace(
        alternator=laws.LinearLoad(
            load_constant=k * k / (r + load), efficiency=load / (r + load), **fixed
        )
    )
    figures = saleg.simulate(wanted, 1.5, rtol=1e-9).performance
    errors = []
    for inductance in (2e-4, 1e-4, 5e-5):
        circuit = laws.CircuitAlternator(
            flux_gradient=k,
            coil_resistance=r,
            load_resistance=load,
            inductance=inductance,
            **fixed,
        )
        run = saleg.simulate(BASE.replace(alternator=circuit), 1.5, rtol=1e-9)
        errors.append(
            [
                getattr(run.performance, name) / getattr(figures, name) - 1.0
                for name in ("stroke", "frequency", "power")
            ]
        )
    orders = np.log2(np.abs(np.array(errors[:-1]) / np.array(errors[1:])))
    np.testing.assert_allclose(orders[-1], 1.0, atol=0.05)
    assert (np.abs(orders[1] - 1.0) < 0.6 * np.abs(orders[0] - 1.0)).all()


def test_circuit_energy_balance_closes():
    """Mechanical work is electrical work, coil loss and what the magnetic field gains."""
    engine = BASE.replace(alternator=laws.CircuitAlternator())
    law = engine.alternator
    run = saleg.simulate(engine, 0.5, rtol=1e-9)
    rows = run.orbit.history_rows
    t, i = rows["t"], rows["current"]
    keep = np.append(np.diff(t) > 0.0, True)
    from scipy.interpolate import CubicSpline

    loss = CubicSpline(t[keep], law.coil_resistance * i[keep] ** 2).integrate(t[0], t[-1])
    field = 0.5 * law.inductance * (i[-1] ** 2 - i[0] ** 2)
    strokes = run.orbit.strokes
    work = strokes["alternator_work"].sum()
    assert work == pytest.approx(strokes["electrical_energy"].sum() + loss + field, rel=1e-7)


def test_a_motor_alone_swings_the_translator_up():
    engine = saleg.machines.thesis_transient().replace(
        alternator=laws.SinusoidalMotor(amplitude=66.0, frequency=40.2),
        equivalence_ratio=0.0,
        start=saleg.engine.start.AtRest(),
    )
    run = saleg.simulate(engine, 1.0, rtol=1e-7, stall_stroke=0.0)
    assert run.cycles.compression_ratio.max() > 2.0
    assert run.cycles.power.iloc[5:].mean() < 0.0


def test_range_exits_are_data_and_in_the_summary():
    run = saleg.simulate(BASE, 0.3, rtol=1e-7)
    exits = run.range_exits
    assert {row["law"] for row in exits} == {"ChangGas"}
    row = exits[0]
    assert row["seen_low"] < row["low"] < row["high"] < row["seen_high"]
    assert 0.0 < row["time_share"] < 1.0
    from saleg.simulation.report import describe_run

    assert "outside its range: ChangGas" in describe_run(run)


def test_laws_with_series_survive_a_file(tmp_path):
    engine = ENGINES["woschni, profile, flux"]
    path = tmp_path / "engine.toml"
    path.write_text(engine.to_toml())
    assert saleg.Engine.from_toml(path) == engine


def test_bad_series_are_named():
    engine = BASE.replace(
        heat_release=laws.BurnProfile(times=(0.0, 0.5, 0.4), fractions=(0.0, 2.0))
    )
    with pytest.raises(saleg.InvalidEngine) as caught:
        saleg.simulate(engine, 0.1)
    text = str(caught.value)
    assert "greater than the one before" in text
    assert "fractions" in text
    odd = dataclasses.replace(engine.left.heat_release, times=[0.0, "a"])
    assert "tuple of numbers" in str(BASE.replace(heat_release=odd).problems()[0])


def test_a_circuit_at_no_load_is_open():
    """A load weight of zero leaves the current near zero and the integration cheap."""
    engine = BASE.replace(alternator=laws.CircuitAlternator(target_stroke=1.0, regulator_gain=50.0))
    run = saleg.simulate(engine, 0.3, rtol=1e-6, history=1)
    assert run.status is not Status.STEP_FAILURE
    open_circuit = run.history[run.history.load_weight == 0.0]
    assert len(open_circuit) > 1000
    loaded = saleg.simulate(BASE.replace(alternator=laws.CircuitAlternator()), 0.3, history=1)
    assert np.abs(open_circuit.current).max() < 0.05 * np.abs(loaded.history.current).max()


@pytest.mark.parametrize("number", [0.5, -0.5, float("nan"), 3])
def test_a_single_number_is_no_series(number):
    engine = BASE.replace(ignition=laws.TabulatedDelay(equivalence_ratios=number))
    with pytest.raises(saleg.InvalidEngine, match=r"equivalence_ratios.*tuple of numbers"):
        saleg.simulate(engine, 0.1)
