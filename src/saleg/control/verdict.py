"""What became of a run under a controller."""

from __future__ import annotations

from saleg.controller import Controller
from saleg.kernel import layout
from saleg.laws.arguments import Commands
from saleg.simulate import Course
from saleg.status import Status
from saleg.verdict import PER_CYCLE, STEADY, change_per_cycle, verdict

#: Which part of a controller gives each command.
PARTS = {
    "motoring": "state_logic",
    "load_weight": "load_control",
    "amplitude": "motor_control",
    "frequency": "motor_control",
    "sweep": "motor_control",
    "sets_phase": "motor_control",
    "phase": "motor_control",
    "equivalence_ratio": "fuel_control",
    "intake_temperature": "intake_control",
}


def fault_message(number: int, commands: Commands | None, controller: Controller | None) -> str:
    """Text that names a command out of its limits."""
    name = Commands._fields[number - 1]
    value = "" if commands is None else f" = {commands[number - 1]!r}"
    law = "" if controller is None else type(controller.actuators).__name__
    return f"{name}{value} is not finite or beyond the limits of {law or 'the actuators'}"


def verdict_of(course: Course, code: int, fault: str = "") -> tuple[Status, str]:
    """Status and message of a run under a controller.

    An engine that is motored, or whose fuel is cut, when its time is up has done as it was told.
    """
    E, t = course.state.engine[0], course.state.time
    if fault:
        return Status.CONTROLLER_FAULT, f"at t = {t:.6g} s {fault}"
    if code == layout.CONTROLLER_FAULT:
        number = int(E["fault"])
        part = PARTS[Commands._fields[number - 1]]
        law = type(getattr(course.controller, part)).__name__
        why = fault_message(number, None, course.controller)
        return Status.CONTROLLER_FAULT, f"at t = {t:.6g} s {part} {law}: {why}"
    strokes = course.strokes
    if code != layout.END_OF_TIME or E["direction"] == 0.0:
        return verdict(course.engine, code, course.state, strokes)
    if E["motoring"] == 0.0 and E["equivalence_ratio"] > 0.0:
        return verdict(course.engine, code, course.state, strokes)
    what = "motored" if E["motoring"] > 0.0 else "without fuel"
    length = float(E["stroke"])
    where = f"{what} at t = {t:.6g} s with a stroke of {1e3 * length:.4g} mm"
    change = change_per_cycle(course.engine, strokes)
    if change is None:
        return Status.COMPLETED, f"{where}; too few cycles to call it steady"
    steady = change < STEADY
    status = Status.STEADY if steady else Status.COMPLETED
    return status, f"{where}: {PER_CYCLE.format(change)}"
