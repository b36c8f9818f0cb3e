"""Control (Chapter 5): engines under controllers, and the experiments of the dissertation."""

from saleg.control.plant import Plant
from saleg.control.running import (
    fired_at,
    generator,
    motor,
    motor_returns,
    simulate,
    simulate_many,
)
from saleg.control.sensors import Sensors

__all__ = [
    "Plant",
    "Sensors",
    "fired_at",
    "generator",
    "motor",
    "motor_returns",
    "simulate",
    "simulate_many",
]
