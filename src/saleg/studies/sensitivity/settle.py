"""The one place where a sensitivity study waits for a steady state."""

from __future__ import annotations

import numpy as np

from saleg.engine import Engine
from saleg.errors import InvalidEngine, StartError
from saleg.kernel import layout
from saleg.simulation.integration import simulate
from saleg.simulation.run import Run
from saleg.status import Status

#: Times to simulate [s]; the next is tried where a run is not steady at the end of the one before.
SETTLING_TIMES = (3.0, 12.0)
#: A burn rate that jumps lets steps differ from cycle to cycle: looser, their errors hide a steady
#: state.
TOLERANCE = 1e-9
#: Cycles whose records are kept: those the verdict on a run looks at.
KEPT_CYCLES = 20


def settle(engine: Engine) -> Run:
    """Run an engine until it is steady, or for long enough to say that it will not be.

    Parameters
    ----------
    engine : Engine

    Returns
    -------
    Run
        Always with a status; ``invalid`` if the engine cannot be run.

    Examples
    --------
    >>> import saleg
    >>> run = settle(saleg.machines.thesis_base())
    >>> is_stable(run), round(run.performance.compression_ratio, 1)
    (True, 19.7)
    """
    try:
        for duration in SETTLING_TIMES:
            run = simulate(engine, duration, rtol=TOLERANCE, keep_cycles=KEPT_CYCLES)
            if run.status is not Status.COMPLETED:
                return run
    except (InvalidEngine, StartError) as error:
        return _never_ran(engine, error)
    return run


def is_stable(run: Run) -> bool:
    """Whether a run reached a steady state in which the engine delivers power."""
    return run.status is Status.STEADY


def _never_ran(engine: Engine, error: Exception) -> Run:
    """A run of no length, in place of one that cannot be made."""
    return Run(
        engine=engine,
        status=Status.INVALID,
        message=str(error),
        duration=0.0,
        strokes=np.zeros(0, layout.STROKE_RECORD),
        event_rows=np.zeros(0, layout.EVENT_RECORD),
        history_rows=None,
    )
