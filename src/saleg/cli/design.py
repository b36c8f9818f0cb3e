"""``saleg design``: the steady state of a component design, with its masses and dimensions."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from saleg.cli.words import CommandError
from saleg.errors import UnknownPath
from saleg.files.atomic import write_text
from saleg.files.reading import expanded
from saleg.files.units import UnitError, number_in_si

if TYPE_CHECKING:
    from saleg.design import Design


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser(
        "design", help="evaluate a component design: masses and dimensions follow from it"
    )
    add = parser.add_argument
    add(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        dest="changes",
        help="one of the eight parameters of a design, or a path of its engine: bore=60mm",
    )
    add("--list", action="store_true", help="list the eight parameters, and end")
    add("--out", type=expanded, metavar="FILE.toml", help="write the engine found")
    add("--drawing", type=expanded, metavar="FILE.png", help="draw its section to scale")
    parser.set_defaults(command=evaluate)


def evaluate(options: argparse.Namespace) -> bool:
    """Evaluate and report; returns whether there is a steady state."""
    from saleg.design import Design
    from saleg.design import evaluate as evaluated

    design = Design()
    if options.list:
        print(_parameters(design))
        return True
    found = evaluated(design, **_values(design, options.changes))
    print(found)
    if not found.found:
        return False
    print("\n".join(_components(found.component_figures)))
    if options.out is not None:
        write_text(options.out, found.engine.to_toml())
        print(f"wrote {options.out}")
    if options.drawing is not None:
        found.draw().figure.savefig(options.drawing)
        print(f"wrote {options.drawing}")
    return True


def _parameters(design: Design) -> str:
    """The eight parameters with unit, value and meaning."""
    import dataclasses

    from saleg.cli.parameters import meaning_of

    lines = []
    for item in dataclasses.fields(design.parameters):
        limits, value = item.metadata["limits"], getattr(design.parameters, item.name)
        told = meaning_of(design.parameters, item.name)
        lines.append(f"{item.name:<20}{value:<10g}{limits.unit:<5}{limits!s:<24}{told}".rstrip())
    return "\n".join(lines)


def _values(design: Design, assignments: list[str]) -> dict[str, Any]:
    """Values by name, in SI."""
    found: dict[str, Any] = {}
    for text in assignments:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not name or not equals or not value:
            raise CommandError(f"--set {text}: must be NAME=VALUE, such as bore=60mm")
        if name in found:
            raise CommandError(f"--set {name}: given twice")
        try:
            number = number_in_si(value, design.unit(name))
        except UnknownPath:  # told by the design, with all others
            number = None
        except UnitError as error:
            raise CommandError(f"--set {text}: {error}") from None
        found[name] = value if number is None else number
    return found


def _components(figures: dict[str, float]) -> list[str]:
    """What the components add to the figures of the cycle, in readable units."""
    from saleg.design.results import COMPONENT_UNITS
    from saleg.simulation.readable import readable

    lines = []
    for name, value in figures.items():
        shown = readable(name, COMPONENT_UNITS[name])
        unit = "" if shown.unit == "-" else shown.unit
        words = shown.words if "$" not in shown.words else name.replace("_", " ")
        lines.append(f"  {words:<26} {shown.of(value):>8.4g} {unit}".rstrip())
    return lines
