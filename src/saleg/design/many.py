"""Many designs at once."""

from __future__ import annotations

import math
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import TYPE_CHECKING

from saleg.batch.many import UNITS as STEADY_UNITS
from saleg.batch.many import Row, steady_row
from saleg.design.designs import Design
from saleg.design.loop import solve
from saleg.design.results import UNITS as COMPONENT_UNITS
from saleg.design.results import DesignedState
from saleg.design.score import Score
from saleg.steady.solver import Effort

if TYPE_CHECKING:
    import pandas as pd

#: Columns of a table of designs beside its inputs.
UNITS = {**STEADY_UNITS, **COMPONENT_UNITS, "score": "-"}


class Follower:
    """Rows of designs, one after the other.

    Parameters
    ----------
    design : Design
        What the values of a row replace something of.
    rtol : float
        Tolerance.
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
        effort: Effort = Effort.THOROUGH,
    ):
        self._design, self._rtol, self._multipliers, self._warm = design, rtol, multipliers, warm
        self._effort = effort
        self._near: DesignedState | None = None

    def __call__(self, values: Mapping[str, float]) -> Row:
        """Row of a design."""
        design = self._design.replace(values)
        found = solve(design, rtol=self._rtol, near=self._near, effort=self._effort)
        if self._warm and found.found:
            self._near = found
        return design_row(found, self._multipliers)


def design_row(found: DesignedState, multipliers: bool) -> Row:
    """Row of a design: status, message, figures of the cycle and of the components, score."""
    row = steady_row(found, multipliers, found.shown_performance)
    row |= found.component_figures
    if not found.found:
        row["moving_mass"] = math.nan  # of what was simulated, a guess
    row["score"] = float(Score()(row))
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
    chunk: int = 32,
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
        Tolerance.
    multipliers : bool
        Differentiate each steady state: whether it is stable, and how it would not be.
    effort : Effort
        As for :func:`saleg.steady_state`: ``Effort.QUICK`` gives up a design without an orbit from
        the standard starts after a few milliseconds, with the status "not found".
    executor, workers, chunk
        As for :func:`saleg.sweep.run`.

    Returns
    -------
    DataFrame
        One row per row: the inputs, status, message, figures of cycle and components (SI), score.
        A design without a steady state, or that is not valid, is a row with that status. Units in
        ``.attrs["units"]``.

    Examples
    --------
    >>> import pandas as pd
    >>> table = evaluate_many(pd.DataFrame({"bore": [0.060, -1.0]}))
    >>> list(table.status)
    ['steady', 'invalid']
    """
    from saleg.sweep import run

    return run(
        frame,
        design,
        rtol=rtol,
        multipliers=multipliers,
        effort=effort,
        executor=executor,
        workers=workers,
        chunk=chunk,
    )
