"""From a system of Chapter 2 to an engine of the numeric model, under the same assumptions."""

from __future__ import annotations

from dataclasses import replace
from functools import singledispatch

from saleg.checks import a, checked
from saleg.engine import Engine, SealedCylinder, Translator
from saleg.engine.start import CompressedCharge, charge_mass
from saleg.errors import OutsideModel
from saleg.fundamental.checks import LEFT, SCALAR, require
from saleg.fundamental.gas import Gas, Isentropic, Polytropic
from saleg.fundamental.ignition import AtDeadCentre, AtPressure, Ignition
from saleg.fundamental.loads import ConstantLoad, CosineLoad, Load
from saleg.fundamental.scales import Scales
from saleg.fundamental.system import System
from saleg.laws import (
    ConstantForce,
    ConstantGamma,
    CosineForce,
    IgnitionAtDeadCentre,
    IgnitionAtPressure,
    InstantRelease,
    LinearSprings,
    NoFriction,
    NoHeatTransfer,
    PolytropicLoss,
)
from saleg.laws.base import Alternator, HeatTransfer
from saleg.laws.base import Ignition as IgnitionLaw
from saleg.quantities import Problem

#: Scales of the thesis' base case (Table 1).
BASE_CASE = Scales(half_stroke=0.1, bore=0.064, stiffness=30e3, mass=2.39)
#: Temperature of a fresh charge at the midpoint [K]. It sets the mass of the charge and no more:
#: heat is given, not fuel.
TEMPERATURE = 300.0
#: Midpoint pressure that stands for none [-]: chambers of the numeric model hold some gas.
VACUUM = 1e-15
#: Clearance of head contact over the half stroke [-]; the closed form ends at the very head.
HEAD_GAP = 1e-6


@checked(system=a(System), start=SCALAR, scales=a(Scales))
def to_engine(system: System, start: float = -0.8, *, scales: Scales = BASE_CASE) -> Engine:
    """Engine of the numeric model that makes the assumptions of a system.

    Constant gamma, all heat in an instant, heat rejection at bottom dead centre down to the curve
    through the midpoint pressure, no friction.

    Parameters
    ----------
    system : System
        With a constant or cosine load; others change from stroke to stroke.
    start : float
        Left dead centre at which it starts at rest, its charge burning, x_l* [-].
    scales : Scales
        What turns the system's quantities into SI; those of the thesis' base case unless given.

    Returns
    -------
    Engine

    Raises
    ------
    OutsideModel
        If `start` is not between -1 and 0, or if no law does what the system does.

    Examples
    --------
    >>> from saleg.fundamental import from_engine
    >>> engine = to_engine(System(pressure=0.17, heat=2.2, load=ConstantLoad(0.814)))
    >>> groups = from_engine(engine)
    >>> round(groups.midpoint_pressure, 12), round(groups.heat, 12)
    (0.17, 2.2)
    """
    require(start=(start, LEFT))
    return Engine.mirrored(
        Translator(mass=scales.mass),
        _heated(_cylinder(system, scales), system.heat * scales.energy),
        springs=LinearSprings(stiffness=scales.stiffness),
        friction=NoFriction(),
        alternator=_alternator(system.load, scales),
        start=CompressedCharge(position=start, burning=1.0 if system.heat > 0.0 else 0.0),
        name="assumptions of Chapter 2",
    )


def _cylinder(system: System, scales: Scales) -> SealedCylinder:
    pressure = max(system.pressure, VACUUM) * scales.pressure
    return SealedCylinder(
        bore=scales.bore,
        half_stroke=scales.half_stroke,
        head_gap=HEAD_GAP * scales.half_stroke,
        wall_temperature=100.0,
        pressure=pressure,
        temperature=TEMPERATURE,
        curve_exponent=system.gas.compression,
        equivalence_ratio=0.0,
        combustion_efficiency=1.0,
        gas_properties=ConstantGamma(value=system.gas.gamma),
        heat_transfer=_heat_transfer(system.gas),
        heat_release=InstantRelease(),
        ignition=_ignition(system.ignition, pressure),
    )


def _heated(cylinder: SealedCylinder, heat: float) -> SealedCylinder:
    """Cylinder with fuel for some heat a charge [J].

    The charge is stoichiometric, whatever its mass; the heating value of its fuel gives the heat.
    """
    if heat == 0.0:
        return cylinder
    per_mass = heat / charge_mass(cylinder)
    value = per_mass * (1.0 + cylinder.fuel.air_fuel_ratio)
    fuel = replace(cylinder.fuel, lower_heating_value=value)
    return replace(cylinder, equivalence_ratio=1.0, fuel=fuel)


@singledispatch
def _alternator(load: Load, scales: Scales) -> Alternator:
    raise _not_expressed("load", load, "must be constant or a cosine, the same in every stroke")


@_alternator.register
def _(load: ConstantLoad, scales: Scales) -> Alternator:
    return ConstantForce(amplitude=load.amplitude * scales.force, regulator_gain=0.0)


@_alternator.register
def _(load: CosineLoad, scales: Scales) -> Alternator:
    return CosineForce(
        amplitude=load.amplitude * scales.force,
        half_stroke=scales.half_stroke,
        regulator_gain=0.0,
    )


@singledispatch
def _heat_transfer(gas: Gas) -> HeatTransfer:
    raise _not_expressed("gas", gas, "must be isentropic or polytropic")


@_heat_transfer.register
def _(gas: Isentropic) -> HeatTransfer:
    return NoHeatTransfer()


@_heat_transfer.register
def _(gas: Polytropic) -> HeatTransfer:
    return PolytropicLoss(gas.gamma, compression=gas.compression, expansion=gas.expansion)


@singledispatch
def _ignition(ignition: Ignition, pressure: float) -> IgnitionLaw:
    raise _not_expressed("ignition", ignition, "must be at dead centre or at a pressure")


@_ignition.register
def _(ignition: AtDeadCentre, pressure: float) -> IgnitionLaw:
    return IgnitionAtDeadCentre()


@_ignition.register
def _(ignition: AtPressure, pressure: float) -> IgnitionLaw:
    return IgnitionAtPressure(ignition.ratio * pressure)


def _not_expressed(name: str, value: object, allowed: str) -> OutsideModel:
    return OutsideModel([Problem(name, value, "-", f"{allowed} for the numeric engine")])
