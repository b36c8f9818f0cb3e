"""The one place where a sensitivity study asks for a steady state."""

from __future__ import annotations

import math

import numpy as np

from saleg.engine import Engine
from saleg.errors import InvalidEngine, StartError
from saleg.kernel import layout
from saleg.status import Status
from saleg.steady import SteadyState, steady_state

#: Tolerance of the integrator.
TOLERANCE = 1e-8


def settle(engine: Engine) -> SteadyState:
    """Steady state of an engine, or why there is none.

    Parameters
    ----------
    engine : Engine

    Returns
    -------
    SteadyState
        Always with a status; ``invalid`` if the engine cannot be run.

    Examples
    --------
    >>> import saleg
    >>> found = settle(saleg.machines.thesis_base())
    >>> is_stable(found), round(found.performance.compression_ratio, 1)
    (True, 19.7)
    """
    try:
        return steady_state(engine, rtol=TOLERANCE)
    except (InvalidEngine, StartError) as error:
        return SteadyState(
            engine=engine,
            status=Status.INVALID,
            message=str(error),
            half_cycles=0,
            evaluations=0,
            residual=math.nan,
            method="none",
            strokes=np.zeros(0, layout.STROKE_RECORD),
        )


def is_stable(found: SteadyState) -> bool:
    """Whether there is a steady state that delivers power and withstands small disturbances."""
    return found.status is Status.STEADY and found.stable
