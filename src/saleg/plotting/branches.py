"""Bifurcation diagrams."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label, label, values
from saleg.plotting.style import TRANSLATOR_COLOUR, axes_or_new, finish
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes
    from saleg.steady.continuation import Branch

UNSTABLE_COLOUR = "#CC3311"


@documented()
def bifurcation(branch: Branch, figure: str = "stroke", ax: Axes | None = None) -> ShownAxes:
    """A figure of the steady states along a parameter: solid where stable, dashed where not.

    Parameters
    ----------
    branch : Branch
    figure : str
        Field of :class:`saleg.Performance`.
    """
    ax = axes_or_new(ax)
    table = branch.table
    along = readable(branch.path, branch.unit)
    x, y = along.of(table[branch.path].to_numpy()), values(table, figure)
    stable = table["stable"].to_numpy()
    for begin, end in _pieces(stable):
        steady = bool(stable[min(begin + 1, len(stable) - 1)])
        ax.plot(
            x[begin : end + 1],
            y[begin : end + 1],
            color=TRANSLATOR_COLOUR if steady else UNSTABLE_COLOUR,
            linestyle="-" if steady else "--",
        )
    ax.plot([], [], color=TRANSLATOR_COLOUR, label="stable")
    if not stable.all():
        ax.plot([], [], color=UNSTABLE_COLOUR, linestyle="--", label="unstable")
    for value, kind in branch.stability_changes:
        shown = along.of(value)
        at = _at(branch, shown, x, y)
        ax.plot([shown], [at], "o", color="black", label=f"{kind} at {shown:.4g}")
    ax.set_xlabel(axis_label(along))
    ax.set_ylabel(label(table, figure))
    return finish(ax, f"{branch.engine.name}: steady states", "best")


def _at(branch: Branch, value: float, x: np.ndarray, y: np.ndarray) -> float:
    """Figure where stability changes, between the two points of the branch around it."""
    stable = np.array([point.stability.stable for point in branch.points])
    changes = np.flatnonzero(stable[1:] != stable[:-1])
    i = min(changes, key=lambda n: abs(0.5 * (x[n] + x[n + 1]) - value))
    share = (value - x[i]) / (x[i + 1] - x[i]) if x[i + 1] != x[i] else 0.5
    return float(y[i] + min(max(share, 0.0), 1.0) * (y[i + 1] - y[i]))


def _pieces(stable: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of the pieces of one kind; neighbours share the point between them."""
    changes = [0, *(np.flatnonzero(stable[1:] != stable[:-1]) + 1), len(stable) - 1]
    return [
        (max(int(begin) - (begin > 0), 0), int(end) - (end < len(stable) - 1))
        for begin, end in itertools.pairwise(changes)
    ]
