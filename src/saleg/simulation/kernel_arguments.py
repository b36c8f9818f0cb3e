"""Arguments of the integrator, put together in one place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.compiler.compiled_engine import CompiledEngine
from saleg.kernel import layout
from saleg.kernel.tuples import Integration, Scratch, Snapshots, Spare, Tableau, Tables, Words
from saleg.simulation.initial_state import State


def arguments_of(
    compiled: CompiledEngine,
    state: State,
    *,
    tableau: Tableau,
    order: float,
    options: np.ndarray,
    tables: Tables,
) -> Integration:
    """Arguments of the integrator for an engine.

    Parameters
    ----------
    compiled : CompiledEngine
        Kernel, laws and controller.
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

    Returns
    -------
    Integration
    """
    snapshots = _snapshots(state)
    return Integration(
        laws=compiled.parameters,
        engine=state.engine,
        chambers=state.chambers,
        y=state.y,
        peaks=state.peaks,
        tableau=tableau,
        order=order,
        options=options,
        tables=tables,
        snapshots=snapshots,
        words=_words(state, snapshots),
        scratch=_scratch(len(tableau.b)),
        control=compiled.control,
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


def _words(state: State, snapshots: Snapshots) -> Words:
    """Records as whole numbers of 8 bytes."""
    return Words(
        *(
            records.view(np.int64).reshape(*shape, -1)
            for records, shape in (
                (state.engine, (1,)),
                (state.chambers, (2,)),
                (snapshots.engine, (2,)),
                (snapshots.chambers, (2, 2)),
            )
        )
    )


def _scratch(stages: int) -> Scratch:
    """Scratch arrays for a method of some stages."""
    n = layout.N_ALL
    spare = Spare(
        y=np.zeros(n),
        dy=np.zeros(n),
        rates=np.zeros((stages + 1, n)),
        y_new=np.zeros(n),
        trail=np.zeros(layout.N_PEAKS + 1),
        slopes=np.zeros((3, layout.N_PEAKS + 1)),
    )
    return Scratch(rates=np.zeros((stages + 1, n)), y_new=np.zeros(n), spare=spare)
