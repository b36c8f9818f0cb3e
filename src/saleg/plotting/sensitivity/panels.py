"""Figures of a study over what was varied, a panel for each (Figures 43, 50, 55 and 58)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.plotting.cycle import NoCycle
from saleg.plotting.docstrings import documented
from saleg.plotting.sensitivity.names import NAMED, label_of, words_of
from saleg.plotting.style import finish, panels_or_new
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels

MARKERS = "osD^vP"
#: What Figure 50 and Figure 55 show, and what Figure 58 does.
TRENDS = ("compression_ratio", "efficiency", "frequency", "heat_transfer_share")
REGULATED = ("stroke", "compression_ratio", "frequency", "power", "efficiency", "peak_pressure")


@documented()
def trends(
    table: pd.DataFrame,
    figures: Sequence[str] = TRENDS,
    ax: Sequence[Axes] | np.ndarray | None = None,
    *,
    logarithmic: bool = False,
) -> Panels:
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
    Panels

    Raises
    ------
    ValueError
        If there are not as many axes as figures.
    """
    count = len(figures)
    rows, columns = -(-count // 2), min(count, 2)
    panels = panels_or_new(ax, (rows, columns), 9.6, 3.7 * rows, count)
    across = _across(table)
    for panel, figure in zip(panels, figures, strict=True):
        label, factor = label_of(figure)
        for line in _lines(table, figure):
            _trend(panel, across.factor * line.across, factor * line.up, line)
        panel.set_xscale("log" if logarithmic else "linear")
        panel.set_xlabel(across.label)
        panel.set_ylabel(label)
        finish(panel, "", None)
    _explain(panels, table)
    return panels


@documented(axes=2)
def regulator_gains(table: pd.DataFrame, ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
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
    panels = panels_or_new(ax, (1, 2), 9.6, 3.7)
    own = table[table["stable"] & np.isclose(table["relative"], 1.0)]
    if len(own) == 0:
        raise NoCycle("no stable row at the engine's own gain to compare the others with")
    for panel, rows in zip(panels, (table, table[table["stable"]]), strict=True):
        for number, figure in enumerate(REGULATED):
            label = label_of(figure)[0].partition(" [")[0]
            line = _Line(label, NAMED[number], MARKERS[number], *_columns(rows, "value", figure))
            _trend(panel, line.across, line.up / float(own[figure].iloc[0]), line)
        panel.set_xlabel("regulator gain G [-]")
        panel.set_ylabel("over that at the engine's own gain [-]")
    finish(panels[0], "All gains: o stable, x not", None)
    finish(panels[1], "Stable gains", "upper right")
    return panels


class _Across(NamedTuple):
    """Axis along which a study runs."""

    column: str
    label: str
    factor: float


class _Line(NamedTuple):
    """Line of a figure of trends."""

    label: str
    colour: Any
    marker: str
    across: np.ndarray
    up: np.ndarray
    stable: np.ndarray


def _across(table: pd.DataFrame) -> _Across:
    if "parameter" in table:
        return _Across("relative", "parameter over its value in the engine [-]", 1.0)
    shown = readable("value", table.attrs["units"]["value"], words_of(table.attrs["quantity"]))
    return _Across("value", shown.label, shown.factor)


def _columns(rows: pd.DataFrame, across: str, figure: str) -> tuple[np.ndarray, ...]:
    """Values across, the figure (NaN of an engine that stands still), and flags of stability."""
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
        yield _Line(words_of(str(name)), colour, "o", *_columns(rows, across, figure))


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
