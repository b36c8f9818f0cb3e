"""Many engines at once: rows in order, failures among them, the same whoever does the work."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from saleg.batch.arguments import check_engines, check_search
from saleg.batch.table import (
    CHUNK,
    Columns,
    Row,
    filled_up,
    in_pieces,
    rows_of,
    suitable_chunk,
    table_of,
)
from saleg.batch.workers import check_workers
from saleg.compiler.compiled_engine import kernel_for
from saleg.engine import Engine, check_engine
from saleg.engine.columns import Rows, is_usual, rows_by_make
from saleg.simulation.indicators import closure
from saleg.simulation.initial_state import prepare
from saleg.simulation.integration import integrate
from saleg.simulation.performance import UNITS as PERFORMANCE_UNITS
from saleg.simulation.performance import Performance, cycle_figures
from saleg.simulation.plausibility import is_remarkable, remarks_on
from saleg.simulation.settings import Settings
from saleg.status import Status
from saleg.steady.lanes import UNKNOWN
from saleg.steady.many import Orbits, steady_rows, verdicts
from saleg.steady.solver import Effort, found_steady_state
from saleg.steady.stabilities import stabilities
from saleg.steady.stability import Stability
from saleg.steady.state import SteadyState

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

    from saleg.simulation.run import Run

#: Figures that need the whole history of a cycle; a batch leaves them out.
NOT_IN_ROWS = ("adverse_work",)

T = TypeVar("T")

#: Columns of a table of runs with units, what a steady state adds, and what its stability adds.
RUN_UNITS = {
    "status": "-",
    "message": "-",
    **{name: unit for name, unit in PERFORMANCE_UNITS.items() if name not in NOT_IN_ROWS},
    "evaluations": "-",
}
STEADY_UNITS = {**RUN_UNITS, "method": "-", "half_cycles": "-", "residual": "-"}
STABILITY_UNITS = {
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
    effort: Effort = Effort.THOROUGH,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int | None = None,
) -> pd.DataFrame:
    """Steady states of many engines.

    Parameters
    ----------
    engines : iterable of Engine
        Taken as they are needed, so they need not all exist at once.
    rtol : float
        Tolerance of the integrator [-].
    multipliers : bool
        Differentiate each steady state: whether it is stable, and how it would not be.
    effort : Effort
        As for :func:`saleg.steady_state`: ``Effort.QUICK`` gives up an engine without an orbit from
        the standard starts after a few milliseconds, with the status "not found".
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.
    workers : int, optional
        Threads; as many as there are processors unless given.
    chunk : int, optional
        Engines sent at a time; 32 to 256 unless given, an eighth of them if that is between.
        Where engines stand along lines, the last digits depend on it, within the tolerance.

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
    how, engines_first = (executor, workers, chunk), partial(check_engines, engines)
    check_search(rtol, effort, *how, engines_first, multipliers=multipliers)
    rtol = float(rtol)
    count = len(engines) if isinstance(engines, Sequence) else None
    total = UNKNOWN if count is None else max(count, UNKNOWN)
    work = partial(_steady_piece, rtol=rtol, multipliers=multipliers, effort=effort, total=total)
    units = STABILITY_UNITS if multipliers else STEADY_UNITS
    if chunk is None:
        chunk = suitable_chunk(count)
    return batch_table(work, engines, units, kernel_for, executor, workers, chunk)


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
    row_of = partial(_run_row, settings=Settings.of(duration, settings))
    return batch_table(
        partial(rows_of, row_of), engines, RUN_UNITS, kernel_for, executor, workers, chunk
    )


def batch_table(
    work: Callable[[Sequence[T]], Columns],
    items: Iterable[T],
    units: Mapping[str, str],
    kernel_of: Callable[[T], Hashable],
    executor: Executor | None,
    workers: int | None,
    chunk: int,
) -> pd.DataFrame:
    """Table with a row per item and a column per unit, whoever does the work."""
    check_workers(executor, workers, chunk)
    check_engines(items)
    parts = in_pieces(
        work,
        items,
        chunk=chunk,
        executor=executor,
        workers=workers,
        kernel_of=kernel_of,
        total=len(items) if isinstance(items, Sequence) else None,
    )
    return table_of(dict(parts), units)


def steady_columns(
    lots: Iterable[Rows],
    row_of: Callable[[int], Row],
    count: int,
    rtol: float,
    multipliers: bool,
    effort: Effort,
    total: int,
) -> Columns:
    """Columns of steady states: of most engines together, of the others one by one.

    Parameters
    ----------
    lots : iterable of Rows
        Those among the engines that may be solved together.
    row_of : callable
        Row of the engine in a place, solved by itself.
    count : int
        Number of engines.
    rtol : float
        Tolerance of the integrator.
    multipliers : bool
        Whether to differentiate each.
    effort : Effort
    total : int
        Number of engines in the batch they are a piece of.
    """
    together = []
    for found in (orbits for rows in lots for orbits in steady_rows(rows, rtol, effort, total)):
        columns = columns_of(found, cycle_figures_of(found), *verdicts(found, rtol))
        if multipliers:
            columns |= stability_columns(found, columns["status"])
        together.append((found.rows.places, columns))
    return filled_up(count, together, row_of)


def _steady_piece(
    engines: Sequence[Engine], rtol: float, multipliers: bool, effort: Effort, total: int
) -> Columns:
    """Columns of steady states of some engines, of a batch of so many."""

    def row_of(place: int) -> Row:
        return _steady_row(engines[place], rtol, multipliers, effort)

    lots = rows_by_make(engines)
    return steady_columns(lots, row_of, len(engines), rtol, multipliers, effort, total)


def cycle_figures_of(found: Orbits) -> dict[str, Any]:
    """Figures of orbits."""
    engine, strokes = found.rows.engine, found.strokes
    return {**cycle_figures(engine, strokes), "stability": closure(engine, strokes)}


def columns_of(
    found: Orbits, figures: Mapping[str, Any], status: np.ndarray, message: np.ndarray
) -> Columns:
    """Columns of orbits; remarks go into their messages."""
    engine, strokes, count = found.rows.engine, found.strokes, len(status)
    known = {
        name: np.broadcast_to(figures.get(name, np.nan), count)
        for name in PERFORMANCE_UNITS
        if name not in NOT_IN_ROWS
    }
    remarkable = is_remarkable(engine, known, strokes)
    for n in np.flatnonzero(~is_usual(found.rows) | remarkable).tolist():
        one, own = found.rows.row(n), {name: values[n] for name, values in known.items()}
        remarks = remarks_on(one, own, strokes[n]) if remarkable[n] else []
        message[n] = "; ".join([message[n], *_odd(one, remarks)])
    return {
        "status": status,
        "message": message,
        **known,
        "method": np.full(count, "fixed point", dtype=object),
        "half_cycles": found.half_cycles.astype(float),
        "evaluations": found.evaluations,
        "residual": found.residual,
    }


def stability_columns(found: Orbits, status: np.ndarray) -> Columns:
    """Columns of the stability of orbits, of which those count that are steady states."""
    places = np.flatnonzero(np.isin(status, [str(Status.STEADY), str(Status.IDLING)]))
    known = dict(zip(places.tolist(), stabilities(found.some(places)), strict=True))
    rows = [stability_row(known.get(n)) for n in range(len(status))]
    return rows_of(rows.__getitem__, range(len(rows)))


def stability_row(known: Stability | None) -> Row:
    """What a row says of the stability of a steady state; None if there is none."""
    values = known.multipliers if known is not None else np.zeros(0)
    return {
        "stable": known is not None and known.stable,
        "kind": "" if known is None else known.kind,
        "largest_multiplier": float(abs(values[0])) if len(values) else np.nan,
        "beat_period": np.nan if known is None else known.beat_period,
    }


def _steady_row(engine: Engine, rtol: float, multipliers: bool, effort: Effort) -> Row:
    """Row of a steady state."""
    return steady_row(found_steady_state(engine, rtol, effort=effort), multipliers)


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
        row |= stability_row(found.stability if found.found and found.has_multipliers else None)
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
