"""Scavenging of a ported two-stroke cylinder."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.laws.base import GasExchange
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
