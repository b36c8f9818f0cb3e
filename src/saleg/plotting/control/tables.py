"""Figures of tables of controlled engines: resonance, maps, survival (94, 95, 101, 104, 105)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.control.maps import OperatingMap
from saleg.control.moments import stretches
from saleg.control.part_load import PartLoadMap
from saleg.plotting.docstrings import documented
from saleg.plotting.kinds import NO_FIGURES, STABLE, draw_kind, kinds
from saleg.plotting.labels import label as label_of
from saleg.plotting.labels import values
from saleg.plotting.overlay import placed_table
from saleg.plotting.style import (
    LEFT_COLOUR,
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    axes_or_new,
    finish,
    legend_below,
    panels_or_new,
)
from saleg.status import Status

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels, ShownAxes

#: How runs that still change are called.
UNSETTLED = "not settled: its last cycle"
#: Shades where the ports open.
PORTS_COLOUR = "#56B4E9"
PORTS = {
    "opened_ports": ("ports opened on the way", 0.18),
    "opens_ports": ("ports open when settled", 0.35),
}


@documented(axes=2)
def motored_amplitudes(
    table: pd.DataFrame, ax: Sequence[Axes] | np.ndarray | None = None
) -> Panels:
    """Draw relative stroke [%] and compression ratio [-] over the motor's amplitude (Figure 94).

    Where the ports open, on the way or when settled, is shaded.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.control.motored`.
    """
    return _motored(table, "motor_amplitude", "motor_frequency", ax)


@documented(axes=2)
def motored_resonance(table: pd.DataFrame, ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw relative stroke [%] and compression ratio [-] over the motor's frequency (Figure 95).

    Where the ports open, on the way or when settled, is shaded.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.control.motored`.
    """
    return _motored(table, "motor_frequency", "motor_amplitude", ax)


@documented(axes=2)
def operating_map(
    known: OperatingMap,
    ax: Sequence[Axes] | np.ndarray | None = None,
    *,
    label: str | None = None,
) -> Panels:
    """Draw power [kW] and compression ratio [-] of steady states over a quantity (Fig. 101, 104).

    Parameters
    ----------
    known : OperatingMap
    label : str, optional
        Name of the map in the legend. Maps on the same axes differ in colour.
    """
    panels = panels_or_new(ax, (2, 1), 6.4, 5.4, sharex=True)
    table, path = known.table, known.path
    with placed_table(panels[0], label) as place:
        for panel, name in zip(panels, ("power", "compression_ratio"), strict=True):
            for kind, rows in kinds(table):
                if rows.any():
                    draw_kind(panel, values(table, path), values(table, name), rows, kind, place)
            panel.set_ylabel(label_of(table, name))
            panel.set_ylim(bottom=0.0)
            finish(panel, "", None)
    panels[-1].set_xlabel(label_of(table, path))
    panels[0].set_title("Steady operation", fontsize="medium")
    legend_below(panels)
    return panels


@documented()
def part_load(
    best: PartLoadMap, ax: Axes | None = None, *, others: Mapping[str, pd.DataFrame] | None = None
) -> ShownAxes:
    """Draw the efficiency [%] of a part-load map over power [kW], beside what it was chosen from.

    Parameters
    ----------
    best : PartLoadMap
    others : mapping of str to DataFrame, optional
        Tables of other maps by name, such as that of :func:`saleg.control.intake_map`.
    """
    ax = axes_or_new(ax)
    states = best.states[best.states.within]
    look: dict[str, Any] = {"color": "0.75", "marker": ".", "markersize": 4, "linestyle": "none"}
    x, y = "power", "efficiency"
    ax.plot(values(states, x), values(states, y), label="within the margins", **look)
    for colour, (name, table) in zip(
        (RIGHT_COLOUR, LEFT_COLOUR, "0.4"), (others or {}).items(), strict=False
    ):
        rows = {kind.label: rows for kind, rows in kinds(table)}[STABLE.label]
        look = {"color": colour, "linestyle": "--", "linewidth": 1.4}
        ax.plot(values(table, x)[rows], values(table, y)[rows], label=name, **look)
    look = {"color": TRANSLATOR_COLOUR, "linewidth": 1.6}
    ax.plot(values(best.table, x), values(best.table, y), label="best", **look)
    ax.set_xlim(left=0.0)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel(label_of(best.table, x))
    ax.set_ylabel(label_of(best.table, y))
    return finish(ax, "Part load", "lower right")


@documented(axes=2)
def operating_grid(table: pd.DataFrame, ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw maps of power [kW] and compression ratio [-] over both quantities (Figure 105).

    Only stable steady states are mapped; other points show what they are.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.control.operating_grid`.
    """
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4, sharey=True)
    x, y = "intake.temperature", "equivalence_ratio"
    sorts = {kind.label: rows for kind, rows in kinds(table)}
    for panel, name in zip(panels, ("power", "compression_ratio"), strict=True):
        _fill(panel, table, (x, y, name), sorts[STABLE.label])
        for kind, rows in kinds(table):
            if kind is not STABLE and rows.any():
                look = {**kind.look, "linestyle": "none", "clip_on": False}
                if kind is NO_FIGURES:
                    look |= {"marker": "x", "markersize": 5}
                panel.plot(values(table, x)[rows], values(table, y)[rows], label=kind.label, **look)
        panel.set_xlabel(label_of(table, x))
        finish(panel, label_of(table, name), None)
        panel.grid(visible=False)
    panels[0].set_ylabel(label_of(table, y))
    legend_below(panels)
    return panels


@documented()
def survival(table: pd.DataFrame, ax: Axes | None = None) -> ShownAxes:
    """Draw the time to recover [s] over the strokes without fuel, with the motor and without it.

    Engines that stall have no such time: crosses on the axis count them.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.control.misfires`.
    """
    ax = axes_or_new(ax)
    cases = {
        "with the motor": (table["motor"], LEFT_COLOUR, "o"),
        "without the motor": (~table["motor"], RIGHT_COLOUR, "s"),
    }
    for text, (of_case, colour, shape) in cases.items():
        rows = table[of_case].sort_values("strokes")
        alive, dead = rows[rows["survives"]], rows[~rows["survives"]]
        look: dict[str, Any] = {"color": colour, "clip_on": False}
        ax.plot(alive["strokes"], alive["recovery_time"], marker=shape, label=text, **look)
        if len(dead):
            cross: dict[str, Any] = {
                "marker": "x",
                "markersize": 7,
                "linestyle": "none",
                "markeredgewidth": 1.8,
            }
            named = f"{text}: does not recover"
            ax.plot(dead["strokes"], np.zeros(len(dead)), label=named, **cross, **look)
    if table["strokes"].max() > 10 * table["strokes"].min():
        ax.set_xscale("log", base=2)
        ax.xaxis.set_major_formatter("{x:g}")
    ax.set_ylim(0.0, 1.05 * max(ax.dataLim.ymax, 0.1))
    ax.set_xlabel("strokes without fuel [-]")
    ax.set_ylabel("time to recover [s]")
    return finish(ax, "Recovery from misfire", "upper left")


def _motored(
    table: pd.DataFrame, x: str, other: str, ax: Sequence[Axes] | np.ndarray | None
) -> Panels:
    """Compression ratio and power of motored starts, as in Figures 94 and 95."""
    panels = panels_or_new(ax, (2, 1), 6.4, 5.4, sharex=True)
    ordered = table.sort_values(x)
    ordered.attrs = table.attrs
    at = values(ordered, x)
    beats = ordered["status"].to_numpy() != str(Status.STEADY)
    shown = {"relative_stroke": "relative stroke", "compression_ratio": "compression ratio"}
    for panel, (name, words) in zip(panels, shown.items(), strict=True):
        look: dict[str, Any] = {"marker": ".", "markersize": 4, "linewidth": 1.4}
        heights = values(ordered, name)
        panel.plot(at, heights, color=TRANSLATOR_COLOUR, **look)
        if beats.any():
            look = {"markerfacecolor": "white", "markeredgecolor": TRANSLATOR_COLOUR}
            panel.plot(at[beats], heights[beats], "o", markersize=4.5, label=UNSETTLED, **look)
        for column, (text, alpha) in PORTS.items():
            _shade(panel, at, ordered[column].to_numpy(dtype=bool), label=text, alpha=alpha)
        panel.set_ylabel(label_of(ordered, name, words))
        panel.margins(x=0.0)
        finish(panel, "", None)
    panels[0].set_ylim(0.0, 1.08 * panels[0].dataLim.ymax)
    panels[1].set_ylim(1.0, 1.0 + 1.08 * (panels[1].dataLim.ymax - 1.0))
    panels[-1].set_xlabel(label_of(ordered, x))
    panels[0].set_title(f"Motored: {_fixed(ordered, other)}", fontsize="medium")
    legend_below(panels)
    return panels


def _fixed(table: pd.DataFrame, name: str) -> str:
    """Value of what is not varied."""
    given = sorted(set(table[name]))
    unit = table.attrs["units"][name]
    return f"{name.replace('_', ' ')} {given[0]:g} {unit}" if len(given) == 1 else "several runs"


def _shade(panel: Axes, at: np.ndarray, opens: np.ndarray, **look: Any) -> None:
    """Shade where the ports open; the edge lies between the two points around it."""
    edges = np.concatenate([at[:1], 0.5 * (at[1:] + at[:-1]), at[-1:]])
    for first, last in stretches(opens):
        panel.axvspan(edges[first], edges[last + 1], color=PORTS_COLOUR, linewidth=0.0, **look)


def _fill(panel: Axes, table: pd.DataFrame, names: tuple[str, str, str], good: np.ndarray) -> None:
    """Filled contours of a column over two others, where the rows are good."""
    x, y, z = (values(table, name) for name in names)
    columns, rows = np.unique(x), np.unique(y)
    grid = np.full((len(rows), len(columns)), np.nan)
    grid[np.searchsorted(rows, y[good]), np.searchsorted(columns, x[good])] = z[good]
    if np.isfinite(grid).any() and min(grid.shape) > 1:
        filled = panel.contourf(columns, rows, np.ma.masked_invalid(grid), levels=14)
        panel.figure.colorbar(filled, ax=panel)
    panel.margins(0.0)
