"""Labels of axes and values in the units they name, from the one table of readable units."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from saleg.simulation.readable import Readable, readable

if TYPE_CHECKING:
    import pandas as pd


def axis_label(shown: Readable) -> str:
    """Name and unit of a quantity, with exponents set as such."""
    return f"{shown.words} [{exponents_raised(shown.unit)}]"


def exponents_raised(unit: str) -> str:
    """A unit as matplotlib sets it."""
    return re.sub(r"\^(\d)", r"$^\1$", unit)


#: Label of the time of a run.
TIME = axis_label(readable("t", "s"))


def column(table: pd.DataFrame, name: str, words: str = "") -> Readable:
    """Name and readable unit of a column; its SI unit stands in ``table.attrs["units"]``."""
    return readable(name, table.attrs["units"][name], words)


def label(table: pd.DataFrame, name: str, words: str = "") -> str:
    """Label of an axis for a column."""
    return axis_label(column(table, name, words))


def values(table: pd.DataFrame, name: str) -> np.ndarray:
    """A column in its readable unit."""
    return np.asarray(column(table, name).of(table[name].to_numpy(dtype=float)))
