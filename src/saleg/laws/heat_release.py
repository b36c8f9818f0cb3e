"""Course of the heat release."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import HeatRelease
from saleg.quantities import quantity


@dataclass(frozen=True)
class Wiebe(HeatRelease):
    """Single Wiebe function of time (Eq. 52-53): ``chi = 1 - exp(-a u^(b+1))``.

    The release ends at u = 1; the share ``exp(-a)`` not released by then stays unburned.

    Parameters
    ----------
    combustion_duration : float
        Combustion duration C_d [s].
    a : float
        Efficiency parameter [-].
    b : float
        Shape parameter [-].

    Examples
    --------
    >>> round(Wiebe().burnt_fraction(1.0), 6)
    0.993262
    """

    combustion_duration: float = quantity("s", default=1.25e-3, low=0, open_low=True)
    a: float = quantity("-", default=5.0, low=0, open_low=True)
    b: float = quantity("-", default=2.0, low=0)

    def duration(self, gas: Gas, charge: Charge) -> float:
        """Combustion duration [s]."""
        return self.combustion_duration

    def burn_rate(self, u: float) -> float:
        """Rate of the burnt fraction [-], Eq. 53."""
        return self.a * (self.b + 1.0) * u**self.b * math.exp(-self.a * u ** (self.b + 1.0))

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-], Eq. 52."""
        return -math.expm1(-self.a * u ** (self.b + 1.0))
