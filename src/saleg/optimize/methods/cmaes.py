"""CMA-ES with restarts: Hansen's ``cma`` (BSD), asked and told."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.errors import Problem as Wrong
from saleg.optimize.methods.base import MOST, Method, Search, Start, mean_of, plain
from saleg.optimize.problem import Problem, Told
from saleg.quantities import quantity


@dataclass(frozen=True, kw_only=True)
class CMAES(Method):
    """CMA-ES, restarted with a doubled population where it has converged.

    It begins at the best of the designs given, or of a random sample. A restart begins at the next
    best of these.

    Parameters
    ----------
    size : int
        Designs of a generation.
    step : float
        First standard deviation over the range of each parameter [-].
    sample : int
        Random designs to begin with where none are given.

    References
    ----------
    .. [1] N. Hansen, "The CMA evolution strategy: a tutorial", 2016,
       https://arxiv.org/abs/1604.00772
    """

    package = "cma"
    size: int = quantity("-", default=20, low=4, high=MOST, whole=True)
    step: float = quantity("-", default=0.25, low=0, high=1, open_low=True)
    sample: int = quantity("-", default=100, low=1, whole=True)

    def begin(self, start: Start) -> Search:
        """Begin with a sample."""
        return _Search(self, start)

    def wrong(self, problem: Problem) -> Iterator[Wrong]:
        """All that keeps it from being used for a problem."""
        yield from super().wrong(problem)
        if len(problem.bounds) == 1:
            yield Wrong("method", "CMAES", "-", "needs two parameters at least")


class _Search:
    finished = False

    def __init__(self, settings: CMAES, start: Start):
        self._settings, self._rng = settings, np.random.default_rng(start.seed)
        count = len(start.given) or settings.sample
        self._sample = start.designs(count, self._rng)
        self._strategy: Any = None
        self._restarts = 0
        self._asked: Any = None

    def ask(self) -> np.ndarray:
        """The sample; then generations."""
        if self._strategy is None:
            return self._sample
        self._asked = self._strategy.ask()
        return plain(self._asked)

    def tell(self, told: Told) -> float:
        """Rank the sample, or adapt; begin anew where all has been found."""
        if self._strategy is None:
            self._sample = self._sample[np.argsort(-told.guide, kind="stable")]
            self._strategy = self._begun()
        else:
            self._strategy.tell(self._asked, -told.guide)
            if self._strategy.stop():
                self._restarts += 1
                self._strategy = self._begun()
        return mean_of(told.fitness)

    def _begun(self) -> Any:
        """A strategy that begins at one of the sample."""
        from cma import CMAEvolutionStrategy

        # Its own random numbers: with a seed it would seed those of numpy for everybody.
        options = {
            "bounds": [0.0, 1.0],
            "popsize": self._settings.size * 2**self._restarts,
            "randn": lambda *shape: self._rng.standard_normal(shape),
            "seed": math.nan,
            "verbose": -9,
        }
        start = self._sample[self._restarts % len(self._sample)]
        return CMAEvolutionStrategy(start, self._settings.step, options)
