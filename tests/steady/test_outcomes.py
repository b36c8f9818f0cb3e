"""Verdicts on runs and steady states, by mirror images, scaled twins and longer simulations."""

import time
from dataclasses import dataclass, replace

import numpy as np
import pytest

import saleg
from saleg import Effort, Status, laws
from saleg.engine.start import CompressedCharge
from saleg.laws import Motion
from saleg.steady import NoSteadyState
from saleg.steady.symmetry import repeats_itself

FIGURES = ("stroke", "frequency", "power", "efficiency", "peak_pressure", "compression_ratio")


def mirror_image(engine):
    """The same engine seen in the mirror, its start as well."""
    start = replace(engine.start, position=-engine.start.position)
    return replace(engine, left=engine.right, right=engine.left, start=start)


def asymmetric(base, count, seed, spread=0.35):
    """Random engines with unlike sides; every second has a bounce chamber on the left."""
    rng = np.random.default_rng(seed)

    def vary(value):
        return value * rng.uniform(1.0 - spread, 1.0 + spread)

    for number in range(count):
        names = ("bore", "half_stroke", "equivalence_ratio", "intake.pressure")
        changes = {
            f"{side}.{name}": vary(base.get(name)) for side in ("left", "right") for name in names
        }
        for side in ("left", "right"):
            changes[f"{side}.port_closing"] = 1.33 * changes[f"{side}.half_stroke"]
            changes[f"{side}.intake.temperature"] = 325.0 * rng.uniform(0.85, 1.2)
        changes["moving_mass"] = vary(base.get("moving_mass"))
        changes["alternator.load_constant"] = vary(base.get("alternator.load_constant"))
        changes["friction.coefficient"] = vary(3.0 * base.get("friction.coefficient"))
        engine = base.replace(**changes)
        if number % 2:
            bounce = saleg.BounceChamber(
                bore=vary(0.064), half_stroke=vary(0.1), pressure=vary(2.5e5)
            )
            engine = replace(engine, left=bounce)
        yield engine


def test_the_outcome_does_not_depend_on_the_side(base):
    for engine in asymmetric(base, 60, seed=1):
        there, here = (saleg.steady_state(one, rtol=1e-8) for one in (engine, mirror_image(engine)))
        assert there.status is here.status, (there.message, here.message)
        assert there.method == here.method
        runs = [saleg.simulate(one, 0.5, rtol=1e-7) for one in (engine, mirror_image(engine))]
        assert runs[0].status is runs[1].status, (runs[0].message, runs[1].message)
        for name in FIGURES if there.found else ():
            wanted = getattr(there.performance, name)
            assert getattr(here.performance, name) == pytest.approx(wanted, rel=1e-5), name


def test_an_engine_that_fires_on_the_right_has_the_figures_of_its_mirror_image(base):
    left = saleg.Engine(
        translator=saleg.Translator(mass=2.4),
        left=base.left,
        right=saleg.BounceChamber(bore=0.064, half_stroke=0.100, pressure=2.5e5),
        springs=laws.LinearSprings(stiffness=20e3),
        alternator=laws.LinearLoad(load_constant=30.0),
    )
    wanted = saleg.steady_state(left, rtol=1e-9)
    found = saleg.steady_state(mirror_image(left), rtol=1e-9)
    for name in (*FIGURES, "start_of_combustion", "adverse_work"):
        expected = getattr(wanted.performance, name)
        assert getattr(found.performance, name) == pytest.approx(expected, rel=1e-6), name
    orbit = found.orbit
    assert orbit.performance.power == pytest.approx(wanted.performance.power, rel=1e-6)
    assert orbit.strokes["x_end"][1] == pytest.approx(-wanted.strokes["x_end"][0], rel=1e-6)
    assert abs(found.energy.residual) < 1e-6 * found.energy.fuel


@pytest.mark.parametrize("relaxation", [1e-3, 1e-5, 1e-8])
def test_a_slow_memory_is_solved_for_and_not_taken_for_steady(base, relaxation):
    """Whatever the relaxation, at the fixed point friction takes the share it is tuned to."""
    slow = laws.FrictionShare(share=0.06, initial=1.0, relaxation=relaxation)
    quick = replace(slow, relaxation=0.5)
    found = saleg.steady_state(base.replace(friction=slow))
    wanted = saleg.steady_state(base.replace(friction=quick))
    assert found.method == "fixed point"
    assert found.energy.friction / found.energy.fuel == pytest.approx(0.06, rel=1e-5)
    assert found.performance.power == pytest.approx(wanted.performance.power, rel=1e-5)
    run = saleg.simulate(base.replace(friction=slow), 1.0, rtol=1e-6)
    assert run.status is Status.COMPLETED
    assert "not steady" in run.message


def test_idling_that_dies_away_is_not_steady(base):
    engine = base.replace(
        **{
            "equivalence_ratio": 0.45,
            "intake.temperature": 600.0,
            "moving_mass": 40.0,
            "friction.coefficient": 3.0,
        }
    )
    assert saleg.simulate(engine, 30.0, rtol=1e-6).status is Status.STALLED
    early = saleg.simulate(engine, 3.0, rtol=1e-6)
    assert early.status is Status.COMPLETED
    assert "delivers no power" in early.message
    assert not saleg.steady_state(engine).found


@dataclass(frozen=True)
class Unpacks(laws.ViscousFriction):
    def force(self, held: float, motion: Motion) -> float:
        now, _x, v, _direction, _current = motion
        return held * v * (1.0 + now)


@dataclass(frozen=True)
class Numbers(laws.ViscousFriction):
    def force(self, held: float, motion: Motion) -> float:
        return held * motion.v * (3.0 if motion[0] > 1.0 else 1.0)


@dataclass(frozen=True)
class Renames(laws.LinearSprings):
    def energy(self, motion: Motion) -> float:
        other = motion
        return self.stiffness * motion.x * motion.x * (1.0 + 0.0 * other[0])


def aged(motion):
    return 1.0 + motion[0]


@dataclass(frozen=True)
class HandsOn(laws.LinearLoad):
    def electrical_power(self, held: float, motion: Motion) -> float:
        return held * self.load_constant * motion.v * motion.v / aged(motion)


@dataclass(frozen=True)
class Timeless(laws.ViscousFriction):
    """A local name t and a field taken by name are no look at the time."""

    def force(self, held: float, motion: Motion) -> float:
        t = motion.x
        return held * motion.v + 0.0 * t * motion.direction


@pytest.mark.parametrize(
    ("slot", "law"),
    [
        ("friction", Unpacks()),
        ("friction", Numbers()),
        ("springs", Renames()),
        ("alternator", HandsOn()),
        ("alternator", laws.SinusoidalMotor()),
    ],
)
def test_a_law_of_time_is_recognised_however_it_gets_at_it(base, slot, law):
    assert not repeats_itself(base.replace(**{slot: law}))


def test_laws_that_do_not_look_at_the_time_are_not_suspected(base):
    own = [Timeless()]
    own += [laws.ConstantFriction(), laws.CoulombViscousFriction(), laws.FrictionShare()]
    assert all(repeats_itself(base.replace(friction=law)) for law in own)
    for law in (laws.CircuitAlternator(), laws.CosineForce(), laws.ForceMap(), laws.FluxProfile()):
        assert repeats_itself(base.replace(alternator=law))
    for law in (laws.ProgressiveSprings(), laws.PreloadedSprings(), laws.EndStops()):
        assert repeats_itself(base.replace(springs=law))


def test_a_motored_engine_runs(base):
    """Cold motoring: the translator follows the motor, whose work is friction and heat."""
    motor = laws.SinusoidalMotor(amplitude=264.0, frequency=35.0)
    engine = base.replace(equivalence_ratio=0.0, alternator=motor)
    run = saleg.simulate(engine, 4.0, rtol=1e-8)
    assert run.status is Status.STEADY, run.message
    assert run.performance.frequency == pytest.approx(35.0, rel=1e-6)
    assert run.performance.stroke > 0.15
    energy = run.energy
    given = -energy.alternator
    assert energy.electrical < energy.alternator < 0.0
    taken = energy.friction + energy.heat_transfer + energy.exhaust - energy.port_work
    assert given == pytest.approx(taken, rel=1e-5)
    assert np.isnan(run.performance.efficiency)
    found = saleg.steady_state(engine)
    assert found.found
    assert found.performance.power == pytest.approx(run.performance.power, rel=1e-4)
    assert not found.has_multipliers
    assert not found.stable
    with pytest.raises(NoSteadyState, match="no return map"):
        _ = found.multipliers
    row = saleg.steady_states([engine], multipliers=True).iloc[0]
    assert (row.status, row.stable, row.kind) == ("steady", False, "")


@pytest.mark.filterwarnings("ignore:unusual for an engine")
def test_an_engine_that_lives_on_the_heat_of_its_walls_is_steady(base):
    """It was "stalled" with 900 W: it never fires, but what it delivers comes from the walls."""
    hot = base.replace(wall_temperature=2500.0, equivalence_ratio=0.0)
    found, run = saleg.steady_state(hot), saleg.simulate(hot, 20.0)
    assert (found.status, run.status) == (Status.STEADY, Status.STEADY)
    assert "delivers power without firing" in found.message
    assert found.performance.power == pytest.approx(run.performance.power, rel=1e-5)
    energy = found.energy
    assert energy.fuel == energy.released == 0.0
    assert 0.0 < energy.alternator + energy.friction < -energy.heat_transfer


@pytest.mark.filterwarnings("ignore:unusual for an engine")
def test_an_overdamped_piston_is_stalled(base):
    """It creeps to its equilibrium: no dead centre ever comes."""
    engine = base.replace(**{"friction.coefficient": 5e4})
    run = saleg.simulate(engine, 2.0)
    assert run.status is Status.STALLED
    assert "stands still" in run.message
    assert not len(run.strokes)
    assert saleg.reference.simulate(engine, 1.0).status is Status.STALLED
    assert saleg.steady_state(engine).status is Status.STALLED


def scaled(engine, length, duration):
    """An engine in which all lengths and times are so many times those of another.

    Pressures, temperatures and all ratios stay. The heat transfer must not depend on speed.
    """
    law, burning = engine.left.heat_transfer, engine.left.heat_release.combustion_duration
    return engine.replace(
        **{
            "bore": engine.get("bore") * length,
            "half_stroke": engine.get("half_stroke") * length,
            "port_closing": engine.get("port_closing") * length,
            "moving_mass": engine.get("moving_mass") * length * duration**2,
            "spring.stiffness": engine.get("spring.stiffness") * length,
            "alternator.load_constant": engine.get("alternator.load_constant") * length * duration,
            "friction.coefficient": engine.get("friction.coefficient") * length * duration,
            "heat_release.combustion_duration": burning * duration,
            "ignition.k": engine.left.ignition.k / duration,
            "heat_transfer.a": law.a * length / duration * length ** (-3.0 * law.b),
        }
    )


@pytest.mark.parametrize(("port", "max_maps"), [(0.06, 60), (0.126, 60), (0.126, 0)])
@pytest.mark.parametrize(("length", "duration"), [(1.0, 20.0), (0.25, 0.1), (4.0, 4.0)])
def test_engines_scaled_in_size_and_time_come_to_the_same_outcome(
    base, port, max_maps, length, duration
):
    """Also those that are simulated: without any map they all are."""
    engine = base.replace(**{"heat_transfer.e": 0.0, "heat_transfer.a": 260.0})
    engine = engine.replace(port_closing=port)
    here, there = (
        saleg.steady_state(one, max_maps=max_maps)
        for one in (engine, scaled(engine, length, duration))
    )
    assert there.status is here.status
    assert there.method == here.method
    if here.found:
        a, b = here.performance, there.performance
        assert b.frequency * duration == pytest.approx(a.frequency, rel=1e-4)
        assert b.stroke == pytest.approx(a.stroke * length, rel=1e-4)
        assert b.efficiency == pytest.approx(a.efficiency, rel=1e-4)


HOPELESS = (
    {"port_closing": 0.06},
    {"intake.temperature": 670.0},
    {"alternator.load_constant": 300.0},
    {"friction.coefficient": 5e3},
    {"half_stroke": 0.3},
)


@pytest.mark.parametrize("changes", HOPELESS)
def test_a_hopeless_start_is_cheap(base, changes):
    engine, spent = base.replace(**changes), []
    assert not saleg.steady_state(engine).found
    for _ in range(5):
        before = time.process_time()
        found = saleg.steady_state(engine, effort=Effort.QUICK)
        spent.append(time.process_time() - before)
    assert found.status is Status.NOT_FOUND
    assert (found.method, found.fallback, found.orbit) == ("none", None, None)
    assert "THOROUGH" in found.message
    assert min(spent) < 0.010
    with pytest.raises(NoSteadyState):
        _ = found.multipliers


def test_a_quick_search_finds_what_a_thorough_one_finds(base):
    engines = [base.replace(egr=share) for share in (0.05, 0.2)] + [base.replace(port_closing=0.06)]
    quick = saleg.steady_states(engines, effort=Effort.QUICK)
    thorough = saleg.steady_states(engines)
    assert quick.iloc[:2].equals(thorough.iloc[:2])
    assert list(quick.status) == ["steady", "steady", "not found"]
    assert thorough.status[2] == "stalled"
    for bad in ("quick", None):
        with pytest.raises(saleg.SalegError, match=r"Effort\.QUICK"):
            saleg.steady_state(base, effort=bad)


def test_designs_are_searched_quickly_too():
    good = saleg.design.evaluate(bore=0.06, effort=Effort.QUICK)
    assert good.moving_mass == saleg.design.evaluate(bore=0.06).moving_mass
    bad = saleg.design.evaluate(port_location=0.7, effort=Effort.QUICK)
    assert bad.status is Status.NOT_FOUND
    assert bad.half_cycles < 200


def test_what_was_not_found_has_no_multipliers(base):
    found = saleg.steady_state(base.replace(equivalence_ratio=0.0))
    with pytest.raises(saleg.SalegError, match="no steady state"):
        _ = found.multipliers


def test_an_engine_without_fuel_begins_without_burning(base):
    law = laws.Wiebe(equivalence_ratio_exponent=-0.5)
    engine = base.replace(equivalence_ratio=0.0, heat_release=law)
    assert saleg.simulate(engine, 0.2).status is not Status.INVALID
    same = saleg.simulate(base.replace(equivalence_ratio=0.0), 0.2)
    assert saleg.simulate(engine, 0.2).strokes["x_end"] == pytest.approx(same.strokes["x_end"])
    unlit = base.replace(equivalence_ratio=0.0, start=CompressedCharge(burning=0.0))
    assert np.array_equal(saleg.simulate(unlit, 0.2).strokes["x_end"], same.strokes["x_end"])


@pytest.mark.parametrize("share", [0.999, 1.0, 1.001, 1.002])
def test_all_that_an_adiabatic_chamber_conserves_is_no_instability(base, share):
    """Woschni's law takes the motored pressure along: a second conserved quantity."""
    engine = saleg.Engine(
        translator=saleg.Translator(mass=2.4 * share),
        left=replace(base.left, heat_transfer=laws.Woschni()),
        right=saleg.BounceChamber(bore=0.064, half_stroke=0.100, pressure=2.5e5),
        springs=laws.LinearSprings(stiffness=20e3),
        alternator=laws.LinearLoad(load_constant=30.0),
    )
    found = saleg.steady_state(engine)
    assert found.stability.kind == "stable"
    assert abs(found.multipliers[0]) < 0.5
    assert saleg.simulate(engine, 2.0).status is Status.STEADY


def test_a_folder_of_quick_results_is_not_continued_by_a_thorough_sweep(tmp_path):
    points = saleg.sweep.grid({"bore": [0.060, 0.064], "port_location": [0.7]})
    table = saleg.sweep.run(points, folder=tmp_path / "quick", effort=Effort.QUICK)
    assert list(table.status) == ["not found", "not found"]
    with pytest.raises(saleg.SalegError):
        saleg.sweep.run(points, folder=tmp_path / "quick")
