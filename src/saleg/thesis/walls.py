"""Engines of the dissertation with walls that follow: its section 4.2 asks for such a model."""

from __future__ import annotations

from typing import Any

from saleg.checks import POSITIVE, a, checked
from saleg.engine import Engine
from saleg.laws import LumpedWall
from saleg.steady import steady_state
from saleg.steady.solver import NoSteadyState


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
    """
    steady = steady_state(engine)
    if not steady.found:
        raise NoSteadyState(f"no steady state to take the heat from: {steady.message}")
    cylinder: Any = engine.left
    heat = steady.strokes["heat_lost"].sum(axis=0)[0] * steady.quick_performance.frequency
    above = cylinder.wall_temperature - coolant_temperature
    wall = LumpedWall(conductance=float(heat / above), coolant_temperature=coolant_temperature)
    return engine.replace(wall=wall)
