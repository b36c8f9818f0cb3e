"""Real fuels: heating values, stoichiometry and the gas they make, from data of the species."""

from saleg.fuels.delays import compute_delays, ignition_delays
from saleg.fuels.filling import fill
from saleg.fuels.mixtures import FuelError, gas_of
from saleg.fuels.real_fuel import RealFuel, blend, pure

#: Methane.
methane = pure("methane")
#: Propane.
propane = pure("propane")
#: Hydrogen.
hydrogen = pure("hydrogen")
#: Ammonia.
ammonia = pure("ammonia")
#: Dimethyl ether.
dimethyl_ether = pure("dimethyl ether")
#: Methanol.
methanol = pure("methanol")
#: Ethanol.
ethanol = pure("ethanol")
#: Iso-octane.
iso_octane = pure("iso-octane")
#: N-heptane.
n_heptane = pure("n-heptane")
#: Toluene.
toluene = pure("toluene")

__all__ = [
    "FuelError",
    "RealFuel",
    "ammonia",
    "blend",
    "compute_delays",
    "dimethyl_ether",
    "ethanol",
    "fill",
    "gas_of",
    "hydrogen",
    "ignition_delays",
    "iso_octane",
    "methane",
    "methanol",
    "n_heptane",
    "propane",
    "pure",
    "toluene",
]
