"""Figures of controlled runs over time (97 to 100, 102, 103, 106 to 108)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.control.demand import Demand
from saleg.control.running import fired_at
from saleg.plotting.control.curves import (
    COMMANDS,
    check,
    draw,
    draw_moments,
    draw_peaks,
    finished,
)
from saleg.plotting.docstrings import documented
from saleg.plotting.labels import TIME
from saleg.plotting.overlay import placed
from saleg.plotting.style import (
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    axes_or_new,
    finish,
    marker,
    new_figure,
    panels_or_new,
)
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels, ShownAxes
    from saleg.simulation.run import Run

#: Relative change below which a command counts as constant.
CONSTANT = 1e-3


@documented(axes=6)
def start_up(
    run: Run, ax: Sequence[Axes] | np.ndarray | None = None, *, label: str | None = None
) -> Panels:
    """Draw commands, and what the cylinders answer, during a start-up (Figure 97).

    Motor frequency [Hz], load weight [-] and equivalence ratio [-]; peak pressures [bar], peak
    temperatures [K] and compression ratio [-], over time [s].
    """
    check(run)
    panels = panels_or_new(ax, (3, 2), 10.0, 6.0, sharex=True)
    with placed(panels[0], run, label) as place:
        for panel, name in zip(panels[::2], COMMANDS[:3], strict=True):
            draw(panel, run, name, place)
        draw_peaks(panels[1], run, "peak_pressure", "peak pressure", place)
        draw_peaks(panels[3], run, "peak_temperature", "peak temperature", place)
        draw(panels[5], run, "compression_ratio", place)
    return finished(panels, run, "Start-up", columns=2, place=place)


@documented(axes=2)
def approach(
    run: Run, ax: Sequence[Axes] | np.ndarray | None = None, *, label: str | None = None
) -> Panels:
    """Draw how compression ratio [-] and stroke [mm] grow until the engine is fired (Figure 98)."""
    check(run)
    panels = panels_or_new(ax, (2, 1), 6.8, 5.2, sharex=True)
    at = fired_at(run)
    with placed(panels[0], run, label) as place:
        colour, text = place.colour(RIGHT_COLOUR), place.text(f"fired at {at:.2f} s")
        for panel, name in zip(panels, ("compression_ratio", "stroke"), strict=True):
            draw(panel, run, name, place)
            if not np.isnan(at):
                panel.axvline(at, color=colour, linestyle="--", label=text)
    return finished(panels, run, "Start-up", place=place)


@documented()
def start_ups(runs: Mapping[float, Run], ax: Axes | None = None) -> ShownAxes:
    """Draw the compression ratio [-] over time [s] for several base frequencies (Figure 99).

    Parameters
    ----------
    runs : mapping of float to Run
        Runs by the base frequency of the motor [Hz].

    Raises
    ------
    NoCycle
        If one of the runs completed no full cycle.
    """
    from matplotlib import colormaps

    ax = axes_or_new(ax, 7.6, 4.8)
    ordered = sorted(runs.items())
    unfired: list[tuple[str, Any]] = []
    for colour, (frequency, run) in zip(
        colormaps["plasma"](np.linspace(0.0, 0.75, len(ordered))), ordered, strict=True
    ):
        check(run)
        draw(ax, run, "compression_ratio", color=colour, label=f"{frequency:g} Hz")
        if np.isnan(fired_at(run)):
            unfired.append((f"{frequency:g} Hz: never fired", colour))
        else:
            _name_start_up(ax, run, frequency, colour)
    for row, (text, colour) in enumerate(unfired):
        place: dict[str, Any] = {"xy": (1.0, 0.09 + 0.05 * row), "xycoords": "axes fraction"}
        ax.annotate(text, **place, ha="right", color=colour, fontsize="small")
    ax.set_xlim(0.0, max(run.duration for run in runs.values()))
    ax.set_xlabel(TIME)
    ax.set_ylim(0.0, 1.15 * ax.dataLim.ymax)
    return finish(ax, "Start-ups from several base frequencies", None)


@documented(axes=5)
def demand(run: Run, wanted: Demand, ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw how an engine follows a demand (Figures 100, 102, 103).

    On the left power and demand [kW] and load weight [-], on the right compression ratio [-],
    frequency [Hz] and the intake temperature [K] or equivalence ratio [-], whichever is varied, or
    the stroke [mm] if none is. A value that runs away leaves the axes, and a note says how far.

    Parameters
    ----------
    wanted : Demand
    ax : array of five matplotlib.axes.Axes, optional
        Power, load weight, then those on the right; new ones unless given.
    """
    check(run)
    panels = _demand_panels() if ax is None else panels_or_new(ax, (5, 1), 0.0, 0.0)
    names = ("power", "load_weight", "compression_ratio", "frequency", _varied(run))
    for panel, name in zip(panels, names, strict=True):
        draw(panel, run, name)
    times = [0.0, *wanted.times, max(run.duration, wanted.times[-1])]
    powers = readable("power", "W").of(
        np.array([wanted.powers[0], *wanted.powers, wanted.powers[-1]])
    )
    look: dict[str, Any] = {"color": TRANSLATOR_COLOUR, "linestyle": "--", "linewidth": 1.2}
    panels[0].plot(times, powers, label="demand", **look)
    return finished(panels, run, "Demand for power", legend_on=panels[0])


@documented(axes=4)
def duty_cycle(
    run: Run,
    ax: Sequence[Axes] | np.ndarray | None = None,
    *,
    gas: bool = False,
    window: tuple[float, float] | None = None,
    label: str | None = None,
) -> Panels:
    """Draw a duty cycle: start-up, operation and what disturbs it (Figures 106 to 108).

    Compression ratio [-], stroke [mm], frequency [Hz] and power [kW] over time [s], with the
    strokes that were motored or without fuel, the first misfire and late ignitions marked.

    Parameters
    ----------
    ax : array of four or six matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.
    gas : bool
        Whether peak pressure [bar] and peak temperature [K] of every cycle are drawn too, as in
        Figure 107.
    window : (float, float), optional
        Begin and end of the time shown [s]; the whole run unless given.

    Returns
    -------
    Panels
        Of four or six axes.
    """
    check(run)
    rows = 3 if gas else 2
    panels = panels_or_new(ax, (rows, 2), 10.0, 2.1 * rows + 0.8, sharex=True)
    names = ("compression_ratio", "stroke", "frequency", "power")
    with placed(panels[0], run, label) as place:
        for panel, name in zip(panels, names, strict=False):
            draw(panel, run, name, place)
        if gas:
            draw_peaks(panels[4], run, "peak_pressure", "peak pressure", place)
            draw_peaks(panels[5], run, "peak_temperature", "peak temperature", place)
    if place.number == 0:
        draw_moments(panels, run)
    finished(panels, run, "Duty cycle", columns=2, place=place)
    if window is not None:
        for panel in panels:
            panel.set_xlim(*window)
    return panels


@documented(axes=8)
def controlled(
    run: Run, ax: Sequence[Axes] | np.ndarray | None = None, *, label: str | None = None
) -> Panels:
    """Draw what a run did over time [s], on the left, and what was commanded, on the right.

    Compression ratio [-], stroke [mm], frequency [Hz] and power [kW]; motor frequency [Hz], load
    weight [-], equivalence ratio [-] and intake temperature [K]. Of several runs on the same axes
    the first shows when it was motored and what disturbed it.
    """
    check(run)
    panels = panels_or_new(ax, (4, 2), 10.0, 7.8, sharex=True)
    measured = ("compression_ratio", "stroke", "frequency", "power")
    with placed(panels[0], run, label) as place:
        for panels_of, names in ((panels[::2], measured), (panels[1::2], COMMANDS)):
            for panel, name in zip(panels_of, names, strict=True):
                draw(panel, run, name, place)
    if place.number == 0:
        draw_moments(panels, run)
    title = "Under control" if _is_commanded(run) else "Operation, and what was commanded"
    return finished(panels, run, title, columns=2, place=place)


def _is_commanded(run: Run) -> bool:
    """Whether motor, fuel or intake were commanded to change; any engine's load may regulate."""
    table = run.dead_centres
    changed = ("motor_frequency", "equivalence_ratio", "intake_temperature")
    return bool(table["motoring"].any()) or any(float(np.ptp(table[name])) > 0 for name in changed)


def _varied(run: Run) -> str:
    """The command on the gas that varies most while fuel is burnt; the stroke if none does."""
    table = run.dead_centres
    fired = table[table["equivalence_ratio"] > 0.0]
    spans = {
        name: float(np.ptp(fired[name]) / fired[name].max()) if len(fired) else 0.0
        for name in ("intake_temperature", "equivalence_ratio")
    }
    name = max(spans, key=lambda name: spans[name])
    return name if spans[name] > CONSTANT else "stroke"


def _name_start_up(ax: Axes, run: Run, frequency: float, colour: Any) -> None:
    """Name a curve where the engine is fired."""
    at, table = fired_at(run), run.dead_centres
    ratio = float(np.interp(at, table["t"], table["compression_ratio"]))
    ax.plot([at], [ratio], **marker("o", colour))
    look: dict[str, Any] = {"color": colour, "fontsize": "small", "textcoords": "offset points"}
    text = f"{frequency:g} Hz\nfired at\n{at:.2f} s"
    ax.annotate(text, (at, ratio), (-5, -2), ha="right", **look)


def _demand_panels() -> Panels:
    """Two panels on the left, the upper one higher, and three on the right."""
    from saleg.plotting.figure import Panels

    figure = new_figure(10.0, 6.0)
    grid = figure.add_gridspec(6, 2)
    places = [grid[:4, 0], grid[4:, 0], grid[:2, 1], grid[2:4, 1], grid[4:, 1]]
    panels: list[Axes] = []
    for place in places:
        panels.append(figure.add_subplot(place, sharex=panels[0] if panels else None))
    for panel in (panels[0], panels[2], panels[3]):
        panel.tick_params(labelbottom=False)
    return Panels.of(panels)
