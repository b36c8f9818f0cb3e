"""The charge of Chapter 2: a gas at its midpoint pressure, and the heat it releases."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from saleg.fundamental.gas import Gas, Isentropic
from saleg.quantities import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class Charge(Quantities):
    """What burns in either chamber, and the curve it is compressed along.

    Parameters
    ----------
    pressure : float
        Midpoint pressure P_mp* [-] (Eq. 9); 0 leaves the springs alone.
    heat : float
        Heat Q_in* of a stroke [-] (Eq. 27).
    gas : Gas
        Ratio of specific heats and exponents; isentropic at 1.4 unless given.
    """

    pressure: float = quantity("-", low=0)
    heat: float = quantity("-", default=0.0, low=0)
    gas: Gas = field(default_factory=Isentropic)

    def motored_pressure(self, s: Any) -> Any:
        """Pressure of an unburnt charge compressed up to `s` [-] (Eq. 4)."""
        return self.pressure * (1.0 - s) ** -self.gas.compression

    def pressure_rise(self, s: Any) -> Any:
        """Rise in pressure of a charge that burns at `s` [-] (Eq. 21)."""
        return self.heat * (self.gas.gamma - 1.0) / (1.0 - s)
