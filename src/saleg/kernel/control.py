"""What a controller sees and sets at a dead centre."""

from math import pi

from saleg.kernel.jit import compiled, inline
from saleg.kernel.rhs import motor_angle
from saleg.kernel.slots import (
    actuators_follow,
    actuators_refused,
    fuel_control_equivalence_ratio,
    intake_control_temperature,
    load_control_weight,
    motor_control_drive,
    state_logic_motors,
)
from saleg.laws.arguments import Commands, Signals


@inline
def signals_of(E):
    """What is measured at a dead centre."""
    half = 0.5 * E.maximum_stroke
    return Signals(
        E.t,
        E.x_dead_centre,
        E.direction,
        E.stroke,
        (half + 0.5 * E.stroke) / (half - 0.5 * E.stroke),
        0.5 / E.stroke_duration if E.stroke_duration > 0.0 else 0.0,
        E.power,
        E.regulated_weight,
        E.motoring,
        E.motoring,
        E.maximum_stroke,
        E.rated_equivalence_ratio,
        E.rated_intake_temperature,
    )


@inline
def with_motoring(s, motoring):
    """The same signals with what the state logic has decided."""
    return Signals(
        s.t,
        s.x,
        s.direction,
        s.stroke,
        s.compression_ratio,
        s.frequency,
        s.power,
        s.regulated_weight,
        motoring,
        s.was_motoring,
        s.maximum_stroke,
        s.rated_equivalence_ratio,
        s.rated_intake_temperature,
    )


@compiled
def decide(P, held, measured):
    """Commands of the parts of the controller, each with the numbers it holds."""
    motoring = state_logic_motors(P, held[0], measured)
    signals = with_motoring(measured, motoring)
    drive = motor_control_drive(P, held[1], signals)
    return Commands(
        motoring,
        load_control_weight(P, held[2], signals),
        drive.amplitude,
        drive.frequency,
        drive.sweep,
        drive.sets_phase,
        drive.phase,
        fuel_control_equivalence_ratio(P, held[3], signals),
        intake_control_temperature(P, held[4], signals),
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
        E.motor_phase,
        E.equivalence_ratio,
        E.intake_temperature,
    )


@compiled
def obey(P, E, C, wanted, elapsed):
    """Set what is commanded, as far as the actuators follow; refuse what they cannot do."""
    E.fault = actuators_refused(P, wanted)
    if E.fault > 0.0:
        return
    angle = motor_angle(E, E.t)
    now = actuators_follow(P, standing(E), wanted, elapsed)
    E.t_command = E.t
    E.motoring = now.motoring
    E.load_weight = now.load_weight
    E.motor_amplitude = now.amplitude
    E.motor_frequency = now.frequency
    E.motor_sweep = now.sweep
    E.motor_phase = now.phase if now.sets_phase > 0.0 else angle % (2.0 * pi)
    E.equivalence_ratio = now.equivalence_ratio
    E.intake_temperature = now.intake_temperature
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
