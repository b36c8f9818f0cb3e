"""Engines of the dissertation with walls that follow: its section 4.2 asks for such a model."""

from __future__ import annotations

from typing import Any

from saleg.checks import POSITIVE, a, checked
from saleg.engine import Engine
from saleg.errors import InvalidEngine
from saleg.laws import LumpedWall
from saleg.quantities import Problem
from saleg.steady import steady_state
from saleg.steady.state import NoSteadyState


@checked(engine=a(Engine), coolant_temperature=POSITIVE)
def with_walls_that_follow(engine: Engine, *, coolant_temperature: float = 360.0) -> Engine:
    """Engine whose walls, as it stands, have the temperature given, and follow from there.

    The conductance to the coolant is that which takes the heat of the engine's own steady state.
    Neither the dissertation nor anybody else gives it, or the temperature of the coolant.

    Parameters
    ----------
    engine : Engine
        Mirrored.
    coolant_temperature : float
        Temperature of the coolant [K].

    Returns
    -------
    Engine

    Raises
    ------
    NoSteadyState
        If there is none.
    InvalidEngine
        If the engine is not mirrored, or its coolant no colder than its walls.
    """
    if not engine.is_mirrored or not engine.has_combustion:
        raise InvalidEngine([Problem("engine", engine, "-", "must be mirrored, with cylinders")])
    steady = steady_state(engine)
    if not steady.found:
        raise NoSteadyState(f"no steady state to take the heat from: {steady.message}")
    cylinder: Any = engine.left
    heat = steady.strokes["heat_lost"].sum(axis=0)[0] * steady.quick_performance.frequency
    above = cylinder.wall_temperature - coolant_temperature
    if above <= 0.0:
        allowed = f"must be less than the wall's temperature, {cylinder.wall_temperature:g}"
        raise InvalidEngine([Problem("coolant_temperature", coolant_temperature, "K", allowed)])
    wall = LumpedWall(conductance=float(heat / above), coolant_temperature=coolant_temperature)
    return engine.replace(wall=wall)
