"""A frame that moves: momentum, limits, energy, steady states, engines that share one."""

import dataclasses

import numpy as np
import pytest

import saleg
from agreement import assert_agree
from saleg import laws, reference
from saleg.laws import FixedFrame, MountedFrame

FRAME = MountedFrame(mass=50.0, stiffness=5e4, damping=200.0)
FREE = MountedFrame(mass=50.0)


def on(engine, frame):
    return dataclasses.replace(engine, frame=frame)


@pytest.fixture(scope="module")
def idle(base):
    """Base case without fuel, friction, load and heat transfer: nothing is lost."""
    return base.replace(
        equivalence_ratio=0.0,
        **{
            "friction.coefficient": 0.0,
            "alternator.load_constant": 0.0,
            "heat_transfer.a": 0.0,
            "start.burning": 0.0,
            "start.position": -0.7,
        },
    )


@pytest.fixture(scope="module")
def steady(base):
    return saleg.steady_state(on(base, FRAME), rtol=1e-8)


def test_free_frame_keeps_its_momentum(base):
    run = saleg.simulate(on(base, FREE), 0.3, history=1)
    seen, m, M = run.history, base.translator.mass, FREE.mass
    momentum = m * (seen["v"] + seen["frame_v"]) + M * seen["frame_v"]
    assert np.abs(momentum).max() < 1e-12 * m * np.abs(seen["v"]).max()
    assert run.shaking.peak_force == 0.0
    # The centre of mass stays where it was.
    centre = m * (seen["x"] + seen["frame_x"]) + M * seen["frame_x"]
    assert np.ptp(centre) < 1e-12 * m * np.ptp(seen["x"])


def test_free_frame_raises_the_frequency_by_the_root_of_one_plus_m_over_M(idle):
    fixed, free = (saleg.simulate(on(idle, f), 0.3, rtol=1e-10) for f in (FixedFrame(), FREE))
    expected = np.sqrt(1.0 + idle.translator.mass / FREE.mass)
    slower, faster = (run.strokes["duration"][:16] for run in (fixed, free))
    np.testing.assert_allclose(slower / faster, expected, rtol=1e-9)


def test_free_frame_is_an_engine_of_reduced_mass(base):
    m, M = base.translator.mass, FREE.mass
    reduced = base.replace(**{"translator.mass": m * M / (m + M)})
    here = saleg.steady_state(on(base, FREE), rtol=1e-10).performance
    there = saleg.steady_state(reduced, rtol=1e-10).performance
    for name in ("stroke", "frequency", "power", "efficiency", "compression_ratio"):
        assert getattr(here, name) == pytest.approx(getattr(there, name), rel=1e-8), name


@pytest.mark.filterwarnings("ignore:unusual for an engine")
def test_infinite_frame_is_a_fixed_one_to_rounding(base):
    fixed = saleg.simulate(base, 0.3)
    heavy = saleg.simulate(on(base, MountedFrame(mass=1e30)), 0.3)
    for name in ("t", "x_end", "gas_work", "friction_work"):
        np.testing.assert_allclose(heavy.strokes[name], fixed.strokes[name], rtol=1e-12)
    assert fixed.shaking.peak_force == pytest.approx(
        base.translator.mass * fixed.performance.peak_acceleration, rel=1e-3
    )


def test_reference_agrees(base):
    engine = on(base, FRAME)
    run, again = saleg.simulate(engine, 0.2, rtol=1e-10), reference.simulate(engine, 0.2)
    assert_agree(run, again, 1e-9)
    for name in ("frame_energy", "mount_loss"):
        there = again.strokes[name]
        np.testing.assert_allclose(run.strokes[name], there, rtol=1e-7, atol=1e-9 * there.max())


def test_energy_closes_with_the_heat_in_the_mounts(base, steady):
    run = saleg.simulate(on(base, FRAME), 0.3, rtol=1e-10)
    for energy in (run.energy, steady.energy):
        assert abs(energy.residual) < 1e-8 * energy.largest_term
        assert energy.mounts > 1.0
    without_heat = saleg.simulate(on(base, FREE), 0.3).energy
    assert without_heat.mounts == 0.0


def test_steady_state_is_where_waiting_ends(base, steady):
    run = saleg.simulate(on(base, FRAME), 12.0, rtol=1e-8)
    for name in ("stroke", "frequency", "power"):
        here, there = getattr(steady.performance, name), getattr(run.performance, name)
        assert here == pytest.approx(there, rel=1e-6), name
    assert steady.shaking.peak_force == pytest.approx(run.shaking.peak_force, rel=1e-5)
    assert steady.shaking.mount_power == pytest.approx(
        FRAME.damping * np.mean(resampled(steady) ** 2), rel=1e-3
    )


def resampled(steady):
    """Velocity of the frame at even times of a cycle [m/s]."""
    seen = steady.orbit.history
    t = np.linspace(seen["t"].iloc[0], seen["t"].iloc[-1], 4001)[:-1]
    return np.interp(t, seen["t"], seen["frame_v"])


def test_slow_multipliers_are_the_oscillation_on_the_mounts(base, steady):
    # Translator and frame together, on the mounts: far below the engine's own frequency.
    total = base.translator.mass + FRAME.mass
    decay = FRAME.damping / (2.0 * total)
    swing = np.sqrt(FRAME.stiffness / total - decay**2)
    expected = np.exp(complex(-decay, swing) / steady.performance.frequency)
    slow = steady.multipliers[:2]
    assert np.abs(np.abs(slow) - abs(expected)).max() < 0.005
    assert np.abs(np.abs(np.angle(slow)) - np.angle(expected)).max() < 0.02


def test_mirror_image(base):
    left = saleg.simulate(on(base, FRAME), 0.2)
    right = saleg.simulate(on(base.replace(**{"start.position": 0.9}), FRAME), 0.2)
    n = min(len(left.strokes), len(right.strokes))
    np.testing.assert_array_equal(left.strokes["x_end"][:n], -right.strokes["x_end"][:n])
    np.testing.assert_array_equal(left.strokes["frame_energy"], right.strokes["frame_energy"])


def test_two_engines_in_antiphase_leave_their_frame_at_rest(base):
    opposite = base.replace(**{"start.position": 0.9})
    pair = reference.simulate_on_one_frame([base, opposite], FRAME, 0.15)
    alone = reference.simulate(base, 0.15, rtol=1e-9, jitted=True)
    assert pair.frame["x"].abs().max() < 1e-9
    assert pair.frame["force"].abs().max() < 1e-3
    assert len(alone.strokes) > 10
    for run, sides in zip(pair.runs, (slice(None), slice(None, None, -1)), strict=True):
        np.testing.assert_allclose(run.strokes["duration"], alone.strokes["duration"], rtol=1e-7)
        np.testing.assert_allclose(
            run.strokes["peak_pressure"][:, sides], alone.strokes["peak_pressure"], rtol=1e-4
        )


def test_two_engines_in_phase_have_half_a_frame_each(base):
    half = MountedFrame(mass=25.0, stiffness=2.5e4, damping=100.0)
    pair = reference.simulate_on_one_frame([base, base], FRAME, 0.15)
    alone = saleg.simulate(on(base, half), 0.15, rtol=1e-9)
    for run in pair.runs:
        assert run.performance.frequency == pytest.approx(alone.performance.frequency, rel=1e-6)


def test_one_engine_on_a_shared_frame_is_the_engine_on_its_frame(base):
    shared = reference.simulate_on_one_frame([base], FRAME, 0.15).runs[0]
    own = saleg.simulate(on(base, FRAME), 0.15, rtol=1e-9)
    assert shared.performance.frequency == pytest.approx(own.performance.frequency, rel=1e-6)


def test_files_and_paths(base, tmp_path):
    engine = on(base, FRAME)
    path = tmp_path / "engine.toml"
    path.write_text(engine.to_toml(), encoding="utf-8")
    assert saleg.Engine.from_toml(path) == engine
    assert "Frame" not in base.to_toml()
    assert engine.replace(**{"frame.mass": 80.0}).frame.mass == 80.0


def test_many_steady_states_are_those_of_each(base):
    engines = [on(base, dataclasses.replace(FRAME, mass=mass)) for mass in (40.0, 60.0)]
    for one, engine in zip(saleg.steady_states(engines)["frequency"], engines, strict=True):
        assert one == pytest.approx(saleg.steady_state(engine).performance.frequency, rel=1e-6)


def test_wrong_frames_are_named_together(base):
    wrong = MountedFrame(mass=0.0, stiffness=-1.0, damping=float("nan"))
    with pytest.raises(saleg.errors.InvalidEngine) as caught:
        saleg.simulate(on(base, wrong), 0.1)
    assert [p.path for p in caught.value.problems] == [
        "frame.mass",
        "frame.stiffness",
        "frame.damping",
    ]
    with pytest.raises(saleg.errors.InvalidEngine, match="frame = 3"):
        on(base, 3).validate()
    with pytest.raises(saleg.errors.InvalidEngine, match=r"engines\[1\]\.frame"):
        reference.simulate_on_one_frame([base, on(base, FRAME)], FRAME, 0.1)
    with pytest.raises(saleg.errors.InvalidEngine, match="must be a Frame"):
        reference.simulate_on_one_frame([base], None, 0.1)
    with pytest.raises(saleg.errors.InvalidEngine, match=r"engines = .*must be a list of engines"):
        reference.simulate_on_one_frame(base, FRAME, 0.1)  # before, a TypeError
    with pytest.raises(saleg.errors.WrongArguments) as found:  # before, the engine alone
        reference.simulate_on_one_frame([base, 3, base.replace(bore=-1)], None, -1, rtol=2)
    assert [p.path for p in found.value.problems] == [
        "engines[1]",
        "engines[2].bore",
        "frame",
        "rtol",
        "duration",
    ]


def test_law_that_moves_its_frame_asks_for_the_state(base):
    @dataclasses.dataclass(frozen=True)
    class Forgetful(laws.Frame):
        def acceleration(self, force: float, x: float, v: float) -> float:
            return force / 10.0

    with pytest.raises(saleg.errors.LawError, match='states: ClassVar = \\("frame",\\)'):
        saleg.simulate(on(base, Forgetful()), 0.1)
