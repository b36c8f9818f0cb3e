"""Gaps and valves through which a chamber loses or draws gas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.arguments import Gas
from saleg.laws.base import Leak
from saleg.quantities import quantity

#: Range of areas of gaps and small valves that have been built [m^2].
AREA = 1e-10, 1e-2
PRESSURE = 1e3, 2e7
TEMPERATURE = 200.0, 1500.0


@dataclass(frozen=True)
class NoLeak(Leak):
    """A tight chamber."""

    def area(self, gas: Gas) -> float:
        """Effective area [m^2]: none."""
        return 0.0

    def beyond(self) -> tuple[float, float]:
        """Pressure [Pa] and temperature [K] beyond; of no account."""
        return 1e5, 300.0


@dataclass(frozen=True)
class RingLeak(Leak):
    """Gap past the piston rings, both ways.

    Compressible flow through an orifice (:mod:`saleg.kernel.flow`).

    Parameters
    ----------
    gap : float
        Effective area of the gap [m^2].
    pressure : float
        Pressure beyond the rings [Pa].
    temperature : float
        Temperature there [K].
    """

    states: ClassVar[tuple[str, ...]] = ("contents",)

    gap: float = quantity("m^2", default=1e-7, low=0, usual=AREA)
    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0, usual=TEMPERATURE)

    def area(self, gas: Gas) -> float:
        """Effective area [m^2]."""
        return self.gap

    def beyond(self) -> tuple[float, float]:
        """Pressure [Pa] and temperature [K] beyond the rings."""
        return self.pressure, self.temperature


@dataclass(frozen=True)
class MakeUpValve(Leak):
    """Check valve that lets gas in from a supply, beside a gap past the rings to that supply.

    It opens in proportion to the pressure that lifts it, up to its full area.

    Parameters
    ----------
    valve : float
        Effective area of the open valve [m^2].
    lift_pressure : float
        Pressure difference at which it is fully open [Pa].
    gap : float
        Effective area past the rings, both ways [m^2].
    pressure : float
        Pressure of the supply [Pa].
    temperature : float
        Temperature of the supply [K].
    """

    states: ClassVar[tuple[str, ...]] = ("contents",)

    valve: float = quantity("m^2", default=1e-5, low=0, usual=AREA)
    lift_pressure: float = quantity("Pa", default=5e3, low=0, open_low=True, usual=(10.0, 1e6))
    gap: float = quantity("m^2", default=0.0, low=0, usual=AREA)
    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0, usual=TEMPERATURE)

    def area(self, gas: Gas) -> float:
        """Effective area [m^2]."""
        lift = (self.pressure - gas.p) / self.lift_pressure
        return self.gap + self.valve * min(max(lift, 0.0), 1.0)

    def beyond(self) -> tuple[float, float]:
        """Pressure [Pa] and temperature [K] of the supply."""
        return self.pressure, self.temperature
