"""Second stages: what is done with the winners of a score."""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.checks import a, checked, whole
from saleg.errors import Problem as Wrong
from saleg.optimize.loop import optimize
from saleg.optimize.methods import CMAES, CompassSearch, Method, default_method
from saleg.optimize.objectives import Objective
from saleg.optimize.problem import InvalidProblem, Problem
from saleg.optimize.result import Found

#: Designs a second stage begins with.
WINNERS = 8
#: CMA-ES around the winners. Measured on 4 kW: with wider steps (0.1, 0.2) it first falls off the
#: ridge the winners are on, and seldom comes back in a thousand designs.
NEAR = CMAES(step=0.05, size=16)


def improve(
    found: Found,
    objective: str | Objective = "efficiency",
    method: Method | str | None = None,
    evaluations: int = 1000,
    seed: int = 0,
    **further: Any,
) -> Found:
    """Make one figure as great as possible within the limits of a score, from its winners on.

    A score saturates: beyond its targets nothing pulls any more. The limits are those its terms
    ask for (:class:`Limit`), beside the constraints of the problem: 5 % around a target, the ends
    of a range, the limit of a pressure.

    Parameters
    ----------
    found : Found
    objective : str or Objective
        Figure to maximise, or an :class:`Objective`.
    method : Method, optional
        CMA-ES with a small step unless given.
    evaluations, seed, **further
        As for :func:`optimize`.

    Returns
    -------
    Found

    Examples
    --------
    >>> import saleg
    >>> problem = saleg.optimize.thesis_problem(4e3)
    >>> rough = saleg.optimize.optimize(problem, evaluations=20)
    >>> better = improve(rough, evaluations=8)
    >>> [limit.figure for limit in better.problem.constraints]
    ['power', 'compression_ratio', 'peak_pressure']
    """
    _refuse_other(found)
    wanted = Objective(objective) if isinstance(objective, str) else objective
    problem = found.problem
    limits = (*problem.constraints, *getattr(problem.score, "limits", ()))
    goal = problem.replace(objectives=(wanted,), constraints=tuple(dict.fromkeys(limits)))
    if method is None:
        method = default_method(1)
        method = NEAR if isinstance(method, CMAES) else method
    return optimize(goal, method, evaluations, seed, start=winners(found, goal), **further)


def polish(found: Found, evaluations: int = 400, **further: Any) -> Found:
    """Follow the objective from the best design to its local optimum, by a compass search.

    Parameters
    ----------
    found : Found
    evaluations, **further
        As for :func:`optimize`.

    Returns
    -------
    Found
    """
    start = winners(found, count=1)
    return optimize(found.problem, CompassSearch(), evaluations, start=start, **further)


@checked(problem=a(Problem).optional, count=whole(1))
def winners(found: Found, problem: Problem | None = None, count: int = WINNERS) -> Any:
    """The best designs of a result, by the fitness of another problem with the same parameters.

    Parameters
    ----------
    found : Found
    problem : Problem, optional
        That of the result unless given.
    count : int

    Returns
    -------
    DataFrame
        Rows of the table, the best first, no design twice.

    Raises
    ------
    InvalidProblem
        If the problem has other parameters.
    """
    _refuse_other(found)
    problem = found.problem if problem is None else problem
    if list(problem.bounds) != list(found.problem.bounds):
        need = f"must have the parameters {', '.join(found.problem.bounds)}"
        raise InvalidProblem([Wrong("problem", list(problem.bounds), "-", need)])
    table = found.table.drop_duplicates(list(problem.bounds))
    order = np.argsort(-problem.told(table).fitness, kind="stable")
    return table.iloc[order[:count]]


def _refuse_other(found: Any) -> None:
    if not isinstance(found, Found):
        raise InvalidProblem([Wrong("found", found, "-", "must be what optimize(...) returns")])
