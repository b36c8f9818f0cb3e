"""What a controller is shown and what it sets at a dead centre.

A controller is compiled by itself (:mod:`saleg.compiler.controllers`), so that another one needs
no other kernel; `control` is the address of its function, its numbers, and scratch arrays for what
it holds, is shown and commands.
"""

from math import inf, isfinite, nan, pi

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import CONTROL_PARTS, HELD
from saleg.kernel.rhs import motor_angle
from saleg.kernel.slots import actuators_follow, actuators_refused, call_at
from saleg.laws.arguments import Commands


@compiled
def write_signals(E, signals):
    """What is measured at a dead centre, in the order of :class:`saleg.laws.Signals`."""
    half = 0.5 * E.maximum_stroke
    signals[0] = E.t
    signals[1] = E.x_dead_centre
    signals[2] = E.direction
    signals[3] = E.stroke
    signals[4] = (half + 0.5 * E.stroke) / (half - 0.5 * E.stroke)
    signals[5] = 0.5 / E.stroke_duration if E.stroke_duration > 0.0 else 0.0
    signals[6] = E.power
    signals[7] = E.regulated_weight
    signals[8] = E.motoring
    signals[9] = E.motoring
    signals[10] = E.maximum_stroke
    signals[11] = E.rated_equivalence_ratio
    signals[12] = E.rated_intake_temperature


@compiled
def ask(E, control):
    """Commands of the controller; what it holds travels with the engine's record."""
    address, numbers, held, signals, commands = control
    write_signals(E, signals)
    for n in range(CONTROL_PARTS * HELD):
        held[n] = E.held[n]
    for n in range(commands.shape[0]):
        commands[n] = nan  # stays where the controller fails
    call_at(
        address, numbers.ctypes.data, held.ctypes.data, signals.ctypes.data, commands.ctypes.data
    )
    if isfinite(commands[0]):
        for n in range(CONTROL_PARTS * HELD):
            E.held[n] = held[n]
    return Commands(
        commands[0],
        commands[1],
        commands[2],
        commands[3],
        commands[4],
        commands[5],
        commands[6],
        commands[7],
        commands[8],
    )


@inline
def standing(E):
    """Where the actuators stand."""
    return Commands(
        E.motoring,
        E.load_weight,
        E.motor_amplitude,
        E.motor_frequency,
        E.motor_sweep,
        0.0,
        0.0,
        E.equivalence_ratio,
        E.intake_temperature,
    )


@inline
def asked(E):
    """What they were asked for last."""
    return Commands(
        E.motoring,
        E.asked_load_weight,
        E.asked_amplitude,
        E.motor_frequency,
        E.motor_sweep,
        0.0,
        0.0,
        E.asked_equivalence_ratio,
        E.asked_intake_temperature,
    )


@compiled
def obey(P, E, C, wanted, elapsed):
    """Set what is commanded, as far as the actuators follow; refuse what they cannot do.

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
    E.asked_load_weight = wanted.load_weight
    E.asked_amplitude = wanted.amplitude
    E.asked_equivalence_ratio = wanted.equivalence_ratio
    E.asked_intake_temperature = wanted.intake_temperature
    supply(E, C)


@compiled
def supply(E, C):
    """Hand fuel and intake temperature to the chambers that burn fuel.

    They keep what they differ by when the engine is rated.
    """
    for side in range(2):
        c = C[side]
        if c.lower_heating_value <= 0.0:
            continue
        c.intake_temperature = E.intake_temperature + c.beside_rated_temperature
        c.equivalence_ratio_wanted = E.equivalence_ratio * c.over_rated_fuel
