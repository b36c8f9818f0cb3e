"""``saleg control``: an experiment on transient operation and control (Chapter 5)."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.cli.run import add_changes, changed, load
from saleg.cli.tables import write as write_csv
from saleg.cli.words import CommandError
from saleg.errors import nearest
from saleg.files.atomic import write_text
from saleg.files.reading import expanded
from saleg.machines import CATALOGUE

if TYPE_CHECKING:
    from saleg.engine import Engine
    from saleg.simulation.run import Run
    from saleg.thesis.experiment import Experiment, Line

#: The engine of Chapter 5.
DEFAULT = "thesis-transient"
#: Options that belong to some experiments only, by the keyword of theirs.
FLAGS = {
    "duration": "--duration",
    "base_frequency": "--base-frequency",
    "phase": "--phase",
    "strokes": "--strokes",
    "motor": "--no-motor",
    "demand": "--demand",
}
ENGINE, TABLES = "engine.toml", ("dead_centres.csv", "cycles.csv", "results.csv")


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser(
        "control", help="an experiment on start-up, demand or misfire (Chapter 5)"
    )
    add = parser.add_argument
    add("experiment", nargs="?", metavar="EXPERIMENT", help="which; without one, all are listed")
    add(
        "machine",
        nargs="?",
        default=DEFAULT,
        metavar="MACHINE|FILE.toml",
        help="a name 'saleg list' shows, or an engine file (thesis-transient)",
    )
    add_changes(parser)
    add("--duration", type=float, metavar="T", help="time to simulate [s]")
    add(
        "--base-frequency", type=float, metavar="F", help="the motor begins with it [Hz] (start-up)"
    )
    add(
        "--phase",
        choices=("literal", "integrated"),
        help="the motor's force is sin(2 pi f t), or its frequency is integrated (start-up)",
    )
    add("--strokes", type=int, metavar="N", help="strokes without fuel (misfire)")
    add(
        "--no-motor",
        action="store_false",
        default=None,
        dest="motor",
        help="the motor does not come back (misfire)",
    )
    text = "times and powers, two columns; SI unless their heads say otherwise, as power [kW] does"
    add("--demand", type=expanded, metavar="FILE.csv", help=text)
    add("--out", type=expanded, metavar="DIR", help="write pictures and tables to a new folder")
    add("--animate", type=expanded, metavar="FILE", help="write the last cycle as .gif or .html")
    add("--force", action="store_true", help="replace DIR and FILE of an earlier experiment")
    parser.set_defaults(command=perform)


def perform(options: argparse.Namespace) -> bool:
    """Do an experiment, report and write; returns whether its run ended well."""
    if options.experiment is None:
        print(_listed())
        return True
    experiment = _experiment(options.experiment)
    _check(options, experiment)
    engine = changed(load(options.machine), options.changes)
    engine.validate()
    keywords = _keywords(options)
    if options.out is None:
        result = experiment.run(engine, **keywords)
        print(_report(options, experiment, engine, result))
    else:
        from saleg.files.atomic import new_folder

        with new_folder(options.out, options.force, _known(), how="add --force") as folder:
            result = experiment.run(engine, **keywords)
            names = _write(folder, engine, experiment, result)
        print(_report(options, experiment, engine, result))
        print(f"\nwrote {options.out}: {', '.join(names)}")
    from saleg.thesis.experiment import run_of

    run = run_of(result)
    if options.animate is not None and run is not None:
        from saleg.plotting import animate

        print(f"saleg: drawing {options.animate}, some 20 s", file=sys.stderr, flush=True)
        animate(run, options.animate, overwrite=options.force)
        print(f"wrote {options.animate}")
    return run is None or run.status.ended_well


def _listed() -> str:
    """All experiments, one a line."""
    from saleg.thesis.chapter_5 import EXPERIMENTS

    width = max(map(len, EXPERIMENTS))
    return "\n".join(f"{name:<{width}}  {item.summary}" for name, item in EXPERIMENTS.items())


def _experiment(name: str) -> Experiment:
    from saleg.thesis.chapter_5 import EXPERIMENTS

    if name not in EXPERIMENTS:
        hint = nearest(name, EXPERIMENTS)
        raise CommandError(f"no experiment '{name}'{hint}; there are\n{_listed()}")
    return EXPERIMENTS[name]


def _check(options: argparse.Namespace, experiment: Experiment) -> None:
    """Refuse options the experiment has no use for."""
    for name, flag in FLAGS.items():
        if getattr(options, name) is not None and name not in experiment.options:
            raise CommandError(f"{flag} does not belong to {options.experiment}")
    if options.animate is None:
        return
    if not experiment.is_run:
        raise CommandError(f"--animate needs a single run, and {options.experiment} is none")
    from saleg.plotting.animations import check_suffix

    check_suffix(options.animate)


def _keywords(options: argparse.Namespace) -> dict[str, Any]:
    """Keywords of the experiment that were given."""
    from saleg.control import Demand

    given = {name: getattr(options, name) for name in FLAGS}
    if given["demand"] is not None:
        given["demand"] = Demand.read(given["demand"])
    return {name: value for name, value in given.items() if value is not None}


def _report(
    options: argparse.Namespace, experiment: Experiment, engine: Engine, result: Any
) -> str:
    """What was done, how it ended, and what was seen beside what the dissertation says."""
    from saleg.thesis.experiment import run_of

    run, beside = run_of(result), engine == CATALOGUE[DEFAULT]()
    head = [f"{options.experiment}: {experiment.summary}"]
    if run is not None:
        head.append(f"{run.engine.name}: {run.status} - {run.message}")
    lines = experiment.report(result) if _moved(run) else []
    return "\n\n".join(["\n".join(head), "\n".join(_aligned(lines, beside))]).rstrip()


def _moved(run: Run | None) -> bool:
    """Whether there is anything to draw and report; not after a run without a full cycle."""
    return run is None or len(run.cycles) > 0


def _aligned(lines: list[Line], beside: bool) -> list[str]:
    """Lines of a report as columns; with those of the dissertation if it says something."""
    rows: list[tuple[str, str, str]] = [("", "here", "dissertation"), *lines]
    if not beside or not any(line.dissertation for line in lines):
        rows = [(line.what, line.here, "") for line in lines]
    first, second = (max((len(row[column]) for row in rows), default=0) for column in (0, 1))
    return [f"  {what:<{first}}  {here:<{second}}  {said}".rstrip() for what, here, said in rows]


def _known() -> tuple[str, ...]:
    """Names of all files a folder may hold."""
    from saleg.thesis.chapter_5 import EXPERIMENTS

    pictures = {name for experiment in EXPERIMENTS.values() for name in experiment.draw}
    return (ENGINE, *TABLES, *sorted(pictures))


def _write(folder: Path, engine: Engine, experiment: Experiment, result: Any) -> list[str]:
    """Write engine, tables and, of what moved, pictures; returns the names of the files."""
    from saleg.thesis.experiment import run_of, table_of

    run, table = run_of(result), table_of(result)
    write_text(folder / ENGINE, (engine if run is None else run.engine).to_toml())
    if run is not None:
        write_csv(folder / "dead_centres.csv", run.dead_centres)
        write_csv(folder / "cycles.csv", run.cycles)
    if table is not None:
        write_csv(folder / "results.csv", table)
    for name, draw in experiment.draw.items() if _moved(run) else ():
        np.ravel(draw(result))[0].figure.savefig(folder / name)
    return [name for name in _known() if (folder / name).exists()]
