"""``saleg list``: machines, and laws by slot."""

from __future__ import annotations

import argparse
import inspect
from typing import Any

from saleg.engine.toml import laws_by_slot
from saleg.machines import CATALOGUE


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("list", help="list machines, or laws by slot")
    parser.add_argument(
        "what", nargs="?", choices=("machines", "laws"), default="machines", help="default machines"
    )
    parser.set_defaults(command=show)


def show(options: argparse.Namespace) -> bool:
    """Print the list asked for."""
    if options.what == "machines":
        _print_aligned({name: _summary(machine) for name, machine in CATALOGUE.items()}, "")
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
