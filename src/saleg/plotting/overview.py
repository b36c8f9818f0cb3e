"""Figures of several panels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from saleg.plotting.cycle import NoCycle, last_cycle, titled
from saleg.plotting.docstrings import documented
from saleg.plotting.gas import pressure_position
from saleg.plotting.labels import label, values
from saleg.plotting.style import (
    COINCIDING,
    COLOURS,
    TRANSLATOR_COLOUR,
    finish,
    panels_or_new,
)
from saleg.plotting.translator import velocity_position

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels
    from saleg.simulation.run import Run


#: Least relative height of an axis of :func:`approach_to_steady_state`: what varies less is steady.
MIN_SPAN = 1e-4


@documented(axes=2)
def dynamics(run: Run, ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw velocity and pressures over position side by side (Figure 92 of the thesis)."""
    last_cycle(run)
    panels = panels_or_new(ax, (1, 2), 10.0, 4.2)
    legend = velocity_position(run, panels[0]).get_legend()
    if legend is not None:
        legend.remove()  # that of the pressures has it all
    pressure_position(run, panels[1])
    return panels


@documented(axes=4)
def approach_to_steady_state(run: Run, ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw how a run settles, one point per cycle (Figure 42 of the thesis).

    Stroke [mm], dead centres as distances from the midpoint [mm], compression ratio and electrical
    power [kW] over time [s]. What varies by less than 1e-4 of itself looks constant.
    """
    cycles = run.cycles
    if len(cycles) == 0:
        raise NoCycle(f"nothing to draw: the run completed no full cycle ({run.message})")
    panels = panels_or_new(ax, (2, 2), 9.0, 5.4)
    time = (cycles["t"] + cycles["period"]).to_numpy()
    grey, points = TRANSLATOR_COLOUR, {"marker": ".", "markersize": 4.0}
    stroke, centres, ratio, power = panels
    stroke.plot(time, values(cycles, "stroke"), color=grey, **points)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        look = {**points, "linestyle": COINCIDING[side].line, "linewidth": COINCIDING[side].width}
        place = sign * values(cycles, f"x_{side}")
        centres.plot(time, place, color=COLOURS[side], label=side, **look)
    ratio.plot(time, cycles["compression_ratio"].to_numpy(), color=grey, **points)
    power.plot(time, values(cycles, "power"), color=grey, **points)
    for panel, name, words in (
        (stroke, "stroke", ""),
        (centres, "x_right", "dead centres, |x|"),
        (ratio, "compression_ratio", ""),
        (power, "power", "mean power"),
    ):
        start = float(cycles["t"].iloc[0])
        panel.set_xlim(start, time[-1] + 0.02 * (time[-1] - start))
        panel.set_xlabel(label(cycles, "t"))
        panel.set_ylabel(label(cycles, name, words))
        _readable(panel)
        finish(panel, "", "best" if panel is centres else None)
    stroke.set_title(titled(run, "Approach to steady state"), fontsize="medium")
    return panels


def _readable(ax: Axes) -> None:
    """Few ticks with plain numbers, and a height that does not magnify rounding."""
    low, high = ax.get_ylim()
    spare = 0.5 * (MIN_SPAN * max(abs(low), abs(high)) - (high - low))
    if spare > 0.0:
        ax.set_ylim(low - spare, high + spare)
    ax.locator_params(nbins=5)
    ax.ticklabel_format(useOffset=False)
