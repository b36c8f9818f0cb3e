"""``saleg sweep``: a parametric sweep from a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.cli.workers import add_workers, executor_of
from saleg.files.reading import expanded

if TYPE_CHECKING:
    import pandas as pd


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("sweep", help="evaluate every point of a sweep file")
    add = parser.add_argument
    add("file", type=expanded, metavar="FILE.toml", help="what to sweep; see docs/sweeps.md")
    add("--out", type=expanded, metavar="DIR", help="folder of the results (FILE without .toml)")
    add_workers(parser)
    parser.set_defaults(command=sweep)


def sweep(options: argparse.Namespace) -> bool:
    """Run or go on with a sweep; returns whether every point has a steady state."""
    from saleg.sweep import run
    from saleg.sweep.files import read

    asked = read(options.file)
    folder = options.out or options.file.with_suffix("")
    with executor_of(options) as pool:
        table = run(
            asked.points,
            asked.swept,
            folder=folder,
            executor=pool,
            workers=options.workers,
            report=_say,
            **asked.settings,
        )
    for status, count in table["status"].value_counts().items():
        print(f"{count} {status}")
    _complain(table)
    names = ["results.csv", *_pictures(table, folder)]
    print(f"wrote {folder}: {', '.join(names)}")
    return bool((table["status"] == "steady").all())


def _complain(table: pd.DataFrame) -> None:
    """Say what most of the failed points have to say."""
    messages = table["message"][table["status"] != "steady"].value_counts()
    if len(messages):
        print(f"{messages.iloc[0]} of the failed: {messages.index[0]}")


def _say(done: int, total: int) -> None:
    print(f"done {done} of {total}", flush=True)


def _pictures(table: pd.DataFrame, folder: Path) -> list[str]:
    """Panels over every input that has more than one value, if there is just one such input."""
    varied = [name for name in table.attrs["inputs"] if len(table[name].unique()) > 1]
    if len(varied) != 1 or "power_density" not in table:
        return []
    from saleg.plotting.sweeps import panels

    figure = panels(table, varied[0])[0].figure
    figure.savefig(folder / "panels.png")
    return ["panels.png"]
