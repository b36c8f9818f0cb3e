"""Last cycles of a study, one curve for each value (Figures 44 to 49, 51 to 54, 56, 57 and 59)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.plotting.cycle import (
    HEAT_FLOW,
    POSITION,
    PRESSURE,
    TIME,
    VELOCITY,
    VOLUME,
    Cycle,
    NoCycle,
    Quantity,
    last_cycle,
)
from saleg.plotting.docstrings import documented
from saleg.plotting.sensitivity.names import NAMED, words_of
from saleg.plotting.style import axes_or_new, finish, from_zero, zero_lines
from saleg.quantities import is_number
from saleg.simulation.readable import readable
from saleg.status import Status

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes
    from saleg.studies.sensitivity import Case, Study

UNSTABLE = (0, (4, 2))
#: What a figure calls a status that says nothing of stability.
NOT_STABLE = {Status.COMPLETED: "not steady"}
#: Entries of a legend beyond which it has two columns.
LONG_LEGEND = 9
#: Share of the greatest volume that :func:`pressure_volume` shows.
NEAR_DEAD_CENTRE = 0.4


@documented()
def pressure_volume(study: Study, ax: Axes | None = None) -> ShownAxes:
    """Draw pressure [bar] over volume [cm^3] of the left chamber, one curve per value.

    As Figures 46, 48, 49, 51, 52, 54 and 57. The axis shows the volumes near dead centre; widen it
    to see the rest.

    Examples
    --------
    >>> import saleg
    >>> found = saleg.sensitivity.equivalence_ratios(saleg.machines.thesis_base(), [0.3, 0.6])
    >>> ax = pressure_volume(found)
    >>> [text.get_text() for text in ax.get_legend().get_texts()]
    ['0.3', '0.6']
    """
    ax = _curves(study, VOLUME, PRESSURE, ax)
    ax.set_xlim(0.0, NEAR_DEAD_CENTRE * ax.dataLim.xmax)
    from_zero(ax)
    return _finish(ax, study, "Pressure and volume", "upper right")


@documented()
def velocity_position(study: Study, ax: Axes | None = None) -> ShownAxes:
    """Draw velocity [m/s] over position [mm] of the translator, one curve per value.

    As Figures 45, 47, 53 and 59.
    """
    ax = axes_or_new(ax)
    zero_lines(ax, x=True, y=True)
    return _finish(_curves(study, POSITION, VELOCITY, ax), study, "Velocity and position", "center")


@documented()
def pressure_time(study: Study, ax: Axes | None = None) -> ShownAxes:
    """Draw pressure [bar] of the left chamber around its dead centre [ms], one curve per value.

    As the left half of Figure 44.
    """
    ax = _around_dead_centre(study, PRESSURE, ax)
    from_zero(ax)
    return _finish(ax, study, "Pressure around dead centre", "upper right")


@documented()
def heat_flow_time(study: Study, ax: Axes | None = None) -> ShownAxes:
    """Draw the heat flow to the walls [kW] of the left chamber around its dead centre [ms].

    As the right half of Figure 44, one curve per value.
    """
    ax = axes_or_new(ax)
    zero_lines(ax, y=True)
    ax = _around_dead_centre(study, HEAT_FLOW, ax)
    return _finish(ax, study, "Heat to the walls around dead centre", "upper right")


@documented()
def release_rates(study: Study, ax: Axes | None = None) -> ShownAxes:
    """Draw the burn rate [%/ms] over the time since the start of combustion [ms].

    One curve per value, of the left cylinder's last combustion, as Figure 56.

    Parameters
    ----------
    study : Study
        From :func:`saleg.sensitivity.release_profiles` or :func:`saleg.sensitivity.study`.
    """
    ax = axes_or_new(ax)
    for look, cycle in _drawn(study, ax):
        law = cycle.run.engine.get("left.heat_release")
        duration = float(cycle.strokes["combustion_duration"][:, 0].max())
        u = np.linspace(0.0, 1.0, 1001)
        # The rate falls from its last value to zero at the end of combustion.
        rate = np.append([law.burn_rate(float(x)) for x in u], 0.0)
        ax.plot(1e3 * duration * np.append(u, 1.0), 0.1 * rate / duration, **look)
    ax.set_xlabel("time since start of combustion [ms]")
    ax.set_ylabel("burn rate [% of the fuel per ms]")
    ax.set_xlim(left=0.0)
    from_zero(ax)
    return _finish(ax, study, "Heat release", "upper right")


def _curves(
    study: Study, across: Quantity, up: Quantity, ax: Axes | None, side: str = "left"
) -> ShownAxes:
    """The last cycle of every run."""
    ax = axes_or_new(ax)
    for look, cycle in _drawn(study, ax):
        ax.plot(cycle(across, side), cycle(up, side), **look)
    ax.set_xlabel(across.label)
    ax.set_ylabel(up.label)
    return ax


def _around_dead_centre(study: Study, up: Quantity, ax: Axes | None) -> ShownAxes:
    """A quantity of the left chamber from a quarter of a cycle before its dead centre on."""
    ax = axes_or_new(ax)
    longest = 0.0
    for look, cycle in _drawn(study, ax):
        time, period = cycle(TIME), TIME.scale * cycle.period
        # The cycle begins at the dead centre: its second half is what comes before.
        later = time > 0.5 * period
        turned = np.concatenate([time[later] - period, time[~later]])
        ax.plot(turned, np.concatenate([cycle(up)[later], cycle(up)[~later]]), **look)
        longest = max(longest, period)
    ax.set_xlim(-0.25 * longest, 0.25 * longest)
    ax.set_xlabel("time after dead centre [ms]")
    ax.set_ylabel(up.label)
    return ax


def _drawn(study: Study, ax: Axes) -> Iterator[tuple[dict[str, Any], Cycle]]:
    """Look and cycle of every case; runs without a cycle are named in the legend only."""
    from saleg.studies.sensitivity import is_stable

    drawn = 0
    for case, colour in zip(study.cases, _colours(study), strict=True):
        stable, status = is_stable(case.run), case.run.status
        label = _label(study, case) + ("" if stable else f" ({NOT_STABLE.get(status, status)})")
        if status in (Status.STALLED, Status.INVALID) or case.run.orbit is None:
            ax.plot([], [], "x", color=colour, label=label)
            continue
        drawn += 1
        look: dict[str, Any] = {"color": colour, "label": label, "linewidth": 1.3}
        yield {**look, "linestyle": "-" if stable else UNSTABLE}, last_cycle(case.run)
    if not drawn:
        raise NoCycle("nothing to draw: no run of the study completed a full cycle")


def _colours(study: Study) -> list[Any]:
    """Colours in the order of the cases: a scale for numbers, black for the engine itself."""
    if not all(is_number(case.value) for case in study.cases):
        return [NAMED[number % len(NAMED)] for number in range(len(study.cases))]
    from matplotlib import colormaps

    scale = colormaps["viridis"](np.linspace(0.0, 0.9, len(study.cases)))
    return [
        "black" if math.isclose(case.relative, 1.0, rel_tol=1e-6) else tuple(colour)
        for case, colour in zip(study.cases, scale, strict=True)
    ]


def _label(study: Study, case: Case) -> str:
    if not is_number(case.value):
        return str(case.value)
    value = readable("value", study.unit).of(case.value)
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"


def _finish(ax: ShownAxes, study: Study, title: str, legend: str) -> ShownAxes:
    """Title and legend, with the quantity and its unit over the values."""
    finish(ax, title, legend, columns=2 if len(study.cases) > LONG_LEGEND else 1)
    box = ax.get_legend()
    if box is not None and all(is_number(case.value) for case in study.cases):
        box.set_title(readable("value", study.unit, words_of(study.quantity)).label)
        box.get_title().set_fontsize("small")
    return ax
