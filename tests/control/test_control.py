"""Control: experiments, controllers in Python and compiled, plant and sensors."""

import dataclasses
import math

import numpy as np
import pytest

import saleg
from helpers import Asserting, single_piston
from saleg import Controller, Status, control
from saleg.compiler.controllers import control_of
from saleg.control import Demand, Plant, Sensors, generator, motor
from saleg.control.plant import InPython
from saleg.engine.start import AtRest
from saleg.errors import ControllerError, InvalidController, SalegError
from saleg.kernel import layout
from saleg.kernel.slots import call_at
from saleg.laws import (
    Actuators,
    AlwaysMotored,
    Commands,
    CompressionThreshold,
    DeadCentreRegulator,
    FuelCut,
    FuelOnDemand,
    HeatedIntake,
    LinearSprings,
    LoadControl,
    NeverMotored,
    PowerDemand,
    ResonanceSearch,
    ScaledLoad,
    Signals,
    SteadyMotor,
    ViscousFriction,
)
from saleg.laws.control.base import CONTROL_SLOTS

HALF_CYCLE = 0.5 / 45.0


@pytest.fixture(scope="module")
def at_rest(transient):
    return transient.replace(start=AtRest())


@pytest.fixture(scope="module")
def started(transient):
    """The rapid start-up that most experiments begin with."""
    return control.start_up(transient, 38.0, duration=2.0)


# --- the experiments; what the dissertation says of them is in tests/thesis/test_chapter_5.py


def test_nothing_recovers_from_what_has_not_happened(transient, started):
    with pytest.raises(SalegError, match="duration"):
        control.misfire(transient, at=1.5, duration=1.0)
    assert math.isnan(control.recovery_time(started, 5.0))


@pytest.mark.parametrize("machine", ["transient", "base"])
def test_maps_end_where_their_orbits_do(machine, request):
    """One step beyond the last value no stable orbit delivers power."""
    engine = request.getfixturevalue(machine)
    for known, step in ((control.intake_map(engine), 10.0), (control.fuel_map(engine), -0.025)):
        ends = known.table[known.path].iloc[[0, -2, -1]].tolist()
        assert ends[0] == engine.get(known.path)
        assert ends[2] == pytest.approx(ends[1] + step)
        assert {known.lowest, known.highest} == {ends[0], ends[1]}
        last = saleg.steady_state(engine.replace(**{known.path: ends[1]}))
        assert last.status is Status.STEADY
        assert last.stable
        assert 0.0 < last.performance.power < 0.1 * max(known.powers)
        beyond = saleg.steady_state(engine.replace(**{known.path: ends[2]}))
        assert beyond.status is not Status.STEADY


def test_fuel_follows_a_step_down(transient):
    run = control.demand_by_fuel(transient, Demand.step(2.0, 3905.0, 1905.0))
    assert run.status is Status.STEADY
    assert run.performance.power == pytest.approx(1905.0, rel=0.01)
    assert run.performance.efficiency > 0.3


@pytest.mark.parametrize(("base", "seen"), [(30.0, 2.25), (35.0, 1.20), (38.0, 0.49)])
def test_start_up_with_the_frequency_integrated(transient, base, seen):
    """The default, whose sweep is the frequency itself: it passes resonance when it gets there."""
    run = control.start_up(transient, base, duration=seen + 0.7)
    fired = control.fired_at(run)
    assert fired == pytest.approx(seen, abs=3 * HALF_CYCLE)
    at = run.dead_centres[run.dead_centres.t < fired].motor_frequency.iloc[-1]
    assert 39.5 < at < 43.0  # resonance, 40.3 Hz, a little passed


# --- Python and compiled


MAP = {"powers": (1766.0, 2500.0, 3905.0), "compression_ratios": (13.66, 14.9, 17.87)}
STEP = {"times": (0.8, 0.8), "demands": (3905.0, 2500.0)}
RAPID = ResonanceSearch(base_frequency=38.0)
CONTROLLERS = {
    "start-up": Controller(motor_control=RAPID),
    "hysteresis": Controller(
        motor_control=dataclasses.replace(RAPID, keeps_phase=1.0, keeps_integral=1.0),
        state_logic=CompressionThreshold(hysteresis=2.0),
    ),
    "literal": Controller(motor_control=dataclasses.replace(RAPID, literal_phase=1.0)),
    "fuel cut": Controller(motor_control=RAPID, fuel_control=FuelCut(at=0.9, strokes=3.0)),
    "load": Controller(motor_control=RAPID, load_control=PowerDemand(**STEP)),
    "intake": Controller(motor_control=RAPID, intake_control=HeatedIntake(**MAP, **STEP)),
    "fuel": Controller(
        motor_control=RAPID,
        fuel_control=FuelOnDemand(**MAP, **STEP),
        load_control=ScaledLoad(times=(0.9, 1.1), factors=(1.0, 1.05)),
    ),
    "lags": Controller(
        motor_control=RAPID,
        actuators=Actuators(load_lag=0.02, force_lag=0.05, fuel_lag=0.03, intake_lag=0.1),
    ),
}


@pytest.mark.parametrize("name", CONTROLLERS)
def test_python_and_compiled_switch_at_the_same_instants(at_rest, name):
    controller = CONTROLLERS[name]
    compiled = control.simulate(at_rest, controller, 1.4)
    python = control.simulate(at_rest, controller, 1.4, compiled=False)
    assert len(compiled.event_rows) == len(python.event_rows)
    assert (compiled.event_rows["kind"] == python.event_rows["kind"]).all()
    assert np.abs(compiled.event_rows["t"] - python.event_rows["t"]).max() < 1e-12
    assert (compiled.event_rows["kind"] == layout.EVENT_MOTOR_OFF).any()
    np.testing.assert_allclose(
        compiled.dead_centres.to_numpy(float), python.dead_centres.to_numpy(float), rtol=1e-9
    )
    assert compiled.performance.power == pytest.approx(python.performance.power, rel=1e-9)


PARTS = [
    getattr(saleg.laws, name)
    for name in saleg.laws.__all__
    if getattr(getattr(saleg.laws, name), "slot", "") in CONTROL_SLOTS
    and dataclasses.is_dataclass(getattr(saleg.laws, name))
]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_every_part_commands_the_same_compiled(part):
    """The compiled function, called by its address, against the same source run as Python."""
    controller = dataclasses.replace(Controller(), **{part.slot: part()})
    address, numbers, memory, signals, commands, _ = control_of(controller)
    python = InPython(controller)
    rng = np.random.default_rng(1)
    was = 0.0
    for n in range(30):
        ratio, power = rng.uniform(1.0, 30.0), rng.uniform(-500.0, 5e3)
        seen = Signals(
            0.1 * n,
            0.04,
            1.0 - 2.0 * (n % 2),
            0.08,
            ratio,
            45.0,
            power,
            0.9,
            was,
            was,
            0.0934,
            0.6,
            300.0,
        )
        signals[0] = seen
        call_at(
            address,
            numbers.ctypes.data,
            memory.ctypes.data,
            signals.ctypes.data,
            commands.ctypes.data,
        )
        wanted = python.act(seen)
        np.testing.assert_allclose(commands[0].tolist(), wanted, rtol=1e-14)
        np.testing.assert_allclose(memory, python.memory.ravel(), rtol=1e-14)
        was = wanted.motoring


# --- physics of the motor


def test_a_motored_oscillator_without_gas_has_its_closed_form(at_rest):
    """Amplitude and power of a driven, damped oscillator."""
    m, k, c, force, f = 4.0, 100e3, 20.0, 50.0, 33.0
    engine = at_rest.replace(
        bore=1e-4,
        moving_mass=m,
        springs=LinearSprings(stiffness=k),
        friction=ViscousFriction(coefficient=c),
    )
    controller = Controller(
        state_logic=AlwaysMotored(),
        motor_control=SteadyMotor(amplitude=force, frequency=f),
        actuators=Actuators(motor_efficiency=1.0),
    )
    run = control.simulate(engine, controller, 12.0, rtol=1e-11)
    w = 2.0 * math.pi * f
    impedance = complex(2.0 * k - m * w**2, c * w)
    assert run.performance.stroke == pytest.approx(2.0 * force / abs(impedance), rel=1e-5)
    assert run.performance.frequency == pytest.approx(f, rel=1e-9)
    taken = 0.5 * c * (w * force / abs(impedance)) ** 2
    assert -run.performance.power == pytest.approx(taken, rel=1e-4)
    assert run.status is Status.STEADY


def test_a_motored_cycle_conserves_energy(at_rest):
    controller = Controller(state_logic=AlwaysMotored(), motor_control=SteadyMotor(frequency=40.0))
    run = control.simulate(at_rest, controller, 3.0, rtol=1e-11)
    balance = run.energy
    assert balance.alternator < 0.0
    assert abs(balance.residual) < 1e-8 * abs(balance.alternator)


def test_a_lag_is_of_first_order(at_rest):
    """What the generator draws moves by 1 - exp(-dt / lag) of its way at each dead centre."""
    lag = 0.05

    class Plain:
        def act(self, signals):
            return generator(signals, load_weight=0.8 if signals.t < 0.3 else 1.0)

    engine = saleg.machines.thesis_transient()
    run = control.simulate(engine, Plain(), 0.6, actuators=Actuators(load_lag=lag))
    table = run.dead_centres
    begin = table.t[table.t >= 0.3].iloc[0]
    after = table[table.t > begin]
    # The weight in a stroke was set where the stroke began.
    passed = np.concatenate([[begin], after.t.to_numpy()[:-1]]) - begin
    np.testing.assert_allclose(after.load_weight, 1.0 - 0.2 * np.exp(-passed / lag), rtol=1e-9)


# --- controllers of one's own


def test_a_controller_in_ten_lines(at_rest):
    class BangBang:
        def act(self, signals):
            if signals.compression_ratio < 12.0:
                return motor(signals, amplitude=500.0, frequency=signals.frequency or 38.0)
            return generator(signals, load_weight=0.9)

    run = control.simulate(at_rest, BangBang(), 2.0)
    assert run.status is Status.STEADY
    assert (run.dead_centres.load_weight.iloc[-20:] == 0.9).all()


class Failing:
    def __init__(self, what):
        self.what = what

    def act(self, signals):
        if signals.t > 0.05:
            if isinstance(self.what, Exception):
                raise self.what
            return self.what
        return generator(signals)


NAN = Commands(0.0, math.nan, 0.0, 0.0, 0.0, 0.0, 0.0, 0.6, 300.0)
HOT = NAN._replace(load_weight=1.0, intake_temperature=5000.0)


@pytest.mark.parametrize(
    ("what", "words"),
    [
        (ValueError("no idea"), ["Failing raised ValueError", "no idea"]),
        (NAN, ["Failing", "load_weight", "nan"]),
        (HOT, ["Failing", "intake_temperature", "5000"]),
        (HOT._replace(motoring=0.5), ["motoring"]),
        (HOT._replace(frequency="fast"), ["frequency", "number"]),
        (None, ["Commands", "NoneType"]),
        ((1, 2), ["Commands", "tuple"]),
    ],
)
def test_a_controller_that_fails_ends_the_run_and_is_named(transient, what, words):
    run = control.simulate(transient, Failing(what), 1.0)
    assert run.status is Status.CONTROLLER_FAULT
    assert 0.05 < run.duration < 0.1
    for word in words:
        assert word in run.message
    assert len(run.strokes) > 3


@dataclasses.dataclass(frozen=True)
class Runaway(LoadControl):
    """Asks for nonsense after a while."""

    def weight(self, memory, signals):
        memory[0] += 1.0
        return 1.0 if memory[0] < 10.0 else math.nan


def test_a_compiled_part_that_fails_ends_the_run_and_is_named(transient):
    controller = Controller(load_control=Runaway())
    run = control.simulate(transient, controller, 1.0)
    assert run.status is Status.CONTROLLER_FAULT
    assert "Runaway" in run.message
    assert "load_weight" in run.message
    assert len(run.strokes) == 9
    python = control.simulate(transient, controller, 1.0, compiled=False)
    assert python.status is Status.CONTROLLER_FAULT
    assert len(python.strokes) == 9


@dataclasses.dataclass(frozen=True)
class Dividing(LoadControl):
    """Fails at once: there is no frequency before the first stroke."""

    def weight(self, memory, signals):
        return 45.0 / signals.frequency


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize(
    ("part", "error"), [(Asserting(), "AssertionError"), (Dividing(), "ZeroDivisionError")]
)
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_part_that_raises_ends_the_run_and_is_named(transient, part, error, compiled):
    run = control.simulate(transient, Controller(load_control=part), 0.3, compiled=compiled)
    assert run.status is Status.CONTROLLER_FAULT
    assert f"load_control {type(part).__name__} raised {error}" in run.message
    assert run.duration < 0.12


def test_nothing_hangs(at_rest):
    for sample_time in (1e-18, 1e-300):
        with pytest.raises(SalegError, match="sample_time"):
            control.simulate(at_rest, Controller(), 1.0, sample_time=sample_time)
    plant = Plant(at_rest, 1.0)
    with pytest.raises(ControllerError, match="sweep"):
        plant.command(motor(plant.signals, 264.0, 38.0, sweep=1e300))
    plant.advance(0.1)
    with pytest.raises(SalegError, match="too short"):
        plant.advance(1e-300)


def test_a_first_command_beyond_the_limits_ends_the_run_at_once(at_rest):
    controller = Controller(actuators=Actuators(most_force=100.0))
    for compiled in (True, False):
        run = control.simulate(at_rest, controller, 1.0, compiled=compiled)
        assert run.status is Status.CONTROLLER_FAULT
        assert "amplitude" in run.message
        assert run.duration == 0.0


def test_what_makes_no_sense_is_refused(at_rest):
    with pytest.raises(InvalidController, match=r"threshold(?s:.)*base_frequency"):
        control.simulate(
            at_rest,
            Controller(
                state_logic=CompressionThreshold(threshold=0.5),
                motor_control=ResonanceSearch(base_frequency=-1.0),
            ),
            1.0,
        )
    with pytest.raises(InvalidController, match="must be a LoadControl"):
        control.simulate(at_rest, Controller(load_control=RAPID), 1.0)
    with pytest.raises(SalegError, match="method act"):
        control.simulate(at_rest, object(), 1.0)
    with pytest.raises(SalegError, match="sample_time"):
        control.simulate(at_rest, Controller(), 1.0, sample_time=-1.0)
    with pytest.raises(SalegError, match="compiled"):
        control.simulate(at_rest, Controller(), 1.0, compiled=True, sensors=Sensors())
    with pytest.raises(SalegError, match="actuators"):
        control.simulate(at_rest, Controller(), 1.0, actuators=Actuators())
    with pytest.raises(SalegError, match="duration"):
        control.simulate(at_rest, Controller(), math.nan)


# --- plant, sensors, batches


def test_a_plant_is_advanced_and_commanded(transient):
    plant = Plant(transient, 0.2)
    times = []
    while plant.running:
        plant.command(generator(plant.signals))
        plant.advance()
        times.append(plant.time)
    run = plant.run()
    assert run.dead_centres.t.tolist() == times[:-1]
    with pytest.raises(SalegError, match="over"):
        plant.advance()
    plain = saleg.simulate(transient, 0.2)
    np.testing.assert_allclose(run.dead_centres.t, plain.dead_centres.t, rtol=1e-9)


def test_a_plant_refuses_a_command_and_goes_on(transient):
    plant = Plant(transient, 0.2)
    plant.command(generator(plant.signals))
    plant.advance()
    with pytest.raises(ControllerError, match="equivalence_ratio"):
        plant.command(generator(plant.signals, equivalence_ratio=-1.0))
    wrong = {"load_weight": -3, "equivalence_ratio": np.nan, "intake_temperature": -5}
    with pytest.raises(ControllerError) as caught:  # before, load_weight alone
        plant.command(generator(plant.signals, force="x", **wrong))
    for part in ("load_weight = -3,", "equivalence_ratio = nan", "temperature = -5", "force = 'x'"):
        assert part in str(caught.value)
    with pytest.raises(SalegError, match="duration"):
        plant.advance(0.0)
    plant.advance()
    assert plant.run().status is Status.COMPLETED


def test_a_plant_advances_by_a_sample_time(transient):
    fixed = transient.replace(**{"alternator.regulator_gain": 0.0})
    plant = Plant(fixed, 0.1)
    instants = []
    while plant.running:
        plant.command(generator(plant.signals))
        plant.advance(1e-3)
        instants.append(plant.time)
    np.testing.assert_allclose(instants, np.arange(1, 101) * 1e-3, atol=1e-12)
    ordinary = saleg.simulate(fixed, 0.1)
    np.testing.assert_allclose(plant.run().dead_centres.t, ordinary.dead_centres.t, rtol=1e-6)


def test_sensors_without_errors_change_nothing(at_rest):
    plain = control.simulate(at_rest, CONTROLLERS["start-up"], 0.8, compiled=False)
    seen = control.simulate(at_rest, CONTROLLERS["start-up"], 0.8, sensors=Sensors())
    np.testing.assert_allclose(seen.dead_centres.t, plain.dead_centres.t, rtol=1e-9)


class Listening:
    """Generates and remembers what it was shown."""

    def __init__(self):
        self.seen = []

    def act(self, signals):
        self.seen.append(signals)
        return generator(signals)


def test_noise_and_resolution_reach_the_controller(transient):
    sensors = Sensors(position_noise=1e-4, power_resolution=50.0, seed=5)
    first, second = Listening(), Listening()
    run = control.simulate(transient, first, 1.0, sensors=sensors)
    control.simulate(transient, second, 1.0, sensors=sensors)
    assert first.seen == second.seen
    measured = np.array([signals.stroke for signals in first.seen[1:]])
    errors = measured - run.dead_centres.stroke.to_numpy()[: len(measured)]
    assert np.std(errors) == pytest.approx(math.sqrt(2.0) * 1e-4, rel=0.3)  # of two positions
    assert all(signals.power % 50.0 == 0.0 for signals in first.seen)
    with pytest.raises(InvalidController, match=r"position_noise(?s:.)*delay"):
        control.simulate(
            transient, Listening(), 0.1, sensors=Sensors(position_noise=-1.0, delay=-1)
        )


def test_a_delay_counts_dead_centres(transient):
    late = Listening()
    run = control.simulate(transient, late, 0.3, sensors=Sensors(delay=2))
    shown = [signals.stroke for signals in late.seen]
    true = run.dead_centres.stroke.tolist()
    np.testing.assert_allclose(shown[3:], true[: len(shown) - 3], rtol=1e-12)
    assert np.ptp(true[:5]) > 1e-4  # they differ, so that the wrong one would show


def test_between_dead_centres_there_is_nothing_new_to_measure(at_rest):
    """Perfect sensors read at intervals start the engine as well as none."""
    controller = CONTROLLERS["start-up"]
    run = control.simulate(at_rest, controller, 1.5, sensors=Sensors(), sample_time=1e-3)
    plain = control.simulate(at_rest, controller, 1.5, sample_time=1e-3)
    assert control.fired_at(run) == control.fired_at(plain) < 0.6
    assert run.performance.compression_ratio == pytest.approx(
        plain.performance.compression_ratio, rel=1e-9
    )


def test_noise_reaches_the_regulator(transient):
    run = control.simulate(transient, Regulated(), 0.6, sensors=Sensors(position_noise=1e-3))
    assert np.std(run.dead_centres.load_weight.iloc[-20:]) > 0.01


class Regulated:
    def act(self, signals):
        return generator(signals)


def test_a_fuel_cut_counts_strokes_not_samples(at_rest):
    controller = Controller(motor_control=RAPID, fuel_control=FuelCut(at=1.2, strokes=3.0))
    least = []
    for sample_time in (None, 5e-4):
        run = control.simulate(at_rest, controller, 1.35, compiled=False, sample_time=sample_time)
        table = run.dead_centres
        least.append(table.compression_ratio[table.t > 1.2].min())
    assert least[0] == pytest.approx(least[1], rel=0.02)


def test_an_actuator_moves_on_after_a_single_command(transient):
    plant = Plant(transient, 1.0, actuators=Actuators(load_lag=0.1))
    plant.command(generator(plant.signals, load_weight=0.5))
    plant.advance(0.05)
    plant.command(generator(plant.signals, load_weight=1.0))
    assert plant._course.state.engine["load_weight"][0] == 0.5  # it only begins to move
    for _ in range(10):
        plant.advance(0.01)
    plant.command(generator(plant.signals, load_weight=1.0))
    reached = 1.0 - 0.5 * math.exp(-0.1 / 0.1)
    assert plant._course.state.engine["load_weight"][0] == pytest.approx(reached, rel=1e-12)


def test_engines_without_fuel_and_with_unlike_sides_are_controlled(transient):
    chamber = saleg.BounceChamber(
        bore=0.0345, half_stroke=0.0467, gas_properties=saleg.laws.ConstantGamma()
    )
    closed = saleg.Engine.mirrored(
        saleg.Translator(mass=4.93), chamber, springs=transient.springs, start=AtRest()
    )
    table = control.motored(closed, [38.0], [66.0], duration=1.0)
    assert table.stroke.iloc[0] > 1e-3
    unlike = transient.replace(**{"left.equivalence_ratio": 0.0})
    run = control.simulate(unlike, Regulated(), 0.3)
    plain = saleg.simulate(unlike, 0.3)
    np.testing.assert_allclose(run.dead_centres.t, plain.dead_centres.t, rtol=1e-9)


@pytest.mark.parametrize("sensors", [None, Sensors()])
def test_signals_have_the_compression_ratio_of_the_cylinder(base, sensors):
    """By its volumes; the clearances of both chambers together would say 7.2 for 16.6."""
    engine = single_piston(base, load_constant=49.66, regulator_gain=0.0)
    listening = Listening()
    run = control.simulate(engine, listening, 0.5, sensors=sensors)
    history = run.orbit.history
    shown = [signals.compression_ratio for signals in listening.seen]
    assert shown[1:] == pytest.approx(run.dead_centres.compression_ratio.tolist(), rel=1e-9)
    assert shown[-1] == pytest.approx(history.V_left.max() / history.V_left.min(), rel=1e-2)
    for side in ("left", "right"):
        name, volumes = f"compression_ratio_{side}", history[f"V_{side}"]
        shown = [getattr(signals, name) for signals in listening.seen]
        assert shown[1:] == pytest.approx(run.dead_centres[name].tolist(), rel=1e-9)
        assert shown[-1] == pytest.approx(volumes.max() / volumes.min(), rel=1e-2)
    ends = sorted(run.dead_centres.x.tolist()[-2:])
    assert [listening.seen[-1].x_left, listening.seen[-1].x_right] == pytest.approx(ends, rel=1e-9)


@pytest.mark.parametrize("sensors", [None, Sensors()])
def test_the_top_dead_centre_of_a_cylinder_is_held(base, sensors):
    """Left to itself the piston turns 12.1 mm from its head."""
    engine = single_piston(base, load_constant=49.66, regulator_gain=0.0)
    held = DeadCentreRegulator(distance=0.0885)
    run = control.simulate(
        engine, Controller(state_logic=NeverMotored(), load_control=held), 3.0, sensors=sensors
    )
    assert run.cycles.x_left.iloc[-1] == pytest.approx(-0.0885, abs=2e-6)
    weight = run.dead_centres.load_weight.iloc[-1]
    steady = saleg.steady_state(engine.replace(**{"alternator.load_constant": 49.66 * weight}))
    assert steady.strokes["x_end"].min() == pytest.approx(-0.0885, abs=1e-5)
    right = dataclasses.replace(held, right=1.0, distance=0.1)
    run = control.simulate(engine, Controller(state_logic=NeverMotored(), load_control=right), 3.0)
    assert run.cycles.x_right.iloc[-1] == pytest.approx(0.1, abs=2e-6)


def test_a_single_piston_engine_is_started_up_from_where_it_rests(base):
    """At the midpoint its gas spring would throw it against the head, without fuel."""
    engine = single_piston(base, load_constant=49.66, regulator_gain=0.0)
    resting = engine.replace(start=AtRest())
    start = AtRest().initial(resting)
    left, right = resting.chambers
    force = left.area * start.left.pressure - right.area * start.right.pressure
    assert force == pytest.approx(2.0 * 20e3 * start.x, rel=1e-9)
    squeezed = (0.133 / (0.1 + start.x)) ** 1.35
    assert start.left.pressure == pytest.approx(1.05e5 * squeezed, rel=1e-9)
    assert -0.06 < start.x < -0.01
    left_alone = saleg.simulate(resting, 0.05, history=1, stall_stroke=0.0)
    assert np.abs(left_alone.history.x - start.x).max() < 1e-3  # its wall warms the air
    controller = Controller(motor_control=ResonanceSearch(amplitude=600.0, target=17.0))
    run = control.start_up(engine, 24.0, duration=3.0, controller=controller)
    found = saleg.steady_state(engine).performance
    assert run.performance.stroke == pytest.approx(found.stroke, rel=1e-6)
    assert run.performance.power == pytest.approx(found.power, rel=1e-6)


def test_a_threshold_is_passed_by_the_cylinder_of_a_single_piston_engine(base):
    engine = single_piston(base, load_constant=49.66, regulator_gain=0.0)
    run = control.simulate(engine, Controller(state_logic=CompressionThreshold()), 0.5)
    free = saleg.simulate(engine, 0.5)
    assert free.cycles.compression_ratio.min() > 12.0
    assert not run.dead_centres.motoring.any()
    assert run.performance.power == pytest.approx(free.performance.power, rel=1e-6)


@pytest.mark.parametrize("state_logic", [NeverMotored(), CompressionThreshold(hysteresis=2.0)])
def test_a_controlled_engine_has_the_run_of_its_mirror_image(base, state_logic):
    """Unlike sides, fuel, intake and motor by the compression ratio: no side is the first."""
    changes = {"left.bore": 0.060, "left.equivalence_ratio": 0.5, "right.intake.temperature": 340.0}
    engine = base.replace(**changes)
    start = dataclasses.replace(engine.start, position=-engine.start.position)
    image = dataclasses.replace(engine, left=engine.right, right=engine.left, start=start)
    controller = Controller(
        state_logic=state_logic,
        motor_control=ResonanceSearch(base_frequency=38.0),
        fuel_control=FuelOnDemand(times=(0.1, 0.1)),
        intake_control=HeatedIntake(times=(0.1, 0.1)),
    )
    there, here = (control.simulate(one, controller, 0.3, rtol=1e-9) for one in (engine, image))
    wanted, found = there.dead_centres, here.dead_centres
    assert len(found) == len(wanted)
    np.testing.assert_allclose(found.x, -wanted.x, rtol=1e-5)
    for name in ("compression_ratio", "equivalence_ratio", "intake_temperature", "motoring"):
        np.testing.assert_allclose(
            found[name].astype(float), wanted[name].astype(float), rtol=1e-5, err_msg=name
        )


def test_start_up_survives_coarse_sensors(at_rest):
    sensors = Sensors(position_noise=2e-5, position_resolution=1e-5, time_resolution=1e-5, delay=1)
    run = control.simulate(at_rest, CONTROLLERS["start-up"], 2.0, sensors=sensors)
    assert control.fired_at(run) < 1.0
    assert run.performance.compression_ratio == pytest.approx(17.9, abs=1.5)


def test_many_start_ups_in_one_call(at_rest):
    bases = [34.0, 35.0, 36.0, 37.0, 38.0]
    pairs = [
        (at_rest, Controller(motor_control=ResonanceSearch(base_frequency=base))) for base in bases
    ]
    broken = (at_rest, Controller(motor_control=ResonanceSearch(base_frequency=-1.0)))
    table = control.simulate_many([*pairs, broken], 2.5, rtol=1e-6)
    assert table.status.tolist() == ["steady"] * 5 + ["invalid"]
    assert "base_frequency" in table.message.iloc[-1]
    fired = table.fired_at.to_numpy()[:5]
    assert (np.diff(fired) < 0.0).all()
    alone = control.simulate(*pairs[4], 2.5, rtol=1e-6)
    assert fired[4] == control.fired_at(alone)
    assert table.attrs["units"]["fired_at"] == "s"


def test_an_orbit_is_seen_again_under_a_controller(at_rest):
    """The last cycle, replayed, ends where it ended, compiled and with commands from Python."""
    for compiled in (True, False):
        run = control.simulate(at_rest, CONTROLLERS["start-up"], 0.75, compiled=compiled)
        start = len(run.strokes) - 2 - (run.strokes["direction"][-1] > 0.0)
        np.testing.assert_allclose(
            run.orbit.strokes["x_end"], run.strokes["x_end"][start : start + 2], rtol=1e-9
        )


def test_a_controlled_run_is_saved_and_loaded(started, tmp_path):
    started.save(tmp_path / "run.npz")
    again = saleg.Run.load(tmp_path / "run.npz")
    assert again.dead_centres.equals(started.dead_centres)
    assert again.status is Status.STEADY
    assert (again.events.event == started.events.event).all()


# --- demands and maps


def test_a_demand_from_a_file_and_from_arrays(tmp_path):
    path = tmp_path / "demand.csv"
    path.write_text("t [s],power [W]\n0,3900\n2,3900\n2,1900\n")
    read = Demand.read(path)
    assert read == Demand.of(np.array([0, 2, 2]), [3900, 3900, 1900])
    path.write_text("0,3900\n2,3900\n2,1900\n")
    assert Demand.read(path) == read
    for heads in ("time (ms), P [kW]", "t / ms,P_kW", "ms,kW"):
        path.write_text(f"{heads}\n0,3.9\n2000,3.9\n2000,1.9\n")
        assert Demand.read(path) == read  # before, as 3.9 W
    path.write_text("t [h],P [hp]\n0,3.9\n1,x\n2\n")
    with pytest.raises(InvalidController) as caught:
        Demand.read(path)
    for part in ("4 wrong fields", "'h' is no unit here", "'hp' is", "line 3", "line 4"):
        assert part in str(caught.value)
    for heads in ("t,P [kW", "t,P_KW", "minutes,W", "kW,ms", "power,time"):
        path.write_text(f"{heads}\n0,3.9\n")
        with pytest.raises(InvalidController, match="line 1"):  # before, read in SI
            Demand.read(path)
    path.write_text("0,3.9 kW\n1,1900\n")
    with pytest.raises(InvalidController, match="line 1"):  # before, taken for heads
        Demand.read(path)
    path.write_text("t,power\n0,3900\n1,abc\n")
    with pytest.raises(InvalidController, match="line 3"):
        Demand.read(path)
    with pytest.raises(InvalidController, match="times"):
        Demand.of([1.0, 0.0], [1.0, 2.0])
    with pytest.raises(InvalidController, match="powers"):
        Demand.of([0.0, 1.0], [1.0])


def test_a_map_keeps_what_a_controller_can_go_by(transient):
    known = control.operating_map(transient, "equivalence_ratio", [0.0, 0.3, 0.655])
    assert len(known.powers) == 2
    assert known.lowest == 0.3
    assert known.table.status.iloc[0] != "steady"
    grid = control.operating_grid(transient, [263.0, 370.0], [0.4, 0.6])
    assert len(grid) == 4
    assert grid.power.iloc[0] > grid.power.iloc[2]
    with pytest.raises(InvalidController, match="at least two"):
        _ = control.operating_map(transient, "equivalence_ratio", [0.655]).powers
