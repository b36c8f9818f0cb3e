"""Results as text: bar, mm and percent, for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from saleg.simulation.performance import Performance

if TYPE_CHECKING:
    from saleg.simulation.run import Run

#: Figure, label, factor from SI, unit, digits.
FIGURES = (
    ("stroke", "stroke", 1e3, "mm", 2),
    ("compression_ratio", "compression ratio", 1.0, "-", 3),
    ("frequency", "frequency", 1.0, "Hz", 3),
    ("power", "mean electrical power", 1e-3, "kW", 3),
    ("rms_power", "RMS electrical power", 1e-3, "kW", 3),
    ("efficiency", "efficiency", 1e2, "%", 2),
    ("mean_alternator_force", "mean alternator force", 1.0, "N", 1),
    ("peak_pressure", "peak pressure", 1e-5, "bar", 2),
    ("peak_acceleration", "peak acceleration", 1e-3, "km/s^2", 3),
    ("peak_velocity", "peak velocity", 1.0, "m/s", 3),
    ("fuel_energy_per_cycle", "fuel energy per cycle", 1.0, "J", 1),
    ("charge_mass", "charge mass", 1e3, "g", 4),
    ("peak_temperature", "peak temperature", 1.0, "K", 1),
    ("peak_pressure_rise", "peak pressure rise", 1e-8, "bar/ms", 2),
    ("indicated_work", "indicated work per cycle", 1.0, "J", 1),
    ("indicated_efficiency", "indicated efficiency", 1e2, "%", 2),
    ("adverse_work", "adverse work per cycle", 1.0, "J", 3),
    ("start_of_combustion", "start of combustion", 1e3, "ms before dead centre", 3),
    ("start_of_combustion_position", "  at distance", 1e3, "mm", 2),
    ("burn_centre", "burn centre", 1e3, "ms after dead centre", 3),
    ("moving_mass", "moving mass", 1.0, "kg", 3),
)


def describe_performance(performance: Performance) -> str:
    """Performance as an aligned table."""
    lines = []
    for name, label, factor, unit, digits in FIGURES:
        value = getattr(performance, name) * factor
        shown = "-" if math.isnan(value) else f"{value:.{digits}f}"
        lines.append(f"  {label:<24} {shown:>10} {'' if unit == '-' else unit}".rstrip())
    return "\n".join(lines)


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
    rows = {(row["law"], row["quantity"]): row for row in run.range_exits}
    return [
        f"  outside its range: {row['law']} is for {row['quantity'].replace('_', ' ')} "
        f"{row['low']:g} to {row['high']:g} {'' if row['unit'] == '-' else row['unit']}, "
        f"saw {row['seen_low']:.4g} to {row['seen_high']:.4g} ({row['source']})"
        for row in rows.values()
    ]
