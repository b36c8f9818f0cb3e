"""Running a sweep: every point a row, in any process, from where it stopped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.batch.arguments import check_search
from saleg.batch.points import Evaluation
from saleg.batch.table import CHUNK, Columns
from saleg.checks import FUNCTION, checked
from saleg.design.designs import Design
from saleg.design.subjects import Subject, subject_of
from saleg.engine import Engine
from saleg.errors import SweepError
from saleg.files.reading import as_path, is_folder
from saleg.steady.lanes import repeatable
from saleg.steady.solver import DEFAULT_TOLERANCE, Effort
from saleg.sweep.store import Folder
from saleg.version import __version__

if TYPE_CHECKING:
    import pandas as pd

#: Grows when what is kept in a folder changes its meaning; a new kernel is no such change.
FORMAT = 1
Report = Callable[[int, int], None]


@checked(report=FUNCTION.optional)
def run(
    points: pd.DataFrame,
    swept: Design | Engine | Subject | None = None,
    *,
    folder: str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int | None = None,
    rtol: float = DEFAULT_TOLERANCE,
    multipliers: bool = True,
    warm: bool = False,
    effort: Effort = Effort.THOROUGH,
    report: Report | None = None,
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
    chunk : int, optional
        Points sent to a worker at a time; 32 to 256 unless given, an eighth of them if that is
        between, and 32 with a folder or warm starts. Where points stand along lines, the last
        digits depend on it, within the tolerance.
    rtol : float
        Tolerance of the integrator [-].
    multipliers : bool
        Differentiate each steady state: whether it is stable, and how it would not be.
    warm : bool
        For designs: start each point from the one before it in its chunk, which follows a branch
        where there are several steady states. It is no faster.
    effort : Effort
        As for :func:`saleg.steady_state`: ``Effort.QUICK`` gives up a point without an orbit from
        the standard starts after a few milliseconds, with the status "not found".
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
    WorkersError
        If nobody could do the work so.

    Examples
    --------
    >>> from saleg import sweep
    >>> table = sweep.run(sweep.grid({"bore": [0.060, 0.064]}))
    >>> bool(table.efficiency.is_monotonic_increasing), list(table.stable)
    (True, [True, True])
    """
    subject = subject_of(swept)
    check_search(rtol, effort, executor, workers, chunk, multipliers=multipliers, warm=warm)
    rtol = float(rtol)
    solver = partial(subject.solver, rtol, multipliers, warm, effort)
    if chunk is None and (warm or folder is not None):
        chunk = CHUNK  # of these the results, and the names of the files, depend on it
    told = int if folder is None else repeatable
    evaluation = Evaluation(points, subject, solver, chunk, executor, workers, told)
    if folder is None:
        return evaluation.table(dict(_work(evaluation, report)))
    settings = {"rtol": rtol, "multipliers": bool(multipliers), "warm": bool(warm)}
    settings["chunk"] = int(evaluation.chunk)
    if effort is not Effort.THOROUGH:  # folders from before there was a choice stay what they are
        settings["effort"] = effort.value
    identity = {
        "format": FORMAT,
        "swept": subject.describe(),
        "settings": settings,
        "inputs": evaluation.input_units,
        "count": len(points),
    }
    kept = Folder(_path(folder))
    with kept.opened(identity, evaluation.points, begun_by=__version__):
        return _resumed(kept, evaluation, report)


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
    kept = Folder(_path(folder))
    if not kept.finished:
        raise SweepError(f"{folder} holds no finished sweep; run it again to finish it")
    return kept.table()


def _path(folder: Any) -> Path:
    path = as_path(folder, SweepError, "folder")
    is_folder(path, SweepError)
    return path


def _resumed(kept: Folder, evaluation: Evaluation, report: Report | None) -> pd.DataFrame:
    """Do what is not done yet and keep it."""
    total = len(evaluation.points)
    if kept.finished:
        kept.clear()  # what was left if the end was interrupted
        if report is not None:
            report(total, total)
        return load(kept.path)
    for _ in _work(evaluation, report, kept):
        pass
    kept.finish(evaluation.table(kept.parts(total, evaluation.chunk)))
    return load(kept.path)


def _work(
    evaluation: Evaluation, report: Report | None, kept: Folder | None = None
) -> Iterator[tuple[int, Columns]]:
    """Results of pieces not done yet, kept before they are reported."""
    total = len(evaluation.points)
    before = kept.parts(total, evaluation.chunk) if kept is not None else {}
    done = sum(len(columns["status"]) for columns in before.values())
    for number, columns in evaluation.parts(done=before):
        if kept is not None:
            kept.keep(number, columns)
        done += len(columns["status"])
        if report is not None:
            report(done, total)
        yield number, columns
