"""A folder with a CSV table per table, ``engine.toml`` and ``run.json``."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from saleg.engine.text_files import is_folder
from saleg.export.description import Column, Description, Table
from saleg.export.place import RunFileError
from saleg.export.units import CODES, LAYOUTS

KIND = "folder of tables"
ENGINE, FACTS = "engine.toml", "run.json"
#: What a folder may hold.
FILES = (ENGINE, FACTS, *(f"{name}.csv" for name in ("performance", "cycles", *LAYOUTS)))
#: Rows turned into text at a time.
BLOCK = 5_000


def write(description: Description, folder: Path) -> None:
    """Write a description into an empty folder."""
    write_text(folder / ENGINE, description.engine_toml)
    write_text(folder / FACTS, description.run_json)
    for name, table in description.tables.items():
        write_table(folder / f"{name}.csv", table)


def write_text(path: Path, text: str) -> None:
    """Write a text file, the same on every system."""
    path.write_text(text, encoding="utf-8", newline="\n")


def write_table(path: Path, table: Table) -> None:
    """Write a table, units in its header, every number so that it is read back exactly."""
    columns = list(table.values())
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(",".join(_label(name, held.unit) for name, held in table.items()) + "\n")
        for start in range(0, len(columns[0].values), BLOCK):
            texts = (_texts(column, start) for column in columns)
            file.writelines(",".join(row) + "\n" for row in zip(*texts, strict=True))


def _label(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def _texts(column: Column, start: int) -> Iterator[str]:
    values = column.values[start : start + BLOCK].tolist()
    if column.words:
        return (column.words[code] for code in values)
    return map(repr, values)


class _Stored:
    """What a folder holds; its tables are read one at a time."""

    is_exact = False  # a NaN has no sign in text

    def __init__(self, folder: Path):
        self._folder = folder
        self.engine_toml = _read_text(folder / ENGINE)
        self.run_json = _read_text(folder / FACTS)

    def table(self, name: str) -> dict[str, np.ndarray]:
        """Columns of a table."""
        places = LAYOUTS[name].places
        labels = {column: _label(column, place.unit) for column, place in places.items()}
        rows = _read_rows(self._folder / f"{name}.csv", labels.values())
        return {
            column: _codes(column, rows[label]) if column in CODES else rows[label]
            for column, label in labels.items()
        }


def _read_text(path: Path) -> str:
    """A text as :func:`write_text` wrote it, whatever ends of lines an editor gave it since."""
    return path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")


def _codes(column: str, texts: np.ndarray) -> np.ndarray:
    """Whole numbers for the words in a column."""
    codes = {word: code for code, word in enumerate(CODES[column])}
    return np.array([codes[text] for text in texts.tolist()], dtype=np.int64)


def _read_rows(path: Path, needed: Iterable[str]) -> np.ndarray:
    """Rows of a table with a field per label: numbers, or text where there are codes."""
    labels, filled = _look_into(path)
    for label in needed:
        if label not in labels:
            raise RunFileError(f"{path.name} lacks the column '{label}'")
    dtype = np.dtype([(label, "U32" if label in CODES else "f8") for label in labels])
    if not filled:
        return np.zeros(0, dtype)
    try:
        return np.loadtxt(
            path, dtype, delimiter=",", skiprows=1, comments=None, encoding="utf-8", ndmin=1
        )
    except ValueError as error:
        raise RunFileError(f"{path.name} is damaged: {error}") from None


def _look_into(path: Path) -> tuple[list[str], bool]:
    """Labels of a table, and whether it has rows; a table that was cut short is refused."""
    with open(path, "rb") as file:
        labels = file.readline().decode("utf-8-sig").rstrip("\r\n").split(",")
        filled = bool(file.read(1))
        file.seek(max(file.seek(0, os.SEEK_END) - 1, 0))
        if file.read(1) != b"\n":
            raise RunFileError(f"{path.name} was cut short")
    return labels, filled


@contextmanager
def opened(folder: Path) -> Iterator[_Stored]:
    """Look into a folder for reading, table by table."""
    for name in FILES:
        is_folder(folder / name, RunFileError)  # refuses what would be waited for without end
    yield _Stored(folder)
