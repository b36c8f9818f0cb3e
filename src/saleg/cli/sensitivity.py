"""``saleg sensitivity``: how much the figures of a steady state change with its inputs."""

from __future__ import annotations

import argparse
from typing import Any

from saleg.cli.run import add_changes, changed, load
from saleg.cli.tables import write
from saleg.cli.words import CommandError
from saleg.errors import nearest
from saleg.files.reading import expanded


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser(
        "sensitivity", help="percent of each figure per percent of each input, at the steady state"
    )
    add = parser.add_argument
    add("machine", metavar="MACHINE|FILE.toml", help="a name 'saleg list' shows, or an engine file")
    add_changes(parser)
    add("--inputs", metavar="PATH,...", help="inputs, as 'saleg list parameters' shows them")
    add("--figures", metavar="NAME,...", help="figures of a cycle, such as power,efficiency")
    add("--change", type=float, default=0.01, metavar="C", help="relative change (0.01)")
    add("--out", type=expanded, metavar="FILE.csv", help="write the table to a new file")
    parser.set_defaults(command=tell)


def tell(options: argparse.Namespace) -> bool:
    """Solve, print and write; returns whether every elasticity is known."""
    from saleg.batch.many import NOT_IN_ROWS
    from saleg.engine.paths import MAIN_INPUTS
    from saleg.simulation.performance import UNITS
    from saleg.studies.elasticities import MAIN_FIGURES, elasticities

    engine = changed(load(options.machine), options.changes)
    inputs, figures = _words(options.inputs, MAIN_INPUTS), _words(options.figures, MAIN_FIGURES)
    for name in figures:
        if name not in UNITS or name in NOT_IN_ROWS:
            raise CommandError(f"--figures {name}: no such figure{nearest(name, UNITS)}")
    if options.inputs is not None:
        for path in inputs:
            engine.get(path)
    table = elasticities(engine, inputs, figures, change=options.change)
    if len(table) and bool(table.isna().all(axis=None)):
        raise CommandError(f"no steady state to be sensitive: see saleg steady {options.machine}")
    width = max(map(len, map(str, table.index)), default=0)
    print(f"{'% per %':<{width}}  {'  '.join(map(str, table.columns))}")
    for path, row in zip(table.index, table.to_numpy(dtype=float), strict=True):
        cells = (f"{value:>+{len(name)}.3f}" for name, value in zip(figures, row, strict=True))
        print(f"{path:<{width}}  {'  '.join(cells)}")
    if options.out is not None:
        whole = table.reset_index()
        whole.attrs["units"] = {"input": "-", **table.attrs["units"]}
        write(options.out, whole)
        print(f"wrote {options.out}")
    return bool(table.notna().all(axis=None)) and len(table) > 0


def _words(text: str | None, usual: tuple[str, ...]) -> tuple[str, ...]:
    return usual if text is None else tuple(word.strip() for word in text.split(","))
