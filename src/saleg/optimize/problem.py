"""What is optimised: parameters with bounds, objectives, limits, and how a design is evaluated."""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.batch.identity import described
from saleg.batch.points import Evaluation
from saleg.batch.table import MISSING, MOST_TOGETHER, PIECES, kind_of
from saleg.checks import as_array
from saleg.design.designs import Design
from saleg.design.score import Score
from saleg.design.subjects import Subject, subject_of
from saleg.design.terms import InvalidScore, Limit, is_known
from saleg.engine import Engine
from saleg.errors import Problem as Wrong
from saleg.errors import WrongFields
from saleg.optimize.checks import wrong_designs, wrong_fields
from saleg.optimize.objectives import Objective
from saleg.optimize.scatter import FIGURES as SCATTER_FIGURES
from saleg.optimize.scatter import Scatter
from saleg.steady.lanes import BY_ITSELF
from saleg.steady.solver import DEFAULT_TOLERANCE, Effort

if TYPE_CHECKING:
    import pandas as pd

#: Fitness of a design without a steady state, and from where downwards those that miss limits lie.
FAILED, MISSES = -2e9, -1e9
#: Columns of a table that say whether an orbit is stable.
STABILITY = ("stable", "kind", "largest_multiplier", "beat_period")


class InvalidProblem(WrongFields):
    """An optimisation that makes no sense; `problems` lists all that is wrong."""

    whole = "optimisation"


class Told(NamedTuple):
    """What a method is told of the designs it asked for.

    Attributes
    ----------
    table : DataFrame
        Rows of the designs.
    objectives : ndarray, shape (designs, objectives)
        The greater the better; NaN where there is no steady state.
    violation : ndarray
        By how much limits are missed in all, over the limits; infinite without a steady state.
    fitness : ndarray
        First objective; below :data:`MISSES` where limits are missed, :data:`FAILED` without a
        steady state. Scores are never below 0: what fails has a score of 0.
    guide : ndarray
        Fitness, but less where a term of the score is flat at nothing: the same best design, and a
        pull towards it from everywhere.
    """

    table: pd.DataFrame
    objectives: np.ndarray
    violation: np.ndarray
    fitness: np.ndarray
    guide: np.ndarray


@dataclass(frozen=True)
class Problem:
    """An optimisation problem.

    Parameters
    ----------
    bounds : mapping
        Lowest and highest value (SI) by name of the parameter: any that
        :meth:`saleg.design.Design.replace`, or an engine, takes.
    score : callable
        Score of the rows of a table, 0 to 1: :class:`saleg.design.Score`,
        :class:`saleg.optimize.WeightedScore`, or an own one.
    objectives : tuple of Objective
        What is to be great or small: the score unless given.
    constraints : tuple of Limit
        Ranges figures have to lie in.
    swept : Design or Engine
        What the parameters replace something of; the designs of Chapter 4 unless given.
    scatter : Scatter, optional
        Constants that are not known well: rows get the mean and the worst score under it.
    effort : Effort
        How much work a design may be. ``Effort.QUICK`` gives up one without an orbit from the
        standard starts after a few milliseconds.
    rtol : float
        Tolerance of the integrator [-].

    Raises
    ------
    InvalidProblem
        Naming all that is wrong.

    Examples
    --------
    >>> problem = Problem({"bore": (0.05, 0.07), "egr": (0.0, 0.3)})
    >>> table = problem.evaluate([[0.060, 0.1], [0.065, 0.2]])
    >>> list(table.status), bool((table.score > 0.5).all())
    (['steady', 'steady'], True)
    """

    bounds: Mapping[str, tuple[float, float]]
    score: Callable[[Any], Any] = field(default_factory=Score)
    objectives: tuple[Objective, ...] = (Objective("score"),)
    constraints: tuple[Limit, ...] = ()
    swept: Design | Engine | Subject = field(default_factory=Design)
    scatter: Scatter | None = None
    effort: Effort = Effort.QUICK
    rtol: float = DEFAULT_TOLERANCE

    def __post_init__(self) -> None:
        """Refuse what makes no sense."""
        found = list(wrong_fields(self))
        if found:
            raise InvalidProblem(found)
        plain = {str(name): (float(a), float(b)) for name, (a, b) in self.bounds.items()}
        object.__setattr__(self, "bounds", plain)

    def replace(self, **changes: Any) -> Problem:
        """Copy with some fields replaced."""
        return dataclasses.replace(self, **changes)

    @cached_property
    def subject(self) -> Subject:
        """What evaluates a design."""
        return subject_of(self.swept)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        return tuple(self.bounds)

    @cached_property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds (SI)."""
        low, high = np.array(list(self.bounds.values())).T
        return low, high

    @cached_property
    def units(self) -> dict[str, str]:
        """Units of the columns of a table, in their order."""
        inputs = {name: self.subject.unit(name) for name in self.bounds}
        scattered = dict.fromkeys(SCATTER_FIGURES, "-") if self.scatter is not None else {}
        return {**inputs, **_results(self.subject, inputs), **scattered, "score": "-"}

    @property
    def has_multipliers(self) -> bool:
        """Whether it can be told if an orbit is stable."""
        return "largest_multiplier" in self.subject.units

    def candidate(self, values: Mapping[str, Any]) -> Any:
        """The design, or engine, with the parameters of a row."""
        return self.swept.replace(**{name: float(values[name]) for name in self.bounds})  # type: ignore[union-attr]

    def evaluate(
        self,
        X: Any,
        *,
        multipliers: bool = False,
        executor: Executor | None = None,
        workers: int | None = None,
    ) -> pd.DataFrame:
        """Evaluate designs.

        Parameters
        ----------
        X : array_like or DataFrame, shape (designs, parameters)
            Values (SI) in the order of the bounds, or columns of their names.
        multipliers : bool
            Differentiate each steady state: whether it is stable. It costs several times the rest.
        executor, workers
            As for :func:`saleg.steady_states`; the table does not depend on them.

        Returns
        -------
        DataFrame
            One row per design, in order: parameters, status, message, figures, score.

        Raises
        ------
        InvalidProblem
            If these are no rows of finite numbers.
        """
        table = self.rows(X, multipliers, executor, workers)
        table.attrs["units"] = {name: self.units[name] for name in map(str, table)}
        table.attrs["inputs"] = list(self.bounds)
        return table

    def rows(
        self,
        X: Any,
        multipliers: bool = False,
        executor: Executor | None = None,
        workers: int | None = None,
    ) -> pd.DataFrame:
        """Rows of designs, as :meth:`evaluate` gives them, without units."""
        import pandas as pd

        held = X
        if not isinstance(X, pd.DataFrame):
            array = as_array(X)
            if array is not None and array.ndim == 2 and array.shape[1] == len(self.bounds):
                held = pd.DataFrame(array, columns=list(self.bounds))
        found = list(wrong_designs("X", held, self.bounds))
        if found:
            raise InvalidProblem(found)
        points = held[list(self.bounds)].astype(float)
        table = evaluated(self, points, multipliers, executor, workers)
        if self.scatter is not None:
            again = partial(evaluated, self, executor=executor, workers=workers)
            nominal = self.swept.get  # type: ignore[union-attr]
            table = self.scatter.added(table, points, again, self.score, nominal)
        return scored(table, self)

    def told(self, table: pd.DataFrame) -> Told:
        """What a method is told of the rows of a table."""
        known = np.asarray(is_known(table)) & np.ones(len(table), bool)
        values = np.column_stack([objective.values(table) for objective in self.objectives])
        scored_only = all(objective.figure == "score" for objective in self.objectives)
        values = np.where(known[:, None] | scored_only, values, np.nan)
        missed = np.zeros(len(table))
        for limit in self.constraints:
            missed += limit.violation(table)
        if not scored_only and "largest_multiplier" in table:
            missed += table["largest_multiplier"].to_numpy(dtype=float) > 1.0
        if not scored_only or self.constraints:
            missed = np.where(known & ~np.isnan(missed), missed, np.inf)
        fitness = np.where(missed > 0.0, MISSES - np.minimum(missed, -MISSES), values[:, 0])
        fitness = np.where(np.isnan(fitness) | np.isinf(missed), FAILED, fitness)
        guide = fitness
        if self.objectives[0].figure == "score" and hasattr(self.score, "miss"):
            guide = fitness - np.where(known, self.score.miss(table), 1.0)
        return Told(table, values, missed, fitness, guide)

    def shown(self, fitness: float) -> float:
        """First objective behind a fitness, in its SI unit; NaN for missed limits and no result."""
        if not fitness > MISSES:
            return math.nan
        return fitness if self.objectives[0].maximise else -fitness

    def describe(self) -> dict[str, Any]:
        """All that decides about the course of an optimisation, as plain data."""
        return {
            "bounds": {name: list(ends) for name, ends in self.bounds.items()},
            "score": described(self.score, "score") if not _is_function(self.score) else {},
            "own_score": described(_Held(self.score), "score") if _is_function(self.score) else {},
            "objectives": [list(item) for item in self.objectives],
            "constraints": [
                [item.figure, repr(item.low), repr(item.high)] for item in self.constraints
            ],
            "swept": self.subject.describe(),
            "scatter": {} if self.scatter is None else described(self.scatter, "scatter"),
            "effort": self.effort.value,
            "rtol": self.rtol,
        }


@dataclass(frozen=True)
class _Held:
    """A plain function, as an object whose fields can be described."""

    function: Any


def _is_function(score: Any) -> bool:
    return not hasattr(type(score), "__dataclass_fields__") and hasattr(score, "__code__")


def _results(subject: Subject, inputs: Mapping[str, str]) -> dict[str, str]:
    """Units of the figures of a row, but for its score."""
    held = {str(name): unit for name, unit in subject.units.items() if name != "score"}
    return {name: unit for name, unit in held.items() if name not in inputs}


def evaluated(
    problem: Problem,
    points: pd.DataFrame,
    multipliers: bool = False,
    executor: Executor | None = None,
    workers: int | None = None,
) -> pd.DataFrame:
    """Rows of points, which may have columns beside the parameters, with all columns in order.

    Each is searched for by itself: what it becomes decides what is tried next, and the last digit
    must depend neither on who does the work nor on what has been compiled before.
    """
    import pandas as pd

    solver = partial(problem.subject.solver, problem.rtol, multipliers, False, problem.effort)
    at_once = PIECES * (workers or os.cpu_count() or 1)
    chunk = min(max(math.ceil(len(points) / at_once), 1), MOST_TOGETHER)
    work = chunk, executor, workers, _by_itself
    evaluation = Evaluation(points, problem.subject, solver, *work)
    rows = evaluation.table(dict(evaluation.parts()))
    columns = {name: points[name].to_numpy(dtype=float) for name in points}
    for name in _results(problem.subject, evaluation.input_units):
        kind = kind_of(name)
        known = rows[name].to_numpy() if name in rows else np.full(len(rows), MISSING[kind], kind)
        columns[name] = known
    return pd.DataFrame(columns)


def _by_itself(_: int) -> int:
    return BY_ITSELF


def scored(table: pd.DataFrame, problem: Problem) -> pd.DataFrame:
    """A table with the score of a problem as its last column."""
    rest = table.drop(columns="score", errors="ignore")
    return rest.assign(score=score_of(rest, problem.score))


def score_of(table: pd.DataFrame, score: Callable[[Any], Any]) -> np.ndarray:
    """Scores of the rows of a table; 0 without a steady state.

    Raises
    ------
    InvalidScore
        If a row with a steady state has no score from 0 to 1.
    """
    given = score(table)
    known = np.broadcast_to(is_known(table), len(table))
    try:
        values = np.broadcast_to(np.asarray(given, dtype=float), len(table))
        wrong = values[known & ~((values >= 0.0) & (values <= 1.0))].tolist()
    except (TypeError, ValueError):
        wrong = [given]
    if wrong:
        need = "must be a number for every row with a steady state, from 0 to 1"
        raise InvalidScore([Wrong("score", wrong[0], "-", need)])
    return np.where(known, values, 0.0)
