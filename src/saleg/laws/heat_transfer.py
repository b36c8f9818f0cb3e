"""Heat transfer from the gas to the wall."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import HeatTransfer
from saleg.quantities import quantity


@dataclass(frozen=True)
class Hohenberg(HeatTransfer):
    """Hohenberg's correlation (Eq. 51): ``h = a V^b p^c T^d (c_m + 1.4)^e``, p in bar.

    The original leading coefficient is 130; the thesis uses 65. Source: G. F. Hohenberg,
    SAE 790825 (1979).

    Parameters
    ----------
    a : float
        Leading coefficient [W/m^2/K in the correlation's units].
    b, c, d, e : float
        Exponents of volume, pressure, temperature and mean piston speed [-].

    Examples
    --------
    >>> from saleg.laws import Gas
    >>> gas = Gas(p=50e5, T=1500.0, V=1e-4, p_motored=50e5, height=0.03, bore=0.064,
    ...           mean_piston_speed=5.0, wall_temperature=550.0, burning=0.0)
    >>> round(Hohenberg(a=130.0).coefficient(gas, None), 2)
    1223.56
    """

    a: float = quantity("-", default=65.0, low=0)
    b: float = quantity("-", default=-0.06)
    c: float = quantity("-", default=0.8)
    d: float = quantity("-", default=-0.4)
    e: float = quantity("-", default=0.8)

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K], Eq. 51."""
        speed = gas.mean_piston_speed + 1.4
        return self.a * gas.V**self.b * (gas.p * 1e-5) ** self.c * gas.T**self.d * speed**self.e


@dataclass(frozen=True)
class NoHeatTransfer(HeatTransfer):
    """Adiabatic walls."""

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]: zero."""
        return 0.0
