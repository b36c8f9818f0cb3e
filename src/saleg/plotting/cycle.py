"""The last full cycle of a run in the units of the figures, and curves of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from saleg.errors import SalegError
from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label
from saleg.plotting.overlay import ALONE, Place, placed, sign
from saleg.plotting.style import (
    APART,
    COINCIDING,
    COLOURS,
    DOTTED,
    MARKERS,
    TRANSLATOR_COLOUR,
    CurveLook,
    Drawn,
    axes_or_new,
    finish,
    marker,
)
from saleg.simulation.readable import readable
from saleg.simulation.run import Run, is_orbit
from saleg.simulation.tables import HISTORY_UNITS

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes

#: Relative difference beyond which motored and actual pressure are two.
SAME_PRESSURE = 1e-6


class NoCycle(SalegError, ValueError):
    """A run without what a figure shows: a full cycle, one before it, fuel, or a closed balance."""


class Quantity(NamedTuple):
    """A column of the history as an axis shows it."""

    label: str
    column: str
    scale: float
    sided: bool = False


def of_history(name: str, *, sided: bool = False) -> Quantity:
    """A column of the history in its readable unit."""
    shown = readable(name, HISTORY_UNITS[name])
    return Quantity(axis_label(shown), name, shown.factor, sided)


#: Unlike the time of a run, that in a cycle is read in milliseconds.
TIME = Quantity(axis_label(readable("", "s", "time in the cycle")), "t", readable("", "s").factor)
POSITION = of_history("x")
VELOCITY = of_history("v")
ACCELERATION = of_history("a")
VOLUME = of_history("V", sided=True)
PRESSURE = of_history("p", sided=True)
MOTORED = of_history("p_motored", sided=True)
HEAT_FLOW = of_history("heat_loss", sided=True)
POWER = of_history("electrical_power")


@dataclass(frozen=True)
class Cycle:
    """The last full cycle of a run, left dead centre to left dead centre.

    Attributes
    ----------
    run : Run
        The run it belongs to.
    strokes : ndarray of STROKE_RECORD, shape (2,)
    history : DataFrame
        SI, one row per instant, two at an event (before and after).
    events : DataFrame
    place : Place
        Of the run among those on the same axes.
    """

    run: Run
    strokes: np.ndarray
    history: pd.DataFrame
    events: pd.DataFrame
    place: Place = ALONE

    @property
    def period(self) -> float:
        """Duration [s]."""
        return float(self.strokes["duration"].sum())

    def __call__(self, quantity: Quantity, side: str = "left") -> np.ndarray:
        """Values of a quantity in the unit of its label; time from the start of the cycle."""
        name = f"{quantity.column}_{side}" if quantity.sided else quantity.column
        values = self.history[name].to_numpy()
        if quantity is TIME:
            values = values - values[0]
        return quantity.scale * values

    @property
    def sides(self) -> tuple[str, ...]:
        """Sides with a chamber that holds gas."""
        return self.run.engine.gas_sides

    def rows_of(self, events: pd.DataFrame) -> np.ndarray:
        """Rows of the history just before events."""
        return np.searchsorted(self.history["t"].to_numpy(), events["t"].to_numpy())

    @property
    def marked(self) -> pd.DataFrame:
        """Events that are drawn as markers."""
        return self.events[self.events["event"].isin(list(MARKERS))]

    def has_motored_pressure(self) -> bool:
        """Whether the motored pressure was integrated and differs from the actual one."""
        return any(
            bool((np.abs(self(MOTORED, side) / self(PRESSURE, side) - 1.0) > SAME_PRESSURE).any())
            for side in self.sides
        )


def titled(run: Run, title: str) -> str:
    """A figure's title, with a warning if the run did not end well."""
    return title if run.status.ended_well else f"{title} (the run ended: {run.status})"


def title_of(ax: Axes, run: Run, title: str, place: Place) -> str:
    """Title of axes on which a run was drawn: that of the first; names in the legend warn too."""
    if place.number:
        return ax.get_title()
    return title if place.name else titled(run, title)


def finish_cycle(
    ax: Drawn,
    cycle: Cycle,
    title: str,
    legend: str | None,
    columns: int = 1,
    *,
    column_per_run: bool = False,
) -> Drawn:
    """Title, grid, frame and legend; the legend of runs with names covers none of their curves."""
    place = cycle.place
    if not place.alone:
        legend = "below"
        columns = min(place.columns, place.number + 1 if column_per_run else place.columns)
    sign(ax, cycle.run)
    return finish(ax, title_of(ax, cycle.run, title, place), legend, columns)


def last_cycle(run: Run) -> Cycle:
    """The last full cycle of a run.

    Raises
    ------
    NoCycle
        If there is none.
    """
    orbit = run if is_orbit(run) else run.orbit
    if orbit is None or orbit.history is None or len(orbit.strokes) < 2:
        raise NoCycle(f"nothing to draw: the run completed no full cycle ({run.message})")
    return Cycle(run, orbit.strokes, orbit.history, orbit.events)


class FigureOfRun(Protocol):
    """A figure of a run on one axes."""

    def __call__(self, run: Run, ax: Axes | None = None, *, label: str | None = None) -> ShownAxes:
        """Draw on the axes handed in, or on new ones."""


def figure_of_cycle(draw: Callable[[Cycle, ShownAxes], ShownAxes]) -> FigureOfRun:
    """Make a figure of a run from what draws its last cycle; completes the docstring."""

    def figure(run: Run, ax: Axes | None = None, *, label: str | None = None) -> ShownAxes:
        cycle, ax = last_cycle(run), axes_or_new(ax)
        with placed(ax, run, label) as place:
            return draw(replace(cycle, place=place), ax)

    figure.__module__, figure.__name__ = draw.__module__, draw.__name__
    figure.__qualname__ = draw.__qualname__
    figure.__doc__ = draw.__doc__
    return documented()(figure)


def time_axis(ax: Axes, cycle: Cycle) -> None:
    """Time over the whole cycle, from its left dead centre on."""
    end = TIME.scale * cycle.period
    ax.set_xlim(0.0, max(end, ax.get_xlim()[1]) if cycle.place.number else end)
    ax.set_xlabel(TIME.label)


def draw_sides(
    ax: Axes,
    cycle: Cycle,
    across: Quantity,
    up: Quantity,
    looks: dict[str, CurveLook] = APART,
    *,
    motored: bool = False,
) -> None:
    """Curves of both chambers with their events, and of the motored pressure if there is one."""
    place, dotted = cycle.place, motored and cycle.has_motored_pressure()
    looks = looks if place.alone else COINCIDING
    looks = {side: looks[side] for side in cycle.sides}
    for side, look in looks.items():
        x, colour = cycle(across, side), place.sides[side]
        if dotted:
            _draw_motored(ax, cycle, x, side)
        line: dict[str, Any] = {"linestyle": look.line, "linewidth": look.width}
        text = side if place.alone else place.name if side == cycle.sides[0] else f"_{place.name}"
        ax.plot(x, cycle(up, side), color=colour, label=text, **line)
    if not place.alone:
        for side, look in looks.items():
            ax.plot([], [], color="0.4", linestyle=look.line, linewidth=look.width, label=side)
    if dotted:
        ax.plot([], [], color="0.4", linestyle=DOTTED["left"], linewidth=1.8, label="motored")
    scales = {side: look.marker_scale for side, look in looks.items()}
    _mark(ax, cycle, across, up, place.sides, scales)
    ax.set_xlabel(across.label)
    ax.set_ylabel(up.label)


def draw_translator(ax: Axes, cycle: Cycle, across: Quantity, up: Quantity) -> None:
    """Curve of the translator, with the events of both chambers."""
    look: dict[str, Any] = {"color": cycle.place.colour(TRANSLATOR_COLOUR), "linewidth": 1.6}
    ax.plot(cycle(across), cycle(up), label=cycle.place.name or "_translator", **look)
    marked = set(cycle.marked["side"])
    for side in (side for side in COLOURS if side in marked):
        ax.plot([], [], color=COLOURS[side], marker="o", linestyle="none", label=side)
    _mark(ax, cycle, across, up, COLOURS, {})
    ax.set_xlabel(across.label)
    ax.set_ylabel(up.label)


def _draw_motored(ax: Axes, cycle: Cycle, x: np.ndarray, side: str) -> None:
    """Dots along both strokes from the side's dead centre on, where way in and out coincide."""
    turn = int(np.argmax(cycle(POSITION)))
    there, back = slice(None, turn + 1), slice(turn, None)
    pressure = cycle(MOTORED, side)
    for part, backward in ((there, side == "right"), (back, side == "left")):
        order = slice(None, None, -1 if backward else 1)
        ax.plot(
            x[part][order],
            pressure[part][order],
            color=cycle.place.sides[side],
            linestyle=DOTTED[side],
            linewidth=1.8,
            label=f"_motored {side}",
        )


def _mark(
    ax: Axes,
    cycle: Cycle,
    across: Quantity,
    up: Quantity,
    colours: dict[str, str],
    scales: dict[str, float],
) -> None:
    """Small markers, one shape per kind of event, in the colour (and size) of their side."""
    for kind, shape in MARKERS.items():
        of_kind = cycle.events[cycle.events["event"] == kind]
        for side, colour in colours.items():
            rows = cycle.rows_of(of_kind[of_kind["side"] == side])
            if len(rows):
                look = marker(shape, colour, scales.get(side, 1.0))
                ax.plot(cycle(across, side)[rows], cycle(up, side)[rows], **look)
        if len(of_kind):
            ax.plot([], [], **marker(shape, "0.6"), label=kind)
