"""Tables of inputs: every row a point that is evaluated, beside which its results stand."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from concurrent.futures import Executor
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from saleg.batch.table import Columns, Row, in_pieces, rows_of, suitable_chunk, table_of
from saleg.batch.workers import check_workers
from saleg.errors import SweepError, raise_together
from saleg.quantities import is_number

if TYPE_CHECKING:
    import pandas as pd

#: Values of the inputs of a point (SI), by name.
Values = Mapping[str, float]


class Solver(Protocol):
    """Makes rows of points; may remember the point before.

    One that has a method ``columns``, which takes a list of points and gives their rows column by
    column, is asked for all points of a piece at once.
    """

    def __call__(self, values: Values) -> Row:
        """Row of a point."""


class Evaluated(Protocol):
    """What a table of inputs is evaluated with."""

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns of results, in their order."""

    def unit(self, name: str) -> str:
        """Unit of an input; raises UnknownPath if there is none of that name."""

    def refuse_clash(self, names: Iterable[str]) -> None:
        """Refuse inputs of which two stand for one number; raises PathsClash."""


class Evaluation:
    """Evaluation of a table of inputs.

    Parameters
    ----------
    points : DataFrame
        One point per row, one input per column (SI).
    evaluated : Evaluated
    solver : callable
        Makes what makes a row of a point, and may remember the point before; each piece of work
        gets one of its own.
    chunk, executor, workers
        As for :func:`saleg.steady_states`.
    told : callable
        Makes of the number of points what the search is told it is, see :mod:`saleg.steady.lanes`.

    Attributes
    ----------
    points : DataFrame
        The points, checked, numbered from 0, with units in ``.attrs``.

    Raises
    ------
    SweepError
        If the points are no table of numbers by name.
    UnknownPath
        If there is no input of that name.
    PathsClash
        If two inputs stand for one number.
    WorkersError
        If nobody could do the work so.
    """

    def __init__(
        self,
        points: pd.DataFrame,
        evaluated: Evaluated,
        solver: Callable[[], Solver],
        chunk: int | None,
        executor: Executor | None,
        workers: int | None,
        told: Callable[[int], int] = int,
    ):
        _check(points, evaluated)
        check_workers(executor, workers, 1 if chunk is None else chunk)
        solver()  # what it refuses, it refuses here
        self.input_units = {str(name): evaluated.unit(str(name)) for name in points}
        self.points = self._described(points.reset_index(drop=True), self.input_units)
        self.chunk = suitable_chunk(len(points)) if chunk is None else chunk
        self._result_units = evaluated.units
        self._pieces = partial(
            in_pieces,
            partial(_rows, solver, total=told(len(points))),
            chunk=self.chunk,
            executor=executor,
            workers=workers,
        )

    def parts(self, done: Collection[int] = ()) -> Iterator[tuple[int, Columns]]:
        """Results of numbered pieces as they are completed, but for those done before."""
        return self._pieces(_values(self.points), done=done, total=len(self.points))

    def table(self, parts: Mapping[int, Columns]) -> pd.DataFrame:
        """Inputs and results in order."""
        import pandas as pd

        found = {name for part in parts.values() for name in part}
        units = {name: unit for name, unit in self._result_units.items() if name in found}
        results = table_of(parts, {name: units[name] for name in units if name not in self.points})
        table = pd.concat([self.points, results], axis=1)
        return self._described(table, {**units, **self.input_units})

    def _described(self, table: pd.DataFrame, units: Mapping[str, str]) -> pd.DataFrame:
        from saleg.simulation.shown_table import Table

        table = Table.of(table, {str(name): units[str(name)] for name in table})
        table.attrs["inputs"] = list(self.input_units)
        return table


def evaluated_points(*given: Any) -> pd.DataFrame:
    """Evaluate a table of inputs; parameters as for :class:`Evaluation`."""
    evaluation = Evaluation(*given)
    return evaluation.table(dict(evaluation.parts()))


def refuse_parts(name: str, value: Any) -> None:
    """Refuse an input that is a law or another part, in place of a number."""
    if not is_number(value):
        raise SweepError(f"{name} is no number but a {type(value).__name__}: name one of its own")


def _values(points: pd.DataFrame) -> Iterator[Values]:
    """Points one by one, each by name of the input."""
    names = [str(name) for name in points]
    for row in points.itertuples(index=False, name=None):
        yield dict(zip(names, map(float, row), strict=True))


def _rows(solver: Callable[[], Solver], points: Iterable[Values], total: int) -> Columns:
    """Rows of a piece of so many points; each piece begins without memory."""
    fresh = solver()
    columns = getattr(fresh, "columns", None)
    return rows_of(fresh, points) if columns is None else columns(points, total)


def _check(points: pd.DataFrame, evaluated: Evaluated) -> None:
    """Refuse what makes no sense before any work is done."""
    import pandas as pd

    if not isinstance(points, pd.DataFrame):
        raise SweepError(
            f"points are a {type(points).__name__}: must be a DataFrame, as sweep.grid makes one"
        )
    if not len(points.columns):
        raise SweepError("no inputs: the points have no columns")
    if not points.columns.is_unique:
        raise SweepError(f"an input stands twice in {', '.join(map(str, points.columns))}")
    checks = [partial(_check_input, name, points[name], evaluated) for name in points]
    raise_together(SweepError, checks)
    evaluated.refuse_clash(map(str, points))


def _check_input(name: Any, values: pd.Series, evaluated: Evaluated) -> None:
    """Refuse what is no input, or no numbers for one."""
    evaluated.unit(str(name))
    if not all(is_number(value) for value in values):
        raise SweepError(f"{name}: every value of an input must be a number")
