"""Tables of results as text for a terminal, and as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.files.atomic import new_file
from saleg.files.tables import labelled, write_table
from saleg.quantities import is_number

if TYPE_CHECKING:
    import pandas as pd

#: Figures that are shown of tables that have them; files have all.
SHOWN = ("power", "efficiency", "stroke", "compression_ratio", "frequency", "peak_pressure")
#: Columns left out at a terminal.
LONG = ("message", "evaluations")


def shown(table: pd.DataFrame, figures: Sequence[str] = SHOWN) -> str:
    """A table in readable units; of the figures of a cycle, some."""
    from saleg.simulation.performance import UNITS
    from saleg.simulation.readable import readable

    units = table.attrs["units"]
    names = [
        str(name) for name in table if name not in LONG and (name not in UNITS or name in figures)
    ]
    read = [readable(name, units.get(name, "-")) for name in names]
    heads = [one.words if one.unit == "-" else one.label for one in read]
    rows = [
        [_cell(value, one.factor) for value, one in zip(row, read, strict=True)]
        for row in table[names].itertuples(index=False)
    ]
    widths = [max(map(len, column)) for column in zip(heads, *rows, strict=True)]
    return "\n".join(
        "  ".join(f"{cell:>{width}}" for cell, width in zip(line, widths, strict=True))
        for line in [heads, *rows]
    )


def _cell(value: Any, factor: float) -> str:
    if isinstance(value, str) or not is_number(value):
        return str(value)
    return f"{factor * float(value):.5g}"


def write(path: Path, table: pd.DataFrame, force: bool = False) -> None:
    """Write a table with its units in the header, every number so that it is read back exactly."""
    with (
        new_file(path, force) as temporary,
        open(temporary, "w", encoding="utf-8", newline="\n") as file,
    ):
        write_table(file, labelled(table))
