"""Caloric properties of the charge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from saleg.laws.arguments import Parts
from saleg.laws.base import GasProperties, Validity
from saleg.laws.choice import where
from saleg.laws.usual import GAS_CONSTANT
from saleg.quantities import quantity, series

# Gauss-Legendre abscissae and weights on [-1, 1]: twelve points integrate c_v of Eq. 49 over its
# whole range to rounding error.
_nodes, _weights = np.polynomial.legendre.leggauss(12)
NODES = tuple(float(node) for node in _nodes)
WEIGHTS = tuple(float(weight) for weight in _weights)

#: Temperature above which the fit is held constant, and where internal energy is zero [K].
HOLD = 2500.0
REFERENCE = 300.0


def chang_gamma(T: float) -> float:
    """Ratio of specific heats of Eq. 49, without its hold."""
    return 1.396 + T * (-1.436e-4 + T * (6.207e-8 - 9.967e-12 * T))


def chang_energy(gas_constant: float, T: float) -> float:
    """Integral of R/(gamma - 1) from the reference temperature to `T` [J/kg]."""
    half = 0.5 * (T - REFERENCE)
    middle = 0.5 * (T + REFERENCE)
    total = 0.0
    for i in range(12):
        total += WEIGHTS[i] / (chang_gamma(middle + half * NODES[i]) - 1.0)
    return gas_constant * half * total


#: Temperature at which the polynomials of a mixture change, and where its energy is zero [K].
POLYNOMIALS_CHANGE = 1000.0
STANDARD = 298.15

#: Coefficients below and above that temperature of methane, dry air and what they burn to.
METHANE_LOW = (5.149876, -0.01367098, 4.918006e-05, -4.84743e-08, 1.66694e-11)
METHANE_HIGH = (1.635526, 0.01008428, -3.369163e-06, 5.349587e-10, -3.155188e-14)
AIR_LOW = (3.583831, -0.0007272478, 1.671434e-06, -1.101983e-10, -4.313878e-13)
AIR_HIGH = (3.101397, 0.001241326, -4.187909e-07, 6.641169e-11, -3.912507e-15)
BURNT_LOW = (3.546313, 0.0003784979, 2.029169e-07, 9.312501e-10, -6.838415e-13)
BURNT_HIGH = (3.06027, 0.001824371, -5.939124e-07, 8.938404e-11, -4.976032e-15)


def polynomial(a: Sequence[float], T: float) -> float:
    """Polynomial of the fourth degree in the temperature."""
    return a[0] + T * (a[1] + T * (a[2] + T * (a[3] + T * a[4])))


def integral(a: Sequence[float], T: float) -> float:
    """Integral of the polynomial from 0 K [K]."""
    rest = a[1] / 2.0 + T * (a[2] / 3.0 + T * (a[3] / 4.0 + T * a[4] / 5.0))
    return T * (a[0] + T * rest)


@dataclass(frozen=True)
class ChangGas(GasProperties):
    """Ratio of specific heats as a cubic in temperature (Eq. 49).

    Fitted to HCCI engine data for 550 K to 2150 K (Chang et al., SAE 2004-01-2996); held constant
    above 2500 K as in its source. Every cycle of the thesis' engines leaves the fitted range.

    Parameters
    ----------
    gas_constant : float
        Specific gas constant R [J/kg/K].

    Examples
    --------
    >>> round(ChangGas().gamma(1000.0), 6)
    1.304503
    """

    valid_for = (Validity("temperature", 550.0, 2150.0, "Chang et al., SAE 2004-01-2996"),)

    gas_constant: float = quantity(
        "J/kg/K", default=287.0, low=0, open_low=True, usual=GAS_CONSTANT
    )

    def gamma(self, T: float) -> float:
        """Ratio of specific heats [-], Eq. 49."""
        return chang_gamma(min(T, HOLD))

    def breakpoint(self) -> float:
        """Temperature at which gamma is not smooth [K]: where its hold begins."""
        return HOLD

    def internal_energy(self, T: float) -> float:
        """Specific internal energy above 300 K [J/kg]."""
        warm = chang_energy(self.gas_constant, min(T, HOLD))
        held = self.gas_constant / (chang_gamma(HOLD) - 1.0)
        return warm + held * max(T - HOLD, 0.0)


@dataclass(frozen=True)
class ConstantGamma(GasProperties):
    """Perfect gas: a constant ratio of specific heats (the assumption of Chapter 2).

    Parameters
    ----------
    value : float
        Ratio of specific heats [-].
    gas_constant : float
        Specific gas constant R [J/kg/K].
    """

    value: float = quantity("-", default=1.4, low=1, open_low=True)
    gas_constant: float = quantity(
        "J/kg/K", default=287.0, low=0, open_low=True, usual=GAS_CONSTANT
    )

    def gamma(self, T: float) -> float:
        """Ratio of specific heats [-]."""
        return self.value

    def internal_energy(self, T: float) -> float:
        """Specific internal energy above 0 K [J/kg]."""
        return self.gas_constant * T / (self.value - 1.0)


@dataclass(frozen=True)
class MixtureGas(GasProperties):
    """Ideal gas of fixed composition by NASA polynomials: ``cp/R = a1 + a2 T + ... + a5 T^4``.

    :mod:`saleg.fuels` makes it from a fuel and its equivalence ratio. The coefficients are those of
    the species, by moles; 200 K to 6000 K (McBride, Gordon and Reno, NASA TM-4513). The defaults
    stand for dry air.

    Parameters
    ----------
    gas_constant : float
        Specific gas constant R [J/kg/K].
    low, high : tuple of float, shape (5,)
        Coefficients a1 to a5 below and above 1000 K [-, 1/K, ... 1/K^4].
    """

    valid_for = (Validity("temperature", 200.0, 6000.0, "NASA TM-4513"),)

    gas_constant: float = quantity(
        "J/kg/K", default=288.19, low=0, open_low=True, usual=GAS_CONSTANT
    )
    low: tuple[float, ...] = series(
        "-", default=(3.58383, -7.27248e-4, 1.671434e-6, -1.101983e-10, -4.313878e-13), at_least=5
    )
    high: tuple[float, ...] = series(
        "-", default=(3.101397, 1.241326e-3, -4.187908e-07, 6.641169e-11, -3.912507e-15), at_least=5
    )

    def gamma(self, T: float) -> float:
        """Ratio of specific heats [-]."""
        low, high = polynomial(self.low, T), polynomial(self.high, T)
        cp = where(T < POLYNOMIALS_CHANGE, low, high)
        return cp / (cp - 1.0)

    def breakpoint(self) -> float:
        """Temperature at which gamma is not smooth [K]: where the polynomials change."""
        return POLYNOMIALS_CHANGE

    def internal_energy(self, T: float) -> float:
        """Specific internal energy above 298.15 K [J/kg]."""
        cold = min(T, POLYNOMIALS_CHANGE)
        total = integral(self.low, cold) - integral(self.low, STANDARD)
        if T > POLYNOMIALS_CHANGE:
            total += integral(self.high, T) - integral(self.high, POLYNOMIALS_CHANGE)
        return self.gas_constant * (total - (T - STANDARD))


def heat_capacity(low: Sequence[float], high: Sequence[float], T: float) -> float:
    """Heat capacity at constant volume over the gas constant [-]."""
    return where(T < POLYNOMIALS_CHANGE, polynomial(low, T), polynomial(high, T)) - 1.0


def energy(low: Sequence[float], high: Sequence[float], T: float) -> float:
    """Enthalpy above 298.15 K less ``R T``, over the gas constant [K]."""
    cold, hot = min(T, POLYNOMIALS_CHANGE), max(T, POLYNOMIALS_CHANGE)
    rise = integral(low, cold) - integral(low, STANDARD)
    return rise + integral(high, hot) - integral(high, POLYNOMIALS_CHANGE) - T


@dataclass(frozen=True)
class ChargeGas(MixtureGas):
    """Ideal gas of a charge of fuel, air and burnt gas: one gas for the whole cycle.

    :meth:`saleg.fuels.RealFuel.charge` makes it. :meth:`saleg.Engine.replace` makes it anew for
    another equivalence ratio and another retained share.

    Parameters
    ----------
    gas_constant, low, high : float, tuple of float
        Of the charge, as of :class:`MixtureGas` [J/kg/K, -].
    fuel_constant, air_constant, burnt_constant : float
        Specific gas constants of fuel, air and stoichiometric burnt gas [J/kg/K].
    fuel_low, fuel_high, air_low, air_high, burnt_low, burnt_high : tuple of float, shape (5,)
        Coefficients of the parts below and above 1000 K [-, 1/K, ... 1/K^4].
    air_fuel_ratio : float
        Stoichiometric air-fuel ratio of the fuel by mass [-]; 0 if the charge is not known.
    equivalence_ratio, burnt_share : float
        Of the charge: that of its fuel and air, and its share of burnt gas by mass [-].
    """

    fuel_constant: float = quantity(
        "J/kg/K", default=518.261, low=0, open_low=True, usual=GAS_CONSTANT
    )
    air_constant: float = quantity(
        "J/kg/K", default=288.187, low=0, open_low=True, usual=GAS_CONSTANT
    )
    burnt_constant: float = quantity(
        "J/kg/K", default=300.884, low=0, open_low=True, usual=GAS_CONSTANT
    )
    fuel_low: tuple[float, ...] = series("-", default=METHANE_LOW, at_least=5)
    fuel_high: tuple[float, ...] = series("-", default=METHANE_HIGH, at_least=5)
    air_low: tuple[float, ...] = series("-", default=AIR_LOW, at_least=5)
    air_high: tuple[float, ...] = series("-", default=AIR_HIGH, at_least=5)
    burnt_low: tuple[float, ...] = series("-", default=BURNT_LOW, at_least=5)
    burnt_high: tuple[float, ...] = series("-", default=BURNT_HIGH, at_least=5)
    air_fuel_ratio: float = quantity("-", default=0.0, low=0)
    equivalence_ratio: float = quantity("-", default=0.0, low=0)
    burnt_share: float = quantity("-", default=0.0, low=0, high=1)

    @property
    def is_of_known_charge(self) -> bool:
        """Whether it says what charge it is the gas of; a file of earlier versions does not."""
        return self.air_fuel_ratio > 0.0

    def for_charge(
        self, equivalence_ratio: float, burnt_share: float, *, direct: bool = False
    ) -> Self:
        """The gas of another charge of the same fuel.

        Parameters
        ----------
        equivalence_ratio, burnt_share : float
            Of that charge [-].
        direct : bool
            Whether its fresh part is air alone, as the fuel is injected once the ports have closed.
        """
        burning, mixed_in = min(equivalence_ratio, 1.0), 0.0 if direct else equivalence_ratio
        whole = equivalence_ratio + self.air_fuel_ratio
        fresh = (1.0 - burnt_share) * whole / (mixed_in + self.air_fuel_ratio)
        # Burnt gas of a lean charge has the air left, of a rich one the fuel left.
        masses = (
            fresh * mixed_in + burnt_share * (equivalence_ratio - burning),
            self.air_fuel_ratio * (fresh + burnt_share * (1.0 - burning)),
            burnt_share * burning * (1.0 + self.air_fuel_ratio),
        )
        constants = self.fuel_constant, self.air_constant, self.burnt_constant
        moles = [mass / whole * R for mass, R in zip(masses, constants, strict=True)]
        constant = sum(moles)

        def mixed(*parts: tuple[float, ...]) -> tuple[float, ...]:
            return tuple(
                sum(n * a for n, a in zip(moles, coefficients, strict=True)) / constant
                for coefficients in zip(*parts, strict=True)
            )

        return replace(
            self,
            gas_constant=constant,
            low=mixed(self.fuel_low, self.air_low, self.burnt_low),
            high=mixed(self.fuel_high, self.air_high, self.burnt_high),
            equivalence_ratio=equivalence_ratio,
            burnt_share=burnt_share,
        )


@dataclass(frozen=True)
class BurningGas(ChargeGas):
    """Ideal gas of fuel, air and burnt gas, whose composition follows the combustion.

    Each part is a gas as of :class:`MixtureGas`, and their masses in the chamber weight them: heat
    capacity, energy and the number of moles change as the charge burns, and with what is retained.
    :meth:`saleg.fuels.RealFuel.burning_gas` makes it. Chambers let no gas in or out but in an
    instant: :class:`InstantExchange`, :class:`NoLeak`.

    Parameters
    ----------
    gas_constant, low, high, air_fuel_ratio, equivalence_ratio, burnt_share : float, tuple of float
        Of a fresh charge, as of :class:`ChargeGas`, for the start of a run [J/kg/K, -].
    fuel_constant, air_constant, burnt_constant : float
        Specific gas constants of the parts [J/kg/K].
    fuel_low, fuel_high, air_low, air_high, burnt_low, burnt_high : tuple of float, shape (5,)
        Coefficients of the parts below and above 1000 K [-, 1/K, ... 1/K^4].
    """

    states = ("contents",)
    follows_composition: ClassVar[bool] = True

    def heat_capacity_of(self, T: float, parts: Parts) -> float:
        """Heat capacity of parts of the gas at constant volume [J/K]."""
        fuel = self.fuel_constant * heat_capacity(self.fuel_low, self.fuel_high, T)
        air = self.air_constant * heat_capacity(self.air_low, self.air_high, T)
        burnt = self.burnt_constant * heat_capacity(self.burnt_low, self.burnt_high, T)
        return parts.fuel * fuel + parts.air * air + parts.burnt * burnt

    def energy_of(self, T: float, parts: Parts) -> float:
        """Enthalpy of parts of the gas above 298.15 K less ``R T`` [J], or its rate [W]."""
        fuel = self.fuel_constant * energy(self.fuel_low, self.fuel_high, T)
        air = self.air_constant * energy(self.air_low, self.air_high, T)
        burnt = self.burnt_constant * energy(self.burnt_low, self.burnt_high, T)
        return parts.fuel * fuel + parts.air * air + parts.burnt * burnt

    @property
    def gas_constants(self) -> tuple[float, float, float]:
        """Specific gas constants of fuel, air and burnt gas [J/kg/K]."""
        return self.fuel_constant, self.air_constant, self.burnt_constant
