"""Figures of the gas in the two chambers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from saleg.plotting.cycle import (
    HEAT_FLOW,
    POSITION,
    PRESSURE,
    TIME,
    VOLUME,
    Cycle,
    draw_sides,
    figure_of_cycle,
    finish_cycle,
    time_axis,
)
from saleg.plotting.style import COINCIDING, from_zero, zero_lines

if TYPE_CHECKING:
    from saleg.plotting.figure import ShownAxes


@figure_of_cycle
def pressure_volume(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw pressure [bar] over volume [cm^3] of both chambers over the last full cycle.

    The motored pressure is dotted if ``simulate(..., motored_pressure=True)`` integrated it.
    """
    draw_sides(ax, cycle, VOLUME, PRESSURE, COINCIDING, motored=True)
    ax.set_xlim(0.0, 1.05 * ax.dataLim.xmax)
    from_zero(ax)
    return finish_cycle(ax, cycle, "Pressure and volume", _clear_of(cycle, "upper right"))


@figure_of_cycle
def pressure_position(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw pressure [bar] of both chambers over position [mm] (Figure 38 of the thesis).

    The motored pressure is dotted if ``simulate(..., motored_pressure=True)`` integrated it.
    """
    draw_sides(ax, cycle, POSITION, PRESSURE, motored=True)
    from_zero(ax)
    return finish_cycle(ax, cycle, "Pressure and position", _clear_of(cycle, "upper center"))


@figure_of_cycle
def pressure_time(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw pressure [bar] of both chambers over time [ms] (Figure 39 of the thesis).

    The cycle begins at left dead centre. The motored pressure is dotted if
    ``simulate(..., motored_pressure=True)`` integrated it.
    """
    draw_sides(ax, cycle, TIME, PRESSURE, motored=True)
    time_axis(ax, cycle)
    from_zero(ax)
    return finish_cycle(ax, cycle, "Pressure in time", "below", columns=4)


@figure_of_cycle
def heat_flow_time(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw heat flow to the walls [kW] of both chambers over time [ms].

    Figure 39 of the thesis calls it heat flux; here it is the whole flow of heat to head, liner and
    crown, not divided by their area. There is none while the ports are open: the model has no heat
    transfer there.
    """
    draw_sides(ax, cycle, TIME, HEAT_FLOW)
    zero_lines(ax, y=True)
    time_axis(ax, cycle)
    return finish_cycle(ax, cycle, "Heat to the walls in time", "below", columns=3)


def _clear_of(cycle: Cycle, place: str) -> str:
    """Place of the legend beside the pressures of a cycle with events; any place without."""
    return place if len(cycle.marked) else "best"
