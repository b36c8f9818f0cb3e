"""Curves of a controlled run over time, and what its figures share."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.control.moments import first_misfire, fuel_cuts, late_ignitions, motored_times
from saleg.plotting.cycle import NoCycle, title_of
from saleg.plotting.labels import TIME, label, values
from saleg.plotting.overlay import ALONE, Place, sign
from saleg.plotting.style import (
    ALTERNATOR_COLOUR,
    COINCIDING,
    COLOURS,
    MARKERS,
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    finish,
    legend_below,
    marker,
    zero_lines,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels
    from saleg.simulation.run import Run

#: What is commanded, and holds from one dead centre to the next; all else is measured there.
COMMANDS = ("motor_frequency", "load_weight", "equivalence_ratio", "intake_temperature")
MOTOR_COLOUR = "#AA4499"
#: Colours of what belongs to neither the translator nor a side.
CURVES = {
    "power": ALTERNATOR_COLOUR,
    "load_weight": ALTERNATOR_COLOUR,
    "motor_frequency": MOTOR_COLOUR,
    "equivalence_ratio": RIGHT_COLOUR,
    "intake_temperature": RIGHT_COLOUR,
}
#: These are read by their change, so their axis does not begin at zero.
NOT_FROM_ZERO = ("frequency", "motor_frequency", "intake_temperature")
#: What is beyond this many times the 95th percentile of a curve has run away.
RUNS_AWAY = 3.0
#: A compression ratio beyond the first is that of a piston about to hit the head; the axis then
#: ends at the second.
MAX_RATIO = 100.0, 40.0


def check(run: Run) -> None:
    """Raise a :class:`NoCycle` if the run completed no full cycle."""
    if len(run.cycles) == 0:
        raise NoCycle(f"nothing to draw: the run completed no full cycle ({run.message})")


def draw(ax: Axes, run: Run, name: str, place: Place = ALONE, **look: Any) -> None:
    """A column of the dead centres over time, on an axis that what runs away does not stretch."""
    table = run.dead_centres
    time, drawn = table["t"].to_numpy(), values(table, name)
    if name == "motor_frequency":
        drawn = np.where(table["motoring"], drawn, np.nan)
    line: dict[str, Any] = {"drawstyle": "steps-pre"} if name in COMMANDS else {}
    colour = place.colour(CURVES.get(name, TRANSLATOR_COLOUR))
    chosen = {"color": colour, "linewidth": 1.4, "label": place.name or f"_{name}"}
    ax.plot(time, drawn, **line, **{**chosen, **look})
    ax.set_ylabel(label(table, name))
    low, high = ax.get_ylim()
    _limit(ax, name, time, drawn)
    if place.number:
        ax.set_ylim(min(low, ax.get_ylim()[0]), max(high, ax.get_ylim()[1]))


def draw_peaks(ax: Axes, run: Run, name: str, text: str, place: Place = ALONE) -> None:
    """Peaks of either cylinder in every cycle."""
    cycles = run.cycles
    time = (cycles["t"] + cycles["period"]).to_numpy()
    for side, colour in place.sides.items():
        column, look = f"{name}_{side}", COINCIDING[side]
        line: dict[str, Any] = {"linestyle": look.line, "linewidth": look.width, "color": colour}
        ax.plot(time, values(cycles, column), label=place.text(side), **line)
    ax.set_ylabel(label(cycles, f"{name}_left", text))
    both = [values(cycles, f"{name}_{side}") for side in COLOURS]
    top = ax.get_ylim()[1]
    _limit(ax, name, time, np.maximum(*both))
    if place.number:
        ax.set_ylim(top=max(top, ax.get_ylim()[1]))


def _limit(ax: Axes, name: str, time: np.ndarray, drawn: np.ndarray) -> None:
    """An upward axis around all that is drawn, except what runs away: a note says how far."""
    known = drawn[np.isfinite(drawn)]
    if not len(known):
        ax.set_ylim(0.0, 1.0)
        return
    top, bottom = float(known.max()), float(known.min())
    limit, end = _bounds(name, known)
    if top > limit > 0.0:
        at = int(np.nanargmax(drawn > end))
        note: dict[str, Any] = {"ha": "right", "va": "top", "fontsize": "small"}
        where, text = ax.get_xaxis_transform(), f"up to {top:.3g} \N{UPWARDS ARROW} "
        ax.text(time[at], 0.97, text, transform=where, color=RIGHT_COLOUR, **note)
        top = end
    if name not in NOT_FROM_ZERO:
        bottom = min(max(bottom, -limit), 0.0)
    room = max(0.06 * (top - bottom), 0.01 * abs(top)) or 0.5
    ax.set_ylim(bottom - room * (bottom != 0.0), top + room)


def _bounds(name: str, known: np.ndarray) -> tuple[float, float]:
    """Value beyond which a curve has run away, and end of the axis if it has."""
    if name == "compression_ratio":
        return MAX_RATIO
    usual = float(np.percentile(np.abs(known), 95.0))
    return RUNS_AWAY * usual, 1.5 * usual


def draw_moments(panels: Iterable[Axes], run: Run) -> None:
    """Stretches with motor and without fuel, the first misfire, and late ignitions."""
    missed, late = first_misfire(run), late_ignitions(run)
    for number, panel in enumerate(panels):
        for begin, end in motored_times(run):
            panel.axvspan(begin, end, color=MOTOR_COLOUR, alpha=0.2, lw=0.8, label="motored")
        for begin, end in fuel_cuts(run):
            panel.axvspan(begin, end, color="0.3", alpha=0.25, lw=0.8, label="without fuel")
        if not np.isnan(missed):
            panel.axvline(missed, color=RIGHT_COLOUR, linestyle=":", label="first misfire")
        if len(late) and number == 0:
            table = run.dead_centres
            ratio = np.interp(late, table["t"], table["compression_ratio"])
            panel.plot(
                late, ratio, **marker(MARKERS["ignition"], RIGHT_COLOUR), label="late ignition"
            )


def finished(
    panels: Panels,
    run: Run,
    title: str,
    columns: int = 1,
    legend_on: Axes | None = None,
    place: Place = ALONE,
) -> Panels:
    """Titles, grids, time axis and legend of all panels."""
    first = title_of(panels[0], run, title, place)
    for panel in panels:
        finish(panel, "", None)
        zero_lines(panel, y=True)
        panel.set_xlim(0.0, max(run.duration, panel.get_xlim()[1] * (place.number > 0)))
        panel.yaxis.set_label_coords(-0.11 if columns == 2 else -0.1, 0.5)
        spec = panel.get_subplotspec()
        if spec is None or spec.is_last_row():
            panel.set_xlabel(TIME)
    panels[0].set_title(first, fontsize="medium")
    sign(panels[0], run)
    if legend_on is not None:
        legend_on.legend(fontsize="small", loc="lower right", edgecolor="none")
    else:
        legend_below(panels)
    return panels
