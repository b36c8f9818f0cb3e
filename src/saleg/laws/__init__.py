"""Laws that fill the slots of an engine and of a controller, one module per slot."""

from saleg.laws.alternator import (
    CircuitAlternator,
    ConstantForce,
    CosineForce,
    FluxProfile,
    ForceMap,
    LinearLoad,
    SinusoidalMotor,
)
from saleg.laws.arguments import Charge, Commands, Drive, Gas, Motion, Signals, Stroke
from saleg.laws.base import (
    Alternator,
    Completeness,
    FlowExchange,
    Friction,
    GasExchange,
    GasProperties,
    HeatRelease,
    HeatTransfer,
    Ignition,
    Law,
    Leak,
    Misfires,
    Springs,
    Supply,
    Validity,
    Wall,
)
from saleg.laws.choice import any_of, where
from saleg.laws.completeness import CompleteCombustion, CompletenessByRatio
from saleg.laws.control.actuators import Actuators
from saleg.laws.control.base import (
    ActuatorLaw,
    FuelControl,
    IntakeControl,
    LoadControl,
    MotorControl,
    StateLogic,
)
from saleg.laws.control.fuel import FuelCut, FuelOnDemand, NoFuel, RatedFuel
from saleg.laws.control.intake import HeatedIntake, RatedIntake
from saleg.laws.control.load import DeadCentreRegulator, PowerDemand, ScaledLoad, StrokeRegulator
from saleg.laws.control.motor import ResonanceSearch, SteadyMotor
from saleg.laws.control.state_logic import AlwaysMotored, CompressionThreshold, NeverMotored
from saleg.laws.earlier_names import accept_earlier_names
from saleg.laws.friction import (
    BlairViscousFriction,
    ConstantFriction,
    CoulombViscousFriction,
    FrictionShare,
    NoFriction,
    ViscousFriction,
)
from saleg.laws.gas_exchange import InstantExchange, PortFlow
from saleg.laws.gas_properties import ChangGas, ConstantGamma, MixtureGas
from saleg.laws.heat_release import BurnProfile, DoubleWiebe, InstantRelease, Wiebe
from saleg.laws.heat_transfer import (
    Annand,
    Chang,
    Hohenberg,
    NoHeatTransfer,
    PolytropicLoss,
    Woschni,
)
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
from saleg.laws.leaks import MakeUpValve, NoLeak, RingLeak
from saleg.laws.misfires import NoMisfires, ScheduledMisfires
from saleg.laws.springs import (
    AirSprings,
    EndStops,
    LinearSprings,
    OneSidedSprings,
    PreloadedSprings,
    ProgressiveSprings,
)
from saleg.laws.supply import Crankcase, Plenum
from saleg.laws.walls import FixedWall, LumpedWall

accept_earlier_names()

__all__ = [
    "ActuatorLaw",
    "Actuators",
    "AirSprings",
    "Alternator",
    "AlwaysMotored",
    "Annand",
    "BlairViscousFriction",
    "BurnProfile",
    "CFRIgnition",
    "Chang",
    "ChangGas",
    "Charge",
    "CircuitAlternator",
    "Commands",
    "CompleteCombustion",
    "Completeness",
    "CompletenessByRatio",
    "CompressionThreshold",
    "ConstantForce",
    "ConstantFriction",
    "ConstantGamma",
    "CosineForce",
    "CoulombViscousFriction",
    "Crankcase",
    "DeadCentreRegulator",
    "DoubleWiebe",
    "Drive",
    "EndStops",
    "FixedWall",
    "FlowExchange",
    "FluxProfile",
    "ForceMap",
    "Friction",
    "FrictionShare",
    "FuelControl",
    "FuelCut",
    "FuelOnDemand",
    "Gas",
    "GasExchange",
    "GasProperties",
    "HeatRelease",
    "HeatTransfer",
    "HeatedIntake",
    "Hohenberg",
    "Ignition",
    "IgnitionAtDeadCentre",
    "IgnitionAtPressure",
    "InstantExchange",
    "InstantRelease",
    "IntakeControl",
    "Law",
    "Leak",
    "LinearLoad",
    "LinearSprings",
    "LoadControl",
    "LumpedWall",
    "MakeUpValve",
    "Misfires",
    "MixtureGas",
    "Motion",
    "MotorControl",
    "NeverMotored",
    "NoFriction",
    "NoFuel",
    "NoHeatTransfer",
    "NoLeak",
    "NoMisfires",
    "OneSidedSprings",
    "Plenum",
    "PolytropicLoss",
    "PortFlow",
    "PowerDemand",
    "PreloadedSprings",
    "ProgressiveSprings",
    "RCMIgnition",
    "RCMIgnitionPascal",
    "RatedFuel",
    "RatedIntake",
    "ResonanceSearch",
    "RingLeak",
    "ScaledLoad",
    "ScheduledMisfires",
    "Signals",
    "SinusoidalMotor",
    "SparkAfterDelay",
    "SparkAtClearance",
    "Springs",
    "StateLogic",
    "SteadyMotor",
    "Stroke",
    "StrokeRegulator",
    "Supply",
    "TabulatedDelay",
    "Validity",
    "ViscousFriction",
    "Wall",
    "Wiebe",
    "Woschni",
    "any_of",
    "where",
]
