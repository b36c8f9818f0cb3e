"""Control within the stroke: samples, sensor, converter, and what is commanded there."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

import saleg
from helpers import bounce_engine
from saleg import Controller, Status, control, laws
from saleg.compiler.controllers import control_of
from saleg.control import Plant, Sensors, generator, motor
from saleg.engine.start import AtRest
from saleg.errors import ControllerError, InvalidController, SalegError
from saleg.kernel.sampled import sample
from saleg.kernel.slots import call_at
from saleg.laws import (
    AlwaysMotored,
    Converter,
    ForceCommand,
    ForceControl,
    Instant,
    PhaseLockedMotor,
    PositionSensor,
    PushAlong,
    tracked_velocity,
)
from saleg.simulation.performance import EnergyBalance


@pytest.fixture(scope="module")
def at_rest(transient):
    return transient.replace(start=AtRest())


@pytest.fixture(scope="module")
def pushed(at_rest):
    """The transient engine, started by a push along its motion."""
    return control.simulate(at_rest, Controller(force_control=PushAlong()), 2.0)


# --- converter


def test_each_limit_of_a_converter_is_met_exactly():
    k, R, eta = 30.0, 0.5, 0.9
    plain = Converter(force_constant=k, resistance=R, efficiency=eta)
    current = dataclasses.replace(plain, maximum_current=5.0)
    assert current.force(-1e4, 3.0) == -5.0 * k
    voltage = dataclasses.replace(plain, bus_voltage=100.0)
    force = voltage.force(1e4, 3.0)
    assert k * 3.0 + R * force / k == pytest.approx(100.0, rel=1e-12)
    assert voltage.force(-1e4, 3.4) == 0.0  # the voltage induced alone is 102 V
    power = dataclasses.replace(plain, maximum_power=1000.0)
    drawn = power.force(1e4, 3.0)
    assert power.power(drawn, 3.0) == pytest.approx(-1000.0, rel=1e-12)
    taken = power.force(-1e4, 10.0)
    assert power.power(taken, 10.0) == pytest.approx(1000.0, rel=1e-12)
    assert plain.force(20.0, 3.0) == pytest.approx(20.0, rel=1e-15)


@pytest.mark.parametrize("v", [-12.0, -1.0, 0.0, 1.0, 12.0])
@pytest.mark.parametrize("wanted", [-3000.0, -10.0, 0.0, 10.0, 3000.0])
def test_a_converter_is_the_same_in_the_mirror(wanted, v):
    converter = Converter(maximum_power=2000.0, bus_voltage=200.0)
    force = converter.force(wanted, v)
    assert converter.force(-wanted, -v) == -force
    assert converter.power(-force, -v) == converter.power(force, v)
    assert abs(force) <= abs(wanted)


# --- sensor


def measured(sensor, positions):
    memory = np.zeros(20)
    return np.array([sensor.measured(memory, x) for x in positions])


def test_the_noise_of_a_sensor_is_normal_and_without_memory():
    noise = measured(PositionSensor(noise=1e-4, seed=7), np.full(20_000, 0.01)) - 0.01
    assert stats.kstest(noise / 1e-4, "norm").pvalue > 0.01
    assert abs(np.corrcoef(noise[:-1], noise[1:])[0, 1]) < 0.03
    other = measured(PositionSensor(noise=1e-4, seed=8), np.full(20_000, 0.01)) - 0.01
    assert abs(np.corrcoef(noise, other)[0, 1]) < 0.03


def test_a_sensor_rounds_and_is_late():
    way = 1e-5 * np.arange(50)
    rounded = measured(PositionSensor(resolution=1e-4), way + 3e-6)
    np.testing.assert_allclose(rounded, 1e-4 * np.round((way + 3e-6) / 1e-4), atol=1e-18)
    late = measured(PositionSensor(delay=3), way)
    assert (late[3:] == way[:-3]).all()
    assert (late[:3] == 0.0).all()


def test_a_tracked_velocity_follows_a_steady_motion_and_lags_a_sine_as_its_poles_say():
    dt, tau, f = 1e-5, 4e-4, 40.0
    t = dt * np.arange(40_000)
    memory = np.zeros(20)
    steady = [tracked_velocity(memory, 3.0 * one, dt, tau) for one in t[:4000]]
    assert steady[-1] == pytest.approx(3.0, rel=1e-9)
    memory = np.zeros(20)
    omega = 2.0 * math.pi * f
    v = np.array([tracked_velocity(memory, math.sin(omega * one), dt, tau) for one in t])
    settled = slice(20_000, 40_000)  # whole periods
    phasor = 2.0 * np.mean(v[settled] * np.exp(-1j * omega * t[settled])) / omega
    assert abs(phasor) == pytest.approx(1.0 / (1.0 + (omega * tau) ** 2), rel=0.01)
    # One sample of the sum is half a sample late, beside the poles' own lag.
    assert np.angle(phasor) == pytest.approx(-2.0 * math.atan(omega * tau), abs=2.0 * omega * dt)


# --- parts that act at samples


def test_parts_at_samples_command_the_same_compiled():
    sensor = PositionSensor(noise=2e-4, resolution=1e-5, delay=2, seed=3)
    controller = Controller(force_control=PushAlong(), position_sensor=sensor)
    room = control_of(controller).sampling
    memory = np.zeros((2, 20))
    ways = set()
    for n in range(500):
        shown = Instant(5e-5 * n, 0.02 * math.sin(0.1 * n), 5e-5, float(n < 400), -0.02, 0.02, 0, 1)
        room.instant[0] = shown
        pointers = (room.numbers, room.memory, room.instant, room.wanted)
        call_at(room.address, *(part.ctypes.data for part in pointers))
        wanted = sample(controller, memory, shown)
        np.testing.assert_allclose(room.wanted[0].tolist(), wanted, rtol=1e-13)
        np.testing.assert_allclose(room.memory, memory.ravel(), rtol=1e-12)
        ways.add(wanted)
    assert ways == {(1.0, 264.0), (1.0, -264.0), (0.0, 0.0)}


class PushInPython:
    """The same push along, as an object of one's own at sample times."""

    def __init__(self, law, sample_time):
        self.law, self.sample_time, self.memory = law, sample_time, np.zeros(20)

    def act(self, signals):
        instant = SimpleNamespace(
            t=signals.t, x=signals.position, sample_time=self.sample_time, motoring=1.0
        )
        command = self.law.push(self.memory, instant)
        return motor(signals, 0.0, 0.0, sets_force=command.sets_force, force=command.force)


def test_python_at_sample_times_moves_as_the_compiled_parts_do(at_rest):
    law, dt = PushAlong(limit=200.0), 2.0**-11  # exact, so that both sample at the same instants
    parts = Controller(
        state_logic=AlwaysMotored(),
        force_control=law,
        position_sensor=PositionSensor(sample_time=dt),
    )
    compiled = control.simulate(at_rest, parts, 0.3, rtol=1e-10)
    python = control.simulate(at_rest, PushInPython(law, dt), 0.3, sample_time=dt, rtol=1e-10)
    assert len(compiled.strokes) > 15
    np.testing.assert_allclose(compiled.strokes["x_end"], python.strokes["x_end"], rtol=1e-7)
    np.testing.assert_allclose(
        compiled.strokes["electrical_energy"], python.strokes["electrical_energy"], rtol=1e-7
    )


def test_dead_centres_in_python_leave_samples_to_the_kernel(at_rest, pushed):
    controller = Controller(force_control=PushAlong())
    python = control.simulate(at_rest, controller, 1.0, compiled=False)
    count = len(python.strokes)
    np.testing.assert_allclose(python.strokes["x_end"], pushed.strokes["x_end"][:count], rtol=1e-7)


def test_a_push_along_adds_twice_its_displacement_per_stroke():
    """A linear oscillator whose force turns with it: the amplitude grows by 2 F / k a stroke.

    There are two springs, and gas on both sides.
    """
    stiffness, force = 2e6, 100.0
    engine = bounce_engine(mass=30.0, stiffness=stiffness, pressure=1e5, position=-0.02)
    law = PushAlong(limit=force, time_constant=2e-5, threshold=1e-4)
    controller = Controller(
        state_logic=AlwaysMotored(),
        force_control=law,
        position_sensor=PositionSensor(sample_time=1e-5),
    )
    run = control.simulate(engine, controller, 0.1)
    chamber = engine.left
    gas = 2.0 * 1.4 * chamber.pressure * chamber.area / chamber.half_stroke
    growth = np.diff(np.abs(run.strokes["x_end"]))
    assert len(growth) > 5
    np.testing.assert_allclose(growth, 2.0 * force / (2.0 * stiffness + gas), rtol=0.01)


def test_energy_balances_close_while_a_force_is_commanded(at_rest):
    controller = Controller(force_control=PushAlong(), position_sensor=PositionSensor(noise=1e-5))
    rows = control.simulate(at_rest, controller, 0.3, rtol=1e-10).strokes
    assert (rows["motoring"] > 0.0).all()
    for n in range(1, len(rows)):
        energy = EnergyBalance.between(rows[n - 1], rows[n : n + 1])
        assert abs(energy.residual) < 1e-8 * energy.largest_term
        assert energy.electrical < energy.alternator < 0.0  # drawn, with losses on the way


def test_the_bus_pays_for_force_times_way_and_the_heat_of_the_winding(at_rest):
    converter = Converter(force_constant=20.0, resistance=0.4, efficiency=0.9)
    plant = Plant(at_rest, 0.5, converter=converter, rtol=1e-10)
    force = 60.0
    while plant.running:
        plant.command(motor(plant.signals, 0.0, 0.0, sets_force=1.0, force=force))
        plant.advance()
    rows = plant.run().strokes[1:]
    way = rows["x_end"] - rows["x_start"]
    np.testing.assert_allclose(rows["alternator_work"], -force * way, rtol=1e-8)
    along = rows["direction"] > 0.0
    heat = converter.resistance * (force / converter.force_constant) ** 2 * rows["duration"]
    drawn = (force * way + heat) / converter.efficiency
    np.testing.assert_allclose(rows["electrical_energy"][along], -drawn[along], rtol=1e-8)
    account = control.bus_energy(plant.run())
    every = plant.run().strokes["electrical_energy"]
    assert account.drawn == pytest.approx(-every[every < 0.0].sum(), rel=1e-12)
    assert account.returned - account.drawn == pytest.approx(every.sum(), rel=1e-12)


def test_a_force_takes_the_place_of_the_load(transient):
    """With no force commanded there is neither load nor motor, whatever else is commanded."""
    plant = Plant(transient, 0.2)
    plant.command(generator(plant.signals, sets_force=1.0, load_weight=2.0))
    plant.advance()
    assert plant.run().strokes["alternator_work"] == [0.0]
    with pytest.raises(ControllerError, match="force = nan"):
        plant.command(generator(plant.signals, force=math.nan))
    with pytest.raises(ControllerError, match=r"sets_force = 0\.5"):
        plant.command(generator(plant.signals, sets_force=0.5))


@dataclasses.dataclass(frozen=True)
class Nonsense(ForceControl):
    """Gives no number after a while."""

    def push(self, memory, instant):
        return ForceCommand(1.0, math.nan if instant.t > 0.05 else 10.0)


@pytest.mark.parametrize("compiled", [True, False])
def test_a_force_that_is_no_number_ends_the_run_and_is_named(at_rest, compiled):
    controller = Controller(force_control=Nonsense())
    run = control.simulate(at_rest, controller, 0.2, compiled=compiled)
    assert run.status is Status.CONTROLLER_FAULT
    assert "force_control Nonsense" in run.message
    assert run.duration == pytest.approx(0.05, abs=1.1e-4)


def test_wrong_parts_at_samples_are_named():
    with pytest.raises(InvalidController) as error:
        Controller(
            force_control=AlwaysMotored(),
            position_sensor=PositionSensor(sample_time=0.0),
            converter=Converter(resistance=0.0),
        ).validate()
    found = {problem.path for problem in error.value.problems}
    assert found == {"force_control", "position_sensor.sample_time", "converter.resistance"}
    with pytest.raises(SalegError, match="converter"):
        control.simulate(saleg.machines.thesis_base(), Controller(), 0.1, converter=Converter())


# --- start-up from anywhere


def test_a_push_along_starts_the_engine_and_hands_over_to_the_load(pushed, transient):
    assert pushed.status is Status.STEADY
    assert control.fired_at(pushed) < 1.0
    plain = saleg.steady_state(transient)
    assert pushed.performance.power == pytest.approx(plain.performance.power, rel=1e-6)


@pytest.mark.parametrize("base_frequency", [20.0, 60.0])
def test_a_motor_locked_to_the_motion_starts_from_below_and_above_resonance(
    at_rest, base_frequency
):
    lock = PhaseLockedMotor(base_frequency=base_frequency)
    run = control.simulate(at_rest, Controller(motor_control=lock), 2.0)
    assert run.status is Status.STEADY
    assert control.fired_at(run) < 1.5


@pytest.mark.parametrize("factor", [0.9, 1.1])
def test_a_push_along_needs_to_know_neither_mass_nor_stiffness_nor_noise(at_rest, factor):
    engine = at_rest.replace(
        **{
            "translator.mass": at_rest.translator.mass * factor,
            "springs.stiffness": at_rest.springs.stiffness / factor,
        }
    )
    controller = Controller(
        force_control=PushAlong(threshold=0.3),
        position_sensor=PositionSensor(sample_time=2e-4, noise=1e-4, seed=1),
    )
    run = control.simulate(engine, controller, 2.0, sensors=Sensors(position_noise=1e-4))
    assert run.status is Status.STEADY or run.dead_centres.compression_ratio.iloc[-1] > 12.0
    assert control.fired_at(run) < 1.2


# --- spark, and pressure of bounce chambers


def test_a_spark_comes_earlier_by_the_way_commanded():
    engine = saleg.machines.wvu()
    assert engine.left.ignition == engine.right.ignition == laws.SparkAtClearance(0.004)
    plant = Plant(engine, 0.1)
    while plant.running:
        plant.command(generator(plant.signals, spark_advance=0.002))
        plant.advance()
    heights = plant.run().strokes["ignition_height"][-2:].max(axis=0)
    assert heights == pytest.approx(0.006, abs=1e-9)


def test_an_engine_filled_to_a_pressure_moves_as_one_built_with_it():
    engine = bounce_engine(pressure=1.0e5)
    plant = Plant(engine, 0.2, rtol=1e-10)
    while plant.running:
        plant.command(generator(plant.signals, spring_pressure=1.7e5))
        plant.advance()
    filled = plant.run()
    built = saleg.simulate(bounce_engine(pressure=1.7e5), 0.2, rtol=1e-10)
    count = len(filled.strokes)
    assert count == len(built.strokes)
    np.testing.assert_allclose(filled.strokes["t"], built.strokes["t"], rtol=1e-8)
    np.testing.assert_allclose(filled.strokes["charge_mass"], built.strokes["charge_mass"])


def test_energy_balances_close_while_bounce_chambers_are_filled_and_emptied():
    plant = Plant(bounce_engine(), 0.3, rtol=1e-10)
    while plant.running:
        seconds = plant.signals.t
        plant.command(generator(plant.signals, spring_pressure=1e5 * (1.0 + 0.5 * seconds)))
        plant.advance()
    rows = plant.run().strokes
    brought = 0.0
    for n in range(1, len(rows)):
        energy = EnergyBalance.between(rows[n - 1], rows[n : n + 1])
        assert abs(energy.residual) < 1e-8 * abs(energy.stored)
        brought -= energy.exhaust
    assert brought > 1.0
