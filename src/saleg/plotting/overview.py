"""Figures of several panels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from saleg.plotting.cycle import NoCycle, last_cycle
from saleg.plotting.gas import pressure_position
from saleg.plotting.style import COINCIDING, COLOURS, TRANSLATOR_COLOUR, finish, new_figure
from saleg.plotting.translator import velocity_position

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from saleg.results import Run


def dynamics(run: Run, axes: Sequence[Axes] | np.ndarray | None = None) -> np.ndarray:
    """Draw velocity and pressures over position side by side (Figure 92 of the thesis).

    Parameters
    ----------
    run : Run
    axes : sequence of two matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (2,)

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    last_cycle(run)
    panels = _panels(axes, (1, 2), 10.0, 4.2)
    legend = velocity_position(run, panels[0]).get_legend()
    if legend is not None:
        legend.remove()  # that of the pressures has it all
    pressure_position(run, panels[1])
    return panels


def approach_to_steady_state(
    run: Run, axes: Sequence[Axes] | np.ndarray | None = None
) -> np.ndarray:
    """Draw how a run settles, one point per cycle (Figure 42 of the thesis).

    Stroke [mm], dead centres as distances from the midpoint [mm], compression ratio and electrical
    power [kW] over time [s].

    Parameters
    ----------
    run : Run
    axes : sequence of four matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (4,)

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    cycles = run.cycles
    if len(cycles) == 0:
        raise NoCycle(f"nothing to draw: the run completed no full cycle ({run.message})")
    panels = _panels(axes, (2, 2), 9.0, 5.4)
    time = (cycles["t"] + cycles["period"]).to_numpy()
    grey, points = TRANSLATOR_COLOUR, {"marker": ".", "markersize": 4.0}
    stroke, centres, ratio, power = panels
    stroke.plot(time, 1e3 * cycles["stroke"].to_numpy(), color=grey, **points)
    for side, sign in (("left", -1e3), ("right", 1e3)):
        look = {**points, "linestyle": COINCIDING[side].line, "linewidth": COINCIDING[side].width}
        place = sign * cycles[f"x_{side}"].to_numpy()
        centres.plot(time, place, color=COLOURS[side], label=side, **look)
    ratio.plot(time, cycles["compression_ratio"].to_numpy(), color=grey, **points)
    power.plot(time, 1e-3 * cycles["power"].to_numpy(), color=grey, **points)
    for ax, label in (
        (stroke, "stroke [mm]"),
        (centres, "dead centres, |x| [mm]"),
        (ratio, "compression ratio [-]"),
        (power, "mean power [kW]"),
    ):
        ax.set_xlim(0.0, 1.02 * time[-1])
        ax.set_xlabel("time [s]")
        ax.set_ylabel(label)
        ax.ticklabel_format(useOffset=False)
        finish(ax, "", "best" if ax is centres else None)
    return panels


def _panels(
    axes: Sequence[Axes] | np.ndarray | None,
    shape: tuple[int, int],
    width: float,
    height: float,
) -> np.ndarray:
    """The axes handed in, or new ones, in one row of an array."""
    if axes is None:
        return new_figure(width, height).subplots(*shape, squeeze=False).ravel()
    panels = np.asarray(axes, dtype=object).ravel()
    if len(panels) != shape[0] * shape[1]:
        raise ValueError(f"this figure needs {shape[0] * shape[1]} axes, not {len(panels)}")
    return panels
