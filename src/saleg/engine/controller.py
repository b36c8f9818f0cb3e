"""A controller: laws that command the engine at dead centres and within the stroke."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from saleg.errors import InvalidController
from saleg.laws.base import Law
from saleg.laws.contract import check_laws
from saleg.laws.control.actuators import Actuators
from saleg.laws.control.base import (
    CONTROL_SLOTS,
    SAMPLED_SLOTS,
    ActuatorLaw,
    ConverterLaw,
    ForceControl,
    FuelControl,
    IntakeControl,
    LoadControl,
    MotorControl,
    PositionSensorLaw,
    StateLogic,
)
from saleg.laws.control.converter import Converter
from saleg.laws.control.fuel import RatedFuel
from saleg.laws.control.intake import RatedIntake
from saleg.laws.control.load import StrokeRegulator
from saleg.laws.control.motor import ResonanceSearch
from saleg.laws.control.position_sensor import PositionSensor
from saleg.laws.control.state_logic import CompressionThreshold
from saleg.quantities import Problem, as_float, problems

#: All slots of a controller.
SLOTS: dict[str, type[Law]] = {
    **CONTROL_SLOTS,
    **SAMPLED_SLOTS,
    ActuatorLaw.slot: ActuatorLaw,
    ConverterLaw.slot: ConverterLaw,
}


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
    force_control : ForceControl, optional
        Force of the alternator at samples within the stroke; nobody acts there unless given.
    position_sensor : PositionSensorLaw
        What it is shown, and how often.
    converter : ConverterLaw
        What comes of a commanded force, and what the DC bus has of it.

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
    force_control: ForceControl | None = None
    position_sensor: PositionSensorLaw = field(default_factory=PositionSensor)
    converter: ConverterLaw = field(default_factory=Converter)

    @property
    def laws(self) -> dict[str, Law]:
        """Laws of the controller that act at dead centres, by slot."""
        return {slot: getattr(self, slot) for slot in CONTROL_SLOTS}

    @property
    def sampled_laws(self) -> dict[str, Law]:
        """Laws of the controller that act within the stroke, by slot; none without a force."""
        if self.force_control is None:
            return {}
        return {slot: getattr(self, slot) for slot in SAMPLED_SLOTS}

    @property
    def sample_time(self) -> float:
        """Time between two samples within the stroke [s]; infinite if nobody acts there."""
        if self.force_control is None:
            return math.inf
        return float(self.position_sensor.sample_time)  # type: ignore[attr-defined]

    def problems(self) -> list[Problem]:
        """Every wrong field; empty when the controller is valid."""
        found = []
        for slot, kind in SLOTS.items():
            part = getattr(self, slot)
            if isinstance(part, kind):
                found += problems(part, slot)
            elif not (slot == ForceControl.slot and part is None):
                found.append(Problem(slot, part, "-", f"must be a {kind.__name__}"))
        if self.force_control is not None:
            interval = as_float(getattr(self.position_sensor, "sample_time", None))
            if interval is None or not 0.0 < interval < math.inf:
                found.append(Problem("position_sensor.sample_time", interval, "s", "must be > 0"))
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
        check_laws(
            [*self.laws.values(), *self.sampled_laws.values(), self.actuators, self.converter]
        )


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
