"""Work sent out in pieces to any executor; what a lost worker had is done again."""

from __future__ import annotations

import os
import pickle
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import nullcontext
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, TypeVar

from saleg.errors import raise_together, shown
from saleg.quantities import is_whole
from saleg.simulation.settings import SettingsError

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

Piece = TypeVar("Piece")
Result = TypeVar("Result")

#: Pieces under way for each worker.
UNDER_WAY = 4
#: What is raised in place of a result when workers, not the work, have failed.
LOST = (BrokenExecutor, CancelledError, ConnectionError)
#: What is raised where work cannot be packed, though the work itself may raise the latter too.
UNSENT = (pickle.PicklingError, AttributeError, TypeError)


class WorkersError(SettingsError):
    """Nobody could do the work so."""


def check_workers(executor: Executor | None, workers: int | None, chunk: int = 1) -> None:
    """Refuse what can do no work, or not in pieces of `chunk`.

    Raises
    ------
    WorkersError
    """
    raise_together(WorkersError, checks_of_workers(executor, workers, chunk))


def checks_of_workers(
    executor: Executor | None, workers: int | None, chunk: int
) -> list[Callable[[], None]]:
    """The checks of :func:`check_workers`, one by one."""
    numbers = ("workers", 1 if workers is None else workers), ("chunk", chunk)
    checks: list[Callable[[], None]] = [partial(_check_number, *number) for number in numbers]
    return [*checks, partial(_check_executor, executor)]


def _check_number(name: str, value: Any) -> None:
    if not is_whole(value, 1, 2**31 - 1):
        raise WorkersError(f"{name} = {shown(value)}: must be a whole number >= 1")


def _check_executor(executor: Any) -> None:
    if executor is not None and (
        isinstance(executor, type) or not callable(getattr(executor, "submit", None))
    ):
        raise WorkersError(
            f"executor = {shown(executor)}: must be an object with a method submit, as "
            "ThreadPoolExecutor(2) is"
        )


def completed(
    work: Callable[[Piece], Result],
    pieces: Iterable[tuple[int, Piece]],
    executor: Executor | None = None,
    workers: int | None = None,
) -> Iterator[tuple[int, Result]]:
    """Results of numbered pieces as they are completed, in any order.

    Parameters
    ----------
    work : callable
        Done for every piece; a module-level function or a partial of one, so that it can travel.
    pieces : iterable of (int, piece)
        Taken as they are needed.
    executor : concurrent.futures.Executor, optional
        Threads, processes, ``client.get_executor()`` of a Dask cluster, an MPI pool; threads of
        this process unless given.
    workers : int, optional
        How many work at once; as many as there are processors unless given.

    Yields
    ------
    (int, result)

    Raises
    ------
    WorkersError
        If the work cannot be sent to another process.

    Warns
    -----
    RuntimeWarning
        If the executor breaks; what it had is then done by threads of this process.
    """
    count = workers or os.cpu_count() or 1
    own = ThreadPoolExecutor(count) if executor is None else nullcontext(executor)
    lost: list[tuple[int, Piece]] = []
    with own as pool:
        yield from _sent_out(work, iter(pieces), pool, UNDER_WAY * count, lost)
    if lost:
        warnings.warn(
            f"the executor broke; {len(lost)} pieces of work go on in threads of this process",
            RuntimeWarning,
            stacklevel=2,
        )
        yield from completed(work, lost, None, count)


def _sent_out(
    work: Callable[[Piece], Result],
    pieces: Iterator[tuple[int, Piece]],
    pool: Executor,
    most: int,
    lost: list[tuple[int, Piece]],
) -> Iterator[tuple[int, Result]]:
    """Send pieces out, no more than `most` at a time; what gets lost is put into `lost`."""
    waiting: dict[Future[Result], tuple[int, Piece]] = {}
    done_there = partial(_at_work, work)
    try:
        for piece in pieces:
            if lost:
                lost.append(piece)
                continue
            try:
                waiting[pool.submit(done_there, piece[1])] = piece
            except LOST:
                lost.append(piece)
            if len(waiting) >= most:
                yield from _some(work, waiting, lost)
        while waiting:
            yield from _some(work, waiting, lost)
    finally:
        for future in waiting:
            future.cancel()


def _some(
    work: Callable[[Piece], Result],
    waiting: dict[Future[Result], tuple[int, Piece]],
    lost: list[tuple[int, Piece]],
) -> Iterator[tuple[int, Result]]:
    """Wait for at least one result and give all there are."""
    done, _ = wait(waiting, return_when=FIRST_COMPLETED)
    for future in done:
        piece = waiting.pop(future)
        try:
            result = future.result()
        except LOST:
            lost.append(piece)
        except UNSENT:
            _check_travels((work, piece[1]))
            raise
        else:
            yield piece[0], result


def _check_travels(parcel: object) -> None:
    """Refuse work that cannot be sent to another process.

    Raises
    ------
    WorkersError
        Naming what cannot.
    """
    try:
        pickle.dumps(parcel)
    except UNSENT as error:
        raise WorkersError(
            f"the work cannot be sent to another process: {error}; define its classes and "
            "functions at the top of a module, or let threads do it (executor=None)"
        ) from error


def _at_work(work: Callable[[Piece], Result], piece: Piece) -> Result:
    """Do a piece, in whatever process."""
    end_with_parent()
    return work(piece)


def end_with_parent() -> None:
    """From now on end a process of a pool when the one that made it is gone.

    One that was killed cannot say so, and a worker would wait for work without end.
    """
    import multiprocessing

    parent = multiprocessing.parent_process()
    if parent is not None:
        _watch(parent)


@lru_cache
def _watch(parent: BaseProcess) -> None:
    """End this process after another, watched by a thread."""

    def end() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=end, name="end with parent", daemon=True).start()
