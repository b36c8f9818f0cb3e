"""NSGA-II: pymoo's (Apache 2.0), asked and told."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.optimize.methods.base import MOST, Method, Search, Start, mean_of, plain
from saleg.optimize.problem import Told
from saleg.quantities import quantity

#: What a design without a steady state has as every objective, and misses the limits by.
WORST = 1e9


@dataclass(frozen=True, kw_only=True)
class NSGA2(Method):
    """NSGA-II: a front of several objectives under limits.

    It begins with the designs given, filled up with random ones. Without a seed of good designs
    fronts of engines stay poor: give the winners of a score as the start.

    Parameters
    ----------
    size : int
        Designs of a population.

    References
    ----------
    .. [1] K. Deb et al., IEEE Trans. Evolutionary Computation 6, 182-197, 2002,
       https://doi.org/10.1109/4235.996017
    """

    package = "pymoo"
    takes_fronts = True
    size: int = quantity("-", default=100, low=4, high=MOST, whole=True)

    def begin(self, start: Start) -> Search:
        """Begin with a population."""
        return _Search(self, start)


class _Search:
    finished = False

    def __init__(self, settings: NSGA2, start: Start):
        from pymoo.algorithms.moo import nsga2
        from pymoo.core.problem import Problem as Box
        from pymoo.core.termination import NoTermination

        rng = np.random.default_rng(start.seed)
        # Copies are cheap here, and mating again until there are none is not.
        self._theirs = nsga2.NSGA2(
            pop_size=settings.size,
            sampling=start.designs(settings.size, rng),
            eliminate_duplicates=False,
        )
        self._box = Box(
            n_var=start.dimension, n_obj=start.objectives, n_ieq_constr=1, xl=0.0, xu=1.0
        )
        self._theirs.setup(
            self._box, termination=NoTermination(), seed=int(rng.integers(2**31)), verbose=False
        )
        self._asked: Any = None

    def ask(self) -> np.ndarray:
        """The next generation."""
        self._asked = self._theirs.ask()
        return plain(self._asked.get("X"))

    def tell(self, told: Told) -> float:
        """Let it select."""
        from pymoo.problems.static import StaticProblem

        objectives = -np.nan_to_num(told.objectives, nan=-WORST)
        missed = np.minimum(told.violation, WORST)[:, None]
        known = StaticProblem(self._box, F=objectives, G=missed)
        self._theirs.evaluator.eval(known, self._asked)
        self._theirs.tell(infills=self._asked)
        return mean_of(told.fitness)
