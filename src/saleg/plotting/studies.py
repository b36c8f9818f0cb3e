"""Figures of the numerical studies of :mod:`saleg.studies.convergence`."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label
from saleg.plotting.style import axes_or_new, finish
from saleg.simulation.readable import readable
from saleg.studies.printed import is_of_base_case

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes

MARKERS = "osD^vPX*"
STEP = readable("step", "s", "fixed step")
EFFICIENCY = readable("efficiency", "-")


@documented()
def work_precision(table: pd.DataFrame, ax: Axes | None = None) -> ShownAxes:
    """Draw error [-] over right-hand sides evaluated [-], one line per method.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.studies.work_precision`.
    """
    ax = axes_or_new(ax)
    for marker, (method, rows) in zip(
        cycle(MARKERS), table.groupby("method", sort=False), strict=False
    ):
        ax.loglog(
            rows["evaluations"], rows["error"], marker=marker, ms=5, lw=1.2, label=str(method)
        )
    ax.set_xlabel("right-hand sides evaluated [-]")
    ax.set_ylabel("greatest relative error [-]")
    return finish(ax, "Work and precision", "best")


@documented()
def delay(
    table: pd.DataFrame,
    ax: Axes | None = None,
    printed: Mapping[float, Mapping[str, float]] | None = None,
) -> ShownAxes:
    """Draw efficiency [%] over step [µs] for several delays of the gas force.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.studies.delay_study`.
    printed : mapping of float to mapping, optional
        Published rows by step [s], drawn as rings, such as ``saleg.thesis.tables.TABLE_2``. A
        study of any other engine than the base case it is printed for stays without them.
    """
    from matplotlib import colormaps

    ax = axes_or_new(ax)
    ran = table[table["status"].isin(["steady", "completed"])]
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, ran["delay"].nunique()))
    for marker, colour, (steps, rows) in zip(
        cycle(MARKERS), colours, ran.groupby("delay"), strict=False
    ):
        label = {"0": "no delay", "1": "1 step late"}.get(f"{steps:g}", f"{steps:g} steps late")
        look: dict[str, Any] = {"color": tuple(colour), "marker": marker, "ms": 4, "lw": 1.2}
        ax.plot(STEP.of(rows["step"]), EFFICIENCY.of(rows["efficiency"]), label=label, **look)
    if printed is not None and is_of_base_case(table):
        _draw_printed(ax, printed, float(ran["step"].max()))
    ax.set_xlabel(axis_label(STEP))
    ax.set_ylabel(axis_label(EFFICIENCY))
    return finish(ax, "Cylinder blocks that lag behind", "best")


def _draw_printed(ax: Axes, rows: Mapping[float, Mapping[str, float]], longest: float) -> None:
    """Rings where the thesis has steps no longer than the longest that ran [s]."""
    printed = [(step, row) for step, row in rows.items() if step <= longest * 1.001]
    ax.plot(
        [STEP.of(step) for step, _ in printed],
        [EFFICIENCY.of(row["efficiency"]) for _, row in printed],
        "o",
        mfc="none",
        mec="#D55E00",
        ms=9,
        mew=1.8,
        label="thesis, Table 2",
    )
