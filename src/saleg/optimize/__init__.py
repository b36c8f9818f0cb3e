"""Optimisation (4.3): problems, scores, methods, and a log in which nothing is lost.

Examples
--------
>>> import saleg
>>> problem = saleg.optimize.thesis_problem(target_power=4e3, compression_ratio=(5.0, 25.0))
>>> found = saleg.optimize.optimize(problem, evaluations=30, seed=1)
>>> len(found.table), found.best["stable"]
(30, True)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from saleg.design.score import Score
from saleg.design.terms import (
    Bell,
    Below,
    InvalidScore,
    Limit,
    Own,
    Range,
    Reached,
    Repeats,
    Term,
    Within,
)
from saleg.design.weighted import Weighted, WeightedScore
from saleg.errors import Problem as _Wrong
from saleg.optimize.log import OptimisationError
from saleg.optimize.loop import Progress, optimize
from saleg.optimize.methods import (
    CMAES,
    METHODS,
    NSGA2,
    Archive,
    Axis,
    CompassSearch,
    DifferentialEvolution,
    GeneticAlgorithm,
    Method,
)
from saleg.optimize.objectives import Objective
from saleg.optimize.presets import (
    BOX,
    SCRIPT_BOX,
    Preset,
    script_score,
    thesis_problem,
    thesis_script,
    thesis_text,
)
from saleg.optimize.problem import InvalidProblem, Problem, Told, score_of
from saleg.optimize.result import Found
from saleg.optimize.scatter import Scatter
from saleg.optimize.stages import improve, polish, winners

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "BOX",
    "CMAES",
    "METHODS",
    "NSGA2",
    "SCRIPT_BOX",
    "Archive",
    "Axis",
    "Bell",
    "Below",
    "CompassSearch",
    "DifferentialEvolution",
    "Found",
    "GeneticAlgorithm",
    "InvalidProblem",
    "InvalidScore",
    "Limit",
    "Method",
    "Objective",
    "OptimisationError",
    "Own",
    "Preset",
    "Problem",
    "Progress",
    "Range",
    "Reached",
    "Repeats",
    "Scatter",
    "Score",
    "Term",
    "Told",
    "Weighted",
    "WeightedScore",
    "Within",
    "improve",
    "optimize",
    "polish",
    "score",
    "script_score",
    "thesis_problem",
    "thesis_script",
    "thesis_text",
    "winners",
]


def score(table: pd.DataFrame, problem: Problem | Any) -> pd.Series:
    """Score rows again, without evaluating anything (Table 11).

    Parameters
    ----------
    table : DataFrame
        Rows with the figures the score reads: of an optimisation, a sweep, or a printed table.
        Rows without a status count as steady states.
    problem : Problem or score
        Whose score to take.

    Returns
    -------
    Series
        0 to 1; 0 without a steady state.

    Examples
    --------
    >>> from saleg.thesis import chapter_4
    >>> printed = chapter_4.printed(9)
    >>> bool(score(printed.loc[["4 kW"]], thesis_problem(4e3)).iloc[0] > 0.998)
    True
    """
    import pandas as pd

    given = problem.score if isinstance(problem, Problem) else problem
    if not isinstance(table, pd.DataFrame) or not callable(given):
        wrong = table if callable(given) else problem
        need = "must be a DataFrame, and a problem or a score"
        raise InvalidProblem([_Wrong("score", wrong, "-", need)])
    return pd.Series(score_of(table, given), index=table.index, name="score")
