"""Differential evolution: scipy's, run in a thread of its own so that it asks and is told."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass
from queue import SimpleQueue

import numpy as np

from saleg.errors import Problem as Wrong
from saleg.errors import nearest
from saleg.optimize.methods.base import MOST, Method, Search, Start, mean_of, plain
from saleg.optimize.problem import Problem, Told
from saleg.quantities import as_float, quantity

#: Strategies of scipy.
STRATEGIES = tuple(
    f"{name}{kind}"
    for kind in ("bin", "exp")
    for name in ("best1", "best2", "rand1", "rand2", "currenttobest1", "randtobest1")
)


@dataclass(frozen=True, kw_only=True)
class DifferentialEvolution(Method):
    """Differential evolution of scipy, a whole generation at a time.

    It begins with the designs given, filled up with random ones, and has no end of its own.

    Parameters
    ----------
    size : int
        Designs of a population.
    strategy : str
        As :func:`scipy.optimize.differential_evolution` names them.
    mutation : (float, float)
        Range of the factor of differences, drawn anew for every generation.
    recombination : float
        Probability that a parameter is that of the mutant [-].

    References
    ----------
    .. [1] R. Storn and K. Price, J. Global Optimization 11, 341-359, 1997,
       https://doi.org/10.1023/A:1008202821328
    """

    size: int = quantity("-", default=48, low=5, high=MOST, whole=True)
    strategy: str = "best1bin"
    mutation: tuple[float, float] = (0.5, 1.0)
    recombination: float = quantity("-", default=0.7, low=0, high=1)

    def begin(self, start: Start) -> Search:
        """Begin with a population."""
        return _Search(self, start)

    def wrong(self, problem: Problem) -> Iterator[Wrong]:
        """All that keeps it from being used for a problem."""
        yield from super().wrong(problem)
        if self.strategy not in STRATEGIES:
            hint = nearest(self.strategy, STRATEGIES) or f"; there are {', '.join(STRATEGIES)}"
            yield Wrong("method.strategy", self.strategy, "-", f"unknown{hint}")
        ends = [as_float(end) for end in self.mutation] if np.iterable(self.mutation) else []
        if len(ends) != 2 or None in ends or not 0.0 <= ends[0] < ends[1] < 2.0:  # type: ignore[operator]
            yield Wrong("method.mutation", self.mutation, "-", "must be two rising numbers below 2")


class _Ended(Exception):
    """Nobody asks any more."""


class _Search:
    finished = False

    def __init__(self, settings: DifferentialEvolution, start: Start):
        rng = np.random.default_rng(start.seed)
        self._asked: SimpleQueue[np.ndarray | BaseException] = SimpleQueue()
        self._told: SimpleQueue[np.ndarray | None] = SimpleQueue()
        population = start.designs(settings.size, rng)
        given = (settings, start.dimension, population, int(rng.integers(2**31)))
        # The thread knows the queues, not the search, and so ends with it.
        queues = (self._asked, self._told)
        threading.Thread(target=_minimise, args=(*queues, *given), daemon=True).start()

    def ask(self) -> np.ndarray:
        """The next generation."""
        asked = self._asked.get()
        if isinstance(asked, BaseException):
            raise asked
        return asked

    def tell(self, told: Told) -> float:
        """Let the solver go on."""
        self._told.put(-told.guide)
        return mean_of(told.fitness)

    def __del__(self) -> None:
        self._told.put(None)


def _minimise(
    asked: SimpleQueue[np.ndarray | BaseException],
    told: SimpleQueue[np.ndarray | None],
    settings: DifferentialEvolution,
    dimension: int,
    first: np.ndarray,
    seed: int,
) -> None:
    """Let scipy minimise what the two queues make a function of."""
    from scipy.optimize import differential_evolution

    def function(designs: np.ndarray) -> np.ndarray:
        asked.put(plain(designs.T))
        values = told.get()
        if values is None:
            raise _Ended
        return values

    try:
        differential_evolution(
            function,
            [(0.0, 1.0)] * dimension,
            strategy=settings.strategy,
            mutation=settings.mutation,
            recombination=settings.recombination,
            init=first,
            maxiter=10**9,
            tol=-1.0,  # a population that agrees goes on
            seed=seed,
            polish=False,
            updating="deferred",
            vectorized=True,
        )
    except _Ended:
        return
    except BaseException as error:
        asked.put(error)
