"""An experiment of the dissertation: run it, draw it, report it beside what is printed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

    from saleg.simulation.run import Run


class Line(NamedTuple):
    """One line of a report: what, as seen here, and as the dissertation says, if it does."""

    what: str
    here: str
    dissertation: str = ""


@dataclass
class Result:
    """Result of an experiment.

    Attributes
    ----------
    run : Run, optional
        If it was a single run.
    table : DataFrame, optional
        If it was many.
    also : dict
        What else its drawing and report go by.
    """

    run: Run | None = None
    table: pd.DataFrame | None = None
    also: dict[str, Any] = field(default_factory=dict)

    @property
    def moved(self) -> bool:
        """Whether there is anything to draw and report; not after a run without a full cycle."""
        return self.run is None or len(self.run.cycles) > 0

    @property
    def one(self) -> Run:
        """The run of an experiment that is one."""
        assert self.run is not None
        return self.run

    @property
    def many(self) -> pd.DataFrame:
        """The table of an experiment that is many."""
        assert self.table is not None
        return self.table


@dataclass(frozen=True)
class Experiment:
    """An experiment of the dissertation: run, draw, report.

    Attributes
    ----------
    summary : str
        One line on what it does.
    run : callable
        Does it with an engine and the options below as keywords.
    draw : dict of str to callable
        Figures by file name, each drawn from a result.
    report : callable
        Lines on a result.
    options : tuple of str
        Keywords it takes.
    is_run : bool
        Whether it is a single run.
    """

    summary: str
    run: Callable[..., Result]
    draw: dict[str, Callable[[Result], Any]]
    report: Callable[[Result], list[Line]]
    options: tuple[str, ...] = ("duration",)
    is_run: bool = True


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
