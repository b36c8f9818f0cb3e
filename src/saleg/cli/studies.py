"""``saleg studies``: what changes with a law, a number or a numerical setting (Chapter 3)."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from typing import Any

from saleg.cli.run import add_changes, changed, load
from saleg.cli.tables import shown, write
from saleg.cli.words import CommandError
from saleg.errors import nearest
from saleg.files.reading import expanded

#: The engine of Chapter 3.
DEFAULT = "thesis-base"
#: Tolerances of the study of them.
TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("studies", help="a study of laws, numbers or numerical settings")
    add = parser.add_argument
    add("study", nargs="?", metavar="STUDY", help="which; without one, all are listed")
    add("machine", nargs="?", default=DEFAULT, metavar="MACHINE|FILE.toml", help=f"({DEFAULT})")
    add_changes(parser)
    add("--out", type=expanded, metavar="FILE.csv", help="write the whole table to a new file")
    parser.set_defaults(command=perform)


def catalogue() -> dict[str, Callable[..., Any]]:
    """Studies by the name the command line uses."""
    from saleg import studies
    from saleg.studies import sensitivity

    found: dict[str, Callable[..., Any]] = {
        "step-size": studies.step_size_study,
        "solver": studies.solver_study,
        "stop-time": studies.stop_time_study,
        "tolerance": partial(studies.tolerance_study, tolerances=TOLERANCES),
    }
    names = (
        "friction_laws",
        "heat_transfer_laws",
        "hohenberg_parameters",
        "ignition_laws",
        "cfr_parameters",
        "equivalence_ratios",
        "retained_gas",
        "release_durations",
        "release_profiles",
        "flux_ripples",
        "regulator_gains",
        "target_strokes",
    )
    return found | {name.replace("_", "-"): getattr(sensitivity, name) for name in names}


def perform(options: argparse.Namespace) -> bool:
    """Do a study, print and write its table; returns whether every row has figures."""
    known = catalogue()
    if options.study is None:
        width = max(map(len, known))
        print("\n".join(f"{name:<{width}}  {_summary(one)}" for name, one in known.items()))
        return True
    if options.study not in known:
        hint = nearest(options.study, known) or f"; there are {', '.join(known)}"
        raise CommandError(f"no study '{options.study}'{hint}")
    found = known[options.study](changed(load(options.machine), options.changes))
    table = getattr(found, "table", found)
    print(shown(table))
    if options.out is not None:
        write(options.out, table)
        print(f"wrote {options.out}")
    return bool(table["status"].isin(("steady", "completed")).all())


def _summary(study: Any) -> str:
    """First line of what a study says of itself."""
    text = getattr(study, "func", study).__doc__ or ""
    return text.partition("\n")[0].rstrip(".")
