"""Plots of the numerical studies of :mod:`saleg.studies`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.thesis_tables import TABLE_2

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

MARKERS = "osD^vPX*"


def work_precision(table: pd.DataFrame, ax: Any = None) -> Axes:
    """Error over right-hand sides evaluated, one line per method.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.studies.work_precision`.
    ax : Axes, optional
        A new figure's unless given.

    Returns
    -------
    Axes
    """
    ax = _axes(ax)
    for marker, (method, rows) in zip(MARKERS, table.groupby("method", sort=False), strict=False):
        ax.loglog(rows["evaluations"], rows["error"], marker=marker, ms=5, lw=1.2, label=method)
    ax.set_xlabel("right-hand sides evaluated [-]")
    ax.set_ylabel("greatest relative error [-]")
    ax.set_title("Work and precision")
    ax.grid(True, which="major", alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax


def delay(table: pd.DataFrame, ax: Any = None) -> Axes:
    """Efficiency over step for several delays of the gas force, beside Table 2 of the thesis.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.studies.delay_study`.
    ax : Axes, optional
        A new figure's unless given.

    Returns
    -------
    Axes
    """
    ax = _axes(ax)
    ran = table[table["status"].isin(["steady", "completed"])]
    shades = np.linspace(0.25, 0.85, ran["delay"].nunique())
    for shade, (steps, rows) in zip(shades, ran.groupby("delay"), strict=True):
        label = {"0": "no delay", "1": "1 step late"}.get(str(steps), f"{steps} steps late")
        colour = (0.0, 0.45 * (1.0 - shade), shade)
        ax.plot(1e6 * rows["step"], 100.0 * rows["efficiency"], ".-", color=colour, label=label)
    printed = {step: row for step, row in TABLE_2.items() if step <= ran["step"].max() * 1.001}
    ax.plot(
        [1e6 * step for step in printed],
        [100.0 * row["efficiency"] for row in printed.values()],
        "o",
        mfc="none",
        mec="#d55e00",
        ms=9,
        mew=1.8,
        label="thesis, Table 2",
    )
    ax.set_xlabel("fixed step [us]")
    ax.set_ylabel("efficiency [%]")
    ax.set_title("Cylinder blocks that lag behind")
    ax.grid(True, alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    from matplotlib.figure import Figure

    return Figure(figsize=(6.0, 4.5), layout="constrained").subplots()
