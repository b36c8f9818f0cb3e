"""Many engines at once: rows in order, failures among them, the same whoever does the work."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from saleg.compiler.compose import Kernel, kernel_for
from saleg.engine import Engine, check_engine
from saleg.errors import SalegError
from saleg.quantities import is_whole
from saleg.simulation.initial_state import prepare
from saleg.simulation.integration import Settings, SettingsError, integrate, settings_of
from saleg.simulation.performance import UNITS as PERFORMANCE_UNITS
from saleg.simulation.performance import Performance
from saleg.status import Status
from saleg.steady.solver import SteadyState, check_tolerance, found_steady_state

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

    from saleg.simulation.run import Run

#: Engines sent to a worker at a time.
CHUNK = 32
#: Figures that need the whole history of a cycle; a batch leaves them out.
NOT_IN_ROWS = ("adverse_work",)

T = TypeVar("T")
Row = dict[str, Any]
Columns = dict[str, list[Any]]

#: Columns of a table of runs with units, what a steady state adds, and what its multipliers add.
RUN_UNITS = {
    "status": "-",
    "message": "-",
    **{name: unit for name, unit in PERFORMANCE_UNITS.items() if name not in NOT_IN_ROWS},
    "evaluations": "-",
}
STEADY_UNITS = {**RUN_UNITS, "method": "-", "half_cycles": "-", "residual": "-"}
UNITS = {
    **STEADY_UNITS,
    "stable": "-",
    "kind": "-",
    "largest_multiplier": "-",
    "beat_period": "s",
}


def steady_states(
    engines: Iterable[Engine],
    *,
    rtol: float = 1e-6,
    multipliers: bool = False,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int = CHUNK,
) -> pd.DataFrame:
    """Steady states of many engines.

    Parameters
    ----------
    engines : iterable of Engine
        Taken as they are needed, so they need not all exist at once.
    rtol : float
        Tolerance of the integrator.
    multipliers : bool
        Differentiate each steady state: whether it is stable, and how it would not be.
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.
    workers : int, optional
        Threads; as many as there are processors unless given.
    chunk : int
        Engines sent at a time.

    Returns
    -------
    DataFrame
        One row per engine, in order: status, message, figures of the cycle (SI), half cycles and
        right-hand sides spent. An engine without a steady state, or that is not valid, is a row
        with that status. Units in ``.attrs``.

    Examples
    --------
    >>> import saleg
    >>> base = saleg.machines.thesis_base()
    >>> table = saleg.steady_states(base.replace(egr=share) for share in (0.1, 0.2))
    >>> list(table.status)
    ['steady', 'steady']
    """
    rtol = check_tolerance(rtol)
    if not isinstance(multipliers, (bool, np.bool_)):
        raise SettingsError(f"multipliers = {multipliers!r}: must be True or False")
    one = partial(_steady_row, rtol=rtol, multipliers=multipliers)
    units = UNITS if multipliers else STEADY_UNITS
    return table_of(one, engines, units, executor, workers, chunk, kernel_for)


def simulate_many(
    engines: Iterable[Engine],
    duration: float,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int = CHUNK,
    **settings: Any,
) -> pd.DataFrame:
    """Simulate many engines, each from its own start, and keep how they end.

    Parameters
    ----------
    engines : iterable of Engine
    duration : float
        Time to simulate [s].
    executor, workers, chunk
        As for :func:`steady_states`.
    **settings
        Further settings of :func:`saleg.simulate`.

    Returns
    -------
    DataFrame
        One row per engine, in order: status, message and the figures of the last cycle.
    """
    one = partial(_run_row, settings=settings_of(duration, **settings))
    return table_of(one, engines, RUN_UNITS, executor, workers, chunk, kernel_for)


def _steady_row(engine: Engine, rtol: float, multipliers: bool) -> Row:
    """Row of a steady state."""
    return steady_row(found_steady_state(engine, rtol), multipliers)


def steady_row(
    found: SteadyState, multipliers: bool, performance: Performance | None = None
) -> Row:
    """Row of a steady state found or not; figures of the orbit unless others are given."""
    message = "; ".join([found.message, *_odd(found.engine, found.remarks)])
    row = _row(found.status, message, performance or found.quick_performance)
    row["method"] = found.method
    row["half_cycles"] = float(found.half_cycles)
    row["evaluations"] = float(found.evaluations)
    row["residual"] = found.residual
    if multipliers:
        known = found.stability if found.found else None
        values = known.multipliers if known is not None else np.zeros(0)
        row["stable"] = known is not None and known.stable
        row["kind"] = "" if known is None else known.kind
        row["largest_multiplier"] = float(abs(values[0])) if len(values) else np.nan
        row["beat_period"] = np.nan if known is None else known.beat_period
    return row


def _run_row(engine: Engine, settings: Settings) -> Row:
    """Row of a run."""
    check_engine(engine)
    return run_row(integrate(engine, prepare(engine), settings))


def run_row(run: Run) -> Row:
    """Row of a run: how it ended and the figures of its last cycle."""
    message = "; ".join([run.message, *_odd(run.engine, run.remarks)])
    row = _row(run.status, message, run.performance)
    row["evaluations"] = float(run.evaluations)
    return row


def _odd(engine: Engine, remarks: list[str]) -> list[str]:
    """What a single run warns of or remarks on; in a table the message of its row says it."""
    return [f"unusual: {problem}" for problem in engine.unusual()] + [
        f"beyond what is built: {remark}" for remark in remarks
    ]


def _row(status: Status, message: str, performance: Performance) -> Row:
    figures = performance.to_dict()
    kept = {name: figures[name] for name in figures if name not in NOT_IN_ROWS}
    return {"status": str(status), "message": message, **kept}


def rows_of(one: Callable[[T], Row], items: Sequence[T]) -> Columns:
    """Rows of a chunk, column by column; what cannot even begin is a row too."""
    columns: Columns = {}
    for count, item in enumerate(items):
        try:
            row = one(item)
        except SalegError as error:
            row = {"status": str(Status.INVALID), "message": str(error)}
        except Exception as error:  # a law of the user's, or no engine at all: one row, not all
            what = f"{type(error).__name__}: {error}"
            row = {"status": str(Status.INVALID), "message": what}
        for name in row:
            columns.setdefault(name, [missing(name)] * count)
        for name, values in columns.items():
            values.append(row.get(name, missing(name)))
    return columns


def missing(name: str) -> Any:
    """What stands in a column where a row has no entry."""
    if name in ("method", "kind"):
        return ""
    return False if name == "stable" else np.nan


def table_of(
    one: Callable[[T], Row],
    items: Iterable[T],
    units: Mapping[str, str],
    executor: Executor | None,
    workers: int | None,
    chunk: int,
    kernel_of: Callable[[T], Kernel],
) -> pd.DataFrame:
    """Send engines, or whatever `one` makes rows of, out in chunks; put the rows in order."""
    import pandas as pd

    from saleg.batch.workers import check_workers, completed

    for name, value in (("chunk", chunk), ("workers", 1 if workers is None else workers)):
        if not is_whole(value, 1, 2**31 - 1):
            raise SettingsError(f"{name} = {value!r}: must be a whole number >= 1")
    check_workers(executor, None)
    if not isinstance(items, Iterable):
        raise SettingsError(f"engines = {items!r}: must be a list of engines, or the like")
    parts: dict[int, dict[str, np.ndarray]] = {}
    chunks = enumerate(_chunks(one, items, chunk, kernel_of))
    with progress_bar(items) as bar:
        for number, columns in completed(partial(rows_of, one), chunks, executor, workers):
            parts[number] = {name: _column(columns, name) for name in units}
            if bar is not None:
                bar.update(len(columns["status"]))
    ordered = [parts[number] for number in sorted(parts)] or [
        {name: np.zeros(0, kind_of(name)) for name in units}
    ]
    frame = pd.DataFrame({name: np.concatenate([part[name] for part in ordered]) for name in units})
    frame.attrs["units"] = dict(units)
    return frame


def _column(columns: Columns, name: str) -> np.ndarray:
    """One column of a chunk, filled up where no row has an entry."""
    values = columns.get(name, [missing(name)] * len(columns["status"]))
    return np.asarray(values, dtype=kind_of(name))


def kind_of(name: str) -> type:
    """Type of the values in a column."""
    if name in ("status", "message", "method", "kind"):
        return object
    return bool if name == "stable" else float


def _chunks(
    one: Callable[[T], Row], items: Iterable[T], size: int, kernel_of: Callable[[T], Kernel]
) -> Iterator[list[T]]:
    """Items in lists.

    The first item with a new combination of laws is tried here and now, so that its kernel is
    compiled once before the workers ask for it: cold caches are no place for a race.
    """
    source, known = iter(items), set()
    while taken := list(itertools.islice(source, size)):
        for item in taken:
            try:
                kernel = kernel_of(item)
            except Exception:
                continue  # its row will say why
            if kernel not in known:
                known.add(kernel)
                rows_of(one, [item])
        yield taken


def progress_bar(engines: Iterable[Any]) -> Any:
    """Progress bar for batches longer than a second of waiting, on a terminal only."""
    if not sys.stderr.isatty():
        return nullcontext()
    from tqdm import tqdm

    total = len(engines) if isinstance(engines, Sequence) else None
    return tqdm(total=total, delay=1, leave=False, unit=" engines")
