"""Numbers in the units people read, as text."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from saleg.engine import Engine
from saleg.engine.paths import MAIN_INPUTS, unit_of
from saleg.errors import UnknownPath
from saleg.quantities import is_number
from saleg.simulation.readable import readable

#: 0 degrees Celsius [K].
FREEZING = 273.15
_WORDS = {
    "half_stroke": "crown to head at the midpoint",
    "port_closing": "clearance at port closing",
    "spring.stiffness": "spring stiffness",
    "intake.pressure": "intake pressure",
    "pressure": "pressure opposite the cylinder",
    "temperature": "temperature opposite the cylinder",
    "friction.coefficient": "friction coefficient",
    "alternator.load_constant": "load constant",
}


def number(value: Any) -> str:
    """A number to four digits; a dash where there is none."""
    if not is_number(value) or math.isnan(value):
        return "-"
    return (
        f"{value:.4g}"
        if abs(value) < 1e4
        else f"{value:.0f}"
        if abs(value) < 1e6
        else f"{value:.3e}"
    )


def shown(name: str, unit: str, value: float) -> tuple[str, str, str]:
    """Name, number and unit of a quantity as people read it; not so hot temperatures in °C."""
    read = readable(name, unit, _WORDS.get(name, ""))
    if unit == "K" and "peak" not in name:
        return read.words, number(value - FREEZING), "°C"
    return read.words, number(read.of(value)), "" if read.unit == "-" else read.unit


def inputs(engine: Engine) -> Iterator[tuple[str, str, str]]:
    """Name, number and unit of the inputs of an engine; of both sides where they differ."""
    for path in MAIN_INPUTS:
        found = [_at(engine, name) for name in (path, f"left.{path}", f"right.{path}")]
        both, sides = found[0], [value for value in found[1:] if value is not None]
        values = sides if len(set(sides)) > 1 else [both]
        if values[0] is None:
            continue
        unit = unit_of(engine, path)
        rows = [shown(path, unit, value) for value in values if value is not None]
        yield rows[0][0], " | ".join(row[1] for row in rows), rows[0][2]


def _at(engine: Engine, path: str) -> float | None:
    """Number at a path; None without one."""
    try:
        value = engine.get(path)
    except UnknownPath:
        return None
    return float(value) if is_number(value) else None
