"""Figures of an optimisation: its course (86), maps of its designs (87-91), archive, front."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design.designs import Design
from saleg.design.loop import solve
from saleg.errors import SalegError
from saleg.optimize.methods.archive import FREQUENCY, STROKE_TO_BORE, Axis
from saleg.optimize.stages import winners
from saleg.plotting import sweeps
from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label, column, label, values
from saleg.plotting.namespace import Method, Namespace
from saleg.plotting.scores import score_terms
from saleg.plotting.style import LEFT_COLOUR, RIGHT_COLOUR, axes_or_new, finish

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.optimize.result import Found
    from saleg.plotting.figure import Panels, ShownAxes

#: Figures beside the parameters in parallel coordinates.
BESIDE = ("efficiency", "power", "compression_ratio", "frequency")
#: Kinds of designs in a front: look of those within the limits, and of the front.
WITHIN: dict[str, Any] = {"color": "0.7", "marker": ".", "markersize": 4, "linestyle": "none"}
LEADING: dict[str, Any] = {"color": LEFT_COLOUR, "marker": "o", "markersize": 4, "linewidth": 1.0}


@documented()
def convergence(found: Found, ax: Axes | None = None) -> ShownAxes:
    """Draw the best objective so far and the mean of each generation over evaluations (Figure 86).

    The mean of the genetic algorithm is that over parents and children before selection.

    Parameters
    ----------
    found : Found
    """
    ax = axes_or_new(ax)
    shown = column(found.table, found.problem.objectives[0].figure)
    course = found.history
    done = course["evaluations"].to_numpy()
    best, mean = (shown.of(course[name].to_numpy(dtype=float)) for name in ("best", "mean"))
    ax.step(done, best, where="post", color=LEFT_COLOUR, linewidth=1.8, label="best so far")
    look: dict[str, Any] = {"color": RIGHT_COLOUR, "linewidth": 1.0, "marker": ".", "markersize": 4}
    ax.plot(done, mean, label="mean of the generation", **look)
    ax.set_xlabel("designs evaluated [-]")
    ax.set_ylabel(axis_label(shown))
    ax.set_xlim(0.0, 1.02 * float(done[-1]))
    unit = "" if shown.unit == "-" else f" {shown.unit}"
    title = f"{type(found.method).__name__}: {shown.words} {best[-1]:.4g}{unit}"
    return finish(ax, title, "lower right")


@documented()
def design_map(
    found: Found,
    x: str = "stroke_to_bore",
    y: str = "frequency",
    z: str = "power_density",
    colour: str = "score",
    ax: Any = None,
) -> Any:
    """Draw all designs evaluated over three columns, coloured by a fourth (Figures 87-91).

    It shows where the search has been; :func:`archive` shows where good designs are.

    Parameters
    ----------
    found : Found
    x, y, z, colour : str
        Columns of ``found.table``.
    ax : mpl_toolkits.mplot3d.axes3d.Axes3D, optional
        Three-dimensional axes to draw on; new ones unless given.

    Returns
    -------
    Axes3D
    """
    return sweeps.design_map(found.table, x, y, z, colour, ax)


@documented(axes=8)
def groups(found: Found, x: str = "stroke_to_bore", ax: Any = None) -> Panels:
    """Draw all designs evaluated over a dimensionless group, in eight panels (Figures 117-124).

    Parameters
    ----------
    found : Found
    x : str
        As for :func:`saleg.plotting.sweeps.groups`.
    """
    return sweeps.groups(found.table, x, ax)


@documented()
def archive(
    found: Found, across: Axis | None = None, up: Axis | None = None, ax: Axes | None = None
) -> ShownAxes:
    """Draw the best objective in every cell of a map over two figures.

    A cell without colour holds no design that meets the limits.

    Parameters
    ----------
    found : Found
    across, up : Axis, optional
        Figures, their ranges and numbers of cells; unless given those of the archive that was the
        method, or maximum stroke over bore and frequency.
    """
    axes = _axes_of_map(found, across, up)
    kept = found.archive(*axes)
    if not len(kept):
        raise SalegError("no design within the limits lies in this map: nothing to draw")
    goal = found.problem.objectives[0].figure
    best = np.full([axis.cells for axis in axes], np.nan)
    best.ravel()[kept["cell"].to_numpy(dtype=int)] = values(kept, goal)
    ends = [
        column(found.table, axis.figure).of(np.linspace(axis.low, axis.high, axis.cells + 1))
        for axis in axes
    ]
    ax = axes_or_new(ax, width=7.0)
    mesh = ax.pcolormesh(ends[0], ends[1], best.T)
    ax.figure.colorbar(mesh, ax=ax, label=f"best {label(found.table, goal)}")
    ax.set_xlabel(label(found.table, axes[0].figure))
    ax.set_ylabel(label(found.table, axes[1].figure))
    finish(ax, f"{len(found.table)} designs: the best of {len(kept)} of {best.size} cells", None)
    return ax


def _axes_of_map(found: Found, across: Axis | None, up: Axis | None) -> tuple[Axis, Axis]:
    own = getattr(found.method, "axes", (STROKE_TO_BORE, FREQUENCY))
    return across or own[0], up or own[-1]


@documented()
def parallel(found: Found, count: int = 100, ax: Axes | None = None) -> ShownAxes:
    """Draw the best designs as lines over parameters and figures, the best one thick.

    Every axis runs from the lower to the upper bound of its parameter, or from the least to the
    greatest value of its figure; their values stand at its ends.

    Parameters
    ----------
    found : Found
    count : int
        Number of designs.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    goal = found.problem.objectives[0].figure
    kept = winners(found, count=count)
    names = [*found.problem.bounds, *(name for name in BESIDE if name in kept and name != goal)]
    ends = {name: _ends(found, kept, name) for name in names}
    shares = np.column_stack(
        [(kept[name] - low) / (high - low) for name, (low, high) in ends.items()]
    )
    ax = axes_or_new(ax, width=1.05 * len(names) + 1.6, height=4.6)
    earned = values(kept, goal)
    scale = ScalarMappable(Normalize(earned.min(), earned.max()))
    for row in range(len(kept) - 1, -1, -1):
        width = 2.6 if row == 0 else 0.8
        colour = RIGHT_COLOUR if row == 0 else scale.to_rgba(earned[row])
        ax.plot(shares[row], color=colour, linewidth=width, label="best" if row == 0 else None)
    for place, (name, (low, high)) in enumerate(ends.items()):
        shown = column(kept, name)
        ax.axvline(place, color="0.4", linewidth=0.8)
        for height, end, side in ((-0.02, low, "top"), (1.02, high, "bottom")):
            look: dict[str, Any] = {"ha": "center", "va": side, "fontsize": "small"}
            ax.text(place, height, f"{float(shown.of(end)):.4g}", **look)
    words = [axis_label(column(kept, name)).replace(" ", "\n") for name in names]
    ax.set_xticks(range(len(names)), words, fontsize="small")
    ax.tick_params(axis="x", length=0, pad=14)
    ax.set_yticks([])
    ax.set_ylim(-0.08, 1.08)
    ax.figure.colorbar(scale, ax=ax, label=label(kept, goal), pad=0.01)
    finish(ax, f"The {len(kept)} best of {len(found.table)} designs", "upper right")
    ax.grid(visible=False)
    ax.spines[["left", "bottom"]].set_visible(False)
    return ax


def _ends(found: Found, kept: pd.DataFrame, name: str) -> tuple[float, float]:
    """Ends of the axis of a parameter or a figure."""
    if name in found.problem.bounds:
        return found.problem.bounds[name]
    low, high = float(kept[name].min()), float(kept[name].max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)


@documented()
def front(found: Found, ax: Axes | None = None) -> ShownAxes:
    """Draw designs over the first two objectives, and the front of those none of which is better.

    Parameters
    ----------
    found : Found
    """
    goals = [item.figure for item in found.problem.objectives]
    if len(goals) < 2:
        raise SalegError(f"one objective, {goals[0]}, has no front: give the problem two")
    told = found.problem.told(found.table)
    within = found.table[told.violation == 0.0]
    ax = axes_or_new(ax)
    x, y = goals[:2]
    ax.plot(values(within, x), values(within, y), **WITHIN, label="within the limits")
    leading = found.front.sort_values(x)
    joined = LEADING if len(goals) == 2 else {**LEADING, "linestyle": "none"}
    ax.plot(values(leading, x), values(leading, y), **joined, label="front")
    ax.set_xlabel(label(found.table, x))
    ax.set_ylabel(label(found.table, y))
    return finish(ax, f"{len(leading)} designs in front of {len(found.table)}", "best")


@documented()
def score(found: Found, ax: Any = None) -> Panels:
    """Draw what each term of the score earns over its figure (Figure 85).

    Parameters
    ----------
    found : Found
    ax : array of matplotlib.axes.Axes, optional
        One for each term; new ones unless given.

    Returns
    -------
    Panels
    """
    return score_terms(found.problem.score, ax)


@documented()
def engine(found: Found, ax: Axes | None = None) -> ShownAxes:
    """Draw the best design to scale with the translator at its midpoint [mm].

    Parameters
    ----------
    found : Found
    """
    best = found.design()
    if not isinstance(best, Design):
        raise SalegError("an engine with a fixed mass has no dimensions to draw: optimise a Design")
    return solve(best, rtol=found.problem.rtol).draw(ax)


class OptimisationPlots(Namespace):
    """Figures of an optimisation: ``found.plot.convergence()`` and so on; ``dir`` lists them.

    Parameters
    ----------
    result : Found
    """

    _kind = "an optimisation"

    convergence = Method(convergence)
    design_map = Method(design_map)
    groups = Method(groups)
    archive = Method(archive)
    parallel = Method(parallel)
    front = Method(front)
    score = Method(score)
    engine = Method(engine)


#: Figures of an optimisation by name.
FIGURES = OptimisationPlots._figures()
