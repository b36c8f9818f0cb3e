"""Tables of results with their units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from saleg.display.numbers import number
from saleg.display.page import card, grid, raised
from saleg.quantities import is_number
from saleg.simulation.performance import FIGURES
from saleg.simulation.readable import Readable, readable

if TYPE_CHECKING:
    import pandas as pd

#: Rows shown at the beginning and at the end of a long table, and characters of a text.
ENDS, LONGEST = 6, 40


def table_card(table: pd.DataFrame) -> str:
    """Rows of a table with the units they are shown in; the middle of a long one is left out."""
    if "relative" in table.attrs and set(table.index) <= set(table.attrs["units"]):
        return _comparison(table)
    units = table.attrs["units"]
    last = [name for name in table.columns if name == "message"]  # wide, and seldom of interest
    names = [name for name in table.columns if name not in last] + last
    read = {name: readable(str(name), units.get(name, "-")) for name in names}
    heads = [
        [str(table.index.name or ""), *map(str, read)],
        ["", *("" if one.unit == "-" else raised(one.unit) for one in read.values())],
    ]
    count = len(table)
    middle = count > 2 * ENDS
    kept = [*range(ENDS), *range(count - ENDS, count)] if middle else list(range(count))
    rows = [
        [str(table.index[row]), *(_cell(table[name].iloc[row], one) for name, one in read.items())]
        for row in kept
    ]
    if middle:
        rows.insert(ENDS, ["…"] * (1 + len(read)))
    return card("", _counted(table), grid(heads, rows), notes=[_NOTE])


_NOTE = "shown in readable units; the numbers of the table are SI"


def _counted(table: pd.DataFrame) -> str:
    """Number of rows, of each status if they have one."""
    text = f"{len(table)} rows"
    if "status" in table:
        counts = table["status"].value_counts()
        text += ": " + ", ".join(f"{count} {status}" for status, count in counts.items())
    return text


def _cell(value: Any, read: Readable) -> str:
    if isinstance(value, str) or not is_number(value):
        words = str(value)
        return words if len(words) <= LONGEST else f"{words[: LONGEST - 1]}…"
    return number(read.of(float(value)))


def _comparison(table: pd.DataFrame) -> str:
    """A comparison: a row per figure in its readable unit, relative differences in percent."""
    rows = []
    for name, values in zip(map(str, table.index), table.to_numpy(dtype=float), strict=True):
        if name in FIGURES and FIGURES[name].digits is None:
            continue  # how well the cycle repeats itself: noise beside noise
        read = readable(name, table.attrs["units"][name])
        cells = [
            _percent(value) if column in table.attrs["relative"] else number(read.of(value))
            for column, value in zip(table.columns, values, strict=True)
        ]
        rows.append([read.words, "" if read.unit == "-" else raised(read.unit), *cells])
    return card("comparison", "", grid([["", "", *map(str, table.columns)]], rows), notes=[_NOTE])


def _percent(share: float) -> str:
    return "-" if math.isnan(share) else f"{100.0 * share:+.2f} %"
