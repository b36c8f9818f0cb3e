"""An experiment of the dissertation: run it, draw it, report it beside what is printed."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg import Run

if TYPE_CHECKING:
    import pandas as pd


class Line(NamedTuple):
    """One line of a report.

    Attributes
    ----------
    what : str
        What is compared.
    here : str
        As seen here.
    dissertation : str
        As the dissertation says, if it does.
    """

    what: str
    here: str
    dissertation: str = ""


@dataclass(frozen=True)
class Experiment:
    """An experiment of the dissertation: run, draw, report.

    Attributes
    ----------
    summary : str
        One line on what it does.
    run : callable
        Does it with an engine and options as keywords. The result is a run or a table, or holds
        one as its ``run`` or ``table``.
    draw : dict of str to callable
        Figures by file name, each drawn from the result.
    report : callable
        Lines on the result.
    is_run : bool
        Whether it is a single run.
    """

    summary: str
    run: Callable[..., Any]
    draw: dict[str, Callable[[Any], Any]]
    report: Callable[[Any], list[Line]]
    is_run: bool = True

    @property
    def options(self) -> tuple[str, ...]:
        """Keywords it takes."""
        return tuple(inspect.signature(self.run).parameters)[1:]


def run_of(result: Any) -> Run | None:
    """Run of a result that is a single one."""
    found = result if isinstance(result, Run) else getattr(result, "run", None)
    return found if isinstance(found, Run) else None


def table_of(result: Any) -> pd.DataFrame | None:
    """Table of a result that is of many runs."""
    return getattr(result, "table", result) if run_of(result) is None else None


def seconds(value: float) -> str:
    """Time [s] as text; "never" if it is NaN."""
    return "never" if math.isnan(value) else f"{value:.3f} s"


def kilowatts(value: float) -> str:
    """Power [W] as text in kW."""
    return f"{round(1e-3 * value, 2) + 0.0:.2f} kW"


def state_at(run: Run, t: float) -> pd.Series:
    """Row of the last dead centre up to a time [s]."""
    table = run.dead_centres
    return table.iloc[max(int(np.searchsorted(table["t"], t, side="right")) - 1, 0)]
