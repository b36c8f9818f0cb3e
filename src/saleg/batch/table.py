"""One table for many items: pieces of work sent out, their rows put in order."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from saleg.batch.workers import completed
from saleg.errors import SalegError
from saleg.simulation.progress import progress_bar
from saleg.status import Status

if TYPE_CHECKING:
    import pandas as pd

#: Items sent to a worker at a time.
CHUNK = 32
#: The same of items that are worked on together, from which on more make little difference.
MOST_TOGETHER = 256
#: Pieces, if there are so many items, so that several workers find work. Not their number decides:
#: what follows a line begins anew in each piece, and results must not depend on who works.
PIECES = 8
#: Columns that hold text.
TEXT = ("status", "message", "method", "kind")
#: What stands in a column where a row has no entry, by the type of its values.
MISSING: dict[type, Any] = {object: "", bool: False, float: np.nan}

T = TypeVar("T")
Row = dict[str, Any]
Columns = dict[str, np.ndarray]


def kind_of(name: str) -> type:
    """Type of the values in a column."""
    return object if name in TEXT else bool if name == "stable" else float


def rows_of(row_of: Callable[[T], Row], items: Iterable[T]) -> Columns:
    """Rows of some items, column by column; an item that cannot even begin is a row too."""
    rows = [_row_or_reason(row_of, item) for item in items]
    return {name: _column(name, rows) for name in dict.fromkeys(itertools.chain(*rows))}


def suitable_chunk(count: int | None) -> int:
    """Items to send at a time where they are worked on together, of so many if that is known."""
    if count is None:
        return MOST_TOGETHER
    return min(max(-(-count // PIECES), CHUNK), MOST_TOGETHER)


def filled_up(
    count: int, lots: Sequence[tuple[np.ndarray, Columns]], row_of: Callable[[int], Row]
) -> Columns:
    """Columns of some rows, of which some are known; the others are made one by one.

    Parameters
    ----------
    count : int
        Number of rows.
    lots : sequence of (ndarray of int, dict of str to ndarray)
        Places of the rows that are known, and their columns.
    row_of : callable
        Row of a place.
    """
    alone = np.full(count, True)
    for places, _ in lots:
        alone[places] = False
    others = np.flatnonzero(alone)
    return _put_together(count, [*lots, (others, rows_of(row_of, others.tolist()))])


def _put_together(count: int, lots: Sequence[tuple[np.ndarray, Columns]]) -> Columns:
    """Columns of some rows, given as lots of them and the places of their rows."""
    names = dict.fromkeys(name for _, columns in lots for name in columns)
    whole: Columns = {}
    for name in names:
        kind = kind_of(name)
        whole[name] = np.full(count, MISSING[kind], dtype=kind)
        for places, columns in lots:
            if name in columns:
                whole[name][places] = columns[name]
    return whole


def _row_or_reason(row_of: Callable[[T], Row], item: T) -> Row:
    try:
        return row_of(item)
    except SalegError as error:
        reason = str(error)
    except Exception as error:  # a law of the user's, or no engine at all: one row, not all
        reason = f"{type(error).__name__}: {error}"
    return {"status": str(Status.INVALID), "message": reason}


def _column(name: str, rows: Sequence[Row]) -> np.ndarray:
    kind = kind_of(name)
    return np.array([row.get(name, MISSING[kind]) for row in rows], dtype=kind)


def _same_for_all(item: object) -> Hashable:
    """The kernel of items that share one."""
    return None


def in_pieces(
    work: Callable[[Sequence[T]], Columns],
    items: Iterable[T],
    *,
    chunk: int = CHUNK,
    executor: Executor | None = None,
    workers: int | None = None,
    kernel_of: Callable[[T], Hashable] = _same_for_all,
    done: Collection[int] = (),
    total: int | None = None,
) -> Iterator[tuple[int, Columns]]:
    """Columns of numbered pieces of a batch as they are completed, in any order.

    Parameters
    ----------
    work : callable
        Makes the columns of a piece; it travels to the workers.
    items : iterable
        Taken as they are needed, so they need not all exist at once.
    chunk : int
        Items in a piece.
    executor, workers
        As for :func:`saleg.batch.workers.completed`.
    kernel_of : callable
        Tells items apart that need kernels of their own; one kernel for all unless given.
    done : collection of int
        Numbers of pieces to leave out.
    total : int, optional
        Number of items, for the progress bar.

    Yields
    ------
    (int, dict of str to ndarray)
    """
    source = iter(items)
    chunks = iter(lambda: list(itertools.islice(source, chunk)), [])
    pieces = (piece for piece in enumerate(chunks) if piece[0] not in done)
    with progress_bar(total, unit=" rows") as bar:
        alone = executor is None and workers == 1  # it races with nobody
        ready = pieces if alone else _compiled_first(work, pieces, kernel_of)
        for number, columns in completed(work, ready, executor, workers):
            if bar is not None:
                bar.update(len(columns["status"]))
            yield number, columns


def _compiled_first(
    work: Callable[[Sequence[T]], Columns],
    pieces: Iterable[tuple[int, list[T]]],
    kernel_of: Callable[[T], Hashable],
) -> Iterator[tuple[int, list[T]]]:
    """Pieces, the first item of each kernel tried here and now.

    So it is compiled once before the workers ask for it: cold caches are no place for a race.
    """
    known: set[Hashable] = set()
    for number, items in pieces:
        for item in items:
            try:
                kernel = kernel_of(item)
            except Exception:
                continue  # its row will say why
            if kernel not in known:
                known.add(kernel)
                work([item])
        yield number, items


def table_of(parts: Mapping[int, Columns], units: Mapping[str, str]) -> pd.DataFrame:
    """Columns of pieces in the order of their numbers, with units in ``.attrs``."""
    from saleg.simulation.shown_table import Table

    ordered = [parts[number] for number in sorted(parts)]
    return Table.of({name: _joined(name, ordered) for name in units}, units)


def _joined(name: str, parts: Sequence[Columns]) -> np.ndarray:
    """One column of all pieces, filled up where a piece has none."""
    kind = kind_of(name)
    filled = [
        part.get(name, np.full(len(part["status"]), MISSING[kind], dtype=kind)) for part in parts
    ]
    return np.concatenate([np.zeros(0, kind), *filled])
