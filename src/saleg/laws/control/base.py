"""Parts of a controller as laws: compiled by themselves, asked by the kernel at dead centres.

A controller has five parts that act at dead centres and stands behind actuators. Each part may keep
:data:`MEMORY` numbers in `memory` from one dead centre to the next; they begin at zero. Within the
stroke a part of its own, shown what a sensor measures, may set the force of the alternator through
its converter; both keep :data:`SAMPLE_MEMORY` numbers from sample to sample.
"""

from __future__ import annotations

from typing import Any, ClassVar

from saleg.laws.arguments import Commands, Drive, ForceCommand, Instant, Signals
from saleg.laws.base import Law

#: Numbers a part may keep.
MEMORY = 4
#: Numbers a part that acts at samples may keep.
SAMPLE_MEMORY = 20


class StateLogic(Law):
    """Whether the alternator is a motor or draws power."""

    slot = "state_logic"
    compiled = ("is_motor",)
    earlier_names: ClassVar[dict[str, str]] = {"motors": "is_motor"}

    def is_motor(self, memory: Any, signals: Signals) -> float:
        """1 for a motor, 0 for a generator, until the next dead centre."""
        raise NotImplementedError


class MotorControl(Law):
    """How the alternator pushes as a motor."""

    slot = "motor_control"
    compiled = ("drive",)

    def drive(self, memory: Any, signals: Signals) -> Drive:
        """Force until the next dead centre; asked, and without effect, where it does not motor."""
        raise NotImplementedError


class LoadControl(Law):
    """How much the alternator draws."""

    slot = "load_control"
    compiled = ("weight",)

    def weight(self, memory: Any, signals: Signals) -> float:
        """Load weight W [-] until the next dead centre."""
        raise NotImplementedError


class FuelControl(Law):
    """How much fuel the charges get."""

    slot = "fuel_control"
    compiled = ("equivalence_ratio",)

    def equivalence_ratio(self, memory: Any, signals: Signals) -> float:
        """Equivalence ratio [-] of the charge composed in the coming stroke; 0 for no fuel."""
        raise NotImplementedError


class IntakeControl(Law):
    """How warm the intake is."""

    slot = "intake_control"
    compiled = ("temperature",)

    def temperature(self, memory: Any, signals: Signals) -> float:
        """Intake temperature [K] until the next dead centre."""
        raise NotImplementedError


class ActuatorLaw(Law):
    """Limits, lags and losses of the actuators between a controller and the engine."""

    slot = "actuators"
    compiled = ("refused", "follow", "motor_power")

    def refused(self, wanted: Commands) -> float:
        """Number of the first command out of its limits or not finite, from 1 on; 0 if none is."""
        raise NotImplementedError

    def follow(self, actual: Commands, wanted: Commands, elapsed: float) -> Commands:
        """Where the actuators stand `elapsed` seconds after they stood at `actual`."""
        raise NotImplementedError

    def motor_power(self, mechanical: float) -> float:
        """Electrical power delivered [W] for a mechanical power taken from the translator [W]."""
        raise NotImplementedError


class ConverterLaw(Law):
    """The converter between a commanded force of the alternator and its DC bus."""

    slot = "converter"
    compiled = ("force", "power")

    def force(self, wanted: float, v: float) -> float:
        """Force on the translator [N] that comes of the one wanted, at a velocity [m/s]."""
        raise NotImplementedError

    def power(self, force: float, v: float) -> float:
        """Power delivered to the DC bus [W]; negative where it is drawn from it."""
        raise NotImplementedError


class PositionSensorLaw(Law):
    """The position a controller is shown at its samples.

    A sensor has a field `sample_time` [s].
    """

    slot = "position_sensor"
    compiled = ("measured",)

    def measured(self, memory: Any, x: float) -> float:
        """Position measured [m]."""
        raise NotImplementedError


class ForceControl(Law):
    """Force of the alternator at samples within the stroke."""

    slot = "force_control"
    compiled = ("push",)

    def push(self, memory: Any, instant: Instant) -> ForceCommand:
        """Force until the next sample."""
        raise NotImplementedError


#: Slots of a controller, by name, in the order they are asked.
CONTROL_SLOTS: dict[str, type[Law]] = {
    law.slot: law for law in (StateLogic, MotorControl, LoadControl, FuelControl, IntakeControl)
}
#: Slots of a controller that act at samples, in the order they are asked.
SAMPLED_SLOTS: dict[str, type[Law]] = {law.slot: law for law in (PositionSensorLaw, ForceControl)}
