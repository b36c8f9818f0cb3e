"""Fuels: what a kilogram gives, what air it takes, what gas it makes with it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

from saleg.engine import Fuel
from saleg.errors import nearest, shown
from saleg.fuels.mixtures import NITROGEN, FuelError, added, gas_of, mass_of, times, wrong_amounts
from saleg.fuels.species import Atoms, all_species
from saleg.laws import BurningGas, ChargeGas
from saleg.quantities import as_float

#: Gases that are no fuels.
AIR_AND_PRODUCTS = ("oxygen", "nitrogen", "carbon dioxide", "water")

_Gas = TypeVar("_Gas", bound=ChargeGas)


@dataclass(frozen=True)
class RealFuel:
    """Fuel of one or several kinds of molecules, as a gas.

    Attributes
    ----------
    name : str
    moles : dict of str to float
        Its molecules in a mole of fuel [mol].

    Raises
    ------
    FuelError
        Naming every wrong amount; or if it burns with no air.

    Examples
    --------
    >>> from saleg import fuels
    >>> round(fuels.methane.lower_heating_value / 1e6, 2), round(fuels.methane.air_fuel_ratio, 2)
    (50.03, 17.12)
    """

    name: str
    moles: dict[str, float]

    def __post_init__(self) -> None:
        wrong = wrong_amounts(self.moles)
        if not isinstance(self.name, str):
            wrong.insert(0, f"name = {shown(self.name)}: must be text")
        if not wrong:
            moles = {key: float(amount) for key, amount in self.moles.items()}
            object.__setattr__(self, "moles", moles)
            if not self.oxygen > 0.0:
                wrong.append(f"moles = {shown(moles)}: must take air to burn")
        if wrong:
            raise FuelError("\n".join(wrong))

    def __hash__(self) -> int:
        return hash((self.name, frozenset(self.moles.items())))

    @cached_property
    def atoms(self) -> Atoms:
        """Atoms in its mean molecule."""
        parts = [(amount, all_species()[name].atoms) for name, amount in self.moles.items()]
        return Atoms(*(sum(amount * getattr(a, atom) for amount, a in parts) for atom in "CHON"))

    @property
    def molar_mass(self) -> float:
        """Mass of a mole [kg/mol]."""
        return self.atoms.molar_mass

    @property
    def oxygen(self) -> float:
        """Oxygen that a mole takes to burn completely [mol]."""
        return self.atoms.C + self.atoms.H / 4.0 - self.atoms.O / 2.0

    @property
    def air_fuel_ratio(self) -> float:
        """Stoichiometric air-fuel ratio by mass [-], of dry air."""
        return mass_of(self._air(1.0)) / self.molar_mass

    @cached_property
    def lower_heating_value(self) -> float:
        """Lower heating value [J/kg], at 298.15 K from and to gases."""
        formed = {name: all_species()[name].formation_enthalpy for name in all_species()}
        before = self.fresh(1.0)
        after = self.burnt(1.0)
        released = sum(amount * formed[name] for name, amount in before.items())
        released -= sum(amount * formed[name] for name, amount in after.items())
        return released / self.molar_mass

    @property
    def fuel(self) -> Fuel:
        """The fuel of a cylinder."""
        return Fuel(self.lower_heating_value, self.air_fuel_ratio)

    def charge(
        self, equivalence_ratio: float, burnt: float = 0.0, *, direct: bool = False
    ) -> ChargeGas:
        """Gas of fuel and air, and of what a charge before it has burnt to.

        Parameters
        ----------
        equivalence_ratio : float
            Of the fresh charge, and of the one burnt [-].
        burnt : float
            Share of burnt gas by mass [-]: 0 for a fresh charge, 1 for nothing but burnt gas.
        direct : bool
            Whether the fuel is injected later: the fresh gas is air then.

        Returns
        -------
        ChargeGas
            For ``gas_properties`` of a chamber. A charge keeps one gas for a whole cycle.

        Raises
        ------
        FuelError
            If a number is out of range.
        """
        return self._gas(ChargeGas, equivalence_ratio, burnt, direct)

    def burning_gas(
        self, equivalence_ratio: float, burnt: float = 0.0, *, direct: bool = False
    ) -> BurningGas:
        """Gas of this fuel, air and what they burn to, whose composition follows the combustion.

        Parameters
        ----------
        equivalence_ratio, burnt : float
            Of the charge a run starts with, as of :meth:`charge` [-].
        direct : bool
            Whether the fuel is injected later.

        Returns
        -------
        BurningGas
            For ``gas_properties`` of a chamber.

        Raises
        ------
        FuelError
            If a number is out of range.
        """
        return self._gas(BurningGas, equivalence_ratio, burnt, direct)

    def _gas(self, kind: type[_Gas], equivalence_ratio: Any, burnt: Any, direct: bool) -> _Gas:
        """Law of a kind for the gas of a charge."""
        ratio, share = as_float(equivalence_ratio), as_float(burnt)
        wrong = []
        if ratio is None or not 0.0 <= ratio < math.inf:
            wrong.append(f"equivalence_ratio = {shown(equivalence_ratio)}: must be a number >= 0")
        if share is None or not 0.0 <= share <= 1.0:
            wrong.append(f"burnt = {shown(burnt)}: must be a number >= 0 and <= 1")
        if wrong or ratio is None or share is None:
            raise FuelError("\n".join(wrong))
        fuel, air, burnt_gas = map(gas_of, (self.moles, self._air(1.0), self.burnt(1.0)))
        parts = kind(
            fuel_constant=fuel.gas_constant,
            air_constant=air.gas_constant,
            burnt_constant=burnt_gas.gas_constant,
            fuel_low=fuel.low,
            fuel_high=fuel.high,
            air_low=air.low,
            air_high=air.high,
            burnt_low=burnt_gas.low,
            burnt_high=burnt_gas.high,
            air_fuel_ratio=self.air_fuel_ratio,
        )
        return parts.for_charge(ratio, share, direct=direct)

    def fresh(self, equivalence_ratio: float) -> dict[str, float]:
        """Molecules of fresh charge with the air of a mole of fuel [mol]."""
        return added(times(equivalence_ratio, self.moles), self._air(1.0))

    def burnt(self, equivalence_ratio: float) -> dict[str, float]:
        """Molecules that charge burns to [mol]; surplus of fuel or air stays."""
        burning, atoms = min(equivalence_ratio, 1.0), self.atoms
        return added(
            times(equivalence_ratio - burning, self.moles),
            self._air(1.0 - burning),
            {
                "carbon dioxide": burning * atoms.C,
                "water": burning * atoms.H / 2.0,
                "nitrogen": burning * (NITROGEN * self.oxygen + atoms.N / 2.0),
            },
        )

    def _air(self, share: float) -> dict[str, float]:
        """Air that a mole of fuel takes, times a share."""
        oxygen = share * self.oxygen
        return {"oxygen": oxygen, "nitrogen": NITROGEN * oxygen}

    def __repr__(self) -> str:
        return f"<RealFuel {self.name!r}>"


def pure(name: str) -> RealFuel:
    """Fuel of one kind of molecules.

    Parameters
    ----------
    name : str
        Such as ``"methane"``.

    Returns
    -------
    RealFuel

    Raises
    ------
    FuelError
        With the nearest name if there are no data for it.
    """
    told = _no_fuel(name)
    if told:
        raise FuelError(told)
    return RealFuel(name, {name: 1.0})


def _no_fuel(name: Any) -> str:
    """Why a name is none of a fuel; empty for one that is."""
    known = [species for species in all_species() if species not in AIR_AND_PRODUCTS]
    if isinstance(name, str) and name in known:
        return ""
    gas = isinstance(name, str) and name in AIR_AND_PRODUCTS
    hint = "" if gas else nearest(str(name), known)
    return f"no fuel {shown(name)}{hint or '; there are ' + ', '.join(known)}"


def blend(shares: Mapping[str, float], *, by_mass: bool = False, name: str = "") -> RealFuel:
    """Fuel of several kinds of molecules.

    Parameters
    ----------
    shares : mapping of str to float
        Share of each fuel, by its name; they need not add up to one.
    by_mass : bool
        Whether they are shares of the mass; of the moles unless said.
    name : str
        What people call it; its parts and shares unless given.

    Returns
    -------
    RealFuel

    Raises
    ------
    FuelError
        Naming every wrong share.

    Examples
    --------
    >>> hythane = blend({"methane": 0.8, "hydrogen": 0.2})
    >>> round(hythane.lower_heating_value / 1e6, 2)
    52.16
    """
    if not isinstance(shares, Mapping) or not shares:
        raise FuelError(f"shares = {shown(shares)}: must map names of fuels to their shares")
    numbers = {key: as_float(share) or 0.0 for key, share in shares.items()}
    wrong = [told for told in map(_no_fuel, shares) if told]
    wrong += [
        f"share of {key} = {shown(shares[key])}: must be > 0"
        for key, number in numbers.items()
        if not 0.0 < number < math.inf
    ]
    if not isinstance(name, str):
        wrong.append(f"name = {shown(name)}: must be text")
    if not isinstance(by_mass, bool):
        wrong.append(f"by_mass = {shown(by_mass)}: must be True or False")
    if wrong:
        raise FuelError("\n".join(wrong))
    greatest = max(numbers.values())
    amounts = {
        key: number / greatest / (pure(key).molar_mass if by_mass else 1.0)
        for key, number in numbers.items()
    }
    total = sum(amounts.values())
    moles = {key: amount / total for key, amount in amounts.items()}
    named = " + ".join(f"{100.0 * share:.3g} % {key}" for key, share in moles.items())
    return RealFuel(name or named, moles)
