"""Outcome of a run under a controller: status and message."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.engine.controller import Controller
from saleg.errors import shown
from saleg.kernel import layout
from saleg.kernel.decide import with_motoring
from saleg.laws.arguments import Commands, Signals
from saleg.laws.control.base import CONTROL_SLOTS, StateLogic
from saleg.quantities import is_number
from saleg.simulation.course import Course
from saleg.simulation.outcome import outcome_of, settled
from saleg.simulation.signals import measured
from saleg.status import Status

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
    "sets_force": "force_control",
    "force": "force_control",
}


#: Commands no actuator refuses.
USUAL = Commands(*(0.0 for _ in Commands._fields))._replace(intake_temperature=300.0)


def refused_commands(commands: Commands, controller: Controller) -> list[str]:
    """Names of all commands that are no numbers or that the actuators refuse.

    Actuators name one of them at a time: it gives way to a usual one until none is refused.
    """
    wrong = [name for name, value in commands._asdict().items() if not is_plain(value)]
    rest = commands._replace(**{name: getattr(USUAL, name) for name in wrong})
    while True:
        fault = float(controller.actuators.refused(Commands(*map(float, rest))))
        name = Commands._fields[int(fault) - 1] if _is_of_command(fault) else ""
        if not name or name in wrong:
            return [name for name in Commands._fields if name in wrong]
        wrong.append(name)
        rest = rest._replace(**{name: getattr(USUAL, name)})


def fault_message(fault: float, commands: Commands, controller: Controller) -> str:
    """Text that names all commands out of their limits, or actuators that do not work.

    `fault` is what the actuators made of the commands: the number of one of them.
    """
    law = type(controller.actuators).__name__
    if not _is_of_command(fault):
        return f"the actuators {law} give what is not finite or no number of a command ({fault})"
    name = Commands._fields[int(fault) - 1]
    return refusal(commands, controller) or f"{name}: refused by the actuators {law}"


def refusal(commands: Commands, controller: Controller) -> str:
    """Text that names all commands that are no numbers or that actuators refuse; empty if none."""
    wrong = refused_commands(commands, controller)
    named = ", ".join(f"{name} = {shown(getattr(commands, name))}" for name in wrong)
    wanted = "a finite number" if len(wrong) == 1 else "finite numbers"
    law = type(controller.actuators).__name__
    return f"{named}: must be {wanted} within the limits of {law}" if wrong else ""


def is_plain(value: Any) -> bool:
    """Whether a command can be passed on: a number, or a flag."""
    return is_number(value) or isinstance(value, (bool, np.bool_))


def _is_of_command(fault: float) -> bool:
    """Whether a fault is the number of a command."""
    return math.isfinite(fault) and 1 <= fault <= len(Commands._fields)


def blamed(controller: Controller, memory: np.ndarray, signals: Signals, fault: float = 0.0) -> str:
    """Slot and law of the part that fails on these signals, with its error if it raises one.

    Parameters
    ----------
    controller : Controller
    memory : ndarray, shape (CONTROL_PARTS, MEMORY)
        What the parts remembered before.
    signals : Signals
    fault : float
        Number of the command that is wrong, if no part raises an error.
    """
    memory = memory.copy()
    for slot, base in CONTROL_SLOTS.items():
        part: Any = getattr(controller, slot)
        (method,) = base.compiled
        try:
            value = getattr(part, method)(memory[list(CONTROL_SLOTS).index(slot)], signals)
        except Exception as error:  # whatever the part does, the run says so
            return f"{slot} {type(part).__name__} raised {type(error).__name__}: {error}"
        if slot == StateLogic.slot:
            signals = with_motoring(signals, value)
    if not (math.isfinite(fault) and 1 <= fault <= len(PARTS)):
        return "actuators"
    slot = PARTS[Commands._fields[int(fault) - 1]]
    return f"{slot} {type(getattr(controller, slot)).__name__}"


def sampled_fault(controller: Controller) -> str:
    """Text that names the part that gave no force at a sample."""
    return f"force_control {type(controller.force_control).__name__} gives what is not finite"


def _compiled_fault(course: Course) -> str:
    """Fault of a controller in the kernel, which is asked once more, as Python."""
    assert course.controller is not None
    E = course.state.engine[0]
    if not math.isfinite(E["force"] + E["sets_force"]):
        return sampled_fault(course.controller)
    memory = E["memory"].reshape(layout.CONTROL_PARTS, layout.MEMORY)
    fault, commands = float(E["fault"]), course.commanded
    who = blamed(course.controller, memory, measured(course.state), fault)
    return who if "raised" in who else f"{who}: {fault_message(fault, commands, course.controller)}"


def controlled_outcome(course: Course, code: int, fault: str = "") -> tuple[Status, str]:
    """Status and message of a run under a controller.

    An engine that is motored, or whose fuel is cut, when its time is up has done as it was told.
    """
    E, t = course.state.engine[0], course.state.time
    if fault:
        return Status.CONTROLLER_FAULT, f"at t = {t:.6g} s {fault}"
    if code == layout.CONTROLLER_FAULT:
        return Status.CONTROLLER_FAULT, f"at t = {t:.6g} s {_compiled_fault(course)}"
    strokes = course.strokes
    if code != layout.END_OF_TIME or E["direction"] == 0.0:
        return outcome_of(course.engine, code, course.state, strokes)
    if E["motoring"] == 0.0 and E["equivalence_ratio"] > 0.0:
        return outcome_of(course.engine, code, course.state, strokes)
    what = "motored" if E["motoring"] > 0.0 else "without fuel"
    length = float(E["stroke"])
    where = f"{what} at t = {t:.6g} s with a stroke of {1e3 * length:.4g} mm"
    steady, how = settled(course.engine, strokes)
    return Status.STEADY if steady else Status.COMPLETED, f"{where}: {how}"
