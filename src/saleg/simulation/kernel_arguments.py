"""Arguments of the integrator, put together in one place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.compiler.compose import parameters
from saleg.compiler.controllers import nobody
from saleg.engine import Engine
from saleg.kernel import layout
from saleg.kernel.tuples import Control, Integration, Scratch, Snapshots, Spare, Tableau, Tables
from saleg.laws.control.base import ActuatorLaw
from saleg.simulation.initial_state import State


def arguments_of(
    engine: Engine,
    state: State,
    *,
    tableau: Tableau,
    order: float,
    options: np.ndarray,
    tables: Tables,
    actuators: ActuatorLaw | None = None,
    control: Control | None = None,
) -> Integration:
    """Arguments of the integrator for an engine.

    Parameters
    ----------
    engine : Engine
    state : State
        Where it stands; every call moves it.
    tableau : Tableau
        Method.
    order : float
        Its order.
    options : ndarray of OPTIONS_RECORD, shape (1,)
        What is asked of the integrator.
    tables : Tables
        Room for what is recorded.
    actuators : ActuatorLaw, optional
        Actuators before the engine.
    control : Control, optional
        Controller the kernel asks; nobody unless given.

    Returns
    -------
    Integration
    """
    return Integration(
        laws=parameters(engine, actuators),
        engine=state.engine,
        chambers=state.chambers,
        y=state.y,
        peaks=state.peaks,
        tableau=tableau,
        order=order,
        options=options,
        tables=tables,
        snapshots=_snapshots(state),
        scratch=_scratch(len(tableau.b)),
        control=control or nobody(),
    )


def _snapshots(state: State) -> Snapshots:
    """Room for the states at the last two left dead centres; the start may be one."""
    kept = Snapshots(
        engine=np.zeros(2, layout.ENGINE_RECORD),
        chambers=np.zeros((2, 2), layout.CHAMBER_RECORD),
        y=np.zeros((2, layout.N_ALL)),
    )
    E: Any = state.engine[0]
    if math.isfinite(E["x_dead_centre"]) and E["direction"] > 0.0:
        kept.engine[0], kept.chambers[0], kept.y[0] = E, state.chambers, state.y
    return kept


def _scratch(stages: int) -> Scratch:
    """Scratch arrays for a method of some stages."""
    n = layout.N_ALL
    spare = Spare(
        y=np.zeros(n),
        dy=np.zeros(n),
        rates=np.zeros((stages + 1, n)),
        y_new=np.zeros(n),
        trail=np.zeros(layout.N_PEAKS + 1),
    )
    return Scratch(rates=np.zeros((stages + 1, n)), y_new=np.zeros(n), spare=spare)
