"""The same engine through ``scipy.integrate.solve_ivp``: an independent check of the integrator.

Laws, starts and results are shared; equations, events, switching, masses and energies are written
once more, in pressure instead of the integrator's own variables (in energy and masses where a
chamber breathes), with no other aim than to be plain. See :func:`simulate`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.engine import Engine, check_engine, warn_of_unusual
from saleg.errors import shown
from saleg.kernel import layout
from saleg.kernel.plain_rhs import VELOCITY
from saleg.reference.one_frame import Together, simulate_on_one_frame
from saleg.reference.running_engine import RunningEngine
from saleg.reference.runs import checked_settings, run_of
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
from saleg.simulation.run import Run
from saleg.simulation.settings import SettingsError, check_flag

__all__ = ["Together", "simulate", "simulate_on_one_frame"]

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
    _check_solver(solver)
    rtol, stall_stroke, duration = checked_settings(
        rtol=rtol, stall_stroke=stall_stroke, duration=duration
    )
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
    settings = {"method": getattr(solver, "__name__", solver), "rtol": rtol, "jitted": jitted}
    return run_of(running, code, trouble, tally, settings)


def _check_solver(solver: Any) -> None:
    """Refuse what is no solver of scipy's."""
    from scipy.integrate import OdeSolver

    known = ("DOP853", "RK45", "RK23", "Radau", "LSODA", "BDF")
    made = isinstance(solver, type) and issubclass(solver, OdeSolver)
    if not made and not (isinstance(solver, str) and solver in known):
        raise SettingsError(
            f"solver = {shown(solver)}: must be one of {', '.join(known)}, or a class"
        )


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
