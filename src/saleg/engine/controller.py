"""A controller: five laws that command the engine at dead centres, behind actuators."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from saleg.errors import InvalidController
from saleg.laws.base import Law
from saleg.laws.contract import check_laws
from saleg.laws.control.actuators import Actuators
from saleg.laws.control.base import (
    CONTROL_SLOTS,
    ActuatorLaw,
    FuelControl,
    IntakeControl,
    LoadControl,
    MotorControl,
    StateLogic,
)
from saleg.laws.control.fuel import RatedFuel
from saleg.laws.control.intake import RatedIntake
from saleg.laws.control.load import StrokeRegulator
from saleg.laws.control.motor import ResonanceSearch
from saleg.laws.control.state_logic import CompressionThreshold
from saleg.quantities import Problem, problems


@dataclass(frozen=True, kw_only=True)
class Controller:
    """A controller made of laws; compiled, or run as Python.

    The defaults are those of the dissertation's start-up (5.1).

    Parameters
    ----------
    state_logic : StateLogic
        Motor or generator.
    motor_control : MotorControl
        Force of the motor.
    load_control : LoadControl
        Load of the generator.
    fuel_control : FuelControl
        Equivalence ratio.
    intake_control : IntakeControl
        Intake temperature.
    actuators : ActuatorLaw
        Limits and lags.

    Examples
    --------
    >>> Controller().state_logic.threshold
    12.0
    """

    state_logic: StateLogic = field(default_factory=CompressionThreshold)
    motor_control: MotorControl = field(default_factory=ResonanceSearch)
    load_control: LoadControl = field(default_factory=StrokeRegulator)
    fuel_control: FuelControl = field(default_factory=RatedFuel)
    intake_control: IntakeControl = field(default_factory=RatedIntake)
    actuators: ActuatorLaw = field(default_factory=Actuators)

    @property
    def laws(self) -> dict[str, Law]:
        """Laws of the controller by slot; its actuators are not among them."""
        return {slot: getattr(self, slot) for slot in CONTROL_SLOTS}

    def problems(self) -> list[Problem]:
        """Every wrong field; empty when the controller is valid."""
        found = []
        for slot, kind in {**CONTROL_SLOTS, ActuatorLaw.slot: ActuatorLaw}.items():
            part = getattr(self, slot)
            if isinstance(part, kind):
                found += problems(part, slot)
            else:
                found.append(Problem(slot, part, "-", f"must be a {kind.__name__}"))
        return found

    def validate(self) -> None:
        """Raise one error naming every wrong field.

        Raises
        ------
        InvalidController
            Its ``problems`` give field, value, unit and allowed range.
        """
        found = self.problems()
        if found:
            raise InvalidController(found)

    def check_laws(self) -> None:
        """Refuse laws that cannot be compiled, before any of them is called.

        Raises
        ------
        LawError
            Naming law and method.
        """
        check_laws([*self.laws.values(), self.actuators])


def check_controller(controller: Any) -> None:
    """Raise one error unless there is a valid controller.

    Raises
    ------
    InvalidController
    """
    if not isinstance(controller, Controller):
        wrong = Problem("controller", controller, "-", "must be a saleg.Controller")
        raise InvalidController([wrong])
    controller.validate()
