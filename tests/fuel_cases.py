"""Fuels that tests go through, and their gases by Cantera."""

import pytest

from saleg import fuels
from saleg.fuels import RealFuel
from saleg.fuels.species import MOLAR_GAS_CONSTANT, all_species

FUELS = [getattr(fuels, name) for name in fuels.__all__]
FUELS = [fuel for fuel in FUELS if isinstance(fuel, RealFuel)]
BLENDS = [
    fuels.blend({"methane": 0.8, "hydrogen": 0.2}),
    fuels.blend({"iso-octane": 87.0, "n-heptane": 13.0}, by_mass=True, name="petrol"),
    fuels.blend({"ammonia": 0.7, "dimethyl ether": 0.3}),
]
#: What NASA TM-4513 calls the species of ours.
SPECIES = {
    "methane": "CH4",
    "propane": "C3H8",
    "hydrogen": "H2",
    "ammonia": "NH3",
    "dimethyl ether": "CH3OCH3",
    "methanol": "CH3OH",
    "ethanol": "C2H5OH",
    "iso-octane": "C8H18,isooctane",
    "n-heptane": "C7H16,n-heptane",
    "toluene": "C7H8",
    "oxygen": "O2",
    "nitrogen": "N2",
    "carbon dioxide": "CO2",
    "water": "H2O",
}


def cantera_gas(moles):
    """The same gas by Cantera."""
    cantera = pytest.importorskip("cantera", reason="needs the extra 'chemistry'")
    wanted = [
        species
        for species in cantera.Species.list_from_file("nasa_gas.yaml")
        if species.name in SPECIES.values()
    ]
    gas = cantera.Solution(thermo="ideal-gas", species=wanted)
    gas.X = {SPECIES[name]: amount for name, amount in moles.items()}
    return cantera, gas


def energy(moles, T):
    """Internal energy of a composition, formation included [J]: the polynomials, written out."""
    total = 0.0
    for name, amount in moles.items():
        a = all_species()[name].low if T < 1000.0 else all_species()[name].high
        enthalpy = sum(a[n] * T ** (n + 1) / (n + 1) for n in range(5)) + a[5]
        total += amount * MOLAR_GAS_CONSTANT * (enthalpy - T)
    return total
