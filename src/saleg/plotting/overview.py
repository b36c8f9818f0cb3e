"""Figures of several panels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.plotting.cycle import NoCycle, last_cycle, title_of
from saleg.plotting.docstrings import documented
from saleg.plotting.gas import pressure_position
from saleg.plotting.labels import label as label_of
from saleg.plotting.labels import values
from saleg.plotting.overlay import Place, placed, runs_on, sign
from saleg.plotting.style import (
    COINCIDING,
    TRANSLATOR_COLOUR,
    finish,
    legend_below,
    panels_or_new,
)
from saleg.plotting.translator import velocity_position
from saleg.simulation.run import Run, is_orbit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels


#: Least relative height of an axis of :func:`approach_to_steady_state`: what varies less is steady.
MIN_SPAN = 1e-4
#: Relative distance from its last value within which a course is settled; cycles shown at least.
SETTLED, FEWEST = 1e-3, 10


@documented(axes=2)
def dynamics(
    run: Run, ax: Sequence[Axes] | np.ndarray | None = None, *, label: str | None = None
) -> Panels:
    """Draw velocity and pressures over position side by side (Figure 92 of the thesis)."""
    last_cycle(run)
    panels = panels_or_new(ax, (1, 2), 10.0, 4.2)
    velocity_position(run, panels[0], label=label)
    pressure_position(run, panels[1], label=label)
    compared = label or runs_on(panels[1]) > 1
    for panel in panels if compared else panels[:1]:
        if panel.get_legend() is not None:
            panel.get_legend().remove()  # that of the pressures has it all
    if compared:
        legend_below(panels[1:], columns=6)
    return panels


@documented(axes=4)
def approach_to_steady_state(
    run: Run, ax: Sequence[Axes] | np.ndarray | None = None, *, label: str | None = None
) -> Panels:
    """Draw how a run settles, one point per cycle (Figure 42 of the thesis).

    Stroke [mm], dead centres as distances from the midpoint [mm], compression ratio and electrical
    power [kW] over time [s]. What varies by less than 1e-4 of itself looks constant; what comes
    once all is settled is left out.
    """
    cycles = run.cycles
    if is_orbit(run):
        raise NoCycle("a steady state has no approach to draw: simulate the engine")
    if len(cycles) == 0:
        raise NoCycle(f"nothing to draw: the run completed no full cycle ({run.message})")
    panels = panels_or_new(ax, (2, 2), 9.0, 5.4)
    with placed(panels[0], run, label) as place:
        _draw_cycles(panels, run, place)
    stroke, centres, *_ = panels
    title = title_of(stroke, run, "Approach to steady state", place)
    for panel in panels:
        finish(panel, "", "best" if panel is centres and place.alone else None)
    if not place.alone:
        legend_below(panels)
    stroke.set_title(title, fontsize="medium")
    sign(stroke, run)
    return panels


def _draw_cycles(panels: Panels, run: Run, place: Place) -> None:
    """Stroke, dead centres, compression ratio and power of every cycle over time."""
    cycles = run.cycles
    time = (cycles["t"] + cycles["period"]).to_numpy()
    stroke, centres, ratio, power = panels
    points: dict[str, Any] = {"marker": ".", "markersize": 4.0}
    line = {**points, "color": place.colour(TRANSLATOR_COLOUR), "label": place.name or "_cycles"}
    stroke.plot(time, values(cycles, "stroke"), **line)
    for side, way in (("left", -1.0), ("right", 1.0)):
        look = {**points, "linestyle": COINCIDING[side].line, "linewidth": COINCIDING[side].width}
        distance = way * values(cycles, f"x_{side}")
        centres.plot(time, distance, color=place.sides[side], label=place.text(side), **look)
    ratio.plot(time, cycles["compression_ratio"].to_numpy(), **line)
    power.plot(time, values(cycles, "power"), **line)
    for panel, name, words in (
        (stroke, "stroke", ""),
        (centres, "x_right", "dead centres, |x|"),
        (ratio, "compression_ratio", ""),
        (power, "power", "mean power"),
    ):
        start, end = float(cycles["t"].iloc[0]), settled_time(run)
        if place.number:
            start, end = min(start, panel.get_xlim()[0]), max(end, panel.get_xlim()[1])
        panel.set_xlim(start, end + 0.02 * (end - start) * (place.number == 0))
        panel.set_xlabel(label_of(cycles, "t"))
        panel.set_ylabel(label_of(cycles, name, words))
        _readable(panel)


def settled_time(run: Run) -> float:
    """Time up to which the cycles of a run are shown: twice as long as it takes to settle [s]."""
    last = 0
    for name in ("stroke", "x_left", "x_right", "compression_ratio", "power"):
        course = run.cycles[name].to_numpy()
        off = np.flatnonzero(np.abs(course - course[-1]) > SETTLED * abs(course[-1]))
        last = max(last, int(off[-1]) + 1 if len(off) else 0)
    end = run.cycles.iloc[min(max(2 * last, FEWEST), len(run.cycles) - 1)]
    return float(end["t"] + end["period"])


def _readable(ax: Axes) -> None:
    """Few ticks with plain numbers, and a height that does not magnify rounding."""
    low, high = ax.get_ylim()
    spare = 0.5 * (MIN_SPAN * max(abs(low), abs(high)) - (high - low))
    if spare > 0.0:
        ax.set_ylim(low - spare, high + spare)
    ax.locator_params(nbins=5)
    ax.ticklabel_format(useOffset=False)
