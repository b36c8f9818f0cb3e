"""Margin of ignition before the dead centre in a run, and the warning its scatter gives."""

from __future__ import annotations

import math

import numpy as np

from saleg.checks import POSITIVE, a, checked, whole
from saleg.simulation.run import Run


@checked(run=a(Run))
def ignition_margins(run: Run) -> np.ndarray:
    """Time from ignition to the dead centre that ends each stroke.

    Parameters
    ----------
    run : Run

    Returns
    -------
    ndarray, shape (strokes,)
        Margin of the charge compressed in each stroke [s]; NaN where it has not lit by then.
    """
    strokes = run.strokes
    side = np.where(strokes["direction"] < 0.0, 0, 1)
    lit = strokes["ignition_time"][np.arange(len(strokes)), side]
    return np.where(lit >= 0.0, strokes["t"] - lit, math.nan)


@checked(run=a(Run), strokes=whole(2), deviations=POSITIVE)
def misfire_warning(run: Run, *, strokes: int = 6, deviations: float = 3.0) -> float:
    """When the margin of ignition first comes as near to zero as it scatters.

    An overloaded engine does not drift into a misfire: its dead centres begin to swing, and one
    swing too many leaves a charge unlit. So the scatter of the margin warns, not its trend.

    Parameters
    ----------
    run : Run
    strokes : int
        Latest strokes whose margins count.
    deviations : float
        Standard deviations below their mean at which zero is a warning [-].

    Returns
    -------
    float
        Time of the dead centre [s], of those after as many strokes in a row have lit; NaN if there
        is none.
    """
    margins = ignition_margins(run)
    if len(margins) < strokes:
        return math.nan
    latest = np.lib.stride_tricks.sliding_window_view(margins, strokes)
    low = latest.mean(axis=1) < deviations * latest.std(axis=1)
    warned = np.flatnonzero(low)
    return float(run.strokes["t"][warned[0] + strokes - 1]) if len(warned) else math.nan
