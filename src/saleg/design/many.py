"""Many designs at once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from saleg.batch.arguments import check_search
from saleg.batch.many import STABILITY_UNITS, steady_row
from saleg.batch.points import Values, evaluated_points, refuse_parts
from saleg.batch.table import Columns, Row, filled_up
from saleg.design.designs import Design
from saleg.design.loop import check_design, solve
from saleg.design.results import COMPONENT_UNITS, DesignedState
from saleg.design.together import scores, solved_together
from saleg.steady.solver import Effort

if TYPE_CHECKING:
    import pandas as pd

#: Columns of a table of designs beside its inputs.
DESIGN_UNITS = {**STABILITY_UNITS, **COMPONENT_UNITS, "score": "-"}


class DesignSolver:
    """Rows of designs, one after the other.

    Parameters
    ----------
    design : Design
        What the values of a row replace something of.
    rtol : float
        Tolerance of the integrator [-].
    multipliers : bool
        Differentiate each steady state.
    warm : bool
        Start each design from the one before it.
    effort : Effort
        How much work a design may be.
    """

    def __init__(
        self,
        design: Design,
        rtol: float,
        multipliers: bool,
        warm: bool,
        effort: Effort,
    ):
        self._design, self._rtol, self._multipliers, self._warm = design, rtol, multipliers, warm
        self._effort = effort
        self._near: DesignedState | None = None

    def __call__(self, values: Values) -> Row:
        """Row of a design."""
        design = self._design.replace(values)
        found = solve(design, rtol=self._rtol, near=self._near, effort=self._effort)
        if self._warm and found.found:
            self._near = found
        return design_row(found, self._multipliers)


class DesignSolverOfColumns(DesignSolver):
    """The same of designs that are independent of each other."""

    def columns(self, points: Sequence[Values], total: int) -> Columns:
        """Rows of some designs of a batch of so many, column by column."""
        how = self._rtol, self._effort, total, self._multipliers
        together = solved_together(self._design, points, *how)
        return filled_up(len(points), together, lambda place: self(points[place]))


@dataclass(frozen=True)
class EvaluatedDesign:
    """A design of which points replace parameters, or paths of the engine and the mass models."""

    design: Design

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns of results."""
        return DESIGN_UNITS

    def unit(self, name: str) -> str:
        """Unit of an input; refuses what the parameters or the loop decide about."""
        unit = self.design.unit(name)
        refuse_parts(name, self.design.get(name))
        self.design.replace({name: float("nan")})  # an object of its own, to be found again
        return unit

    def refuse_clash(self, names: Iterable[str]) -> None:
        """Refuse inputs of which two stand for one number."""
        self.design.replace({name: self.design.get(name) for name in names})

    def solver(self, rtol: float, multipliers: bool, warm: bool, effort: Effort) -> DesignSolver:
        """What makes a row of a point; may remember the point before."""
        kind = DesignSolver if warm else DesignSolverOfColumns
        return kind(self.design, rtol, multipliers, warm, effort)


def design_row(found: DesignedState, multipliers: bool) -> Row:
    """Row of a design: status, message, figures of the cycle and of the components, score."""
    row = steady_row(found, multipliers, found.shown_performance)
    row |= found.component_figures
    if not found.found:
        row["moving_mass"] = math.nan  # of what was simulated, a guess
    row["score"] = float(scores({name: np.array([value]) for name, value in row.items()})[0])
    return row


def evaluate_many(
    frame: pd.DataFrame,
    design: Design | None = None,
    *,
    rtol: float = 1e-6,
    multipliers: bool = False,
    effort: Effort = Effort.THOROUGH,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int | None = None,
) -> pd.DataFrame:
    """Evaluate many designs.

    Parameters
    ----------
    frame : DataFrame
        One design per row; columns are parameters of Table 8 (SI), or further paths as for
        :meth:`Design.replace`. What has no column is as in `design`.
    design : Design, optional
        Those of Chapter 4 unless given.
    rtol : float
        Tolerance of the integrator [-].
    multipliers : bool
        Differentiate each steady state: whether it is stable, and how it would not be.
    effort : Effort
        As for :func:`saleg.steady_state`: ``Effort.QUICK`` gives up a design without an orbit from
        the standard starts after a few milliseconds, with the status "not found".
    executor, workers, chunk
        As for :func:`saleg.steady_states`.

    Returns
    -------
    DataFrame
        One row per row: the inputs, status, message, figures of cycle and components (SI), score.
        A design without a steady state, or that is not valid, is a row with that status. Units in
        ``.attrs["units"]``.

    Raises
    ------
    SweepError
        If the frame is no table of numbers by name.
    UnknownPath
        If there is no input of that name.
    WorkersError
        If nobody could do the work so.

    Examples
    --------
    >>> import pandas as pd
    >>> table = evaluate_many(pd.DataFrame({"bore": [0.060, -1.0]}))
    >>> list(table.status)
    ['steady', 'invalid']
    """
    check_search(rtol, effort, executor, workers, chunk, multipliers=multipliers)
    design = Design() if design is None else design
    check_design(design)
    evaluated = EvaluatedDesign(design)
    solver = partial(evaluated.solver, rtol, multipliers, warm=False, effort=effort)
    return evaluated_points(frame, evaluated, solver, chunk, executor, workers)
