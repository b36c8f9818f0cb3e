"""``saleg optimize``: an optimisation from a file."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.cli.workers import add_workers, executor_of
from saleg.files.atomic import write_text
from saleg.files.reading import expanded

if TYPE_CHECKING:
    from saleg.optimize import Found, Progress

#: Figures of the best design that are printed.
PRINTED = ("score", "efficiency", "power", "compression_ratio", "peak_pressure", "moving_mass")


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("optimize", help="look for the best design of a file")
    add = parser.add_argument
    add(
        "file",
        type=expanded,
        metavar="FILE.toml",
        help="what to optimise: docs/optimisation.md",
    )
    add("--out", type=expanded, metavar="DIR", help="folder of the results (FILE without .toml)")
    add_workers(parser)
    parser.set_defaults(command=optimize)


def optimize(options: argparse.Namespace) -> bool:
    """Run or go on with an optimisation; returns whether a design within the limits was found."""
    from saleg.optimize import files, improve
    from saleg.optimize import optimize as run

    asked = files.read(options.file)
    folder = options.out or options.file.with_suffix("")
    with executor_of(options) as pool:
        more: dict[str, Any] = {"executor": pool, "workers": options.workers}
        found = run(
            asked.problem,
            asked.method,
            asked.evaluations,
            asked.seed,
            folder,
            report=_reporter(asked.problem.objectives[0].figure),
            **more,
        )
        names = _written(found, folder)
        print(found)
        if asked.improve is not None:
            better = improve(
                found,
                asked.improve.figure,
                evaluations=asked.improve.evaluations,
                seed=asked.seed,
                folder=folder / "improved",
                report=_reporter(asked.improve.figure),
                **more,
            )
            print(better)
            names += [f"improved/{name}" for name in _written(better, folder / "improved")]
            found = better if better.succeeded else found
    _print_best(found)
    print(f"wrote {folder}: {', '.join(names)}")
    return found.succeeded


def _reporter(figure: str) -> Callable[[Progress], None]:
    """Line after each generation: designs done, the best so far, and the time left."""
    begin, first = time.monotonic(), 0

    def say(progress: Progress) -> None:
        nonlocal begin, first
        if progress.generation == 0:
            begin, first = time.monotonic(), progress.evaluations
        done, rest = progress.evaluations - first, progress.of - progress.evaluations
        left = f", {(time.monotonic() - begin) / done * rest:.0f} s left" if done else ""
        best = f"{figure} {progress.best:.5g}"
        print(f"{progress.evaluations} of {progress.of} designs, {best}{left}", flush=True)

    return say


def _written(found: Found, folder: Path) -> list[str]:
    """Names of what is written beside the log: the best engine, and pictures."""
    if not found.succeeded:
        return ["designs.csv"]
    write_text(folder / "best.toml", found.engine().to_toml())
    drawn = ["convergence", "parallel", *(["front"] if len(found.problem.objectives) > 1 else [])]
    for name in drawn:
        getattr(found.plot, name)().figure.savefig(folder / f"{name}.png")
    return ["designs.csv", "best.toml", *(f"{name}.png" for name in drawn)]


def _print_best(found: Found) -> None:
    """Parameters and figures of the best design, in the units people read."""
    from saleg.simulation.readable import readable

    if not found.succeeded:
        return
    best, units = found.best, found.table.attrs["units"]
    print(f"best design ({best['status']}, {'' if best['stable'] else 'not known to be '}stable):")
    for name in dict.fromkeys([*found.problem.bounds, *PRINTED]):
        if name in units:
            shown = readable(name, units[name])
            print(f"  {shown.words:22} {shown.of(float(best[name])):10.4g} {shown.unit}")
