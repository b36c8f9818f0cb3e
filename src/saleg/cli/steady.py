"""``saleg steady``: the steady state of a machine or an engine file, solved for."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from saleg.cli import pictures
from saleg.cli.run import add_changes, changed, load
from saleg.steady.solver import DEFAULT_TOLERANCE, steady_state
from saleg.steady.stability import describe


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("steady", help="solve for the steady state, with its stability")
    add = parser.add_argument
    add("machine", metavar="MACHINE|FILE.toml", help="a name 'saleg list' shows, or an engine file")
    add_changes(parser)
    add("--rtol", type=float, default=DEFAULT_TOLERANCE, metavar="R", help="tolerance (1e-6)")
    pictures.add_plot(parser, "here")
    parser.set_defaults(command=solve)


def solve(options: argparse.Namespace) -> bool:
    """Solve and report; returns whether there is a steady state."""
    pictures.check(options.plot)
    found = steady_state(changed(load(options.machine), options.changes), rtol=options.rtol)
    known = describe(found.stability) if found.found and found.has_multipliers else ""
    print("\n".join(text for text in (str(found), known) if text))
    if options.plot:
        print(f"\nwrote {', '.join(pictures.draw(found, options.plot, Path()))}")
    return found.found
