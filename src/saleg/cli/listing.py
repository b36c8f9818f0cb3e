"""``saleg list``: machines, laws by slot, and the numbers of an engine."""

from __future__ import annotations

import argparse
import inspect
from typing import Any

from saleg.cli.parameters import table_of
from saleg.cli.run import load
from saleg.cli.words import CommandError
from saleg.engine.toml import laws_by_slot
from saleg.machines import catalogue

#: The machine whose parameters are listed unless another is named.
DEFAULT = "thesis-base"


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("list", help="list machines, laws by slot, or parameters")
    add = parser.add_argument
    kinds = ("machines", "laws", "parameters")
    add("what", nargs="?", choices=kinds, default="machines", help="default machines")
    add(
        "machine",
        nargs="?",
        metavar="MACHINE|FILE.toml",
        help=f"whose parameters are listed ({DEFAULT})",
    )
    parser.set_defaults(command=show)


def show(options: argparse.Namespace) -> bool:
    """Print the list asked for."""
    if options.machine is not None and options.what != "parameters":
        raise CommandError(f"saleg list {options.what} takes no machine")
    if options.what == "machines":
        _print_aligned({name: _summary(machine) for name, machine in catalogue().items()}, "")
        return True
    if options.what == "parameters":
        print(table_of(load(options.machine or DEFAULT)))
        return True
    for slot, laws in laws_by_slot().items():
        print(slot)
        _print_aligned({name: _summary(law) for name, law in laws.items()}, "  ")
    return True


def _summary(described: Any) -> str:
    """First line of a docstring, as a description."""
    line = (inspect.getdoc(described) or "").partition("\n")[0]
    text = line.removeprefix("Return ").split(": ``")[0].rstrip(".")
    return text[:1].upper() + text[1:]


def _print_aligned(rows: dict[str, str], indent: str) -> None:
    width = max(map(len, rows), default=0)
    for name, text in rows.items():
        print(f"{indent}{name:<{width}}  {text}".rstrip())
