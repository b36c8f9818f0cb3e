"""Figures of the translator: its motion, what acts on it, and the power it delivers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.plotting.cycle import (
    ACCELERATION,
    POSITION,
    POWER,
    TIME,
    VELOCITY,
    Cycle,
    NoCycle,
    draw_translator,
    figure_of_cycle,
    finish_cycle,
    last_cycle,
    time_axis,
)
from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label
from saleg.plotting.overlay import placed
from saleg.plotting.style import (
    ALTERNATOR_COLOUR,
    FRICTION_COLOUR,
    LEFT_COLOUR,
    RIGHT_COLOUR,
    SPRING_COLOUR,
    TRANSLATOR_COLOUR,
    axes_or_new,
    from_zero,
    zero_lines,
)
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.engine import Engine
    from saleg.plotting.figure import ShownAxes
    from saleg.simulation.run import Run

FORCE = readable("spring_force", "N", "force to the right")
EFFICIENCY = readable("efficiency", "-")
#: Constant pressures, the sum of the forces, and the colours of all of them.
BEHIND, INERTIA = "behind the pistons", "inertia (sum)"
FORCE_COLOURS = {
    "gas left": LEFT_COLOUR,
    "gas right": RIGHT_COLOUR,
    "springs": SPRING_COLOUR,
    "alternator": ALTERNATOR_COLOUR,
    "friction": FRICTION_COLOUR,
    BEHIND: "#CC79A7",
    INERTIA: TRANSLATOR_COLOUR,
}


@figure_of_cycle
def velocity_position(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw velocity [m/s] over position [mm] of the translator (Figure 36 of the thesis)."""
    zero_lines(ax, x=True, y=True)
    draw_translator(ax, cycle, POSITION, VELOCITY)
    return finish_cycle(ax, cycle, "Velocity and position", _at_centre(cycle))


@figure_of_cycle
def acceleration_velocity(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw acceleration [km/s^2] over velocity [m/s] (Figure 37 of the thesis)."""
    zero_lines(ax, x=True, y=True)
    draw_translator(ax, cycle, VELOCITY, ACCELERATION)
    return finish_cycle(ax, cycle, "Acceleration and velocity", _at_centre(cycle))


@figure_of_cycle
def forces(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw the forces on the translator [kN], positive to the right, over time [ms].

    Pressure of the gas on either crown, springs, friction and alternator; their sum is mass times
    acceleration, drawn as inertia (Figure 93 of the thesis).
    """
    place, time = cycle.place, cycle(TIME)
    zero_lines(ax, y=True)
    for label, force in forces_on(cycle.run.engine, cycle.history).items():
        line = (0, (5, 1.5)) if label == INERTIA else "-"
        look: dict[str, Any] = {"color": FORCE_COLOURS[label], "linestyle": place.line(line)}
        ax.plot(time, FORCE.of(force), label=label, **look)
    if not place.alone:
        ax.plot([], [], color="0.4", linestyle=place.line(), label=place.name)
    time_axis(ax, cycle)
    ax.set_ylabel(axis_label(FORCE))
    return finish_cycle(ax, cycle, "Forces on the translator", "below", columns=3)


def forces_on(engine: Engine, history: pd.DataFrame) -> dict[str, np.ndarray]:
    """Forces on the translator over a history by name, positive to the right [N]."""
    left, right = engine.piston_areas
    forces = {
        "gas left": left * history["p_left"],
        "gas right": -right * history["p_right"],
        "springs": history["spring_force"],
        "alternator": -history["alternator_force"],
        "friction": -history["friction_force"],
        BEHIND: np.full(len(history), engine.back_force),
        INERTIA: engine.translator.mass * history["a"],
    }
    if engine.back_force == 0.0:
        del forces[BEHIND]
    return {name: np.asarray(force) for name, force in forces.items()}


@figure_of_cycle
def power(cycle: Cycle, ax: ShownAxes) -> ShownAxes:
    """Draw electrical power [kW] over time [ms], its mean and RMS (Figure 40 of the thesis)."""
    strokes, period = cycle.strokes, cycle.period
    mean = POWER.scale * float(strokes["electrical_energy"].sum()) / period
    rms = POWER.scale * math.sqrt(float(strokes["electrical_squared"].sum()) / period)
    instant = cycle(POWER)
    colour, text = cycle.place.colour, cycle.place.text
    look: dict[str, Any] = {"color": colour(TRANSLATOR_COLOUR), "linewidth": 1.2}
    curve: dict[str, Any] = {"color": colour(ALTERNATOR_COLOUR), "linewidth": 1.6}
    ax.plot(cycle(TIME), instant, label=cycle.place.name or "electrical power", **curve)
    ax.axhline(mean, label=text(f"mean {mean:.4g} kW"), **look)
    ax.axhline(rms, linestyle="--", label=text(f"RMS {rms:.4g} kW"), **look)
    if ax.dataLim.ymin >= 0.0 and instant.max() > 0.0:
        from_zero(ax)
    zero_lines(ax, y=True)
    time_axis(ax, cycle)
    ax.set_ylabel(POWER.label)
    return finish_cycle(ax, cycle, "Electrical power", "below", 3, column_per_run=True)


@documented()
def efficiency(
    run: Run, ax: Axes | None = None, *, label: str | None = None, cycles: int = 10
) -> ShownAxes:
    """Draw the running efficiency [%] over time [ms] (Figure 40 of the thesis).

    The running efficiency is a cumulative one: electrical energy over the fuel energy of all fresh
    charges, both counted from the left dead centre that began the last `cycles` cycles. It drops
    when a port closes on a fresh charge, whose fuel counts at once, and climbs while the alternator
    delivers. At the end of the cycle it is the efficiency of those cycles. The straight line is
    the efficiency of the last cycle alone. The more cycles, the narrower the band; the thesis does
    not say how it counted.

    Parameters
    ----------
    cycles : int
        Cycles counted, the drawn one among them; fewer where the run has fewer.

    Raises
    ------
    NoCycle
        If the run completed no full cycle or its last one had no fresh fuel.
    """
    cycle = last_cycle(run)
    spent = float(cycle.strokes["fresh_fuel_energy"].sum())
    if spent <= 0.0:
        raise NoCycle("no efficiency to draw: the last full cycle had no fresh fuel")
    ax = axes_or_new(ax)
    with placed(ax, run, label) as place:
        return _draw_efficiency(ax, replace(cycle, place=place), cycles, spent)


def _draw_efficiency(ax: ShownAxes, cycle: Cycle, cycles: int, spent: float) -> ShownAxes:
    """Running efficiency over some cycles, and that of the last one with the fuel it spent [J]."""
    cycles = min(max(int(cycles), 1), len(cycle.run.cycles))
    running = EFFICIENCY.of(_running_efficiency(cycle, cycles))
    mean = EFFICIENCY.of(float(cycle.strokes["electrical_energy"].sum())) / spent
    colour, text = cycle.place.colour, cycle.place.text
    over = f" over {cycles} cycles" if cycles > 1 else ""
    words = cycle.place.name or f"running efficiency{over}"
    look: dict[str, Any] = {"color": colour(ALTERNATOR_COLOUR), "linewidth": 1.6}
    ax.plot(cycle(TIME), running, label=words, **look)
    look = {"color": colour(TRANSLATOR_COLOUR), "linewidth": 1.2}
    of_cycle = f"{mean:.4g} %" if cycle.place.name else f"efficiency of the cycle {mean:.4g} %"
    ax.axhline(mean, label=text(of_cycle), **look)
    time_axis(ax, cycle)
    ax.set_ylabel(axis_label(EFFICIENCY))
    return finish_cycle(ax, cycle, "Efficiency", "below", 2, column_per_run=True)


def _at_centre(cycle: Cycle) -> str | None:
    """The legend of the events stands inside the loop; without events it would be empty."""
    return "center" if len(cycle.marked) else None


def _running_efficiency(cycle: Cycle, cycles: int) -> np.ndarray:
    """Electrical over fuel energy since the start of the last `cycles` cycles [-]."""
    before = cycle.run.cycles.iloc[:-1].tail(cycles - 1)
    t = cycle.history["t"].to_numpy()
    watts = cycle.history["electrical_power"].to_numpy()
    steps = 0.5 * (watts[1:] + watts[:-1]) * np.diff(t)
    delivered = np.concatenate([[0.0], np.cumsum(steps)])
    spent = np.zeros(len(t))
    closings = cycle.events[cycle.events["event"] == "port closing"]
    for row, moment, side in zip(
        cycle.rows_of(closings), closings["t"], closings["side"], strict=True
    ):
        stroke = min(int(np.searchsorted(cycle.strokes["t"], moment)), len(cycle.strokes) - 1)
        charge = cycle.strokes["fresh_fuel_energy"][stroke, 0 if side == "left" else 1]
        spent[row + 1 :] += charge
    delivered += float(before["electrical_energy"].sum())
    spent += float(before["fuel_energy"].sum())
    return np.divide(delivered, spent, out=np.full(len(t), np.nan), where=spent > 0.0)
