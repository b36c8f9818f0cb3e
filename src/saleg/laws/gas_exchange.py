"""Scavenging of a ported two-stroke cylinder."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.base import FlowExchange, GasExchange
from saleg.laws.leaks import PRESSURE
from saleg.laws.usual import LENGTH
from saleg.quantities import quantity


@dataclass(frozen=True)
class InstantExchange(GasExchange):
    """Instantaneous gas exchange with a retained share of what was burnt (3.4, Eq. 57).

    When the ports open, pressure and temperature become those of the intake. When they close, the
    share `egr` of burnt gas, fuel and air found at opening is still there, and fresh fuel and air
    are metered so that all fuel and air in the charge stand at the equivalence ratio wanted. If
    more fuel was retained than that asks for, none is added.

    Parameters
    ----------
    egr : float
        Share of each constituent retained, by mass [-].

    Examples
    --------
    >>> fuel, air, burnt, fresh = InstantExchange(egr=0.0).charge(1e-3, 0, 0, 1e-3, 1.0, 17.5)
    >>> round(fuel * 18.5 / 1e-3, 12)
    1.0
    """

    egr: float = quantity("-", default=0.0, low=0, high=1, open_high=True)

    def charge(
        self,
        mass: float,
        fuel: float,
        air: float,
        burnt: float,
        equivalence_ratio: float,
        air_fuel_ratio: float,
    ) -> tuple[float, float, float, float]:
        """Fuel, air, burnt gas and fresh fuel [kg] at port closing."""
        kept_burnt = min(self.egr * burnt, mass)
        kept_fuel = min(self.egr * fuel, mass - kept_burnt)
        share = equivalence_ratio / (equivalence_ratio + air_fuel_ratio)
        fuel = max(kept_fuel, (mass - kept_burnt) * share)
        return fuel, mass - kept_burnt - fuel, kept_burnt, fuel - kept_fuel


@dataclass(frozen=True)
class PortFlow(FlowExchange):
    """Flow through intake and exhaust ports that the piston uncovers.

    Each port is a rectangular window over part of the circumference. The exhaust begins at the
    cylinder's `port_closing`, the intake some way beyond it. Flow is compressible, through an
    orifice (:mod:`saleg.kernel.flow`); what comes in is at the state of the intake, or of the
    crankcase before it, and mixes at once with the gas in the cylinder, which has one temperature.

    Of what leaves, ``x^(1/(1-d))`` is fresh gas, with x its share in the cylinder: perfect mixing
    for d = 0, perfect displacement as d tends to 1.

    Parameters
    ----------
    exhaust_width, intake_width : float
        Widths of the windows along the circumference [m].
    exhaust_height, intake_height : float
        Their heights along the stroke [m].
    intake_delay : float
        Distance of the intake's edge beyond that of the exhaust [m].
    exhaust_coefficient, intake_coefficient : float
        Discharge coefficients [-].
    exhaust_pressure, exhaust_temperature : float
        State beyond the exhaust [Pa, K]. Gas that flows back from there counts as burnt.
    displacement : float
        Displacement d [-].

    Examples
    --------
    >>> ports = PortFlow(exhaust_width=0.05, exhaust_height=0.01, exhaust_coefficient=0.7)
    >>> round(1e6 * ports.areas(0.004)[1], 9)
    140.0
    """

    exhaust_width: float = quantity("m", default=0.05, low=0, usual=LENGTH)
    exhaust_height: float = quantity("m", default=0.02, low=0, open_low=True, usual=LENGTH)
    exhaust_coefficient: float = quantity("-", default=0.7, low=0, high=1)
    exhaust_pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    exhaust_temperature: float = quantity(
        "K", default=600.0, low=100.0, high=3000.0, usual=(200.0, 1500.0)
    )
    intake_width: float = quantity("m", default=0.08, low=0, usual=LENGTH)
    intake_height: float = quantity("m", default=0.015, low=0, open_low=True, usual=LENGTH)
    intake_coefficient: float = quantity("-", default=0.7, low=0, high=1)
    intake_delay: float = quantity("m", default=0.005, low=0, usual=LENGTH)
    displacement: float = quantity("-", default=0.5, low=0, high=1, open_high=True)

    def areas(self, opening: float) -> tuple[float, float]:
        """Effective areas of intake and exhaust [m^2]."""
        intake = min(max(opening - self.intake_delay, 0.0), self.intake_height)
        exhaust = min(max(opening, 0.0), self.exhaust_height)
        return (
            self.intake_coefficient * self.intake_width * intake,
            self.exhaust_coefficient * self.exhaust_width * exhaust,
        )

    def exhaust(self) -> tuple[float, float]:
        """Pressure [Pa] and temperature [K] beyond the exhaust."""
        return self.exhaust_pressure, self.exhaust_temperature

    def fresh_share(self, share: float) -> float:
        """Share of fresh gas in what leaves through the ports, given that in the cylinder [-]."""
        return min(max(share, 0.0), 1.0) ** (1.0 / (1.0 - self.displacement))

    def next_breakpoint(self, opening: float, direction: float) -> float:
        """Next opening at which an area is not smooth [m]."""
        full = self.intake_delay + self.intake_height
        nearest = math.inf
        for place in (self.intake_delay, full, self.exhaust_height):
            way = direction * (place - opening)
            if 0.0 < way < nearest:
                nearest = way
        return opening + direction * nearest
