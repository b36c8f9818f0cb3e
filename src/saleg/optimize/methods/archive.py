"""An archive over two figures (MAP-Elites): the best design of every cell of a map."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.batch.table import TEXT
from saleg.errors import Problem as Wrong
from saleg.errors import nearest
from saleg.optimize.methods.base import MOST, Method, Search, Start, mean_of
from saleg.optimize.problem import MISSES, Problem, Told
from saleg.quantities import is_number, is_whole, quantity

if TYPE_CHECKING:
    import pandas as pd


class Axis(NamedTuple):
    """An axis of a map: a figure, its range and how many cells that has.

    Attributes
    ----------
    figure : str
        Column of the table.
    low, high : float
        Ends of the range, in the SI unit of the figure.
    cells : int
        Number of cells.
    """

    figure: str
    low: float
    high: float
    cells: int = 20

    def cell(self, values: np.ndarray) -> np.ndarray:
        """Number of the cell of each value; -1 outside the range and for NaN."""
        with np.errstate(invalid="ignore"):
            share = (values - self.low) / (self.high - self.low)
            inside = (share >= 0.0) & (share <= 1.0)
        return np.where(
            inside, np.minimum(np.where(inside, share, 0.0) * self.cells, self.cells - 1), -1.0
        ).astype(int)


#: The axes of Figure 88: maximum stroke to bore, and frequency [Hz].
STROKE_TO_BORE = Axis("stroke_to_bore", 0.5, 6.0)
FREQUENCY = Axis("frequency", 20.0, 120.0)


@dataclass(frozen=True, kw_only=True)
class Archive(Method):
    """MAP-Elites: a map of the best design in every cell of two figures.

    It shows where no good design exists, which the course of an optimiser does not.

    Parameters
    ----------
    axes : tuple of Axis
        Of the map; those of Figure 88 unless given.
    size : int
        Designs of a generation.
    sample : int
        Random designs to begin with.
    step, along : float
        A child is an elite moved by a normal deviate of `step` in every parameter and of `along`
        times the difference to another elite [-].

    References
    ----------
    .. [1] J.-B. Mouret and J. Clune, 2015, https://arxiv.org/abs/1504.04909
    .. [2] V. Vassiliades and J.-B. Mouret, GECCO 2018, https://doi.org/10.1145/3205455.3205602
    """

    axes: tuple[Axis, ...] = (STROKE_TO_BORE, FREQUENCY)
    size: int = quantity("-", default=48, low=1, high=MOST, whole=True)
    sample: int = quantity("-", default=200, low=1, whole=True)
    step: float = quantity("-", default=0.02, low=0, open_low=True)
    along: float = quantity("-", default=0.2, low=0)

    def begin(self, start: Start) -> Search:
        """Begin with a sample."""
        return _Search(self, start)

    def leaders(self, problem: Problem, told: Told) -> np.ndarray:
        """The elites of all cells."""
        return elites(self.axes, told)

    def wrong(self, problem: Problem) -> Iterator[Wrong]:
        """All that keeps it from being used for a problem."""
        yield from super().wrong(problem)
        yield from wrong_axes("method.axes", self.axes, problem)


class _Search:
    finished = False

    def __init__(self, settings: Archive, start: Start):
        self._settings, self._rng = settings, np.random.default_rng(start.seed)
        self._asked = start.designs(max(settings.sample, len(start.given)), self._rng)
        self._genes = np.zeros((0, start.dimension))
        self._fitness = np.zeros(0)
        self._cells = np.zeros(0, int)
        self._told = False

    def ask(self) -> np.ndarray:
        """The sample; then children of elites, or more random designs while there are none."""
        settings, rng = self._settings, self._rng
        shape = (settings.size, self._genes.shape[1])
        if self._told and not len(self._genes):
            self._asked = rng.random(shape)
        elif self._told:
            one, other = self._genes[rng.integers(len(self._genes), size=(2, settings.size))]
            along = settings.along * rng.standard_normal((settings.size, 1)) * (other - one)
            moved = one + settings.step * rng.standard_normal(shape) + along
            self._asked = np.clip(moved, 0.0, 1.0)
        return self._asked

    def tell(self, told: Told) -> float:
        """Keep the best of each cell, the older one on ties."""
        genes = np.vstack([self._genes, self._asked])
        fitness = np.concatenate([self._fitness, told.fitness])
        cells = np.concatenate([self._cells, cells_of(self._settings.axes, told.table)])
        kept = _best_of_cells(cells, fitness)
        self._genes, self._fitness, self._cells = genes[kept], fitness[kept], cells[kept]
        self._told = True
        return mean_of(self._fitness)


def cells_of(axes: tuple[Axis, ...], table: pd.DataFrame) -> np.ndarray:
    """Number of the cell of each row, counted through all axes; -1 outside the map."""
    found = np.zeros(len(table), int)
    for axis in axes:
        cell = axis.cell(table[axis.figure].to_numpy(dtype=float))
        found = np.where((found < 0) | (cell < 0), -1, found * axis.cells + cell)
    return found


def elites(axes: tuple[Axis, ...], told: Told) -> np.ndarray:
    """Rows that are the best of their cells."""
    return _best_of_cells(cells_of(axes, told.table), told.fitness)


def _best_of_cells(cells: np.ndarray, fitness: np.ndarray) -> np.ndarray:
    """First row of the greatest fitness in each cell, in order; none that misses the limits."""
    order = np.lexsort((-fitness, cells))
    order = order[(cells[order] >= 0) & (fitness[order] > MISSES)]
    _, first = np.unique(cells[order], return_index=True)
    return np.sort(order[first])


def wrong_axes(where: str, axes: Any, problem: Problem) -> Iterator[Wrong]:
    """What is wrong with the axes of a map."""
    # An Axis is a tuple itself.
    if not isinstance(axes, (tuple, list)) or isinstance(axes, Axis) or not axes:
        yield Wrong(where, axes, "-", "must be a tuple with at least one Axis")
        return
    for number, axis in enumerate(axes):
        place = f"{where}[{number}]"
        if not isinstance(axis, Axis):
            yield Wrong(place, axis, "-", "must be an Axis")
            continue
        if not isinstance(axis.figure, str) or axis.figure not in problem.units:
            yield Wrong(
                place, axis.figure, "-", f"no row has it{nearest(axis.figure, problem.units)}"
            )
        elif axis.figure in TEXT:
            yield Wrong(place, axis.figure, "-", "is text; must be the name of a number")
        if not (is_number(axis.low) and is_number(axis.high) and axis.low < axis.high):
            yield Wrong(place, tuple(axis), "-", "must have low < high, both numbers")
        if not is_whole(axis.cells, 1, MOST):
            yield Wrong(place, axis.cells, "-", f"cells must be a whole number from 1 to {MOST}")
