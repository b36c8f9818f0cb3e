"""The genetic algorithm of the dissertation (4.3 and Appendix B VIII), rule by rule."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from saleg.errors import Problem as Wrong
from saleg.optimize.methods.base import MOST, Method, Search, Start, mean_of
from saleg.optimize.problem import Problem, Told
from saleg.quantities import as_float, quantity


@dataclass(frozen=True, kw_only=True)
class GeneticAlgorithm(Method):
    """Genetic algorithm of the dissertation; the defaults are those of its text.

    Every individual may mutate and may cross with a mate drawn uniformly; children join their
    parents, the best one is kept, and the rest of the next population is drawn by roulette with
    replacement. It needs scores: a fitness below 0 counts as 0.

    Parameters
    ----------
    size : int
        Individuals in a population.
    mutation, crossover : float
        Probability that an individual has a child by mutation, and one by crossover [-].
    generations : int
        Generations after the first population.
    stop : float
        Fitness of the best beyond which the search ends [-]; infinite for none.
    changed : float
        Share of the genes a mutation changes (script) [-].
    deviation : float
        Standard deviation of a changed gene over its range [-] (script: 1/15), before clipping.

    Notes
    -----
    A start is drawn from the designs given, with replacement, or uniform in the box.
    """

    size: int = quantity("-", default=500, low=2, high=MOST, whole=True)
    mutation: float = quantity("-", default=0.25, low=0, high=1)
    crossover: float = quantity("-", default=0.25, low=0, high=1)
    generations: int = quantity("-", default=70, low=1, whole=True)
    stop: float = 0.999
    changed: float = quantity("-", default=0.6, low=0, high=1)
    deviation: float = quantity("-", default=1.0 / 15.0, low=0, open_low=True)

    def begin(self, start: Start) -> Search:
        """Begin with a population drawn from the start."""
        return _Search(self, start)

    def wrong(self, problem: Problem) -> Iterator[Wrong]:
        """All that keeps it from being used for a problem."""
        yield from super().wrong(problem)
        if as_float(self.stop) is None or math.isnan(self.stop):
            yield Wrong("method.stop", self.stop, "-", "must be a number")
        if self.mutation == 0.0 == self.crossover:
            yield Wrong(
                "method.mutation", 0.0, "-", "no children: mutation or crossover must be > 0"
            )


class _Search:
    def __init__(self, settings: GeneticAlgorithm, start: Start):
        self._settings, self._rng = settings, np.random.default_rng(start.seed)
        size = (settings.size, start.dimension)
        if len(start.given):
            self._genes = start.given[self._rng.integers(len(start.given), size=settings.size)]
        else:
            self._genes = self._rng.random(size)
        self._fitness = np.zeros(0)
        self._asked = self._genes
        self._generation = 0
        self.finished = False

    def ask(self) -> np.ndarray:
        """The first population; then children by mutation, followed by those by crossover."""
        if len(self._fitness):
            settings, rng = self._settings, self._rng
            mutating = rng.random(settings.size) < settings.mutation
            crossing = rng.random(settings.size) < settings.crossover
            mutated = mutated_genes(
                self._genes[mutating], settings.changed, settings.deviation, rng
            )
            mates = self._genes[rng.integers(settings.size, size=int(crossing.sum()))]
            self._asked = np.vstack([mutated, crossed_genes(self._genes[crossing], mates, rng)])
        return self._asked

    def tell(self, told: Told) -> float:
        """Select the next population; returns the mean over parents and children before that."""
        fitness = np.maximum(told.fitness, 0.0)
        if not len(self._fitness):
            self._fitness = fitness
            return mean_of(fitness)
        genes = np.vstack([self._genes, self._asked])
        fitness = np.concatenate([self._fitness, fitness])
        order = np.argsort(-fitness, kind="stable")  # on ties the older one first
        drawn = roulette(fitness[order], self._settings.size - 1, self._rng)
        kept = order[np.concatenate([[0], drawn])]
        self._genes, self._fitness = genes[kept], fitness[kept]
        self._generation += 1
        best = self._fitness[0]
        self.finished = bool(
            self._generation >= self._settings.generations or best > self._settings.stop
        )
        return float(fitness.mean())


def mutated_genes(
    genes: np.ndarray, changed: float, deviation: float, rng: np.random.Generator
) -> np.ndarray:
    """Children by mutation: each gene on its own, clipped to its range."""
    chosen = rng.random(genes.shape) < changed
    moved = genes + deviation * rng.standard_normal(genes.shape)
    return np.clip(np.where(chosen, moved, genes), 0.0, 1.0)


def crossed_genes(parents: np.ndarray, mates: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Children by crossover: genes up to a point of the parent, the rest of the mate.

    The point is uniform on 1 to the number of genes: the first gene is the parent's always, and
    with the last point the child is a copy.
    """
    count = parents.shape[1]
    points = rng.integers(1, count + 1, size=(len(parents), 1))
    return np.where(np.arange(count) < points, parents, mates)


def roulette(fitness: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Rows drawn with replacement in proportion to fitness; all alike where it is 0 for all."""
    total = fitness.sum()
    if not total > 0.0:
        return rng.integers(len(fitness), size=count)
    wheel = np.cumsum(fitness) / total
    last = int(np.flatnonzero(fitness)[-1])  # rounding may leave the wheel short of 1
    return np.minimum(np.searchsorted(wheel, rng.random(count), side="right"), last)
