"""Figures of sweeps: panels over an input (67-82), over the groups (115-124), design maps (87-91).

Points that differ in kind look different: stable, unstable (an orbit from which the engine
departs), unsteady (no orbit found; figures of the last simulated cycle), and stalled, idling or
invalid points as ticks on the axis, whatever figures they have.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.errors import SweepError, shown
from saleg.plotting.docstrings import documented
from saleg.plotting.kinds import UNSTABLE, draw_kind, kinds
from saleg.plotting.labels import label as label_of
from saleg.plotting.labels import values
from saleg.plotting.overlay import placed_table
from saleg.plotting.style import (
    LEFT_COLOUR,
    axes_or_new,
    finish,
    legend_below,
    new_figure,
    panels_or_new,
)
from saleg.simulation.readable import readable
from saleg.status import Status

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels, ShownAxes
    from saleg.sweep.sobol_indices import Indices

#: Figures of the panels, in order.
PANELS = (
    "largest_multiplier",
    "compression_ratio",
    "relative_stroke",
    "score",
    "frequency",
    "efficiency",
    "power_density",
    "peak_pressure",
)

#: Figures that take the place of those a table has not.
INSTEAD = ("moving_mass", "power", "peak_velocity")

#: Ratio of the greatest to the least value beyond which an axis is logarithmic.
WIDE = 40.0


@documented(axes=8)
def panels(table: pd.DataFrame, x: str, ax: Any = None, *, label: str | None = None) -> Panels:
    """Draw stability, compression, performance and score along one input (Figures 67-82).

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sweep.run`. Where further inputs vary there is a line for each of their
        combinations.
    x : str
        The input along the axes.
    label : str, optional
        Name of the table in the legend. Tables on the same axes differ in colour.
    """
    shown = _shown(table, x)
    _check(table, [x, *shown])
    axes = panels_or_new(ax, (2, 4), 13.2, 6.2, sharex=True)
    lines = _lines(table, x)
    with placed_table(axes[0], label) as place:
        for panel, name in zip(axes, shown, strict=False):
            for line in lines:
                for kind, rows in kinds(line):
                    if rows.any():
                        draw_kind(panel, values(line, x), values(line, name), rows, kind, place)
            _dress(panel, table, x, name)
    _hide(axes[len(shown) :])
    legend_below(axes)
    return axes


@documented(axes=8)
def maps(table: pd.DataFrame, x: str, y: str, ax: Any = None) -> Panels:
    """Draw stability, compression, performance and score over two inputs, as colours.

    A grid is drawn as cells, other points as dots. Points without a steady state are blank,
    unstable ones are crossed.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sweep.run`.
    x, y : str
        The inputs.
    """
    shown = [name for name in _shown(table, x) if name != y]
    _check(table, [x, y, *shown])
    axes = panels_or_new(ax, (2, 4), 14.0, 6.4, sharex=True, sharey=True)
    kept = _orbits(table)
    kept.attrs = table.attrs
    at = values(kept, x), values(kept, y)
    unstable = ~kept["stable"].to_numpy(dtype=bool) if "stable" in kept else np.zeros(0, dtype=bool)
    for panel, name in zip(axes, shown, strict=False):
        drawn = _coloured(panel, kept, x, y, name)
        if unstable.any():
            panel.scatter(
                at[0][unstable], at[1][unstable], marker="x", s=9, c="0.25", linewidths=0.7
            )
        panel.figure.colorbar(drawn, ax=panel, pad=0.02)
        panel.set_title(label_of(table, name), fontsize="medium")
        if panel.get_subplotspec().is_last_row():
            panel.set_xlabel(label_of(table, x))
        if panel.get_subplotspec().is_first_col():
            panel.set_ylabel(label_of(table, y))
    _hide(axes[len(shown) :])
    axes[0].figure.suptitle(_count(table), fontsize="medium")
    return axes


def _coloured(panel: Axes, kept: pd.DataFrame, x: str, y: str, name: str) -> Any:
    """A figure over two inputs: cells where they are a grid, dots where they are not."""
    across, up, colour = (values(kept, column) for column in (x, y, name))
    columns, rows = np.unique(across), np.unique(up)
    if len(columns) * len(rows) > 2 * len(kept) or min(len(columns), len(rows)) < 2:
        return panel.scatter(across, up, c=colour, s=14.0)
    cells = np.full((len(rows), len(columns)), np.nan)
    cells[np.searchsorted(rows, up), np.searchsorted(columns, across)] = colour
    return panel.pcolormesh(columns, rows, cells, shading="nearest")


@documented(axes=8)
def groups(table: pd.DataFrame, x: str, ax: Any = None) -> Panels:
    """Draw a cloud of designs over a dimensionless group, coloured by score (Figures 117-124).

    Unstable orbits are hollow.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sweep.run` of designs.
    x : str
        "stroke_to_bore", "dimensionless_pressure", "dimensionless_heat", "frequency_ratio", or any
        other column.
    """
    shown = _shown(table, x)
    _check(table, [x, "score", *shown])
    axes = panels_or_new(ax, (2, 4), 13.2, 6.2, sharex=True)
    kept = _orbits(table).sort_values("score")
    kept.attrs = table.attrs
    for panel, name in zip(axes, shown, strict=False):
        dots = _cloud(panel, kept, [values(kept, x), values(kept, name)], kept["score"], 7.0)
        if np.nanmax(values(kept, name)) > WIDE * abs(np.nanmin(values(kept, name))):
            _logarithmic(panel)
        _dress(panel, table, x, name)
    _hide(axes[len(shown) :])
    axes[0].figure.colorbar(dots, ax=list(axes), label="score [-]", aspect=40, pad=0.01)
    axes[0].figure.suptitle(_count(table), fontsize="medium")
    return axes


@documented()
def design_map(
    table: pd.DataFrame, x: str, y: str, z: str, colour: str = "score", ax: Any = None
) -> Any:
    """Draw designs over three columns, coloured by a fourth (Figures 87-91).

    Each design stands on a thin line, so that its place can be read in the ground plane; unstable
    orbits are hollow.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sweep.run` of designs.
    x, y, z, colour : str
        Columns.
    ax : mpl_toolkits.mplot3d.axes3d.Axes3D, optional
        Three-dimensional axes to draw on; new ones unless given.

    Returns
    -------
    Axes3D
    """
    _check(table, [x, y, z, colour])
    if ax is None:
        ax = new_figure(7.4, 5.8).add_subplot(projection="3d")
    kept = _orbits(table).sort_values(colour)
    kept.attrs = table.attrs
    at = [values(kept, name) for name in (x, y, z)]
    floor = float(at[2].min()) - 0.04 * float(np.ptp(at[2]))
    for a, b, c in zip(*at, strict=True):
        ax.plot([a, a], [b, b], [floor, c], color="0.85", linewidth=0.4, zorder=0)
    dots = _cloud(ax, kept, at, values(kept, colour), 14.0, depthshade=False)
    ax.set_zlim(bottom=floor)
    ax.set_xlabel(label_of(table, x))
    ax.set_ylabel(label_of(table, y))
    ax.set_zlabel(label_of(table, z))
    ax.figure.colorbar(dots, ax=ax, label=label_of(table, colour), shrink=0.75, pad=0.12)
    ax.set_title(_count(table), fontsize="medium")
    return ax


@documented()
def indices(found: Indices, ax: Axes | None = None) -> ShownAxes:
    """Draw Sobol' indices as bars with their intervals, the most important input on top.

    Parameters
    ----------
    found : Indices
    """
    table = found.table.sort_values("total")
    ax = axes_or_new(ax, height=1.2 + 0.42 * len(table))
    rows = np.arange(len(table))
    for kind, colour, shift in (("total", "0.75", 0.19), ("first", LEFT_COLOUR, -0.19)):
        value = table[kind].to_numpy()
        ends = [value - table[f"{kind}_low"], table[f"{kind}_high"] - value]
        named = {"total": "with all interactions", "first": "by itself"}[kind]
        look: dict[str, Any] = {"height": 0.36, "color": colour, "label": named}
        error = {"elinewidth": 0.8, "capsize": 2, "ecolor": "0.25"}
        ax.barh(rows + shift, value, xerr=np.maximum(ends, 0.0), error_kw=error, **look)
    ax.set_yticks(rows, [readable(str(name), "").words for name in table.index])
    ax.set_xlabel("share of the variance [-]")
    ax.set_xlim(left=min(0.0, ax.get_xlim()[0]))
    return finish(ax, f"What decides about the {found.figure.replace('_', ' ')}", "lower right")


def _orbits(table: pd.DataFrame) -> pd.DataFrame:
    """Rows with a steady state.

    Raises
    ------
    SweepError
        If there are none.
    """
    kept = table[table["status"] == str(Status.STEADY)]
    if not len(kept):
        raise SweepError(f"none of {len(table)} points has a steady state: nothing to draw")
    return kept


def _check(table: pd.DataFrame, names: list[str]) -> None:
    """Refuse columns that are not there, hold no numbers or have no unit."""
    units = table.attrs.get("units", {})
    for name in ["status", *names]:
        if name not in table:
            raise SweepError(
                f"no column {shown(name)} to draw; there are {', '.join(map(str, table))}"
            )
        if name != "status" and table[name].dtype.kind not in "fiu":
            raise SweepError(f"{name} holds no numbers to draw")
        if name not in units:
            raise SweepError(f"no unit of {name}: keep table.attrs of the table saleg made")


def _lines(table: pd.DataFrame, x: str) -> list[pd.DataFrame]:
    """Rows in order of an input, apart for every combination of the others."""
    others = [
        name
        for name in table.attrs.get("inputs", ())
        if name != x and name in table and np.ptp(table[name]) > 0.0
    ]
    parts = [part for _, part in table.groupby(others)] if others else [table]
    lines = [part.sort_values(x) for part in parts]
    for line in lines:
        line.attrs = table.attrs
    return lines


def _cloud(
    ax: Any, kept: pd.DataFrame, at: list[np.ndarray], colour: Any, size: float, **more: Any
) -> Any:
    """Points coloured by a figure, those of unstable orbits hollow; what a colour bar needs."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    shown = np.asarray(colour, dtype=float)
    scale = ScalarMappable(Normalize(shown.min(), shown.max()))
    for kind, rows in kinds(kept):
        if rows.any():
            shades = scale.to_rgba(shown[rows])
            faces = "none" if kind is UNSTABLE else shades
            look = {
                "facecolors": faces,
                "edgecolors": shades,
                "linewidths": 0.8 if kind is UNSTABLE else 0.0,
            }
            ax.scatter(*(part[rows] for part in at), s=size, **look, **more)
    return scale


def _count(table: pd.DataFrame) -> str:
    """Number of designs with a stable orbit, or with any where stability was not asked for."""
    orbits = _orbits(table)
    if "stable" not in table or "verified" in table:
        few = " of all but the best" if "verified" in table else ""
        return f"{len(orbits)} of {len(table)} designs have an orbit, stability{few} not examined"
    return (
        f"{int(orbits['stable'].sum())} stable of {len(table)} designs, {len(orbits)} with an orbit"
    )


def _shown(table: pd.DataFrame, x: str) -> list[str]:
    """Columns of the panels; others in place of what a table without multipliers or score lacks."""
    wanted = [name for name in (*PANELS, *INSTEAD) if name in table and name != x]
    if not wanted:
        raise SweepError("no point has figures: nothing to draw; the messages of the rows say why")
    return wanted[: len(PANELS)]


def _hide(axes: np.ndarray) -> None:
    """Panels there is nothing for."""
    for panel in axes:
        panel.set_visible(False)


def _logarithmic(panel: Axes) -> None:
    """Logarithmic axis with plain numbers, some in every decade."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    panel.set_yscale("log")
    panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panel.yaxis.set_minor_formatter(NullFormatter())


def _dress(panel: Axes, table: pd.DataFrame, x: str, name: str) -> None:
    """Labels of a panel; the unit circle where multipliers are drawn."""
    finish(panel, label_of(table, name), None)
    if panel.get_subplotspec() is None or panel.get_subplotspec().is_last_row():  # type: ignore[union-attr]
        panel.set_xlabel(label_of(table, x))
    if name == "largest_multiplier":
        panel.axhline(1.0, color="black", linewidth=0.8, linestyle=":")
        panel.set_ylim(0.0, max(1.2, min(panel.get_ylim()[1], 3.0)))
