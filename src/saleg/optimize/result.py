"""What an optimisation has found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design.loop import solve
from saleg.design.terms import is_known
from saleg.engine import Engine
from saleg.optimize.fronts import first_front
from saleg.optimize.methods.archive import Axis, cells_of, elites, wrong_axes
from saleg.optimize.methods.base import Method
from saleg.optimize.problem import MISSES, InvalidProblem, Problem

if TYPE_CHECKING:
    import pandas as pd

    from saleg.plotting.optimisation import OptimisationPlots


@dataclass(frozen=True, eq=False)
class Found:
    """Result of an optimisation.

    Attributes
    ----------
    problem : Problem
    method : Method
    seed : int
    table : DataFrame
        Every design evaluated, in order: parameters, status, figures, score; the number of its
        generation; ``copied``, whether its row is that of an equal design before it; ``verified``,
        whether its multipliers were computed. ``stable`` is True where these say so.
    history : DataFrame
        A row per generation: evaluations so far, best fitness so far, mean fitness (of the
        genetic algorithm: over parents and children before selection, Figure 86).
    message : str
        Why it ended.
    """

    problem: Problem
    method: Method
    seed: int
    table: pd.DataFrame = field(repr=False)
    history: pd.DataFrame = field(repr=False)
    message: str

    @property
    def best(self) -> dict[str, Any]:
        """The row of the greatest fitness: parameters, status, figures, score.

        Its stability is known by its multipliers. With several objectives the first one decides.
        """
        fitness = self.problem.told(self.table).fitness
        row = self.table.iloc[int(np.argmax(fitness))].to_dict()
        return {str(name): value for name, value in row.items()}

    @property
    def front(self) -> pd.DataFrame:
        """Designs within the limits of which none is better in all objectives."""
        told = self.problem.told(self.table)
        return self.table.iloc[first_front(told.objectives, told.violation)]

    def archive(self, *axes: Axis) -> pd.DataFrame:
        """The best design of every cell of a map over some figures.

        Parameters
        ----------
        *axes : Axis

        Returns
        -------
        DataFrame
            Rows of the table, with the number of the ``cell``, counted through all axes.

        Raises
        ------
        InvalidProblem
            Naming all that is wrong with the axes.
        """
        found = list(wrong_axes("axes", axes, self.problem))
        if found:
            raise InvalidProblem(found)
        told = self.problem.told(self.table)
        kept = elites(axes, told)
        return self.table.iloc[kept].assign(cell=cells_of(axes, self.table)[kept])

    def design(self) -> Any:
        """The best design, or engine, to be evaluated or changed further."""
        return self.problem.candidate(self.best)

    def engine(self) -> Engine:
        """The best design as an engine, with the moving mass it has in its steady state.

        ``found.engine().to_toml()`` is a file that ``saleg run`` takes.
        """
        best = self.design()
        if isinstance(best, Engine):
            return best
        return solve(best, rtol=self.problem.rtol).engine

    @property
    def plot(self) -> OptimisationPlots:
        """Figures: ``found.plot.convergence()`` and so on; ``dir`` lists them."""
        from saleg.plotting.optimisation import OptimisationPlots

        return OptimisationPlots(self)

    @property
    def succeeded(self) -> bool:
        """Whether the best design has a steady state within all limits."""
        told = self.problem.told(self.table)
        row = int(np.argmax(told.fitness))
        return bool(is_known(self.table.iloc[[row]])[0] and told.fitness[row] > MISSES)

    def __repr__(self) -> str:
        return f"<Found: {self}>"

    def _repr_html_(self) -> str:
        from saleg.display import found_card

        return found_card(self)

    def __str__(self) -> str:
        if not self.succeeded:
            count = f"{len(self.table)} designs of {type(self.method).__name__}"
            return f"no steady state within the limits in {count} ({self.message})"
        best = self.best
        name, method = self.problem.objectives[0].figure, type(self.method).__name__
        designs = f"{len(self.table)} designs of {method}"
        return f"{name} {best[name]:.5g} after {designs} ({self.message})"
