"""What stands before the intake ports: the intake itself, or a crankcase."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.base import Supply
from saleg.laws.leaks import AREA
from saleg.quantities import quantity


@dataclass(frozen=True)
class Plenum(Supply):
    """The intake, at its own constant state: a large plenum, or a charger."""


@dataclass(frozen=True)
class Crankcase(Supply):
    """Space under the piston that draws through a reed valve and feeds the intake ports.

    Its gas is compressed as the piston moves outward, and pushes it back. It loses no heat. The
    reed opens in proportion to the pressure that lifts it, up to its full area.

    Parameters
    ----------
    volume_at_midpoint : float
        Volume with the translator at its midpoint [m^3].
    area : float
        Area of the piston on this side [m^2].
    reed : float
        Effective area of the open valve [m^2].
    lift_pressure : float
        Pressure difference at which it is fully open [Pa].
    """

    states: ClassVar[tuple[str, ...]] = ("contents", "crankcase")

    volume_at_midpoint: float = quantity(
        "m^3", default=6e-4, low=0, open_low=True, usual=(1e-8, 1.0)
    )
    area: float = quantity("m^2", default=3e-3, low=0, usual=(1e-6, 1.0))
    reed: float = quantity("m^2", default=3e-4, low=0, usual=AREA)
    lift_pressure: float = quantity("Pa", default=2e3, low=0, open_low=True, usual=(10.0, 1e6))

    def volume(self, displacement: float) -> float:
        """Volume of the crankcase [m^3] with the piston some way from its midpoint, outward [m]."""
        return self.volume_at_midpoint - self.area * displacement

    def piston_area(self) -> float:
        """Area of the piston on the crankcase's side [m^2]."""
        return self.area

    def inlet_area(self, rise: float) -> float:
        """Effective area of the inlet [m^2], given how far it is below the intake [Pa]."""
        return self.reed * min(max(rise / self.lift_pressure, 0.0), 1.0)
