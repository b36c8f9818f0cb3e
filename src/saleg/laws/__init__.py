"""Laws that fill the slots of an engine, one module per slot."""

from saleg.laws.alternator import (
    CircuitAlternator,
    FluxProfile,
    ForceMap,
    LinearLoad,
    SinusoidalMotor,
)
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
from saleg.laws.friction import (
    BlairViscousFriction,
    ConstantFriction,
    CoulombViscousFriction,
    FrictionShare,
    NoFriction,
    ViscousFriction,
)
from saleg.laws.gas_exchange import InstantExchange
from saleg.laws.gas_properties import ChangGas, ConstantGamma
from saleg.laws.heat_release import BurnProfile, DoubleWiebe, InstantRelease, Wiebe
from saleg.laws.heat_transfer import Annand, Chang, Hohenberg, NoHeatTransfer, Woschni
from saleg.laws.ignition import (
    CFRIgnition,
    IgnitionAtDeadCentre,
    IgnitionAtPressure,
    RCMIgnition,
    RCMIgnitionPascal,
    SparkAfterDelay,
    SparkAtClearance,
    TabulatedDelay,
)
from saleg.laws.misfires import NoMisfires, ScheduledMisfires
from saleg.laws.springs import EndStops, LinearSprings, PreloadedSprings, ProgressiveSprings

__all__ = [
    "Alternator",
    "Annand",
    "BlairViscousFriction",
    "BurnProfile",
    "CFRIgnition",
    "Chang",
    "ChangGas",
    "Charge",
    "CircuitAlternator",
    "ConstantFriction",
    "ConstantGamma",
    "CoulombViscousFriction",
    "DoubleWiebe",
    "EndStops",
    "FluxProfile",
    "ForceMap",
    "Friction",
    "FrictionShare",
    "Gas",
    "GasExchange",
    "GasProperties",
    "HeatRelease",
    "HeatTransfer",
    "Hohenberg",
    "Ignition",
    "IgnitionAtDeadCentre",
    "IgnitionAtPressure",
    "InstantExchange",
    "InstantRelease",
    "Law",
    "LinearLoad",
    "LinearSprings",
    "Misfires",
    "Motion",
    "NoFriction",
    "NoHeatTransfer",
    "NoMisfires",
    "PreloadedSprings",
    "ProgressiveSprings",
    "RCMIgnition",
    "RCMIgnitionPascal",
    "ScheduledMisfires",
    "SinusoidalMotor",
    "SparkAfterDelay",
    "SparkAtClearance",
    "Springs",
    "Stroke",
    "TabulatedDelay",
    "Validity",
    "ViscousFriction",
    "Wiebe",
    "Woschni",
]
