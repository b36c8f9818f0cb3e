"""Laws that fill the slots of an engine, one module per slot."""

from saleg.laws.alternator import LinearLoad
from saleg.laws.arguments import Charge, Gas, Motion, Stroke
from saleg.laws.base import (
    Alternator,
    Friction,
    GasExchange,
    GasProperties,
    HeatRelease,
    HeatTransfer,
    Ignition,
    Law,
    Misfires,
    Springs,
    Validity,
)
from saleg.laws.friction import BlairViscousFriction, FrictionShare, ViscousFriction
from saleg.laws.gas_exchange import InstantExchange
from saleg.laws.gas_properties import ChangGas, ConstantGamma
from saleg.laws.heat_release import Wiebe
from saleg.laws.heat_transfer import Hohenberg, NoHeatTransfer
from saleg.laws.ignition import CFRIgnition
from saleg.laws.misfires import NoMisfires, ScheduledMisfires
from saleg.laws.springs import LinearSprings

__all__ = [
    "Alternator",
    "BlairViscousFriction",
    "CFRIgnition",
    "ChangGas",
    "Charge",
    "ConstantGamma",
    "Friction",
    "FrictionShare",
    "Gas",
    "GasExchange",
    "GasProperties",
    "HeatRelease",
    "HeatTransfer",
    "Hohenberg",
    "Ignition",
    "InstantExchange",
    "Law",
    "LinearLoad",
    "LinearSprings",
    "Misfires",
    "Motion",
    "NoHeatTransfer",
    "NoMisfires",
    "ScheduledMisfires",
    "Springs",
    "Stroke",
    "Validity",
    "ViscousFriction",
    "Wiebe",
]
