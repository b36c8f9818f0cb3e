"""Commands of a controller made of laws; compiled apart from the engine, or run as Python."""

from saleg.kernel.jit import compiled, inline
from saleg.kernel.slots import (
    fuel_control_equivalence_ratio,
    intake_control_temperature,
    load_control_weight,
    motor_control_drive,
    state_logic_motors,
)
from saleg.laws.arguments import Commands, Signals


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
