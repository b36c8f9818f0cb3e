"""Kinds of points in figures of tables: stable, unstable, unsteady, or without figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.plotting.overlay import ALONE, Place
from saleg.plotting.style import LEFT_COLOUR, RIGHT_COLOUR
from saleg.status import Status

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


class Kind(NamedTuple):
    """Label and look of points of one kind."""

    label: str
    look: dict[str, Any]


STABLE = Kind("stable", {"color": LEFT_COLOUR, "marker": ".", "markersize": 4, "linewidth": 1.4})
#: The same where multipliers were not asked for.
ORBIT = STABLE._replace(label="orbit, stability not examined")
UNSTABLE = Kind(
    "unstable orbit",
    {
        "color": RIGHT_COLOUR,
        "marker": "o",
        "markerfacecolor": "white",
        "markersize": 4.5,
        "linewidth": 1.0,
        "linestyle": "--",
    },
)
UNSTEADY = Kind(
    "no orbit found, last simulated cycle",
    {"color": "0.45", "marker": "x", "markersize": 4.5, "linestyle": "none"},
)
NO_FIGURES = Kind(
    "stalled, idling or invalid",
    {"color": "#CC3311", "marker": "|", "markersize": 9, "linestyle": "none"},
)


def kinds(table: pd.DataFrame) -> list[tuple[Kind, np.ndarray]]:
    """Kinds of points with the rows of each."""
    status = table["status"].to_numpy()
    steady = status == str(Status.STEADY)
    stable = table["stable"].to_numpy(dtype=bool) if "stable" in table else ~steady
    known = _examined(table)
    unsteady = status == str(Status.UNSTEADY)
    return [
        (STABLE, steady & known & stable),
        (ORBIT, steady & ~known),
        (UNSTABLE, steady & known & ~stable),
        (UNSTEADY, unsteady),
        (NO_FIGURES, ~steady & ~unsteady),
    ]


def _examined(table: pd.DataFrame) -> np.ndarray:
    """Rows whose stability is known: none without multipliers, of an optimisation its leaders."""
    if "stable" not in table:
        return np.zeros(len(table), bool)
    if "verified" in table:
        return table["verified"].to_numpy(dtype=bool)
    return np.ones(len(table), bool)


def draw_kind(
    panel: Axes,
    x: np.ndarray,
    y: np.ndarray,
    rows: np.ndarray,
    kind: Kind,
    place: Place = ALONE,
) -> None:
    """Points of a kind, joined only where neighbours are of it; without figures, on the axis."""
    look = {**kind.look, "label": place.text(kind.label)}
    if kind is NO_FIGURES:
        height = np.full(int(rows.sum()), 0.02)
        panel.plot(x[rows], height, transform=panel.get_xaxis_transform(), **look)
        return
    look["color"] = place.colour(kind.look["color"])
    panel.plot(x, np.where(rows, y, np.nan), **look)
