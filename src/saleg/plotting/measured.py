"""Figures of measured traces beside a simulated cycle, and of the residuals of a calibration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.calibration import Calibration, Comparison, Trace, TraceError, comparison
from saleg.checks import a, checked
from saleg.plotting.cycle import POSITION, PRESSURE, TIME, last_cycle
from saleg.plotting.overlay import RUN_COLOURS, darker
from saleg.plotting.style import COLOURS, TRANSLATOR_COLOUR, axes_or_new, finish, zero_lines
from saleg.simulation.run import Run
from saleg.steady.state import SteadyState

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes

RESULT = a(Run, SteadyState)


@checked(trace=a(Trace), result=RESULT)
def pressures(
    trace: Trace, result: Run | SteadyState, ax: Axes | None = None, *, across: str = "time"
) -> ShownAxes:
    """Draw measured pressures [bar] as dots on those of a result, aligned in time.

    Parameters
    ----------
    trace : Trace
    result : Run or SteadyState
    ax : matplotlib.axes.Axes, optional
        Axes the result is drawn on already, such as those of ``result.plot.pressure_time()``; new
        ones with the result on them unless given.
    across : str
        What is along the axis: "time" or "position" [ms or mm].

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TraceError
        If nothing of that was measured, or the result has no full cycle.
    """
    needed = ["x"] if across == "position" else []
    sides = [side for side in COLOURS if f"p_{side}" in trace.channels]
    if across not in ("time", "position") or not sides or set(needed) - set(trace.channels):
        raise TraceError(f"no pressures over {across} in {trace!r}")
    found = comparison(trace, result)
    if ax is None:
        drawn = result.plot.pressure_time() if across == "time" else result.plot.pressure_position()
    else:
        drawn = axes_or_new(ax)
    x = _times(found, result) if across == "time" else POSITION.scale * trace["x"]
    for side in sides:
        words = f"{trace.name}, {side} ({_off(found, f'p_{side}')})"
        _dots(drawn, x, PRESSURE.scale * trace[f"p_{side}"], darker(COLOURS[side]), words)
    return finish(drawn, drawn.get_title(), "below", columns=2)


@checked(trace=a(Trace), result=RESULT)
def positions(trace: Trace, result: Run | SteadyState, ax: Axes | None = None) -> ShownAxes:
    """Draw the measured position [mm] as dots on that of a result over time [ms].

    Parameters
    ----------
    trace : Trace
    result : Run or SteadyState
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TraceError
        If no position was measured, or the result has no full cycle.
    """
    if "x" not in trace.channels:
        raise TraceError(f"no position in {trace!r}")
    found = comparison(trace, result)
    cycle = last_cycle(_run(result))
    ax = axes_or_new(ax)
    ax.plot(cycle(TIME), cycle(POSITION), color=TRANSLATOR_COLOUR, linewidth=1.6, label="simulated")
    words = f"{trace.name} ({_off(found, 'x')})"
    _dots(ax, _times(found, result), POSITION.scale * trace["x"], RUN_COLOURS[0], words)
    ax.set_xlabel(TIME.label)
    ax.set_ylabel(POSITION.label)
    return finish(ax, f"{result.engine.name}: position and time", "below", columns=2)


@checked(found=a(Calibration))
def residuals(found: Calibration, ax: Axes | None = None) -> ShownAxes:
    """Draw the residuals of a calibration [-], in order, between two standard deviations.

    Parameters
    ----------
    found : Calibration
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = axes_or_new(ax, 7.2, 4.2)
    zero_lines(ax, y=True)
    ax.axhspan(-2.0, 2.0, color="0.94", zorder=-1)
    before = 0
    for place, (name, values) in enumerate(found.residuals.items()):
        at = before + np.arange(len(values))
        colour = RUN_COLOURS[place % len(RUN_COLOURS)]
        look: dict[str, Any] = {
            "linestyle": "none",
            "color": colour,
            "label": name.replace("_", " "),
        }
        ax.plot(at, values, marker="." if len(values) > 1 else "o", markersize=4.0, **look)
        before += len(values)
    ax.set_xlabel("number of the residual [-]")
    ax.set_ylabel("simulated less measured, in standard deviations [-]")
    title = f"{found.engine.name}: residuals, scatter {found.scatter:.3g}"
    return finish(ax, title, "below", columns=3)


def _run(result: Run | SteadyState) -> Run:
    """The run whose last cycle is drawn."""
    if isinstance(result, Run):
        return result
    if result.orbit is None:
        raise TraceError(f"no full cycle to compare with: {result.message}")
    return result.orbit


def _times(found: Comparison, result: Run | SteadyState) -> np.ndarray:
    """Times of a trace in the simulated cycle, in the unit of the axis."""
    period = last_cycle(_run(result)).period
    return TIME.scale * np.mod(found.trace.t - found.shift, period)


def _off(found: Comparison, channel: str) -> str:
    return f"RMS difference {100.0 * found.relative[channel]:.2g} % of its range"


def _dots(ax: Axes, x: np.ndarray, y: np.ndarray, colour: str, words: str) -> None:
    look: dict[str, Any] = {"marker": ".", "markersize": 4.0, "linestyle": "none", "zorder": 3}
    ax.plot(x, y, color=colour, label=words, **look)
