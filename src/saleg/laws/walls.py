"""Walls of a chamber: at a constant temperature, or with a thermal mass of their own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.base import Wall
from saleg.quantities import quantity


@dataclass(frozen=True)
class FixedWall(Wall):
    """A wall that stays at the chamber's `wall_temperature`."""


@dataclass(frozen=True)
class LumpedWall(Wall):
    """A wall of one temperature between the gas and a coolant.

    ``C dT/dt = Q - G (T - T_coolant)`` with Q the heat from the gas; it begins at the chamber's
    `wall_temperature`.

    Parameters
    ----------
    heat_capacity : float
        Heat capacity C [J/K].
    conductance : float
        Conductance to the coolant G [W/K].
    coolant_temperature : float
        Temperature of the coolant [K].

    Examples
    --------
    >>> LumpedWall(heat_capacity=100.0, conductance=2.0).temperature_rate(450.0, 150.0)
    -0.3
    """

    states: ClassVar[tuple[str, ...]] = ("wall_temperature",)

    heat_capacity: float = quantity("J/K", default=200.0, low=0, open_low=True, usual=(0.1, 1e6))
    conductance: float = quantity("W/K", default=10.0, low=0, usual=(0.01, 1e5))
    coolant_temperature: float = quantity(
        "K", default=360.0, low=100.0, high=1500.0, usual=(200.0, 700.0)
    )

    def temperature_rate(self, temperature: float, heat: float) -> float:
        """Rate of the temperature [K/s]."""
        lost = self.conductance * (temperature - self.coolant_temperature)
        return (heat - lost) / self.heat_capacity
