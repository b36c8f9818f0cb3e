"""How a run begins.

A start is a law too, though one that runs once, in Python: given an engine it says where the
translator is, how fast, and what stands in each chamber.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

from saleg.columns import exp, log, sqrt
from saleg.engine.chambers import Chamber
from saleg.laws.arguments import Charge, Gas, Motion
from saleg.laws.usual import FREQUENCY
from saleg.quantities import Quantities, quantity

#: Exponent with which a start guesses the state of a charge compressed from port closing.
COMPRESSION_EXPONENT = 1.35
#: Halvings of the range in which an engine rests: to the last digits of a number.
HALVINGS = 60
#: Mass behind an open end [kg]: nobody follows it, but its logarithm is taken.
NO_GAS = 1e-300


class Contents(NamedTuple):
    """What a chamber holds at the start.

    Attributes
    ----------
    is_open : bool
        Whether its ports are open.
    burning : bool
        Whether heat release begins now.
    armed : bool
        Whether its charge may ignite in this stroke.
    pressure : float
        Pressure [Pa].
    mass, fuel, air, burnt : float
        Masses [kg].
    """

    is_open: bool
    burning: bool
    armed: bool
    pressure: float
    mass: float
    fuel: float
    air: float
    burnt: float


class Initial(NamedTuple):
    """State of an engine at the start.

    Attributes
    ----------
    x, v : float
        Position [m] and velocity [m/s].
    at_dead_centre : bool
        Whether the start counts as a dead centre, so that the first stroke is a whole one.
    stroke : float
        Guess of the stroke just passed [m].
    mean_piston_speed : float
        Guess of its mean piston speed [m/s].
    left, right : Contents
    """

    x: float
    v: float
    at_dead_centre: bool
    stroke: float
    mean_piston_speed: float
    left: Contents
    right: Contents


class Start(Quantities):
    """Base of all starts.

    ``engine`` is a :class:`saleg.Engine` throughout; it holds a start, so its type is not named.
    """

    def initial(self, engine: Any) -> Initial:
        """State of the engine at time zero."""
        raise NotImplementedError


@dataclass(frozen=True)
class CompressedCharge(Start):
    """At rest near a head, with a compressed charge there, burning or not.

    The charge stands at ``p_in (d_po/d)^1.35``; a sealed cylinder has its own exponent. If that end
    is open, or burns no fuel but the other one does, the mirror image is meant.

    Parameters
    ----------
    position : float
        Position as a share of the half stroke, negative on the left [-].
    burning : float
        1 to light the charge at time zero, 0 to leave it unlit [-].
    """

    position: float = quantity("-", default=-0.9, low=-1, high=1, open_low=True, open_high=True)
    burning: float = quantity("-", default=1.0, low=0, high=1)

    def initial(self, engine: Any) -> Initial:
        """State of the engine at time zero."""
        side = 0 if self.position < 0.0 else 1
        if _outranks(engine.chambers[1 - side], engine.chambers[side]):
            side = 1 - side
        charged = engine.chambers[side]
        length = charged.half_stroke
        depth = min(abs(self.position) * length, length - min(2.0 * charged.head_gap, 0.5 * length))
        x = depth if side == 1 else -depth
        lit = bool(self.burning) and _burns_fuel(charged)
        held = (
            contents(engine.left, x, burning=lit and side == 0),
            contents(engine.right, -x, burning=lit and side == 1),
        )
        energy = _stored_energy(engine, charged, x, held[side], lit)
        speed = 0.75 * sqrt(2.0 * energy / engine.translator.mass)
        return Initial(x, 0.0, True, 2.0 * depth, speed, *held)


@dataclass(frozen=True)
class MidpointVelocity(Start):
    """Passing the midpoint, both charges where compression would have them.

    The velocity is ``factor pi f S``, that of a harmonic motion times a factor.

    Parameters
    ----------
    frequency : float
        Frequency f the engine is expected to run at [Hz].
    stroke : float
        Stroke S as a share of the maximum stroke [-].
    factor : float
        Peak velocity over that of a harmonic motion, negative to the left [-].
    """

    frequency: float = quantity("Hz", default=45.0, low=0, open_low=True, usual=FREQUENCY)
    stroke: float = quantity("-", default=0.9, low=0, high=1, open_low=True)
    factor: float = quantity("-", default=1.15)

    def initial(self, engine: Any) -> Initial:
        """State of the engine at time zero."""
        stroke = self.stroke * engine.maximum_stroke
        v = self.factor * math.pi * self.frequency * stroke
        left, right = contents(engine.left, 0.0), contents(engine.right, 0.0)
        left = left._replace(armed=left.armed and v < 0.0)
        right = right._replace(armed=right.armed and v > 0.0)
        return Initial(0.0, v, False, stroke, 2.0 * stroke * self.frequency, left, right)


@dataclass(frozen=True)
class AtRest(Start):
    """At rest at the midpoint, both cylinders closed and filled at the intake's state (Ch. 5).

    A cylinder alone, or opposite a gas spring, rests where springs balance the air that its ports
    have enclosed, which is far from the midpoint. There is no fuel in a cylinder: nothing is
    metered before the ports have opened once.
    """

    def initial(self, engine: Any) -> Initial:
        """State of the engine at time zero."""
        if _burns_fuel(engine.left) != _burns_fuel(engine.right):
            x = _resting_position(engine)
            held = _without_fuel(engine.left, x), _without_fuel(engine.right, -x)
            return Initial(x, 0.0, True, 0.0, 0.0, *held)
        return Initial(0.0, 0.0, True, 0.0, 0.0, _resting(engine.left), _resting(engine.right))


def contents(chamber: Any, displacement: float, burning: bool = False) -> Contents:
    """What a chamber holds with its piston somewhere.

    Parameters
    ----------
    chamber : Chamber
    displacement : float
        Position of the piston from the midpoint, away from its head [m].
    burning : bool
        Whether the charge is lit, if the ports are closed.

    Returns
    -------
    Contents
    """
    height = chamber.half_stroke + displacement
    full = chamber.reference_state
    squeeze = full.clearance / height
    if not _holds_gas(chamber):
        return Contents(True, False, False, full.pressure, NO_GAS, 0.0, 0.0, 0.0)
    if not _burns_fuel(chamber):
        pressure = full.pressure * adiabatic_rise(chamber, squeeze)
        return Contents(False, False, False, pressure, charge_mass(chamber), 0.0, 0.0, 0.0)
    mass, fuel, air, burnt = standard_charge(chamber)
    is_open = _has_ports(chamber) and squeeze <= 1.0
    exponent = COMPRESSION_EXPONENT if _has_ports(chamber) else chamber.curve_exponent
    pressure = full.pressure * (1.0 if is_open else squeeze**exponent)
    lit = burning and not is_open
    injection = chamber.injection
    if injection.is_direct and not (lit or (not is_open and height <= injection.place)):
        mass, fuel = mass - fuel, 0.0
    return Contents(is_open, lit, not is_open and not lit, pressure, mass, fuel, air, burnt)


def adiabatic_rise(chamber: Any, squeeze: float) -> float:
    """Pressure of an adiabatically compressed gas over that in the reference state [-].

    ``d ln T / d ln V = 1 - gamma(T)`` by the classical Runge-Kutta method, so that the charge of a
    sealed chamber does not depend on where a run begins.

    Parameters
    ----------
    chamber : Chamber
    squeeze : float
        Volume in the reference state over that now [-].

    Returns
    -------
    float
    """
    gamma = chamber.gas_properties.gamma
    filled = chamber.reference_state.temperature
    ln_T, steps = log(filled), 64
    h = log(squeeze) / steps
    for _ in range(steps):
        k1 = gamma(exp(ln_T)) - 1.0
        k2 = gamma(exp(ln_T + 0.5 * h * k1)) - 1.0
        k3 = gamma(exp(ln_T + 0.5 * h * k2)) - 1.0
        k4 = gamma(exp(ln_T + h * k3)) - 1.0
        ln_T += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return squeeze * exp(ln_T) / filled


def standard_charge(cylinder: Any) -> tuple[float, float, float, float]:
    """Mass, fuel, air and burnt gas of the charge of a cylinder that runs steadily, all injected.

    Parameters
    ----------
    cylinder : Cylinder or SealedCylinder

    Returns
    -------
    (float, float, float, float)
        Masses [kg].
    """
    mass = charge_mass(cylinder)
    ratio, phi = cylinder.fuel.air_fuel_ratio, cylinder.equivalence_ratio
    if phi <= 0.0:
        return mass, 0.0, mass, 0.0
    egr = getattr(cylinder.gas_exchange, "egr", 0.0)
    burns = burning_share(cylinder) * min(1.0, 1.0 / phi)
    gas, is_direct = cylinder.gas_properties, cylinder.injection.is_direct
    # What the ports close on, over the fuel: with direct injection only what did not burn before.
    fuel_then = egr * (1.0 - burns) if is_direct else 1.0
    parts = fuel_then, ratio / phi, (1.0 + ratio) * burns * egr / (1.0 - egr)
    whole = sum(parts)
    if gas.follows_composition:
        constant = sum(part * R for part, R in zip(parts, gas.gas_constants, strict=True)) / whole
        mass *= gas.gas_constant / constant
    fuel = mass / whole
    mass += fuel * (1.0 - fuel_then)
    return mass, fuel, fuel * parts[1], fuel * parts[2]


def burning_share(cylinder: Any) -> float:
    """Share of the fuel there is air for that a cylinder burns in the end [-].

    Parameters
    ----------
    cylinder : Cylinder or SealedCylinder

    Returns
    -------
    float
    """
    p, T, clearance = cylinder.reference_state
    volume, wall = cylinder.area * clearance, cylinder.wall_temperature
    gas = Gas(p, T, volume, p, clearance, cylinder.bore, 0.0, wall, 0.0)
    mass, phi = charge_mass(cylinder), cylinder.equivalence_ratio
    fuel = mass * phi / (phi + cylinder.fuel.air_fuel_ratio)
    charge = Charge(mass, fuel, mass - fuel, 0.0, phi, p, T, volume, volume)
    share = cylinder.combustion_efficiency * cylinder.completeness.share(gas, charge)
    return share * cylinder.heat_release.burnt_fraction(1.0)


def charge_mass(chamber: Any) -> float:
    """Mass of the charge [kg]; of a ported cylinder ``p_in A d_po / (R T_in)``.

    Parameters
    ----------
    chamber : Chamber

    Returns
    -------
    float
    """
    full, area = chamber.reference_state, math.pi * chamber.bore**2 / 4.0
    density = full.pressure / (chamber.gas_properties.gas_constant * full.temperature)
    return density * area * full.clearance


def _resting(chamber: Any) -> Contents:
    """A closed chamber, filled at the state its charge is known in, without fuel."""
    if not _burns_fuel(chamber):
        return contents(chamber, 0.0)
    full = chamber.reference_state
    mass = charge_mass(chamber) * chamber.half_stroke / full.clearance
    return Contents(False, False, False, full.pressure, mass, 0.0, mass, 0.0)


def _without_fuel(chamber: Any, displacement: float) -> Contents:
    """What a chamber holds as in :func:`contents`, but air in place of a mixture."""
    held = contents(chamber, displacement)
    if not _burns_fuel(chamber):
        return held
    return held._replace(armed=False, fuel=0.0, air=held.mass, burnt=0.0)


def _resting_position(engine: Any) -> float:
    """Position at which the forces of gas and springs balance [m]; short of a head at the most."""
    left, right = engine.left, engine.right
    low, high = 2.0 * left.head_gap - left.half_stroke, right.half_stroke - 2.0 * right.head_gap
    areas = engine.piston_areas
    for _ in range(HALVINGS):
        x = 0.5 * (low + high)
        force = areas[0] * contents(left, x).pressure - areas[1] * contents(right, -x).pressure
        force += engine.back_force
        if force + engine.springs.force(Motion(0.0, x, 0.0, 0.0)) > 0.0:
            low = x
        else:
            high = x
    return 0.5 * (low + high)


def _stored_energy(engine: Any, charged: Chamber, x: float, held: Contents, lit: bool) -> float:
    """Energy about to drive the translator [J], for a guess of its speed."""
    springs = engine.springs.energy(Motion(0.0, x, 0.0, 0.0))
    springs -= engine.springs.energy(Motion(0.0, 0.0, 0.0, 0.0))
    height = charged.half_stroke - abs(x)
    volume = charged.area * height
    full = charged.reference_state.clearance
    n = COMPRESSION_EXPONENT - 1.0
    gas = held.pressure * volume / n * max(1.0 - (height / full) ** n, 0.0)
    heat = held.fuel * charged.fuel.lower_heating_value if lit else 0.0  # type: ignore[attr-defined]
    return max(springs + gas + 0.4 * heat, 1e-12)


def _outranks(one: Any, other: Any) -> bool:
    """Whether a charge is rather compressed in one chamber than in another."""
    return (_burns_fuel(one), _holds_gas(one)) > (_burns_fuel(other), _holds_gas(other))


def _holds_gas(chamber: Any) -> bool:
    return hasattr(chamber, "gas_properties")


def _burns_fuel(chamber: Any) -> bool:
    return hasattr(chamber, "ignition")


def _has_ports(chamber: Any) -> bool:
    return hasattr(chamber, "port_closing")
