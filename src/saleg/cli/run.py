"""``saleg run``: simulate a machine or an engine file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from saleg.cli import pictures
from saleg.cli.folder import FORMATS, new_folder, write_run
from saleg.cli.words import CommandError
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.engine.toml import SLOTS, laws_by_slot, read_toml
from saleg.errors import UnknownPath, nearest
from saleg.export.formats import check
from saleg.files.reading import expanded
from saleg.files.units import UnitError, number_in_si
from saleg.machines import catalogue
from saleg.simulation.integration import simulate
from saleg.simulation.run import Run

#: How engine files call what is the same on both sides.
BOTH_SIDES = "cylinder."


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("run", help="simulate a machine or an engine file")
    add = parser.add_argument
    add("machine", metavar="MACHINE|FILE.toml", help="a name 'saleg list' shows, or an engine file")
    add("--duration", type=float, default=2.5, metavar="T", help="time to simulate [s] (2.5)")
    add_changes(parser)
    add("--method", choices=("adaptive", "fixed"), help="integration (adaptive)")
    add("--order", type=int, metavar="N", help="order of the fixed-step method: 1-5 or 8 (4)")
    add("--step", type=float, metavar="S", help="fixed step [s] (5e-6)")
    add("--rtol", type=float, metavar="R", help="tolerance of the adaptive method (1e-8)")
    add("--history", type=int, metavar="N", help="keep every N-th step for the files in DIR (none)")
    add(
        "--out", type=expanded, metavar="DIR", help="write plots, tables and engine to a new folder"
    )
    pictures.add_plot(parser, "in DIR, or here without one")
    add("--format", metavar="F,...", help=f"formats in DIR, of {', '.join(FORMATS)} (csv)")
    add("--force", action="store_true", help="replace DIR if it holds an earlier run")
    parser.set_defaults(command=run)


def add_changes(parser: argparse.ArgumentParser) -> None:
    """Add the option that changes an engine."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        dest="changes",
        help="change a value (SI unless a unit follows) or, by name, a law, such as bore=66mm; "
        "repeatable; 'saleg list parameters' shows what there is",
    )


def run(options: argparse.Namespace) -> bool:
    """Simulate, report and write; returns whether the run ended well."""
    engine = changed(load(options.machine), options.changes)
    wanted = _formats(options)
    settings = _settings(options)
    pictures.check(options.plot)
    if options.out is None:
        result = simulate(engine, options.duration, **settings)
        print(report(result))
        if options.plot:
            print(f"\nwrote {', '.join(pictures.draw(result, options.plot, Path()))}")
    else:
        engine.validate()
        with new_folder(options.out, options.force) as folder:
            result = simulate(engine, options.duration, **settings)
            names = write_run(result, folder, wanted)
            names += pictures.draw(result, options.plot, folder)
        print(report(result))
        print(f"\nwrote {options.out}: {', '.join(names)}")
    return result.status.ended_well


def load(name: str) -> Engine:
    """Engine of the catalogue, or from a file."""
    if name in catalogue():
        return catalogue()[name]()
    if name.endswith(".toml") or Path(name).is_file():
        return read_toml(name)
    hint = nearest(name, catalogue()) or f"; there are {', '.join(catalogue())}"
    raise CommandError(f"no machine '{name}'{hint} (the name of an engine file ends in .toml)")


def changed(engine: Engine, assignments: list[str]) -> Engine:
    """Copy of an engine with texts such as ``bore=60mm`` applied."""
    changes = {}
    for text in assignments:
        path, equals, value = (part.strip() for part in text.partition("="))
        path = path.removeprefix(BOTH_SIDES)
        if not path or not equals or not value:
            raise CommandError(f"--set {text}: must be PATH=VALUE, such as bore=0.06")
        if path in changes:
            raise CommandError(f"--set {path}: given twice")
        changes[path] = _value(engine, path, value)
    return engine.replace(**changes)


def _value(engine: Engine, path: str, text: str) -> Any:
    """Number in SI, or law by name; other text as it is, for the engine's checks to refuse."""
    slot = path.rpartition(".")[2]
    if path == "name":
        return text
    if slot in SLOTS and path in (slot, f"left.{slot}", f"right.{slot}"):
        return _law(text, slot)
    try:
        number = number_in_si(text, unit_of(engine, path))
    except UnknownPath:  # told by the engine, with all others
        return text
    except UnitError as error:
        raise CommandError(f"--set {path}={text}: {error}") from None
    return text if number is None else number


def _law(name: str, slot: str) -> Any:
    """Law of a slot by name, with its default numbers."""
    laws = laws_by_slot()[slot]
    if name in laws:
        return laws[name]()
    hint = nearest(name, laws) or f"; there are {', '.join(laws)}"
    raise CommandError(f"no law '{name}' for {slot}{hint}")


def _formats(options: argparse.Namespace) -> list[str]:
    """Formats to write, all of them at hand."""
    if options.format is None:
        return ["csv"]
    if options.out is None:
        raise CommandError("--format belongs to --out DIR")
    wanted = [word.strip() for word in options.format.split(",")]
    for word in wanted:
        if word not in FORMATS:
            hint = nearest(word, FORMATS) or f"; there are {', '.join(FORMATS)}"
            raise CommandError(f"no format '{word}'{hint}")
        check(FORMATS[word])
    return wanted


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    """Keywords of :func:`saleg.simulate`; those of the other method are refused."""
    fixed = {"--order": options.order, "--step": options.step}
    given = [flag for flag, value in fixed.items() if value is not None]
    method = options.method or ("fixed" if given else "adaptive")
    strange = given if method == "adaptive" else ["--rtol"] * (options.rtol is not None)
    if strange:
        raise CommandError(f"{strange[0]} does not belong to the {method} method")
    if options.history is not None and options.out is None:
        raise CommandError("--history belongs to --out DIR")
    chosen = {name: getattr(options, name) for name in ("order", "step", "rtol", "history")}
    settings = {name: value for name, value in chosen.items() if value is not None}
    return {"method": method, **settings}


def report(result: Run) -> str:
    """Text on a run: status, message and figures, beside the thesis' where there are any."""
    from saleg.simulation.report import describe_run
    from saleg.thesis.beside import comparison

    table = comparison(result) if result.status.ended_well else None
    return describe_run(result) + (f"\n\n{table}" if table else "")
