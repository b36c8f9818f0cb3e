"""What every method of optimisation is: settings that begin a search, which asks and is told.

A search works in the unit cube, the box of the problem scaled to 0..1. It is a function of its
settings, the seed, the start and what it was told, of nothing else; so a search that was
interrupted is got back by telling it again what it asked for.
"""

from __future__ import annotations

import dataclasses
import importlib.util
from collections.abc import Iterator
from typing import Any, NamedTuple, Protocol

import numpy as np

from saleg.errors import Problem as Wrong
from saleg.optimize.fronts import first_front
from saleg.optimize.problem import MISSES, Problem, Told
from saleg.quantities import problems

#: Designs of a population, or cells of an axis, at most; more would fill the memory.
MOST = 1_000_000


class Start(NamedTuple):
    """Where a search begins.

    Attributes
    ----------
    dimension : int
        Number of parameters.
    objectives : int
        Number of objectives.
    seed : int
        Seed of all its random numbers.
    given : ndarray, shape (designs, dimension)
        Designs to start from, in the unit cube; may be empty.
    """

    dimension: int
    objectives: int
    seed: int
    given: np.ndarray

    def designs(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """So many designs to begin with: those given first, the rest uniform in the cube."""
        given = self.given[:count]
        return np.vstack([given, rng.random((count - len(given), self.dimension))])


class Search(Protocol):
    """A search under way."""

    @property
    def finished(self) -> bool:
        """Whether it asks for no more by its own rules."""

    def ask(self) -> np.ndarray:
        """Designs to evaluate next, a row each, in the unit cube."""

    def tell(self, told: Told) -> float:
        """Take what was asked for, evaluated; returns the mean fitness of the generation."""


class Method:
    """Base of the settings of methods."""

    #: Package a method needs beside those of saleg.
    package = ""
    #: Whether it takes more than one objective.
    takes_fronts = False

    def begin(self, start: Start) -> Search:
        """Begin a search."""
        raise NotImplementedError

    def leaders(self, problem: Problem, told: Told) -> np.ndarray:
        """Rows that stand for the result, whose stability has to be known."""
        if told.objectives.shape[1] > 1:
            return first_front(told.objectives, told.violation)
        if not len(told.fitness) or told.fitness.max() <= MISSES:
            return np.zeros(0, int)
        return np.array([int(np.argmax(told.fitness))])

    def wrong(self, problem: Problem) -> Iterator[Wrong]:
        """All that keeps it from being used for a problem, its settings first."""
        if dataclasses.is_dataclass(self):
            yield from problems(self, "method")
        name = type(self).__name__
        if self.package and importlib.util.find_spec(self.package) is None:
            need = f'needs {self.package}: pip install "saleg[optimize]"'
            yield Wrong("method", name, "-", need)
        if len(problem.objectives) > 1 and not self.takes_fronts:
            need = f"takes one objective, the problem has {len(problem.objectives)}; use NSGA2"
            yield Wrong("method", name, "-", need)


def mean_of(fitness: np.ndarray) -> float:
    """Mean fitness of what meets the limits; NaN if nothing does."""
    met = fitness[fitness > MISSES]
    return float(met.mean()) if len(met) else np.nan


def plain(values: Any) -> np.ndarray:
    """Designs as an array of their own, inside the unit cube."""
    return np.clip(np.array(values, dtype=float), 0.0, 1.0)
