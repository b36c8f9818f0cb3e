"""Signals and commands of a controller at a dead centre.

A controller is compiled by itself (:mod:`saleg.compiler.controllers`), so that another one needs
no other kernel; `control` is a :class:`saleg.kernel.tuples.Control`.
"""

from math import inf, isfinite, nan, pi

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    CLOSED,
    CONTROL_PARTS,
    LEFT,
    MEMORY,
    RIGHT,
    SAMPLE_MEMORY,
    SAMPLED_PARTS,
    X,
)
from saleg.kernel.rhs import motor_angle
from saleg.kernel.slots import actuators_follow, actuators_refused, call_at
from saleg.kernel.state import clearance_of
from saleg.laws.arguments import Commands

# How near to a head a position counts, over the clearance at the midpoint.
NEAREST = 1.0 - 1e-9
# How near to the pressure wanted a bounce chamber is left alone.
AS_FILLED = 1e-9


@inline
def between_heads(C, low, high):
    """Two positions, short of the heads [m]."""
    low = max(low, -NEAREST * C[LEFT].half_stroke)
    return low, min(high, NEAREST * C[RIGHT].half_stroke)


@inline
def own_compression_ratio(C, side, low, high):
    """Geometric compression ratio of one chamber between two positions [-]."""
    low, high = between_heads(C, low, high)
    near, far = (low, high) if C[side].sign > 0.0 else (high, low)
    return clearance_of(C, side, far) / clearance_of(C, side, near)


@compiled
def compression_ratio(C, low, high):
    """Geometric compression ratio between two positions, of the cylinders together [-].

    Without a cylinder, of both chambers. Heads end the way.
    """
    low, high = between_heads(C, low, high)
    alike = (C[LEFT].lower_heating_value > 0.0) == (C[RIGHT].lower_heating_value > 0.0)
    greatest, least = 0.0, 0.0
    for side in range(2):
        c = C[side]
        if alike or c.lower_heating_value > 0.0:
            near, far = (low, high) if c.sign > 0.0 else (high, low)
            greatest += c.area * clearance_of(C, side, far)
            least += c.area * clearance_of(C, side, near)
    return greatest / least


@compiled
def write_signals(E, C, y, signals):
    """Fill a record of :class:`saleg.laws.Signals`: what a dead centre showed, and where it is."""
    # A start in the middle of a stroke has guessed its length alone.
    here = E.x_dead_centre if isfinite(E.x_dead_centre) else -0.5 * E.direction * E.stroke
    before = here + E.direction * E.stroke
    signals.t = E.t
    signals.x = E.x_dead_centre
    signals.direction = E.direction
    signals.stroke = E.stroke
    low, high = min(here, before), max(here, before)
    signals.compression_ratio = compression_ratio(C, low, high)
    signals.x_left, signals.x_right = low, high
    signals.compression_ratio_left = own_compression_ratio(C, LEFT, low, high)
    signals.compression_ratio_right = own_compression_ratio(C, RIGHT, low, high)
    signals.frequency = 0.5 / E.stroke_duration if E.stroke_duration > 0.0 else 0.0
    signals.power = E.power
    signals.regulated_weight = E.regulated_weight
    signals.motoring = E.motoring
    signals.was_motoring = E.motoring
    signals.maximum_stroke = E.maximum_stroke
    signals.rated_equivalence_ratio = E.rated_equivalence_ratio
    signals.rated_intake_temperature = E.rated_intake_temperature
    signals.position = y[X]


@inline
def commands_of(record):
    """Commands from a record of them."""
    return Commands(
        motoring=record.motoring,
        load_weight=record.load_weight,
        amplitude=record.amplitude,
        frequency=record.frequency,
        sweep=record.sweep,
        sets_phase=record.sets_phase,
        phase=record.phase,
        equivalence_ratio=record.equivalence_ratio,
        intake_temperature=record.intake_temperature,
        sets_force=record.sets_force,
        force=record.force,
        spark_advance=record.spark_advance,
        spring_pressure=record.spring_pressure,
    )


@compiled
def ask(E, C, y, control):
    """Commands of the controller; the memory of its parts travels with the engine's record."""
    memory, signals, commands = control.memory, control.signals, control.commands
    write_signals(E, C, y, signals[0])
    for n in range(CONTROL_PARTS * MEMORY):
        memory[n] = E.memory[n]
    commands[0] = commands[1]  # NaN, which stays where the controller fails
    call_at(
        control.address,
        control.numbers.ctypes.data,
        memory.ctypes.data,
        signals.ctypes.data,
        commands.ctypes.data,
    )
    if isfinite(commands[0].motoring):
        for n in range(CONTROL_PARTS * MEMORY):
            E.memory[n] = memory[n]
    return commands_of(commands[0])


@inline
def in_force(E, load_weight, amplitude, equivalence_ratio, intake_temperature):
    """Commands that act now; quantities whose actuators may lag have the values given."""
    return Commands(
        motoring=E.motoring,
        load_weight=load_weight,
        amplitude=amplitude,
        frequency=E.motor_frequency,
        sweep=E.motor_sweep,
        sets_phase=0.0,
        phase=0.0,
        equivalence_ratio=equivalence_ratio,
        intake_temperature=intake_temperature,
        sets_force=E.sets_force,
        force=E.force,
        spark_advance=E.spark_advance,
        spring_pressure=E.spring_pressure,
    )


@inline
def standing(E):
    """Commands as far as the actuators have followed them."""
    return in_force(E, E.load_weight, E.motor_amplitude, E.equivalence_ratio, E.intake_temperature)


@inline
def asked(E):
    """Commands as they were given last."""
    return in_force(
        E,
        E.asked_load_weight,
        E.asked_amplitude,
        E.asked_equivalence_ratio,
        E.asked_intake_temperature,
    )


@compiled
def obey(P, E, C, wanted, elapsed):
    """Set commands, as far as the actuators follow; refuse what they cannot do.

    They have moved towards what was asked for last in the time elapsed since, for ever if this is
    the first command; towards what is wanted now they begin to move.
    """
    E.fault = actuators_refused(P, wanted)
    if E.fault != 0.0:
        return
    angle = motor_angle(E, E.t)
    moved = actuators_follow(P, standing(E), wanted if elapsed == inf else asked(E), elapsed)
    now = actuators_follow(P, moved, wanted, 0.0)
    if not isfinite(now.load_weight + now.amplitude + now.equivalence_ratio):
        E.fault = nan
        return
    E.t_command = E.t
    E.motoring = now.motoring
    E.load_weight = now.load_weight
    E.motor_amplitude = now.amplitude
    E.motor_frequency = now.frequency
    E.motor_sweep = now.sweep
    E.motor_phase = now.phase if now.sets_phase > 0.0 else angle % (2.0 * pi)
    E.equivalence_ratio = now.equivalence_ratio
    E.intake_temperature = now.intake_temperature
    E.spark_advance = now.spark_advance
    E.spring_pressure = now.spring_pressure
    if E.sample_time == 0.0:  # else it is commanded at samples
        E.sets_force, E.force = now.sets_force, now.force
    E.is_driven = max(E.motoring, E.sets_force)
    E.asked_load_weight = wanted.load_weight
    E.asked_amplitude = wanted.amplitude
    E.asked_equivalence_ratio = wanted.equivalence_ratio
    E.asked_intake_temperature = wanted.intake_temperature
    supply(E, C)


@compiled
def supply(E, C):
    """Hand fuel, spark and intake temperature to the chambers that burn fuel; fill the others.

    Those that burn keep what they differ by when the engine is rated.
    """
    for side in range(2):
        c = C[side]
        c.next_spark_advance = E.spark_advance
        if c.lower_heating_value <= 0.0:
            order_pressure(c, E.spring_pressure)
            continue
        c.intake_temperature = E.intake_temperature + c.beside_rated_temperature
        c.equivalence_ratio_wanted = E.equivalence_ratio * c.over_rated_fuel


@inline
def order_pressure(c, pressure):
    """Have a chamber that is closed for ever filled so that the midpoint has a pressure."""
    is_closed = c.port == inf and c.mode == CLOSED
    if pressure > 0.0 and is_closed and abs(pressure / pressure_at_midpoint(c) - 1.0) > AS_FILLED:
        c.wanted_pressure = pressure
        c.renewal_due = 1.0


@inline
def pressure_at_midpoint(c):
    """Pressure a bounce chamber would have with its midpoint's temperature there [Pa]."""
    return c.mass * c.gas_constant * c.T_closing / c.V_closing


@compiled
def take_sample(E, y, sampling):
    """Let the parts of the controller that act within the stroke set the force."""
    memory, instant, wanted = sampling.memory, sampling.instant, sampling.wanted
    shown = instant[0]
    here = E.x_dead_centre if isfinite(E.x_dead_centre) else -0.5 * E.direction * E.stroke
    before = here + E.direction * E.stroke
    shown.t, shown.x, shown.sample_time, shown.motoring = E.t, y[X], E.sample_time, E.motoring
    shown.x_left, shown.x_right = min(here, before), max(here, before)
    shown.frequency = 0.5 / E.stroke_duration if E.stroke_duration > 0.0 else 0.0
    shown.maximum_stroke = E.maximum_stroke
    wanted[0].force = nan  # which stays where they fail
    for n in range(SAMPLED_PARTS * SAMPLE_MEMORY):
        memory[n] = E.sample_memory[n]
    call_at(
        sampling.address,
        sampling.numbers.ctypes.data,
        memory.ctypes.data,
        instant.ctypes.data,
        wanted.ctypes.data,
    )
    for n in range(SAMPLED_PARTS * SAMPLE_MEMORY):
        E.sample_memory[n] = memory[n]
    E.t_sample += E.sample_time
    E.sets_force, E.force = wanted[0].sets_force, wanted[0].force
    E.is_driven = max(E.motoring, E.sets_force)
    if not isfinite(E.force + E.sets_force):
        E.fault = nan
