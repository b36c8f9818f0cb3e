"""``saleg sweep``: a parametric sweep from a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.cli.workers import add_workers, executor_of
from saleg.files.reading import expanded

if TYPE_CHECKING:
    import pandas as pd

    from saleg.design import Design
    from saleg.engine import Engine


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
    print(_told(asked.points, asked.swept), flush=True)
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


def _told(points: pd.DataFrame, swept: Design | Engine) -> str:
    """What is swept, over which inputs."""
    from saleg.engine import Engine

    what = f"engine {swept.name}, fixed mass" if isinstance(swept, Engine) else "component design"
    spans = (
        f"{name} {points[name].min():g} to {points[name].max():g}"
        if len(points[name].unique()) > 1
        else f"{name} = {points[name].iloc[0]:g}"
        for name in points
    )
    return f"{what}: {len(points)} points of {', '.join(spans)} (SI)"


def _pictures(table: pd.DataFrame, folder: Path) -> list[str]:
    """Panels over the input that varies, or maps over the first two that do."""
    from saleg.errors import SweepError
    from saleg.plotting.sweeps import maps, panels

    varied = [name for name in table.attrs["inputs"] if len(table[name].unique()) > 1]
    if not varied:
        return []
    name = "panels.png" if len(varied) == 1 else "map.png"
    try:
        axes = panels(table, *varied) if len(varied) == 1 else maps(table, *varied[:2])
    except SweepError:  # no point has figures: what is wrong has been said
        return []
    axes.figure.savefig(folder / name)
    return [name]
