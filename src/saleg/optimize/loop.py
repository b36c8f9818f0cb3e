"""Optimising: a method asks, the batch engine answers, and what it answered is kept."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import Executor
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.batch.identity import described
from saleg.batch.workers import WorkersError, check_workers
from saleg.design.terms import is_known
from saleg.errors import Problem as Wrong
from saleg.errors import nearest
from saleg.optimize.checks import wrong_designs
from saleg.optimize.log import Log, OptimisationError
from saleg.optimize.methods import METHODS, Method, Start, default_method
from saleg.optimize.problem import STABILITY, InvalidProblem, Problem, scored
from saleg.optimize.result import Found
from saleg.quantities import as_float, is_whole

if TYPE_CHECKING:
    import pandas as pd

#: Evaluations at most; more would fill the memory, if they ever came to an end.
MOST_EVALUATIONS = 10_000_000
#: Columns of a table beside those of its problem.
MARKS = ("generation", "copied", "verified")


class Progress(NamedTuple):
    """How far an optimisation is, after a generation that is on disk.

    Attributes
    ----------
    generation : int
        Number of the generation, from 1.
    evaluations, of : int
        Designs evaluated, and how many there may be.
    best, mean : float
        Best fitness so far, and the mean of this generation [-].
    """

    generation: int
    evaluations: int
    of: int
    best: float
    mean: float


def optimize(
    problem: Problem,
    method: Method | str | None = None,
    evaluations: int = 2000,
    seed: int = 0,
    folder: str | Path | None = None,
    executor: Executor | None = None,
    *,
    workers: int | None = None,
    start: pd.DataFrame | None = None,
    stop_at: float = math.inf,
    report: Callable[[Progress], None] | None = None,
) -> Found:
    """Optimise.

    Parameters
    ----------
    problem : Problem
        As :func:`saleg.optimize.thesis_problem` gives one.
    method : Method, optional
        How: :class:`CMAES` where it is installed unless given, else
        :class:`DifferentialEvolution`; :class:`NSGA2` for several objectives. Also its short name.
    evaluations : int
        Designs at most.
    seed : int
        The same seed gives the same designs, whoever does the work and whatever has been compiled
        before.
    folder : str or Path, optional
        Where every design is kept. An optimisation that was interrupted, or that gets more
        evaluations, goes on from there and ends as one that was not, to the last bit.
    executor, workers
        As for :func:`saleg.steady_states`; the result does not depend on them.
    start : DataFrame, optional
        Designs to begin with, a column per parameter (SI). Rows that have all other columns too,
        as those of ``found.table`` or of a sweep, are not evaluated again.
    stop_at : float
        Fitness at which to end [-].
    report : callable, optional
        Called with a :class:`Progress` after every generation.

    Returns
    -------
    Found
        The stability of what leads it is known by its multipliers: a design is differentiated
        before it becomes the best one (or one of the front, or of the archive).

    Raises
    ------
    InvalidProblem
        Naming all that is wrong.
    OptimisationError
        If the folder holds something else.

    Examples
    --------
    >>> import saleg
    >>> problem = saleg.optimize.thesis_problem(target_power=4e3)
    >>> method = saleg.optimize.GeneticAlgorithm(size=8, generations=2)
    >>> found = saleg.optimize.optimize(problem, method, evaluations=12)
    >>> len(found.table), 0.0 <= found.best["score"] <= 1.0
    (12, True)
    """
    if not isinstance(problem, Problem):
        raise InvalidProblem([Wrong("problem", problem, "-", "must be a saleg.optimize.Problem")])
    chosen = _method(method, len(problem.objectives))
    found = list(
        _wrong(problem, chosen, evaluations, seed, executor, workers, start, stop_at, report)
    )
    if found or not isinstance(chosen, Method):
        raise InvalidProblem(found)
    run = _Course(problem, chosen, int(seed), start, executor, workers)
    log = None if folder is None else Log(folder)
    with nullcontext(None) if log is None else log.opened(run.identity()) as before:
        return run.result(before, log, int(evaluations), float(stop_at), report)


def _method(method: Any, objectives: int) -> Any:
    if method is None:
        return default_method(objectives)
    return METHODS.get(method, method) if isinstance(method, str) else method


def _wrong(
    problem: Problem,
    method: Any,
    evaluations: Any,
    seed: Any,
    executor: Any,
    workers: Any,
    start: Any,
    stop_at: Any,
    report: Any,
) -> Iterator[Wrong]:
    """All that keeps an optimisation from beginning."""
    if isinstance(method, Method):
        yield from method.wrong(problem)
    else:
        need = f"must be a method, or one of {', '.join(METHODS)}{nearest(method, METHODS)}"
        yield Wrong("method", method, "-", need)
    if not is_whole(evaluations, 1, MOST_EVALUATIONS):
        need = f"must be a whole number from 1 to {MOST_EVALUATIONS}"
        yield Wrong("evaluations", evaluations, "-", need)
    if not is_whole(seed, 0):
        yield Wrong("seed", seed, "-", "must be a whole number >= 0")
    if as_float(stop_at) is None or math.isnan(stop_at):
        yield Wrong("stop_at", stop_at, "-", "must be a number")
    try:
        check_workers(executor, workers)
    except WorkersError as error:
        yield Wrong("workers", workers, "-", str(error))
    if report is not None and not callable(report):
        yield Wrong("report", report, "-", "must be a function")
    if start is not None:
        yield from wrong_designs("start", start, problem.bounds)
        if hasattr(start, "columns") and not len(start):
            yield Wrong("start", 0, "-", "must have at least one row")


class _Course:
    """An optimisation under way."""

    def __init__(
        self,
        problem: Problem,
        method: Method,
        seed: int,
        start: pd.DataFrame | None,
        executor: Executor | None,
        workers: int | None,
    ):
        self._problem, self._method, self._seed = problem, method, seed
        self._low, high = problem.box
        self._span = high - self._low
        self._workers: dict[str, Any] = {"executor": executor, "workers": workers}
        self._given = np.zeros((0, len(self._low)))
        # Where the row of a design is that was evaluated before: in which columns, and where there.
        self._known: dict[bytes, tuple[dict[str, np.ndarray], int]] = {}
        self._leaders: list[pd.DataFrame] = []
        self._start = ""
        if start is not None:
            self._take(start)

    def _take(self, start: pd.DataFrame) -> None:
        """Designs to begin with, and their rows if these are whole."""
        designs = start[list(self._problem.bounds)].to_numpy(dtype=float)
        given = (designs - self._low) / self._span
        self._given = np.clip(given, 0.0, 1.0)
        figures = [name for name in self._problem.units if name != "score"]
        whole = set(figures) <= set(start)
        start = start.copy()
        start.attrs.clear()  # copied with every step otherwise
        held = start[figures if whole else list(self._problem.bounds)]
        self._start = hashlib.sha256(held.to_csv().encode()).hexdigest()
        if whole:
            inside = (given == self._given).all(axis=1)
            rows = held.assign(verified=start.get("verified", False))[inside]
            self._remember(scored(rows.reset_index(drop=True), self._problem), given[inside])

    def identity(self) -> dict[str, Any]:
        """All that decides about the course, as plain data."""
        return {
            "problem": self._problem.describe(),
            "method": described(self._method, "method"),
            "seed": self._seed,
            "start": self._start,
            "units": self._problem.units,
        }

    def result(
        self,
        before: pd.DataFrame | None,
        log: Log | None,
        evaluations: int,
        stop_at: float,
        report: Callable[[Progress], None] | None,
    ) -> Found:
        """Let the search ask until it has enough; what the log holds already comes from there."""
        counts = (len(self._low), len(self._problem.objectives))
        search = self._method.begin(Start(*counts, self._seed, self._given))
        tables: list[pd.DataFrame] = []
        history: list[Progress] = []
        done, best, message = 0, -math.inf, "evaluations spent"
        while done < evaluations:
            asked = search.ask()
            designs = asked[: evaluations - done]
            known = 0 if before is None else min(max(len(before) - done, 0), len(designs))
            rows = self._rows(designs, None if before is None else before[done : done + known])
            rows = self._verified(rows.assign(generation=len(history)), known)
            if log is not None and known < len(rows):
                log.append(self._described(rows[known:]))
            self._remember(rows, designs)
            tables.append(rows)
            told = self._problem.told(rows)
            done += len(rows)
            best = max(best, float(told.fitness.max(initial=-math.inf)))
            mean = math.nan if len(designs) < len(asked) else search.tell(told)
            shown = self._problem.shown(best), self._problem.shown(mean)
            history.append(Progress(len(history), done, evaluations, *shown))
            if report is not None:
                report(history[-1])
            if search.finished or best >= stop_at:
                message = "the method ended" if search.finished else f"reached {stop_at:g}"
                break
        return self._found(self._described(joined(tables)), history, message)

    def _found(self, table: pd.DataFrame, history: list[Progress], message: str) -> Found:
        import pandas as pd

        course = pd.DataFrame(history, columns=Progress._fields).drop(columns="of")
        return Found(self._problem, self._method, self._seed, table, course, message)

    def _rows(self, designs: np.ndarray, logged: pd.DataFrame | None) -> pd.DataFrame:
        """Rows of designs: from the log, copies of equal ones before, or evaluated."""
        count = 0 if logged is None else len(logged)
        pieces = [self._evaluated(designs[count:])] if count < len(designs) or not count else []
        if logged is not None and count:
            values = logged[list(self._problem.bounds)].to_numpy(dtype=float)
            if not np.array_equal(values, self._values(designs[:count])):
                raise OptimisationError(
                    "the folder holds designs this method does not ask for: another version of "
                    "saleg, numpy, scipy, cma or pymoo wrote it; go on with that one, or name "
                    "another folder"
                )
            pieces.insert(0, scored(logged, self._problem))
        return joined(pieces)

    def _values(self, designs: np.ndarray) -> np.ndarray:
        """Values of the parameters (SI)."""
        return self._low + designs * self._span

    def _evaluated(self, designs: np.ndarray) -> pd.DataFrame:
        """Rows of designs; one that was evaluated before is copied."""
        keys = [design.tobytes() for design in designs]
        new: dict[bytes, int] = {}
        for number, key in enumerate(keys):
            if key not in self._known:
                new.setdefault(key, number)
        values = self._values(designs[list(new.values())])
        rows = self._problem.rows(values, **self._workers).assign(verified=False)
        old = dict.fromkeys(key for key in keys if key not in new)
        place = {key: number for number, key in enumerate([*new, *old])}
        copied = [new.get(key) != number for number, key in enumerate(keys)]
        table = joined([rows, self._copies(old, rows)])
        return table.iloc[[place[key] for key in keys]].assign(copied=copied)

    def _copies(self, keys: Collection[bytes], like: pd.DataFrame) -> pd.DataFrame:
        """Rows of designs that were evaluated before, with the columns of others."""
        import pandas as pd

        # Rows as frames would take longer than evaluating them.
        held = [self._known[key] for key in keys]
        columns = {}
        for name in map(str, like):
            kind = like[name].to_numpy().dtype
            columns[name] = np.array([known[name][row] for known, row in held], dtype=kind)
        return pd.DataFrame(columns)

    def _remember(self, rows: pd.DataFrame, designs: np.ndarray) -> None:
        """Where the rows of designs are, for copies of them."""
        columns = {str(name): rows[name].to_numpy() for name in rows}
        for number, design in enumerate(designs):
            self._known.setdefault(design.tobytes(), (columns, number))

    def _verified(self, rows: pd.DataFrame, known: int) -> pd.DataFrame:
        """Rows of a generation; of what leads all that was found, the multipliers are computed.

        An unstable one then leads no more, and the next one has its turn. So nothing whose
        stability is not known is ever ahead of what is, at the price of few multipliers.
        """
        while True:
            table = joined([*self._leaders, rows])
            first = len(table) - len(rows)
            leaders = self._method.leaders(self._problem, self._problem.told(table))
            wanted = is_known(table) & ~table["verified"].to_numpy()
            waiting = [row - first for row in leaders if row >= first + known and wanted[row]]
            if not waiting or not self._problem.has_multipliers:
                self._leaders = [table.iloc[leaders]]
                return rows
            rows = self._with_multipliers(rows, waiting)

    def _with_multipliers(self, rows: pd.DataFrame, numbers: list[int]) -> pd.DataFrame:
        """Rows, of which some are evaluated again with their multipliers."""
        designs = rows[list(self._problem.bounds)].to_numpy(dtype=float)[numbers]
        found = self._problem.rows(designs, multipliers=True, **self._workers)
        columns = {str(name): rows[name].to_numpy().copy() for name in rows}
        for name in (*STABILITY, "score"):
            columns[name][numbers] = found[name].to_numpy()
        columns["verified"][numbers] = True
        return rows.assign(**columns)

    def _described(self, table: pd.DataFrame) -> pd.DataFrame:
        """A table with its columns in order and their units."""
        from saleg.simulation.shown_table import Table

        units = {**self._problem.units, **dict.fromkeys(MARKS, "-")}
        table = Table.of(table[list(units)], units)
        table.attrs["inputs"] = list(self._problem.bounds)
        return table


def joined(tables: list[pd.DataFrame]) -> pd.DataFrame:
    """Tables one below the other, those columns that all of them have."""
    import pandas as pd

    filled = [table for table in tables if len(table)] or tables[-1:]
    names = [name for name in filled[-1] if all(name in table for table in filled)]
    given = [table if len(table.columns) == len(names) else table[names] for table in filled]
    return pd.concat(given, ignore_index=True) if len(given) > 1 else given[0]
