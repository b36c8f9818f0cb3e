"""Simulation of an engine over a stretch of time."""

from __future__ import annotations

from saleg.engine import Engine, check_engine, warn_of_unusual
from saleg.simulation.course import Course
from saleg.simulation.initial_state import State, prepare
from saleg.simulation.run import Run
from saleg.simulation.settings import Settings


def simulate(
    engine: Engine,
    duration: float,
    *,
    method: str = "adaptive",
    order: int = 4,
    step: float | None = None,
    rtol: float = 1e-8,
    history: int | None = None,
    motored_pressure: bool = False,
    stall_stroke: float = 0.01,
    keep_cycles: int | None = None,
) -> Run:
    """Simulate an engine for some time from its start.

    Parameters
    ----------
    engine : Engine
    duration : float
        Time to simulate [s].
    method : {"adaptive", "fixed"}
        Adaptive Dormand-Prince 5(4) pair, or a fixed step on a grid. Both end steps exactly on
        events.
    order : {1, 2, 3, 4, 5, 8}
        Order of the fixed-step method; the adaptive one has its own.
    step : float, optional
        Fixed step [s]; 5 microseconds unless given. Giving one asks for ``method="fixed"``.
    rtol : float
        Tolerance of the adaptive method [-], from 1e-14 to 1e-2, relative to stroke, natural speed
        and pressure; a fixed step has none.
    history : int, optional
        Keep every n-th step in :attr:`Run.history`, events always; nothing unless given.
    motored_pressure : bool
        Integrate the motored pressure as well.
    stall_stroke : float
        End the run as stalled when a stroke is shorter than this share of the maximum stroke
        [-]; 0 never does.
    keep_cycles : int, optional
        Keep the records of only about the last so many cycles, at least eleven; all unless given.

    Returns
    -------
    Run
        Always with a status and a message.

    Raises
    ------
    InvalidEngine
        Naming every wrong field of the engine.
    SettingsError
        If a setting makes no sense.

    Examples
    --------
    >>> import saleg
    >>> run = saleg.simulate(saleg.machines.thesis_base(), 0.5)
    >>> round(run.performance.frequency, 1)
    47.0
    """
    settings = Settings(
        duration,
        method=method,
        order=order,
        step=step,
        rtol=rtol,
        history=history,
        motored_pressure=motored_pressure,
        stall_stroke=stall_stroke,
        keep_cycles=keep_cycles,
    ).checked()
    check_engine(engine)
    warn_of_unusual(engine)
    return integrate(engine, prepare(engine), settings)


def integrate(engine: Engine, state: State, settings: Settings) -> Run:
    """Integrate from a state; the engine is taken to be valid."""
    return Course(engine, state, settings).finish()
