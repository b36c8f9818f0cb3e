"""Results as text, in readable units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from saleg.simulation.performance import FIGURES, Performance
from saleg.simulation.readable import readable

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


def describe_performance(performance: Performance) -> str:
    """Performance as an aligned table."""
    rows = figure_rows(performance).values()
    return "\n".join(f"  {label:<24} {number:>10} {unit}".rstrip() for label, number, unit in rows)


def describe_run(run: Run) -> str:
    """Run as a short report."""
    head = f"{run.engine.name}: {run.status} - {run.message}"
    return "\n".join(
        [
            head,
            describe_performance(run.performance),
            *describe_ranges(run),
            *describe_remarks(run.remarks),
        ]
    )


def describe_remarks(remarks: list[str]) -> list[str]:
    """A line for every figure no engine built comes near."""
    return [f"  beyond what is built: {remark}" for remark in remarks]


def describe_ranges(run: Run) -> list[str]:
    """A line for every law that was asked outside the range it was made for."""
    return describe_exits(run.range_exits)


def describe_exits(exits: list[dict[str, Any]]) -> list[str]:
    """A line for every law of :func:`.ranges.range_exits`."""
    rows = {(row["law"], row["quantity"]): row for row in exits}
    return [
        f"  outside its range: {row['law']} is for {row['quantity'].replace('_', ' ')} "
        f"{row['low']:g} to {row['high']:g} {'' if row['unit'] == '-' else row['unit']}, "
        f"saw {row['seen_low']:.4g} to {row['seen_high']:.4g} ({row['source']})"
        for row in rows.values()
    ]
