"""Self-ignition of the charge."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import Ignition
from saleg.quantities import quantity


@dataclass(frozen=True)
class CFRIgnition(Ignition):
    """Knock integral fitted to a CFR engine in HCCI operation (Eq. 54-55).

    ``integral of k dt / (A phi^-x exp(b p^n / T)) = 1`` with p in kPa inside the exponential.
    The source (Swan, Shahbakhti, Koch, SAE 2006-01-1086) integrates over crank angle; `k` turns
    crank degrees into time. Section 3.6.4 of the thesis lists the parameters under wrong names.

    Parameters
    ----------
    A : float
        Leading coefficient [-].
    b : float
        Temperature coefficient [K].
    n : float
        Exponent of pressure [-].
    x : float
        Exponent of the equivalence ratio [-].
    k : float
        Degrees of a cycle of the CFR engine, a four-stroke [-]; inferred, see the physics notes.
    """

    A: float = quantity("-", default=9.291e-7, low=0, open_low=True)
    b: float = quantity("K", default=16909.0)
    n: float = quantity("-", default=-0.1121)
    x: float = quantity("-", default=-0.688)
    k: float = quantity("-", default=720.0, low=0)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the knock integral [1/s]."""
        chemistry = math.exp(-self.b * (gas.p * 1e-3) ** self.n / gas.T)
        return self.k / self.A * charge.equivalence_ratio**self.x * chemistry
