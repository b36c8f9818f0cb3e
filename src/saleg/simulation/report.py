"""Results as text, in readable units."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from saleg.simulation.performance import FIGURES, Figure, Performance
from saleg.simulation.ranges import range_exits
from saleg.simulation.readable import readable
from saleg.simulation.scavenging import Scavenging

if TYPE_CHECKING:
    from saleg.simulation.run import Run


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
    return "\n".join(
        [head, *describe_cycle(run.performance, run.scavenging, run.orbit, run.remarks)]
    )


def describe_cycle(
    performance: Performance,
    scavenging: Sequence[Scavenging],
    orbit: Run | None,
    remarks: list[str],
) -> list[str]:
    """Lines for the figures of a cycle, and for where they leave what is known."""
    return [
        describe_performance(performance),
        *describe_rows(scavenging_rows(scavenging)),
        *describe_ranges(orbit),
        *describe_remarks(remarks),
    ]


def describe_remarks(remarks: list[str]) -> list[str]:
    """A line for every figure no engine built comes near."""
    return [f"  beyond what is built: {remark}" for remark in remarks]


def describe_ranges(orbit: Run | None) -> list[str]:
    """A line for every law that was asked, in a cycle, outside the range it was made for."""
    if orbit is None or orbit.history_rows is None:
        return []
    return describe_exits(range_exits(orbit.engine, orbit.strokes, orbit.history_rows))


def describe_exits(exits: list[dict[str, Any]]) -> list[str]:
    """A line for every law of :func:`.ranges.range_exits`."""
    rows = {(row["law"], row["quantity"]): row for row in exits}
    return [
        f"  outside its range: {row['law']} is for {row['quantity'].replace('_', ' ')} "
        f"{row['low']:g} to {row['high']:g} {'' if row['unit'] == '-' else row['unit']}, "
        f"saw {row['seen_low']:.4g} to {row['seen_high']:.4g} ({row['source']})"
        for row in rows.values()
    ]
