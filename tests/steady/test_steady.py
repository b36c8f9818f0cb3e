"""Steady states, their stability, branches and batches."""

import math
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
import pytest

import saleg
from helpers import single_piston
from own_laws import faulty
from saleg import Status, laws
from saleg.laws import Motion
from saleg.simulation.performance import EnergyBalance
from saleg.steady.symmetry import is_symmetric, repeats_itself

FIGURES = ("stroke", "frequency", "power", "efficiency", "peak_pressure", "compression_ratio")


def deviation(a, b):
    """Greatest relative deviation of the main figures."""
    return max(abs(getattr(a, name) / getattr(b, name) - 1.0) for name in FIGURES)


def designs(count, seed=0, spread=0.2):
    """Random engines around the base case."""
    base, rng = saleg.machines.thesis_base(), np.random.default_rng(seed)
    paths = (
        "bore",
        "half_stroke",
        "moving_mass",
        "spring.stiffness",
        "intake.pressure",
        "equivalence_ratio",
        "egr",
        "alternator.load_constant",
        "friction.coefficient",
    )
    for _ in range(count):
        changes = {path: base.get(path) * rng.uniform(1 - spread, 1 + spread) for path in paths}
        changes["port_closing"] = changes["half_stroke"] * 1.33 * rng.uniform(0.9, 1.1)
        changes["intake.temperature"] = 325.0 * rng.uniform(0.9, 1.1)
        changes["alternator.regulator_gain"] = rng.uniform(3.0, 7.5)
        yield base.replace(**changes)


def test_base_case_is_solved_as_it_is_waited_for(base):
    found = saleg.steady_state(base, rtol=1e-9)
    run = saleg.simulate(base, 3.0, rtol=1e-9)
    assert found.status is Status.STEADY
    assert found.method == "fixed point"
    assert found.half_cycles <= 20
    assert deviation(found.performance, run.performance) < 1e-7
    assert found.performance.adverse_work == pytest.approx(run.performance.adverse_work, rel=1e-4)
    assert abs(found.energy.residual) < 1e-6 * found.energy.fuel
    assert found.stable


@pytest.mark.parametrize("seed", [1, 2])
def test_random_designs_are_solved_as_they_are_waited_for(seed):
    """Each disagreement must be a run that is not steady yet, or an orbit that is not stable."""
    for engine in designs(60, seed):
        found = saleg.steady_state(engine, rtol=1e-8)
        run = saleg.simulate(engine, 4.0, rtol=1e-8)
        assert found.method == "fixed point", found.message
        if run.status is Status.STEADY:
            assert deviation(found.performance, run.performance) < 1e-5
        else:
            slow = abs(found.stability.time_constant) > 0.1
            assert slow or not found.stable, (found.message, run.message)


def test_half_cycle_and_full_cycle_map_find_the_same(base):
    """An engine as good as symmetric lands beside the symmetric one, by the other map."""
    nearly = base.replace(**{"left.bore": base.get("bore") * (1.0 + 1e-9)})
    assert is_symmetric(base)
    assert not is_symmetric(nearly)
    a, b = saleg.steady_state(base, rtol=1e-9), saleg.steady_state(nearly, rtol=1e-9)
    assert deviation(a.performance, b.performance) < 1e-7
    np.testing.assert_allclose(
        np.abs(a.multipliers[:4]), np.abs(b.multipliers[:4]), rtol=1e-4, atol=1e-6
    )


def test_multipliers_are_the_decay_of_a_disturbed_simulation(base):
    """The leading complex pair against a fit to dead centres after a push, within 1 %."""
    engine = base.replace(**{"alternator.regulator_gain": 12.0})
    steady = saleg.steady_state(engine, rtol=1e-10)
    start = saleg.engine.start.CompressedCharge(position=-0.9, burning=1.0)
    run = saleg.simulate(engine.replace(start=start), 3.0, rtol=1e-11)
    x = np.array(run.cycles.x_left) - run.cycles.x_left.iloc[-1]
    late = slice(15, 60)
    # x_{n+2} = p x_{n+1} + q x_n; the roots of the characteristic equation are the multipliers.
    y, a, b = x[late][2:], x[late][1:-1], x[late][:-2]
    p, q = np.linalg.lstsq(np.column_stack([a, b]), y, rcond=None)[0]
    roots = np.roots([1.0, -p, -q])
    assert abs(roots[0]) == pytest.approx(abs(steady.multipliers[0]), rel=0.01)
    assert abs(np.angle(roots[0])) == pytest.approx(abs(np.angle(steady.multipliers[0])), rel=0.01)


def test_stability_is_lost_between_gains_of_13_and_14(base):
    found = saleg.steady.continuation.branch(
        base.replace(**{"alternator.regulator_gain": 12.0}),
        "alternator.regulator_gain",
        16.0,
        step=0.5,
    )
    (value, kind), *others = found.stability_changes
    assert not others
    assert kind == "quasi-periodic"
    assert 13.0 < value < 14.0
    assert found.ended == "arrived"


def test_beat_period_is_that_of_the_simulated_orbit(base):
    """Just beyond the loss of stability the dead centres beat with the angle of the multiplier."""
    engine = base.replace(**{"alternator.regulator_gain": 14.0})
    steady = saleg.steady_state(engine, rtol=1e-9)
    assert steady.stability.kind == "quasi-periodic"
    assert not steady.stable
    run = saleg.simulate(engine, 12.0, rtol=1e-8)
    assert run.status is Status.COMPLETED
    strokes = run.strokes[-400:]
    length = np.abs(strokes["x_end"] - strokes["x_start"])
    spectrum = np.abs(np.fft.rfft((length - length.mean()) * np.hanning(len(length))))
    beat = np.argmax(spectrum) / len(length)  # per stroke
    seen = 0.5 / steady.performance.frequency / beat
    assert steady.stability.beat_period == pytest.approx(seen, rel=0.02)


def test_a_fold_is_turned_around(base):
    """Warmer intake: stable and unstable orbit meet; there a multiplier passes +1."""
    found = saleg.steady.continuation.branch(base, "intake.temperature", 700.0)
    fold = found.folds[0]
    value, kind = found.stability_changes[0]
    assert kind == "fold"
    assert value == pytest.approx(fold, rel=2e-3)
    table = found.table
    assert table["intake.temperature"].max() == pytest.approx(fold, rel=1e-3)
    # Beyond the fold there is no such orbit: the engine ends elsewhere.
    beyond = saleg.steady_state(base.replace(**{"intake.temperature": fold + 5.0}))
    assert not beyond.found or beyond.performance.compression_ratio < 3.0
    assert table.attrs["units"]["intake.temperature"] == "K"


def test_bifurcation_diagram_shows_the_branch(base):
    found = saleg.steady.continuation.branch(
        base.replace(**{"alternator.regulator_gain": 13.0}),
        "alternator.regulator_gain",
        15.0,
        step=0.5,
    )
    ax = found.plot("power")
    drawn = np.concatenate([line.get_xdata() for line in ax.lines if len(line.get_xdata()) > 1])
    assert set(np.round(drawn, 6)) == {13.0, 13.5, 14.0, 14.5, 15.0}
    assert ax.get_ylabel() == "power [kW]"
    assert ax.get_xlabel() == "alternator: regulator gain [-]"


def test_what_cannot_be_followed_is_said(base):
    with pytest.raises(saleg.UnknownPath):
        saleg.steady.continuation.branch(base, "boer", 1.0)
    with pytest.raises(saleg.InvalidEngine):
        saleg.steady.continuation.branch(base, "bore", -1.0)
    with pytest.raises(saleg.SalegError, match="cannot follow"):
        saleg.steady.continuation.branch(base, "bore", math.nan)
    for bad in ({"step": math.nan}, {"step": 0.0}, {"max_points": 0}):
        with pytest.raises(saleg.SalegError, match="must be"):
            saleg.steady.continuation.branch(base, "bore", 0.07, **bad)
    with pytest.raises(saleg.SalegError, match="no steady state"):
        saleg.steady.continuation.branch(base.replace(equivalence_ratio=0.0), "bore", 0.07)


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"equivalence_ratio": 0.0}, Status.STALLED),
        ({"alternator.load_constant": 300.0}, Status.STALLED),
        ({"intake.temperature": 600.0}, Status.IDLING),
        ({"heat_transfer.a": 0.0, "friction.coefficient": 0.0, "bore": 0.09}, None),
    ],
)
def test_engines_without_a_steady_state_say_so(base, changes, status):
    found = saleg.steady_state(base.replace(**changes))
    assert status is None or found.status is status
    assert len(found.message) > 20
    assert str(found)
    if not found.found:
        assert math.isnan(found.residual)
        assert found.energy is None
        assert not found.stable
        with pytest.raises(ValueError, match="no steady state"):
            _ = found.multipliers


def test_engines_that_never_repeat_are_simulated(base):
    engine = base.replace(
        misfires=laws.ScheduledMisfires(first=3), friction=laws.BlairViscousFriction()
    )
    assert not repeats_itself(engine)
    found = saleg.steady_state(engine)
    assert found.method == "simulation"
    assert found.status is Status.STEADY
    assert found.fallback is not None


def test_settings_are_checked(base):
    for bad in ({"rtol": 1.0}, {"rtol": "x"}, {"max_maps": -1}):
        with pytest.raises(saleg.SalegError):
            saleg.steady_state(base, **bad)


def test_batches_are_in_order_and_the_same_for_any_workers():
    engines = list(designs(40, 5))
    alone = saleg.steady_states(engines, workers=1)
    many = saleg.steady_states(engines, workers=3, chunk=7)
    assert alone.equals(many)
    row = alone.iloc[17]
    found = saleg.steady_state(engines[17])
    assert row.stroke == found.quick_performance.stroke
    assert row.status == str(found.status)
    assert set(alone.attrs["units"]) == set(alone.columns)


def test_batches_through_processes():
    engines = list(designs(12, 6))
    alone = saleg.steady_states(engines, workers=1)
    with ProcessPoolExecutor(2) as pool:
        assert saleg.steady_states(engines, executor=pool, chunk=5).equals(alone)


def test_failures_are_rows(base):
    engines = [base, base.replace(bore=-1.0), base.replace(equivalence_ratio=0.0), base]
    table = saleg.steady_states(engines, multipliers=True)
    assert list(table.status) == ["steady", "invalid", "stalled", "steady"]
    assert "bore = -1" in table.message[1]
    assert list(table.stable) == [True, False, False, True]
    assert np.isnan(table.power[1])
    assert table.power[2] == 0.0
    assert list(saleg.steady_states([]).power) == []
    assert list(saleg.steady_states([None, 3]).status) == ["invalid", "invalid"]
    for bad in ({"rtol": 5.0}, {"chunk": 2.5}, {"workers": 0}):
        with pytest.raises(saleg.SalegError):
            saleg.steady_states(engines, **bad)


def test_runs_in_batches(base):
    engines = [base, base.replace(bore=-1.0), base.replace(egr=0.2)]
    table = saleg.simulate_many(engines, 1.0, rtol=1e-7)
    assert list(table.status) == ["steady", "invalid", "steady"]
    alone = saleg.simulate(engines[2], 1.0, rtol=1e-7)
    assert table.power[2] == alone.performance.power


@dataclass(frozen=True)
class Ageing(laws.ViscousFriction):
    """Friction that jumps at one second: no probe at a few instants would see it."""

    def force(self, held: float, motion: Motion) -> float:
        return held * motion.v * (3.0 if motion.t > 1.0 else 1.0)


def test_a_law_of_time_is_recognised_by_its_source(base):
    assert not repeats_itself(base.replace(friction=Ageing()))
    assert repeats_itself(base)


@pytest.mark.parametrize("stop", [1e4, 1e5])
def test_a_law_that_tells_left_from_right_is_not_mirrored(base, stop):
    engine = faulty(base, stop=stop)
    found, run = saleg.steady_state(engine, rtol=1e-8), saleg.simulate(engine, 4.0, rtol=1e-8)
    assert found.found, found.message
    assert deviation(found.performance, run.performance) < 1e-5


def test_a_bounce_chamber_is_stable_and_solved_as_it_is_waited_for(base):
    engine = saleg.Engine(
        translator=saleg.Translator(mass=2.4),
        left=base.left,
        right=saleg.BounceChamber(bore=0.064, half_stroke=0.100, pressure=2.5e5),
        springs=laws.LinearSprings(stiffness=20e3),
        alternator=laws.LinearLoad(load_constant=30.0),
    )
    found, run = saleg.steady_state(engine, rtol=1e-9), saleg.simulate(engine, 6.0, rtol=1e-9)
    assert found.stable
    assert abs(found.multipliers[0]) < 0.9
    assert deviation(found.performance, run.performance) < 1e-6


@pytest.mark.parametrize(
    ("path", "stop"),
    [("moving_mass", 2.8), ("right.pressure", 3e5), ("right.bore", 0.07), ("bore", 0.066)],
)
def test_a_branch_keeps_the_charge_of_a_bounce_chamber(base, path, stop):
    """Entropy is conserved, so every one has an orbit: that of the engine at each point counts."""
    engine = single_piston(base, length=0.1, pressure=2.5e5)
    follows_steady_states(engine, path, stop)


def test_a_branch_keeps_all_that_a_bounce_chamber_conserves(base):
    """Woschni's law takes the motored pressure along: a second conserved quantity."""
    cylinder = replace(base.left, heat_transfer=laws.Woschni())
    engine = single_piston(base, length=0.1, pressure=2.5e5, cylinder=cylinder)
    follows_steady_states(engine, "right.pressure", 3e5)


def follows_steady_states(engine, path, stop):
    """Follow a branch and solve for its points one by one."""
    branch = saleg.continuation.branch(engine, path, stop, step=abs(stop - engine.get(path)) / 3.0)
    assert branch.ended == "arrived"
    assert len(branch.points) > 3
    for point in branch.points:
        alone = saleg.steady_state(engine.replace(**{path: point.value}), rtol=1e-9)
        assert deviation(point.steady.performance, alone.performance) < 1e-6
        assert point.stability.kind == alone.stability.kind == "stable"
        leading = [abs(found.multipliers[0]) for found in (point.stability, alone.stability)]
        assert leading[0] == pytest.approx(leading[1], rel=1e-4)


def test_the_orbit_of_a_steady_state_can_be_drawn(base):
    ax = saleg.steady_state(base).orbit.plot.pressure_volume()
    assert ax.lines


def test_waiting_gives_the_same_figures_as_solving(base):
    solved, waited = (
        saleg.steady_state(base, rtol=1e-8),
        saleg.steady_state(base, rtol=1e-8, max_maps=0),
    )
    assert waited.method == "simulation"
    for name, value in solved.quick_performance.to_dict().items():
        if name not in ("stability", "cr_change", "adverse_work"):
            assert getattr(waited.quick_performance, name) == pytest.approx(value, rel=1e-5), name


def test_earlier_names_of_keywords_warn_and_go_on(base):
    with pytest.warns(DeprecationWarning, match=r"steady_state\(most=\.\.\.\) is called max_maps"):
        waited = saleg.steady_state(base, most=0)
    assert waited.method == "simulation"
    with pytest.raises(TypeError, match="most and max_maps"):
        saleg.steady_state(base, most=0, max_maps=0)
    with (
        pytest.warns(DeprecationWarning, match="is called max_points"),
        pytest.raises(saleg.continuation.NoBranch, match="max_points = 1"),
    ):
        saleg.continuation.branch(base, "left.bore", 0.066, most=1)


def test_a_steady_state_says_first_what_it_is(base):
    message = saleg.steady_state(base).message
    assert message.startswith("fixed point of the half-cycle map, found in ")


@pytest.mark.parametrize(
    "law",
    [
        {"springs": laws.PreloadedSprings(preload=500.0)},
        {"heat_release": laws.DoubleWiebe()},
        {"heat_release": laws.BurnProfile()},
    ],
    ids=["preloaded springs", "double Wiebe", "burn profile"],
)
def test_breakpoints_do_not_hide_a_steady_state(base, law):
    """A smooth engine takes as many half cycles; steps across a breakpoint took ten times these."""
    base = base.replace(friction=laws.BlairViscousFriction())  # as in a design: one kernel for both
    smooth = saleg.steady_state(base)
    found = saleg.steady_state(base.replace(**law))
    assert found.method == "fixed point", found.message
    assert found.half_cycles <= smooth.half_cycles + 6
    assert abs(found.energy.residual) < 1e-6 * found.energy.released


def test_a_cycle_that_does_not_conserve_energy_is_no_steady_state(base):
    """A spring that takes more on the way out than it gives back."""
    found = saleg.steady_state(faulty(base, drag=20.0))
    lost = 20.0 * float(np.abs(found.strokes["x_end"] - found.strokes["x_start"]).sum())
    assert found.status is Status.STEP_FAILURE
    assert "energy balance is off" in found.message
    assert found.energy is None
    assert EnergyBalance.between(found.strokes[-1], found.strokes).residual == pytest.approx(
        lost, rel=1e-4
    )
