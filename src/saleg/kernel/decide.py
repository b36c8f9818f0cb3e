"""Commands of a controller made of laws; compiled apart from the engine, or run as Python."""

from saleg.kernel.jit import compiled, inline
from saleg.kernel.slots import (
    fuel_control_equivalence_ratio,
    intake_control_temperature,
    load_control_weight,
    motor_control_drive,
    state_logic_is_motor,
)
from saleg.laws.arguments import Commands, Signals


@inline
def with_motoring(s, motoring):
    """The same signals with what the state logic has decided."""
    return Signals(
        t=s.t,
        x=s.x,
        direction=s.direction,
        stroke=s.stroke,
        compression_ratio=s.compression_ratio,
        frequency=s.frequency,
        power=s.power,
        regulated_weight=s.regulated_weight,
        motoring=motoring,
        was_motoring=s.was_motoring,
        maximum_stroke=s.maximum_stroke,
        rated_equivalence_ratio=s.rated_equivalence_ratio,
        rated_intake_temperature=s.rated_intake_temperature,
        x_left=s.x_left,
        x_right=s.x_right,
        compression_ratio_left=s.compression_ratio_left,
        compression_ratio_right=s.compression_ratio_right,
        position=s.position,
    )


@compiled
def decide(P, memory, measured):
    """Commands of the parts of the controller, each with the numbers it holds."""
    motoring = state_logic_is_motor(P, memory[0], measured)
    signals = with_motoring(measured, motoring)
    drive = motor_control_drive(P, memory[1], signals)
    return Commands(
        motoring=motoring,
        load_weight=load_control_weight(P, memory[2], signals),
        amplitude=drive.amplitude,
        frequency=drive.frequency,
        sweep=drive.sweep,
        sets_phase=drive.sets_phase,
        phase=drive.phase,
        equivalence_ratio=fuel_control_equivalence_ratio(P, memory[3], signals),
        intake_temperature=intake_control_temperature(P, memory[4], signals),
        sets_force=0.0,
        force=0.0,
        spark_advance=0.0,
        spring_pressure=0.0,
    )
