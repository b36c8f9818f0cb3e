"""Running a sweep: every point a row, in any process, from where it stopped."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batch.many import Columns, kind_of, missing, progress_bar, rows_of
from saleg.batch.workers import check_workers, completed
from saleg.design.designs import Design
from saleg.engine import Engine
from saleg.engine.text_files import as_path, is_folder
from saleg.quantities import is_number, is_whole
from saleg.steady.solver import DEFAULT_TOLERANCE, check_tolerance
from saleg.sweep.points import SweepError
from saleg.sweep.store import Folder
from saleg.sweep.subjects import Subject, Values, subject_of
from saleg.version import __version__

if TYPE_CHECKING:
    import pandas as pd

#: Points sent to a worker at a time.
CHUNK = 32


def run(
    points: pd.DataFrame,
    swept: Design | Engine | Subject | None = None,
    *,
    folder: str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int = CHUNK,
    rtol: float = DEFAULT_TOLERANCE,
    multipliers: bool = True,
    warm: bool = False,
    report: Callable[[int, int], None] | None = None,
) -> pd.DataFrame:
    """Evaluate every point of a sweep.

    Parameters
    ----------
    points : DataFrame
        One point per row, one input per column (SI): see :func:`saleg.sweep.grid` and the like.
    swept : Design or Engine, optional
        A design goes through the loop of :mod:`saleg.design`: inputs are the parameters of
        Table 8, or further paths of :meth:`saleg.design.Design.replace`. An engine keeps its mass:
        inputs are its paths. The designs of Chapter 4 unless given.
    folder : str or Path, optional
        Where to keep what is done. A sweep that was interrupted goes on from there and ends with
        the same files as one that was not.
    executor : concurrent.futures.Executor, optional
        Who does the work: threads, processes, ``client.get_executor()`` of a Dask cluster, an MPI
        pool; threads of this process unless given. The results do not depend on it.
    workers : int, optional
        How many work at once; as many as there are processors unless given.
    chunk : int
        Points sent to a worker at a time.
    rtol : float
        Tolerance.
    multipliers : bool
        Differentiate each steady state: whether it is stable, and how it would not be.
    warm : bool
        For designs: start each point from the one before it in its chunk, which follows a branch
        where there are several steady states. It is no faster.
    report : callable, optional
        Called with the numbers of points done and of all points, after what is done is on disk.

    Returns
    -------
    DataFrame
        One row per point, in order: inputs, status, message, figures, stability. Points without a
        steady state, or that are not valid, are rows with that status; figures of an ``unsteady``
        row are those of the last cycle simulated. Units in ``.attrs["units"]``.

    Raises
    ------
    SweepError
        If the sweep makes no sense, or the folder holds another one.
    UnknownPath
        If there is no input of that name.
    PathsClash
        If two inputs stand for one number.

    Examples
    --------
    >>> from saleg import sweep
    >>> table = sweep.run(sweep.grid({"bore": [0.060, 0.064]}))
    >>> bool(table.efficiency.is_monotonic_increasing), list(table.stable)
    (True, [True, True])
    """
    subject = subject_of(swept)
    rtol = check_tolerance(rtol)
    _check(points, subject, chunk)
    for name, value in (("multipliers", multipliers), ("warm", warm)):
        if not isinstance(value, (bool, np.bool_)):
            raise SweepError(f"{name} = {value!r}: must be True or False")
    chunk, multipliers, warm = int(chunk), bool(multipliers), bool(warm)
    check_workers(executor, workers)
    solver = partial(subject.solver, rtol, multipliers, warm)
    solver()  # what it refuses, it refuses here
    points = _described(points.reset_index(drop=True), subject, [str(name) for name in points])
    pieces = [(n, points.iloc[n * chunk : (n + 1) * chunk]) for n in range(_count(points, chunk))]
    job = partial(_rows, solver)
    if folder is None:
        return _table(points, dict(_work(job, pieces, executor, workers, report)), subject)
    settings = {"rtol": rtol, "multipliers": multipliers, "warm": warm, "chunk": chunk}
    description = {
        "version": __version__,
        "swept": subject.describe(),
        "settings": settings,
        "inputs": {str(name): subject.unit(str(name)) for name in points},
        "count": len(points),
    }
    kept = Folder(_path(folder))
    with kept.opened(description, points):
        return _resumed(kept, job, pieces, points, subject, executor, workers, report)


def load(folder: str | Path) -> pd.DataFrame:
    """Results of a sweep that is finished, from its folder.

    Parameters
    ----------
    folder : str or Path

    Returns
    -------
    DataFrame
        As :func:`run` returned it.

    Raises
    ------
    SweepError
        If there is none, or it is damaged.
    """
    if not Folder(_path(folder)).finished:
        raise SweepError(f"{folder} holds no finished sweep; run it again to finish it")
    return Folder(Path(folder)).table()


def _path(folder: Any) -> Path:
    path = as_path(folder, SweepError, "folder")
    is_folder(path, SweepError)
    return path


def _resumed(
    kept: Folder,
    job: Callable[[list[Values]], Columns],
    pieces: list[tuple[int, pd.DataFrame]],
    points: pd.DataFrame,
    subject: Subject,
    executor: Executor | None,
    workers: int | None,
    report: Callable[[int, int], None] | None,
) -> pd.DataFrame:
    """Do what is not done yet and keep it."""
    if kept.finished:
        kept.clear()  # what was left if the end was interrupted
        if report is not None:
            report(len(points), len(points))
        return load(kept.path)
    done = kept.done({number: len(piece) for number, piece in pieces})
    left = [piece for piece in pieces if piece[0] not in done]
    before = len(points) - sum(len(piece) for _, piece in left)
    for _ in _work(job, left, executor, workers, report, before, kept.keep):
        pass
    parts = {number: kept.piece(number) for number, _ in pieces}
    kept.finish(_table(points, parts, subject))
    return load(kept.path)


def _work(
    job: Callable[[list[Values]], Columns],
    pieces: list[tuple[int, pd.DataFrame]],
    executor: Executor | None,
    workers: int | None,
    report: Callable[[int, int], None] | None,
    before: int = 0,
    keep: Callable[[int, Columns], None] | None = None,
) -> Iterator[tuple[int, Columns]]:
    """Results of pieces as they are done, kept before they are reported."""
    total = before + sum(len(piece) for _, piece in pieces)
    sent = ((number, _values(piece)) for number, piece in pieces)
    if pieces:
        job(_values(pieces[0][1].iloc[:1]))  # compiles once, before workers race for it
    done = before
    with progress_bar(range(total)) as bar:
        for number, columns in completed(job, sent, executor, workers):
            if keep is not None:
                keep(number, columns)
            count = len(columns["status"])
            done += count
            if bar is not None:
                bar.update(count)
            if report is not None:
                report(done, total)
            yield number, columns


def _rows(
    solver: Callable[[], Callable[[Values], dict[str, Any]]], points: list[Values]
) -> Columns:
    """Rows of a piece; each piece begins without memory."""
    return rows_of(solver(), points)


def _values(piece: pd.DataFrame) -> list[Values]:
    """Points of a piece, each by name of the input."""
    return [{str(name): float(x) for name, x in row.items()} for row in piece.to_dict("records")]


def _count(points: pd.DataFrame, chunk: int) -> int:
    return math.ceil(len(points) / chunk)


def _table(points: pd.DataFrame, parts: dict[int, Columns], subject: Subject) -> pd.DataFrame:
    """Inputs and results in order."""
    ordered = [parts[number] for number in sorted(parts)]
    names = [name for name in subject.units if any(name in part for part in ordered)]
    table = points.copy()
    for name in names:
        if name in points:
            continue
        values: list[Any] = []
        for part in ordered:
            values += part.get(name, [missing(name)] * len(part["status"]))
        table[name] = np.array(values, dtype=kind_of(name))
    return _described(table, subject, [str(name) for name in points])


def _described(table: pd.DataFrame, subject: Subject, inputs: list[str]) -> pd.DataFrame:
    units = {name: subject.unit(name) for name in inputs}
    known = {**subject.units, **units}
    table.attrs["units"] = {str(name): known[str(name)] for name in table}
    table.attrs["inputs"] = inputs
    return table


def _check(points: pd.DataFrame, subject: Subject, chunk: int) -> None:
    """Refuse what makes no sense before any work is done."""
    import pandas as pd

    if not isinstance(points, pd.DataFrame):
        raise SweepError(
            f"points are a {type(points).__name__}: must be a DataFrame, as sweep.grid makes one"
        )
    if not is_whole(chunk, 1):
        raise SweepError(f"chunk = {chunk!r}: must be a whole number >= 1")
    if not len(points.columns):
        raise SweepError("no inputs: the points have no columns")
    if not points.columns.is_unique:
        raise SweepError(f"an input stands twice in {', '.join(map(str, points.columns))}")
    for name in points:
        subject.unit(str(name))
        if not all(is_number(value) for value in points[name]):
            raise SweepError(f"{name}: every value of an input must be a number")
    subject.refuse_clash([str(name) for name in points])
