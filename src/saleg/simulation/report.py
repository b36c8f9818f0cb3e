"""Results as text, in readable units."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from saleg.simulation.performance import FIGURES, Figure, Performance
from saleg.simulation.readable import readable
from saleg.simulation.scavenging import Scavenging

if TYPE_CHECKING:
    from saleg.simulation.run import Run
    from saleg.simulation.validity import ValidityReport


def figure_rows(performance: Performance) -> dict[str, tuple[str, str, str]]:
    """Label, number and unit of the figures that are reported, as text, by the figure's name."""
    rows = {}
    for name, (unit, label, digits, note) in FIGURES.items():
        if digits is None:
            continue
        shown = readable(name, unit)
        value = shown.of(getattr(performance, name))
        number = "-" if math.isnan(value) else f"{value:.{digits}f}"
        rows[name] = label, number, "" if shown.unit == "-" else f"{shown.unit} {note}".rstrip()
    return rows


def scavenging_rows(sides: Sequence[Scavenging]) -> list[tuple[str, str, str]]:
    """Label, number and unit of the gas exchange: "left | right" where the sides differ.

    Empty for an engine through whose ports no gas flows.
    """
    known = [side for side in sides if side.is_known]
    rows = []
    for item in dataclasses.fields(Scavenging) if known else ():
        told: Figure = item.metadata["figure"]
        shown = readable(item.name, told.unit)
        numbers = [f"{shown.of(getattr(side, item.name)):.{told.digits}f}" for side in known]
        unit = "" if shown.unit == "-" else shown.unit
        rows.append((told.label, " | ".join(dict.fromkeys(numbers)), unit))
    return rows


def describe_rows(rows: Iterable[tuple[str, str, str]]) -> list[str]:
    """Labels, numbers and units as aligned lines."""
    return [f"  {label:<24} {number:>10} {unit}".rstrip() for label, number, unit in rows]


def describe_performance(performance: Performance) -> str:
    """Performance as an aligned table."""
    return "\n".join(describe_rows(figure_rows(performance).values()))


def describe_run(run: Run) -> str:
    """Run as a short report."""
    head = f"{run.engine.name}: {run.status} - {run.message}"
    return "\n".join([head, *describe_cycle(run.performance, run.scavenging, run.validity)])


def describe_cycle(
    performance: Performance, scavenging: Sequence[Scavenging], validity: ValidityReport
) -> list[str]:
    """Lines for the figures of a cycle, and for what speaks against them and for them."""
    return [
        describe_performance(performance),
        *describe_rows(scavenging_rows(scavenging)),
        *(f"  {line}" for line in describe_validity(validity, performance)),
    ]


def describe_validity(validity: ValidityReport, performance: Performance) -> list[str]:
    """A line for every law outside its range, every implausible figure, and the nearest machine.

    The machine is left out where there are no figures that it could support.
    """
    lines = [f"outside its range: {text}" for text in describe_exits(validity.range_exits)]
    lines += [f"beyond what is built: {figure}" for figure in validity.implausible]
    if validity.nearest is not None and performance.frequency > 0.0:
        lines.append(str(validity.nearest))
    return lines


def describe_exits(exits: Iterable[dict[str, Any]]) -> list[str]:
    """Words for every law of :func:`.ranges.range_exits`, both sides together."""
    rows: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for row in exits:
        rows.setdefault((row["law"], row["quantity"]), []).append(row)
    return [_exit_in_words(sides) for sides in rows.values()]


def _exit_in_words(sides: Sequence[dict[str, Any]]) -> str:
    """Range of a law, what it saw on any side, and for how much of its time it was outside."""
    law, low, high = sides[0], min(s["seen_low"] for s in sides), max(s["seen_high"] for s in sides)
    unit = "" if law["unit"] == "-" else f" {law['unit']}"
    share = max(side["time_share"] for side in sides)
    return (
        f"{law['law']} is for {law['quantity'].replace('_', ' ')} {law['low']:g} to "
        f"{law['high']:g}{unit}, saw {low:.4g} to {high:.4g}, "
        f"outside for {100.0 * share:.3g} % of its time ({law['source']})"
    )
