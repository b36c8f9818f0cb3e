"""Heat transfer from the gas to the walls (Eq. 50)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import HeatTransfer
from saleg.laws.choice import where
from saleg.quantities import quantity

#: Stefan-Boltzmann constant [W/m^2/K^4].
STEFAN_BOLTZMANN = 5.670374419e-8


@dataclass(frozen=True)
class Hohenberg(HeatTransfer):
    """Hohenberg's correlation (Eq. 51): ``h = a V^b p^c T^d (c_m + 1.4)^e``.

    V in m^3, p in bar, T in K, mean piston speed c_m in m/s (SAE 790825, a = 130). The thesis'
    base case takes a = 65.

    Parameters
    ----------
    a : float
        Leading coefficient [W/m^2/K in the correlation's units].
    b, c, d, e : float
        Exponents of volume, pressure, temperature and mean piston speed [-].

    Examples
    --------
    >>> from saleg.laws import Gas
    >>> gas = Gas(p=50e5, T=1500.0, V=1e-4, p_motored=50e5, clearance=0.03, bore=0.064,
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
class Woschni(HeatTransfer):
    """Woschni's correlation (SAE 670931): ``h = 130 B^-0.2 p^0.8 T^-0.53 w^0.8``.

    ``w = c1 c_m + c2 V_d T_1 / (p_1 V_1) (p - p_motored)`` with p in bar outside w; state 1 is
    that at port closing. The second term acts where the pressure is above the motored one, which
    is after the start of combustion.

    Parameters
    ----------
    scale : float
        Factor on the whole correlation, to match a wanted total [-].
    c1 : float
        Factor of the mean piston speed [-]; 2.28 while the ports are closed.
    c2 : float
        Factor of the combustion term [m/s/K].
    """

    needs_motored_pressure = True

    scale: float = quantity("-", default=1.0, low=0)
    c1: float = quantity("-", default=2.28, low=0)
    c2: float = quantity("m/s/K", default=3.24e-3, low=0)

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]."""
        speed = woschni_speed(gas, charge, self.c1, self.c2)
        size = 130.0 * self.scale * gas.bore**-0.2
        return size * (gas.p * 1e-5) ** 0.8 * gas.T**-0.53 * speed**0.8


@dataclass(frozen=True)
class Chang(HeatTransfer):
    """Woschni's correlation modified for HCCI (Chang et al., SAE 2004-01-2996).

    ``h = alpha clearance^-0.2 p^0.8 T^-0.73 w^0.8``, p in kPa, the clearance in m; w as in
    :class:`Woschni` with a sixth of its combustion term.

    Parameters
    ----------
    scale : float
        Factor on the whole correlation, to match a wanted total [-].
    alpha : float
        Scaling factor of the correlation [-]; 3.4 in its source.
    c1 : float
        Factor of the mean piston speed [-].
    c2 : float
        Factor of the combustion term [m/s/K].
    """

    needs_motored_pressure = True

    scale: float = quantity("-", default=1.0, low=0)
    alpha: float = quantity("-", default=3.4, low=0)
    c1: float = quantity("-", default=2.28, low=0)
    c2: float = quantity("m/s/K", default=5.4e-4, low=0)

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]."""
        speed = woschni_speed(gas, charge, self.c1, self.c2)
        size = self.scale * self.alpha * gas.clearance**-0.2
        return size * (gas.p * 1e-3) ** 0.8 * gas.T**-0.73 * speed**0.8


def woschni_speed(gas: Gas, charge: Charge, c1: float, c2: float) -> float:
    """Characteristic gas speed of Woschni's correlation [m/s]."""
    rise = max(gas.p - gas.p_motored, 0.0)
    per_pressure = charge.swept_volume * charge.T / (charge.p * charge.V)
    return c1 * gas.mean_piston_speed + c2 * per_pressure * rise


@dataclass(frozen=True)
class Annand(HeatTransfer):
    """Annand's correlation: convection by a Reynolds number, and radiation.

    ``h = a (lambda / B) Re^0.7 + c sigma (T^4 - T_w^4) / (T - T_w)``, ``Re = rho c_m B / mu``
    (Proc. IMechE 177, 1963; a from 0.35 to 0.8). Viscosity ``4.702e-7 T^0.645`` Pa s and
    conductivity ``3.17e-4 T^0.772`` W/m/K of combustion gas are those of Ferguson and Kirkpatrick,
    *Internal Combustion Engines*.

    Parameters
    ----------
    scale : float
        Factor on the whole correlation, to match a wanted total [-].
    a : float
        Factor of the convective part [-].
    c : float
        Emissivity-like factor of the radiative part [-]; 0.576 in Annand's diesel engines, 0.075
        for spark ignition. It acts all the time, though it matters only once the gas is hot.
    """

    scale: float = quantity("-", default=1.0, low=0)
    a: float = quantity("-", default=0.49, low=0)
    c: float = quantity("-", default=0.075, low=0)

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]."""
        viscosity = 4.702e-7 * gas.T**0.645
        conductivity = 3.17e-4 * gas.T**0.772
        reynolds = charge.mass / gas.V * gas.mean_piston_speed * gas.bore / viscosity
        convection = self.a * conductivity / gas.bore * reynolds**0.7
        return self.scale * (convection + self.c * radiation(gas.T, gas.wall_temperature))


def radiation(T: float, T_wall: float) -> float:
    """Black radiation between two temperatures, over their difference [W/m^2/K]."""
    return STEFAN_BOLTZMANN * (T * T + T_wall * T_wall) * (T + T_wall)


@dataclass(frozen=True)
class NoHeatTransfer(HeatTransfer):
    """Adiabatic walls."""

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]: zero."""
        return 0.0


@dataclass(frozen=True)
class PolytropicLoss(HeatTransfer):
    """Heat transfer that makes ``p V^n`` constant, n another one in expansion (2.6).

    Eq. 48 with ``dp/dt = -n p/V dV/dt`` gives the heat flow ``(n - g)/(g - 1) p dV/dt``: heat is
    lost on both ways where ``compression < gamma < expansion``, and gained otherwise, whatever the
    wall's temperature. The coefficient is that flow over area and temperature difference; let
    the gas not pass through the temperature of the wall.

    Parameters
    ----------
    gamma : float
        Ratio of specific heats [-]; that of the gas, which has to be constant.
    compression, expansion : float
        Polytropic exponents [-].
    """

    gamma: float = quantity("-", default=1.4, low=1, open_low=True)
    compression: float = quantity("-", default=1.35, low=1, open_low=True)
    expansion: float = quantity("-", default=1.45, low=1, open_low=True)

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat flow over area and temperature difference [W/m^2/K]; negative if against it."""
        exponent = where(gas.clearance_rate < 0.0, self.compression, self.expansion)
        work = gas.p * gas.V / gas.clearance * gas.clearance_rate
        area = 2.0 * gas.V / gas.clearance + math.pi * gas.bore * gas.clearance
        flow = (exponent - self.gamma) / (self.gamma - 1.0) * work
        return flow / (area * (gas.T - gas.wall_temperature))
