"""Gas of fuel, air and what they burn to, by composition."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from saleg.errors import SalegError, nearest, shown
from saleg.fuels.species import MOLAR_GAS_CONSTANT, all_species
from saleg.laws import MixtureGas
from saleg.quantities import as_float

#: Dry air: nitrogen for each oxygen [mol/mol].
NITROGEN = 3.76


class FuelError(SalegError, ValueError):
    """A fuel, or an amount of it, that cannot be."""


def gas_of(moles: Mapping[str, float]) -> MixtureGas:
    """Law for an ideal gas of given composition.

    Parameters
    ----------
    moles : mapping of str to float
        Amounts of the species of :func:`.all_species`, in any unit of amount.

    Returns
    -------
    MixtureGas

    Raises
    ------
    FuelError
        Naming every wrong amount.

    Examples
    --------
    >>> air = gas_of({"oxygen": 1.0, "nitrogen": 3.76})
    >>> round(air.gas_constant, 1), round(air.gamma(300.0), 4)
    (288.2, 1.3985)
    """
    wrong = wrong_amounts(moles)
    if wrong:
        raise FuelError("\n".join(wrong))
    total = sum(moles.values())
    parts = [(amount / total, all_species()[name]) for name, amount in moles.items()]
    mass = sum(share * species.molar_mass for share, species in parts)
    low, high = (
        tuple(sum(share * getattr(species, part)[n] for share, species in parts) for n in range(5))
        for part in ("low", "high")
    )
    return MixtureGas(gas_constant=MOLAR_GAS_CONSTANT / mass, low=low, high=high)


def wrong_amounts(moles: Any) -> list[str]:
    """What is wrong with amounts of species; empty for a composition."""
    if not isinstance(moles, Mapping) or not moles:
        return [f"moles = {shown(moles)}: must map names of species to their amounts"]
    wrong = []
    for name, amount in moles.items():
        number = as_float(amount)
        if name not in all_species():
            hint = nearest(str(name), all_species()) or f"; there are {', '.join(all_species())}"
            wrong.append(f"no species {shown(name)}{hint}")
        if number is None or not 0.0 <= number < math.inf:
            wrong.append(f"moles of {name} = {shown(amount)}: must be a number >= 0")
    if not wrong and not 0.0 < sum(map(float, moles.values())) < math.inf:
        wrong.append(f"moles = {shown(moles)}: must add up to a number > 0")
    return wrong


def mass_of(moles: Mapping[str, float]) -> float:
    """Mass of a composition [kg, of mol]."""
    return sum(amount * all_species()[name].molar_mass for name, amount in moles.items())


def added(*parts: Mapping[str, float]) -> dict[str, float]:
    """Sum of some compositions."""
    names = dict.fromkeys(name for part in parts for name in part)
    return {name: sum(part.get(name, 0.0) for part in parts) for name in names}


def times(factor: float, moles: Mapping[str, float]) -> dict[str, float]:
    """Composition of so many times as much."""
    return {name: factor * amount for name, amount in moles.items()}
