"""Figures of the studies of :mod:`saleg.studies.sensitivity` (Figures 43 to 59 of the thesis).

Curves are drawn of a :class:`saleg.sensitivity.Study`, trends of its table. What is stable has full
lines and the marker o; what is not, broken lines and the marker x, which lies on the axis itself
where there is no figure at all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

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
from saleg.plotting.style import axes_or_new, finish, from_zero, new_figure, zero_lines
from saleg.quantities import is_number
from saleg.simulation.report import FIGURES
from saleg.status import Status

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.studies.sensitivity import Case, Study

#: Label and factor from SI of what can be drawn of a table, by column.
LABELS = {
    **{name: (f"{label} [{unit}]", factor) for name, label, factor, unit, _ in FIGURES},
    "power": ("electrical power [kW]", 1e-3),
    "heat_transfer": ("heat to the walls per cycle [J]", 1.0),
    "heat_transfer_share": ("heat to the walls [% of fuel energy]", 1e2),
    "friction_share": ("friction [% of fuel energy]", 1e2),
}
#: Units people read, and their factor from SI.
READABLE = {"s": ("ms", 1e3), "Pa": ("bar", 1e-5), "m": ("mm", 1e3)}
#: Colours of cases with names (Okabe and Ito, safe for the colour-blind).
NAMED = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
UNSTABLE = (0, (4, 2))
MARKERS = "osD^vP"
#: What a figure calls a status that says nothing of stability.
NOT_STABLE = {Status.COMPLETED: "not steady"}
#: Entries of a legend beyond which it has two columns.
LONG_LEGEND = 9
#: What Figure 50 and Figure 55 show, and what Figure 58 does.
TRENDS = ("compression_ratio", "efficiency", "frequency", "heat_transfer_share")
REGULATED = ("stroke", "compression_ratio", "frequency", "power", "efficiency", "peak_pressure")


@documented()
def pressure_volume(study: Study, ax: Axes | None = None) -> Axes:
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


#: Share of the greatest volume that :func:`pressure_volume` shows.
NEAR_DEAD_CENTRE = 0.4


@documented()
def velocity_position(study: Study, ax: Axes | None = None) -> Axes:
    """Draw velocity [m/s] over position [mm] of the translator, one curve per value.

    As Figures 45, 47, 53 and 59.
    """
    ax = axes_or_new(ax)
    zero_lines(ax, x=True, y=True)
    return _finish(_curves(study, POSITION, VELOCITY, ax), study, "Velocity and position", "center")


@documented()
def pressure_time(study: Study, ax: Axes | None = None) -> Axes:
    """Draw pressure [bar] of the left chamber around its dead centre [ms], one curve per value.

    As the left half of Figure 44.
    """
    ax = _around_dead_centre(study, PRESSURE, ax)
    from_zero(ax)
    return _finish(ax, study, "Pressure around dead centre", "upper right")


@documented()
def heat_flow_time(study: Study, ax: Axes | None = None) -> Axes:
    """Draw the heat flow to the walls [kW] of the left chamber around its dead centre [ms].

    As the right half of Figure 44, one curve per value.
    """
    ax = axes_or_new(ax)
    zero_lines(ax, y=True)
    ax = _around_dead_centre(study, HEAT_FLOW, ax)
    return _finish(ax, study, "Heat to the walls around dead centre", "upper right")


@documented()
def release_rates(study: Study, ax: Axes | None = None) -> Axes:
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


@documented()
def trends(
    table: pd.DataFrame,
    figures: Sequence[str] = TRENDS,
    ax: Sequence[Axes] | np.ndarray | None = None,
    *,
    logarithmic: bool = False,
) -> np.ndarray:
    """Draw figures of a study over what was varied, a panel for each figure.

    With several parameters (as Figures 43 and 50) over their values relative to the engine's, with
    one (as Figure 55) over its value. Only stable points are joined; a cross on the axis itself
    stands for a value at which there is no figure, as the engine stalls.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sensitivity.vary` or :func:`saleg.sensitivity.vary_each`.
    figures : sequence of str
        Columns of the table.
    ax : array of matplotlib.axes.Axes, optional
        As many axes as figures; new ones unless given.
    logarithmic : bool
        Whether values are spread by their logarithms.

    Returns
    -------
    ndarray of matplotlib.axes.Axes

    Raises
    ------
    ValueError
        If there are not as many axes as figures.
    """
    panels = _panels(ax, len(figures))
    across = _across(table)
    for panel, figure in zip(panels, figures, strict=True):
        label, factor = LABELS[figure]
        for line in _lines(table, figure):
            _trend(panel, across.factor * line.across, factor * line.up, line)
        panel.set_xscale("log" if logarithmic else "linear")
        panel.set_xlabel(across.label)
        panel.set_ylabel(label)
        finish(panel, "", None)
    _explain(panels, table)
    return panels


@documented(axes=2)
def regulator_gains(
    table: pd.DataFrame, ax: Sequence[Axes] | np.ndarray | None = None
) -> np.ndarray:
    """Draw figures over those at the engine's own gain, against the gain (Figure 58).

    All gains to the left, the stable ones to the right.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sensitivity.regulator_gains`, with a stable row at the engine's own gain.

    Raises
    ------
    ValueError
        If there are not two axes.
    NoCycle
        If there is no stable row at the engine's own gain.
    """
    panels = _panels(ax, 2)
    own = table[table["stable"] & np.isclose(table["relative"], 1.0)]
    if len(own) == 0:
        raise NoCycle("no stable row at the engine's own gain to compare the others with")
    for panel, rows in zip(panels, (table, table[table["stable"]]), strict=True):
        for number, figure in enumerate(REGULATED):
            label = LABELS[figure][0].partition(" [")[0]
            line = _Line(label, NAMED[number], MARKERS[number], *_columns(rows, "value", figure))
            _trend(panel, line.across, line.up / float(own[figure].iloc[0]), line)
        panel.set_xlabel("regulator gain G [-]")
        panel.set_ylabel("over that at the engine's own gain [-]")
    finish(panels[0], "All gains: o stable, x not", None)
    finish(panels[1], "Stable gains", "upper right")
    return panels


class _Across(NamedTuple):
    """What the axis along which a study runs shows."""

    column: str
    label: str
    factor: float


class _Line(NamedTuple):
    """One line of a figure of trends."""

    label: str
    colour: Any
    marker: str
    across: np.ndarray
    up: np.ndarray
    stable: np.ndarray


def _across(table: pd.DataFrame) -> _Across:
    if "parameter" in table:
        return _Across("relative", "parameter over its value in the engine [-]", 1.0)
    unit, factor = READABLE.get(table.attrs["units"]["value"], (table.attrs["units"]["value"], 1.0))
    return _Across("value", f"{_words(table.attrs['quantity'])} [{unit}]", factor)


def _words(path: str) -> str:
    """The last part of a dotted path, in words."""
    return path.rpartition(".")[2].replace("_", " ")


def _columns(rows: pd.DataFrame, across: str, figure: str) -> tuple[np.ndarray, ...]:
    """What runs across, the figure (NaN of an engine that stands still), what is stable."""
    figures = rows[figure].where(rows["frequency"] > 0.0)
    return rows[across].to_numpy(float), figures.to_numpy(float), rows["stable"].to_numpy(bool)


def _lines(table: pd.DataFrame, figure: str) -> Iterator[_Line]:
    """The lines of one panel: one, or one per parameter."""
    across = _across(table).column
    if "parameter" not in table:
        yield _Line("", NAMED[1], "o", *_columns(table, across, figure))
        return
    for number, (name, rows) in enumerate(table.groupby("parameter", sort=False)):
        colour = NAMED[1 + number % (len(NAMED) - 1)]
        yield _Line(_words(str(name)), colour, "o", *_columns(rows, across, figure))


def _trend(ax: Axes, across: np.ndarray, up: np.ndarray, line: _Line) -> None:
    """A line through stable points, a cross at every other one."""
    stable = line.stable
    shown = np.isfinite(up) & ~stable
    joined = np.where(stable, up, math.nan)
    look: dict[str, Any] = {"color": line.colour, "markersize": 4.5}
    ax.plot(across, joined, marker=line.marker, linewidth=1.2, label=line.label, **look)
    crosses: dict[str, Any] = {**look, "marker": "x", "linestyle": "none", "markersize": 6.5}
    ax.plot(across[shown], up[shown], **crosses)
    lost = across[~stable & ~shown]
    if len(lost):
        foot = ax.get_xaxis_transform()
        ax.plot(lost, np.zeros(len(lost)), transform=foot, clip_on=False, **crosses)


def _explain(panels: np.ndarray, table: pd.DataFrame) -> None:
    """A legend on the first panel of parameters and of the two markers."""
    first = panels[0]
    if "parameter" not in table:
        first.plot([], [], "o", color=NAMED[1], markersize=4.5, label="stable")
    if not table["stable"].all():
        colour = "0.3" if "parameter" in table else NAMED[1]
        first.plot([], [], "x", color=colour, markersize=6.5, label="not stable")
    finish(first, "", "best")


def _curves(
    study: Study, across: Quantity, up: Quantity, ax: Axes | None, side: str = "left"
) -> Axes:
    """The last cycle of every run."""
    ax = axes_or_new(ax)
    for look, cycle in _drawn(study, ax):
        ax.plot(cycle(across, side), cycle(up, side), **look)
    ax.set_xlabel(across.label)
    ax.set_ylabel(up.label)
    return ax


def _around_dead_centre(study: Study, up: Quantity, ax: Axes | None) -> Axes:
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
    """How to draw which cycles; runs without one are named in the legend only."""
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
    value = READABLE.get(study.unit, ("", 1.0))[1] * case.value
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"


def _finish(ax: Axes, study: Study, title: str, legend: str) -> Axes:
    """Title and legend, with the quantity and its unit over the values."""
    finish(ax, title, legend, columns=2 if len(study.cases) > LONG_LEGEND else 1)
    box = ax.get_legend()
    if box is not None and all(is_number(case.value) for case in study.cases):
        unit = READABLE.get(study.unit, (study.unit, 1.0))[0]
        box.set_title(f"{_words(study.quantity)} [{unit}]")
        box.get_title().set_fontsize("small")
    return ax


def _panels(ax: Sequence[Axes] | np.ndarray | None, count: int) -> np.ndarray:
    """The axes handed in, or new ones, two to a row, in one row of an array."""
    if ax is None:
        rows = -(-count // 2)
        figure = new_figure(9.6, 3.7 * rows)
        panels = figure.subplots(rows, min(count, 2), squeeze=False).ravel()
        for spare in panels[count:]:
            spare.remove()
        return panels[:count]
    panels = np.atleast_1d(np.asarray(ax, dtype=object)).ravel()
    if len(panels) != count:
        raise ValueError(f"this figure needs {count} axes, not {len(panels)}")
    return panels
