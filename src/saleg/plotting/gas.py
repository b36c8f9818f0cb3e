"""Figures of the gas in the two chambers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from saleg.plotting.cycle import (
    HEAT_FLOW,
    POSITION,
    PRESSURE,
    TIME,
    VOLUME,
    draw_sides,
    last_cycle,
)
from saleg.plotting.style import COINCIDING, axes_or_new, finish, zero_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.results import Run


def pressure_volume(run: Run, ax: Axes | None = None) -> Axes:
    """Draw pressure [bar] over volume [cm^3] of both chambers over the last full cycle.

    The motored pressure is dotted if ``simulate(..., motored_pressure=True)`` integrated it.

    Parameters
    ----------
    run : Run
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    cycle = last_cycle(run)
    ax = axes_or_new(ax)
    draw_sides(ax, cycle, VOLUME, PRESSURE, COINCIDING, motored=True)
    ax.set_xlim(left=0.0)
    ax.set_ylim(bottom=0.0)
    return finish(ax, cycle.titled("Pressure and volume"), "upper right")


def pressure_position(run: Run, ax: Axes | None = None) -> Axes:
    """Draw pressure [bar] of both chambers over position [mm] (Figure 38 of the thesis).

    The motored pressure is dotted if ``simulate(..., motored_pressure=True)`` integrated it.

    Parameters
    ----------
    run : Run
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    cycle = last_cycle(run)
    ax = axes_or_new(ax)
    draw_sides(ax, cycle, POSITION, PRESSURE, motored=True)
    ax.set_ylim(bottom=0.0)
    return finish(ax, cycle.titled("Pressure and position"), "upper center")


def pressure_time(run: Run, ax: Axes | None = None) -> Axes:
    """Draw pressure [bar] of both chambers over time [ms] (Figure 39 of the thesis).

    The cycle begins at left dead centre. The motored pressure is dotted if
    ``simulate(..., motored_pressure=True)`` integrated it.

    Parameters
    ----------
    run : Run
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    cycle = last_cycle(run)
    ax = axes_or_new(ax)
    draw_sides(ax, cycle, TIME, PRESSURE, motored=True)
    ax.set_xlim(0.0, TIME.scale * cycle.period)
    ax.set_ylim(bottom=0.0)
    return finish(ax, cycle.titled("Pressure in time"), "below", columns=4)


def heat_flow_time(run: Run, ax: Axes | None = None) -> Axes:
    """Draw heat flow to the walls [kW] of both chambers over time [ms].

    Figure 39 of the thesis calls it heat flux; here it is the whole flow of heat to head, liner and
    crown, not divided by their area. There is none while the ports are open: the model has no heat
    transfer there.

    Parameters
    ----------
    run : Run
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    cycle = last_cycle(run)
    ax = axes_or_new(ax)
    draw_sides(ax, cycle, TIME, HEAT_FLOW)
    zero_lines(ax, y=True)
    ax.set_xlim(0.0, TIME.scale * cycle.period)
    return finish(ax, cycle.titled("Heat to the walls in time"), "below", columns=3)
