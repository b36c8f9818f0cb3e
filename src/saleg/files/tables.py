"""Tables as CSV: units in the header, every number so that it is read back exactly."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from saleg.files.reading import refuse_utf16

#: Rows turned into text at a time.
BLOCK = 5_000


class DamagedTable(ValueError):
    """A file that is no whole table; says why."""


def label(name: str, unit: str) -> str:
    """Head of a column, as ``bore [m]``; a column without a unit has its name only."""
    return f"{name} [{unit}]" if unit else name


def labelled(table: Any) -> dict[str, np.ndarray]:
    """Columns of a DataFrame by their labels, with the units in its ``.attrs``."""
    units = table.attrs["units"]
    return {label(str(name), units.get(name, "")): table[name].to_numpy() for name in table}


def write_table(file: TextIO, columns: Mapping[str, np.ndarray]) -> None:
    """Write columns of equal length, each under its label.

    Parameters
    ----------
    file : text file
        Open for writing, its ends of line left as they are written.
    columns : mapping of str to ndarray
        Numbers, truth values or text by label.
    """
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(columns)
    values = list(columns.values())
    for start in range(0, len(values[0]) if values else 0, BLOCK):
        block = (column[start : start + BLOCK].tolist() for column in values)
        writer.writerows(zip(*block, strict=True))


def read_table(
    path: Path, is_text: Callable[[str], bool], needed: Collection[str] = ()
) -> np.ndarray:
    """Rows of a table as :func:`write_table` writes it, whatever an editor did to its line ends.

    Parameters
    ----------
    path : Path
    is_text : callable
        Whether the column of a label holds text, in place of numbers.
    needed : collection of str
        Labels there must be.

    Returns
    -------
    ndarray
        Structured, with a field per label: float64, or text as objects.

    Raises
    ------
    DamagedTable
        If a column is missing, or a line is cut, has another number of values, or holds what is no
        number.
    OSError
        If the file cannot be read.
    """
    try:
        _refuse_cut(path)
        with open(path, encoding="utf-8-sig", newline="") as file:
            labels = next(csv.reader([file.readline()]))
            for name in needed:
                if name not in labels:
                    raise DamagedTable(f"it lacks the column '{name}'")
            dtype = np.dtype([(name, object if is_text(name) else np.float64) for name in labels])
            start = file.tell()
            if not file.read(1):
                return np.zeros(0, dtype)
            file.seek(start)
            return np.loadtxt(file, dtype, delimiter=",", comments=None, quotechar='"', ndmin=1)
    except UnicodeDecodeError:
        raise DamagedTable("it is no text") from None
    except ValueError as error:
        raise DamagedTable(str(error)) from None


def _refuse_cut(path: Path) -> None:
    """Refuse a table in another coding, or whose last line has no end."""
    with open(path, "rb") as file:
        refuse_utf16(file.read(2))
        file.seek(max(file.seek(0, os.SEEK_END) - 1, 0))
        if file.read(1) != b"\n":
            raise DamagedTable("it was cut short")
