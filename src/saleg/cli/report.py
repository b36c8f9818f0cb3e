"""``saleg report``: all there is to say of an engine or a saved run, on one page."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.cli.run import add_changes, changed, load
from saleg.cli.words import CommandError
from saleg.files.atomic import new_folder
from saleg.files.reading import expanded
from saleg.machines import catalogue
from saleg.simulation.run import Run
from saleg.steady.solver import steady_state

if TYPE_CHECKING:
    from saleg.steady.state import SteadyState

#: The file that is written.
PAGE = "report.html"


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("report", help="write all there is to say as one HTML page")
    add = parser.add_argument
    add(
        "subject",
        metavar="MACHINE|FILE.toml|RUN",
        help="an engine, whose steady state is solved for, or a saved run: its file or folder",
    )
    add_changes(parser)
    add("--out", type=expanded, metavar="DIR", required=True, help=f"new folder for {PAGE}")
    add("--force", action="store_true", help="replace DIR if it holds an earlier report")
    parser.set_defaults(command=write)


def write(options: argparse.Namespace) -> bool:
    """Solve or load, and write the page; returns whether it shows what ended well."""
    from saleg.reporting import report

    with new_folder(options.out, options.force, (PAGE,), how="add --force") as folder:
        result = _result(options.subject, options.changes)
        report(result, folder / PAGE)
    print(f"{result.engine.name}: {result.status} - {result.message}")
    print(f"wrote {options.out / PAGE}")
    return result.status.ended_well


def _result(name: str, changes: list[str]) -> Run | SteadyState:
    """Steady state of an engine, or how it runs without one; or a run that was saved."""
    if name in catalogue() or name.endswith(".toml") or not Path(name).exists():
        found = steady_state(changed(load(name), changes))
        return found if found.found or found.fallback is None else found.fallback
    if changes:
        raise CommandError(f"--set changes an engine, and {name} is a run that is over")
    return Run.load(name)
