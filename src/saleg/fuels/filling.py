"""Engines on a fuel: its heating value, its air, the gas it makes, and how much of it there is."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.engine import CombustionChamber, Engine
from saleg.engine.start import standard_charge
from saleg.errors import shown
from saleg.fuels.mixtures import FuelError
from saleg.fuels.real_fuel import RealFuel
from saleg.quantities import as_float

#: Richest charge that is looked for when fuel is metered by mass or heat [-].
RICHEST = 5.0


def fill(
    engine: Engine,
    fuel: RealFuel,
    *,
    equivalence_ratio: float | None = None,
    fuel_mass: float | None = None,
    heat: float | None = None,
    burnt: float | None = None,
    follows: bool = False,
) -> Engine:
    """Engine whose cylinders run on a fuel.

    Sets fuel, equivalence ratio and gas properties, and with them the fuel that a charge holds. One
    gas is, with direct injection, that of the air and of what is retained.

    Parameters
    ----------
    engine : Engine
    fuel : RealFuel
    equivalence_ratio : float, optional
        Of the charge [-]; that of the engine unless one of the three amounts is given.
    fuel_mass : float, optional
        Fuel in the charge of each cylinder, what is retained unburnt included [kg]; of one that
        gas flows into through ports, that of a charge that fills it at the state of the intake.
    heat : float, optional
        Lower heating value of that fuel [J].
    burnt : float, optional
        Share of burnt gas the gas properties are those of [-]; that which the gas exchange retains
        unless given.
    follows : bool
        Whether the gas follows the combustion (:class:`~saleg.laws.BurningGas`); if not, a charge
        keeps one gas for a whole cycle.

    Returns
    -------
    Engine

    Raises
    ------
    FuelError
        If there is no cylinder, more than one amount, or more than a charge can hold.

    Examples
    --------
    >>> import saleg
    >>> from saleg import fuels
    >>> base = saleg.machines.thesis_base()
    >>> engine = fuels.fill(base, fuels.hydrogen, equivalence_ratio=0.4)
    >>> round(engine.get("fuel.lower_heating_value") / 1e6, 2)
    119.95
    """
    given = {"equivalence_ratio": equivalence_ratio, "fuel_mass": fuel_mass, "heat": heat}
    amounts = {name: value for name, value in given.items() if value is not None}
    wrong = _problems(engine, fuel, amounts, burnt, follows)
    if wrong:
        raise FuelError("\n".join(wrong))
    for side in engine.gas_sides:
        if isinstance(getattr(engine, side), CombustionChamber):
            engine = _filled(engine, side, fuel, amounts, burnt, follows)
    return engine


def _problems(
    engine: Any, fuel: Any, amounts: dict[str, Any], burnt: Any, follows: Any
) -> list[str]:
    wrong = []
    if not isinstance(engine, Engine):
        wrong.append(f"engine = {shown(engine)}: must be a saleg.Engine")
    elif not engine.has_combustion:
        wrong.append(f"{engine!r} has no cylinder to fill")
    if not isinstance(fuel, RealFuel):
        wrong.append(f"fuel = {shown(fuel)}: must be a fuel of saleg.fuels")
    if len(amounts) > 1:
        wrong.append(f"{', '.join(amounts)}: give one of them")
    for name, value in amounts.items():
        number = as_float(value)
        if number is None or not 0.0 <= number < math.inf:
            wrong.append(f"{name} = {shown(value)}: must be a number >= 0")
    share = 0.0 if burnt is None else as_float(burnt)
    if share is None or not 0.0 <= share <= 1.0:
        wrong.append(f"burnt = {shown(burnt)}: must be a number >= 0 and <= 1")
    if not isinstance(follows, (bool, np.bool_)):
        wrong.append(f"follows = {shown(follows)}: must be True or False")
    return wrong


def _filled(
    engine: Engine,
    side: str,
    fuel: RealFuel,
    amounts: dict[str, Any],
    burnt: float | None,
    follows: bool,
) -> Engine:
    """Engine with one cylinder on a fuel."""
    cylinder = getattr(engine, side)
    retained = float(getattr(cylinder.gas_exchange, "egr", 0.0)) if burnt is None else burnt

    gas = fuel.burning_gas if follows else fuel.charge

    def at(ratio: float) -> Engine:
        values = {
            "fuel": fuel.fuel,
            "gas_properties": gas(ratio, retained, direct=cylinder.injection.is_direct),
            "equivalence_ratio": float(ratio),
        }
        return engine.replace(**{f"{side}.{name}": value for name, value in values.items()})

    if "equivalence_ratio" in amounts or not amounts:
        return at(float(amounts.get("equivalence_ratio", cylinder.equivalence_ratio)))
    ((name, wanted),) = amounts.items()
    mass = wanted / (fuel.lower_heating_value if name == "heat" else 1.0)
    return at(_ratio_for(lambda ratio: _fuel_in(at(ratio), side) - mass, name, wanted))


def _fuel_in(engine: Engine, side: str) -> float:
    """Fuel in the charge of a cylinder [kg]."""
    return float(standard_charge(getattr(engine, side))[1])


def _ratio_for(excess: Any, name: str, wanted: float) -> float:
    """Equivalence ratio of a charge with as much fuel as wanted."""
    from scipy.optimize import brentq

    if excess(0.0) >= 0.0:
        return 0.0
    if excess(RICHEST) < 0.0:
        raise FuelError(f"{name} = {wanted:g}: more than a charge holds (phi would be > {RICHEST})")
    return float(brentq(excess, 0.0, RICHEST, xtol=1e-13, rtol=1e-13))
