"""A report as a file."""

from __future__ import annotations

from html import escape
from os import PathLike
from pathlib import Path

from saleg.checks import a, checked
from saleg.errors import SalegError
from saleg.files.atomic import new_file
from saleg.files.reading import as_path
from saleg.reporting.look import PAGE
from saleg.reporting.sections import sections
from saleg.reporting.subject import Subject
from saleg.simulation.run import Run
from saleg.steady.state import SteadyState
from saleg.version import __version__


class ReportError(SalegError, ValueError):
    """A report that cannot be written as asked."""


@checked(result=a(Run, SteadyState))
def report(
    result: Run | SteadyState, path: str | PathLike[str], *, overwrite: bool = False
) -> Path:
    """Write all there is to say of a result as one page of HTML.

    How it was found and with which settings, figures with their units, the engine and a section of
    it, p-V diagram, phase portrait, forces, energy flows, stability, elasticities of the main
    figures, and where laws and figures leave what is known. Of a run, stability and elasticities
    are those of the steady state of its engine.

    Parameters
    ----------
    result : Run or SteadyState
    path : path-like
        File to write, ``.html``; folders above it are made, and it is there whole or not at all.
        The page needs nothing else.
    overwrite : bool
        Whether an earlier file is replaced.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ReportError
        If the name does not end in ``.html``.
    RunFileError
        If the file is in the way or cannot be written.

    Examples
    --------
    >>> import saleg
    >>> steady = saleg.steady_state(saleg.machines.thesis_base())
    >>> saleg.report(steady, "base_case.html")  # doctest: +SKIP
    """
    path = as_path(path, ReportError)
    if path.suffix.lower() not in (".html", ".htm"):
        raise ReportError(f"{path}: the name of a report must end in .html")
    with new_file(path, overwrite) as temporary:
        temporary.write_text(page(result), encoding="utf-8", newline="\n")
    return path


def page(result: Run | SteadyState) -> str:
    """The page as text."""
    subject = Subject.of(result)
    return PAGE.format(
        title=escape(subject.engine.name),
        body="\n".join(sections(subject)),
        version=escape(__version__),
    )
