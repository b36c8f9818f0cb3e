"""How fuel reaches the charge of a cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.base import Injection
from saleg.laws.usual import LENGTH
from saleg.quantities import quantity


@dataclass(frozen=True)
class PortMixing(Injection):
    """Fuel comes with the fresh charge, mixed before the ports."""


@dataclass(frozen=True)
class DirectInjection(Injection):
    """Fuel injected at once where the piston, on its way in, comes within a clearance of the head.

    The ports close on air and what is retained. The fuel that brings all air in the cylinder to the
    equivalence ratio wanted then evaporates and mixes at once, at constant volume::

        U(T', m + m_f) = U(T, m) + m_f (h_f(T_f) - L)

    with the enthalpy h_f of its vapour at its temperature T_f and its latent heat L there
    (Heywood, eq. 9.26, integrated over the jump). Ignition integrals begin here. A piston that
    turns short of the clearance has no fuel injected before it comes again.

    Parameters
    ----------
    clearance : float
        Clearance between crown and head at the injection [m].
    fuel_temperature : float
        Temperature of the fuel T_f [K].
    latent_heat : float
        Latent heat of vaporisation L at that temperature, 0 for a gas [J/kg].

    Examples
    --------
    >>> DirectInjection(clearance=0.02, latent_heat=3.6e5).fuel_state()
    (300.0, 360000.0)
    """

    is_direct: ClassVar[bool] = True

    clearance: float = quantity("m", default=0.020, low=0, open_low=True, usual=LENGTH)
    fuel_temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0)
    latent_heat: float = quantity("J/kg", default=0.0, low=0)

    @property
    def place(self) -> float:
        """Clearance at which fuel is injected [m]."""
        return self.clearance

    def fuel_state(self) -> tuple[float, float]:
        """Temperature of the fuel [K] and latent heat of vaporisation there [J/kg]."""
        return self.fuel_temperature, self.latent_heat
