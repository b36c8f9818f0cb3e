"""The same engine through ``scipy.integrate.solve_ivp``: an independent check of the integrator.

Laws, starts and results are shared; equations, events, switching, masses and energies are written
once more, in pressure instead of the integrator's own variables (in energy and masses where a
chamber breathes), with no other aim than to be plain. See :func:`simulate`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.engine import Engine, check_engine, warn_of_unusual
from saleg.errors import shown
from saleg.kernel import layout
from saleg.kernel.plain_rhs import VELOCITY
from saleg.quantities import as_float
from saleg.reference.running_engine import RunningEngine
from saleg.reference.segments import (
    Solver,
    SolverFailure,
    Tally,
    advance,
    jitted_rates,
    natural_speed,
    plain_rates,
    scales,
)
from saleg.simulation.initial_state import State
from saleg.simulation.outcome import outcome_of
from saleg.simulation.run import Run
from saleg.simulation.settings import SettingsError, check_flag

__all__ = ["simulate"]

#: Segments without progress in time after which a run is given up.
MAX_AT_ONE_INSTANT = 20


def simulate(
    engine: Engine,
    duration: float,
    *,
    solver: Any = "DOP853",
    rtol: float = 1e-10,
    jitted: bool = False,
    motored_pressure: bool = False,
    stall_stroke: float = 0.01,
) -> Run:
    """Simulate an engine for some time from its start, with a solver of scipy.

    Parameters
    ----------
    engine : Engine
    duration : float
        Time to simulate [s].
    solver : str or OdeSolver class
        Method of ``solve_ivp``: "DOP853", "RK45", "Radau", "LSODA", "BDF". The explicit ones suit
        best; a multistep method loses its order at each of some hundred restarts a second and
        comes to about a hundred times its tolerance (LSODA), or a thousand (BDF).
    rtol : float
        Relative tolerance [-]; the absolute one of each component is this times its natural size.
    jitted : bool
        Compile the right-hand side; it is the same source.
    motored_pressure : bool
        Integrate the motored pressure as well.
    stall_stroke : float
        End the run as stalled when a stroke is shorter than this share of the maximum stroke [-].

    Returns
    -------
    Run
        Without a history.

    Raises
    ------
    InvalidEngine
        Naming every wrong field of the engine.
    SettingsError
        If a setting makes no sense.

    Examples
    --------
    >>> import saleg
    >>> from saleg import reference
    >>> engine = saleg.machines.thesis_base()
    >>> again, run = reference.simulate(engine, 0.1, jitted=True), saleg.simulate(engine, 0.1)
    >>> abs(again.performance.power / run.performance.power - 1.0) < 1e-5
    True
    """
    check_engine(engine)
    warn_of_unusual(engine)
    rtol, stall_stroke, duration = _checked(solver, rtol, stall_stroke, duration)
    check_flag("jitted", jitted)
    check_flag("motored_pressure", motored_pressure)
    running = RunningEngine.started(engine, motored_pressure or engine.needs_motored_pressure)
    speed = natural_speed(running)
    method = Solver(
        method=solver,
        rtol=rtol,
        atol=rtol * scales(running, speed),
        natural_time=0.5 * engine.maximum_stroke / speed,
        rates=jitted_rates(engine) if jitted else plain_rates(engine),
    )
    tally, trouble = Tally(), ""
    try:
        code = _run_on(running, duration, method, tally, stall_stroke)
    except SolverFailure as failure:
        code, trouble = layout.STEP_FAILURE, f" ({failure})"
    strokes = _rows(running.strokes, layout.STROKE_RECORD)
    status, message = outcome_of(engine, code, _final_state(running), strokes)
    return Run(
        engine=engine,
        status=status,
        message=message + trouble,
        duration=running.t,
        strokes=strokes,
        event_rows=np.array(running.events, layout.EVENT_RECORD),
        history_rows=None,
        evaluations=tally.evaluations,
        steps=tally.steps,
        settings={"method": getattr(solver, "__name__", solver), "rtol": rtol, "jitted": jitted},
    )


def _checked(solver: Any, *numbers: Any) -> list[float]:
    """Tolerance, stall stroke and duration as floats; refused, as the solver, if they are none."""
    from scipy.integrate import OdeSolver

    known = ("DOP853", "RK45", "RK23", "Radau", "LSODA", "BDF")
    made = isinstance(solver, type) and issubclass(solver, OdeSolver)
    if not made and not (isinstance(solver, str) and solver in known):
        raise SettingsError(
            f"solver = {shown(solver)}: must be one of {', '.join(known)}, or a class"
        )
    found = []
    limits = (("rtol", 1e-14, 1.0), ("stall_stroke", 0.0, 1.0), ("duration", 0.0, math.inf))
    for value, (name, low, high) in zip(numbers, limits, strict=True):
        number = as_float(value)
        if number is None or not low <= number < high:
            raise SettingsError(
                f"{name} = {shown(value)}: must be a number >= {low:g} and < {high:g}"
            )
        found.append(number)
    return found


def _run_on(
    running: RunningEngine, duration: float, solver: Solver, tally: Tally, stall_stroke: float
) -> int:
    """Go from event to event; returns why it stopped, as a code of the layout."""
    running.change_chambers()
    idle = 0
    while running.t < duration:
        before = running.t
        event = advance(running, duration, solver, tally)
        idle = 0 if running.t > before else idle + 1
        if idle > MAX_AT_ONE_INSTANT:
            raise SolverFailure("no progress in time")
        if running.machine.direction == 0.0:
            running.machine.direction = float(np.sign(running.y[VELOCITY]))
        running.change_chambers()
        if event is None:
            continue
        if event.kind == "head":
            running.record(layout.EVENT_HEAD_CONTACT, event.side)
            return layout.HEAD_CONTACT
        if event.kind == "dead centre":
            running.turn()
            running.change_chambers()
            shortest = stall_stroke * running.engine.maximum_stroke
            held = running.machine.stroke == 0.0
            if held or (running.strokes and running.machine.stroke < shortest):
                return layout.STALLED
    return layout.END_OF_TIME


def _rows(rows: list[np.ndarray], dtype: np.dtype) -> np.ndarray:
    return np.concatenate(rows) if rows else np.zeros(0, dtype)


def _final_state(running: RunningEngine) -> State:
    """State at the end of a run, in the records its outcome is read from."""
    E = np.zeros(1, layout.ENGINE_RECORD)
    E["t"], E["stroke"] = running.t, running.machine.stroke
    E["maximum_stroke"] = running.engine.maximum_stroke
    E["direction"], E["t_dead_centre"] = running.machine.direction, running.t_dead_centre
    E["length_scale"] = 0.5 * running.engine.maximum_stroke
    E["speed_scale"] = natural_speed(running)
    y = np.zeros(layout.N_ALL)
    y[: len(running.y)] = running.y
    return State(E, np.zeros(2, layout.CHAMBER_RECORD), y, running.peaks)
