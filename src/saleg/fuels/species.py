"""Pure gases: composition and caloric data as NASA polynomials of seven coefficients."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from typing import NamedTuple

#: Molar gas constant [J/mol/K]; exact since 2019.
MOLAR_GAS_CONSTANT = 8.31446261815324
#: Temperature at which the polynomials change [K], and that enthalpies are told for [K].
MIDDLE = 1000.0
STANDARD = 298.15
#: Standard atomic masses [kg/mol] (IUPAC).
ATOMIC_MASSES = {"C": 12.011e-3, "H": 1.008e-3, "O": 15.999e-3, "N": 14.007e-3}


class Atoms(NamedTuple):
    """Atoms in a molecule; of a blend, their means."""

    C: float
    H: float
    O: float
    N: float

    @property
    def molar_mass(self) -> float:
        """Mass of a mole [kg/mol]."""
        return sum(getattr(self, atom) * mass for atom, mass in ATOMIC_MASSES.items())


@dataclass(frozen=True)
class Species:
    """Ideal gas of one kind of molecule.

    Coefficients a1 to a7 of ``cp/R = a1 + a2 T + ... + a5 T^4``, whose integrals have a6 and a7, of
    McBride, Gordon and Reno (NASA TM-4513, 1993), for 200 K to 6000 K.

    Attributes
    ----------
    name : str
    atoms : Atoms
    low, high : tuple of float, shape (7,)
        Coefficients below and above 1000 K.
    """

    name: str
    atoms: Atoms
    low: tuple[float, ...]
    high: tuple[float, ...]

    @property
    def molar_mass(self) -> float:
        """Mass of a mole [kg/mol]."""
        return self.atoms.molar_mass

    @property
    def formation_enthalpy(self) -> float:
        """Enthalpy of formation at 298.15 K [J/mol]."""
        powers = sum(a * STANDARD**n / n for n, a in enumerate(self.low[:5], 1))
        return MOLAR_GAS_CONSTANT * (powers + self.low[5])


@lru_cache(maxsize=1)
def all_species() -> dict[str, Species]:
    """Every gas there are data for, by name."""
    text = resources.files("saleg.fuels").joinpath("nasa7.csv").read_text(encoding="utf-8")
    return {row["name"]: _read(row) for row in csv.DictReader(text.splitlines())}


def _read(row: dict[str, str]) -> Species:
    low, high = (tuple(float(row[f"{part}_{n}"]) for n in range(1, 8)) for part in ("low", "high"))
    return Species(row["name"], Atoms(*(float(row[atom]) for atom in ATOMIC_MASSES)), low, high)
