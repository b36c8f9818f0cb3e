"""A folder with a CSV table per table, ``engine.toml`` and ``run.json``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path

import numpy as np

from saleg.errors import RunFileError
from saleg.export.description import Column, Description, Stored
from saleg.export.units import CODES, LATER_FIELDS, LAYOUTS
from saleg.files.atomic import write_text
from saleg.files.reading import decoded, is_folder
from saleg.files.tables import DamagedTable, label, read_table, write_table

KIND = "folder of tables"
ENGINE, FACTS = "engine.toml", "run.json"
#: What a folder may hold.
FILES = (ENGINE, FACTS, *(f"{name}.csv" for name in ("performance", "cycles", *LAYOUTS)))


def write(description: Description, folder: Path) -> None:
    """Write a description into an empty folder."""
    write_text(folder / ENGINE, description.engine_toml)
    write_text(folder / FACTS, description.run_json)
    for name, table in description.tables.items():
        with open(folder / f"{name}.csv", "w", encoding="utf-8", newline="\n") as file:
            write_table(file, {label(key, held.unit): _shown(held) for key, held in table.items()})


def _shown(column: Column) -> np.ndarray:
    """Values of a column, with words for codes."""
    return np.array(column.words, dtype=object)[column.values] if column.words else column.values


@contextmanager
def opened(folder: Path) -> Iterator[Stored]:
    """Look into a folder for reading, table by table."""
    for name in FILES:
        is_folder(folder / name, RunFileError)  # refuses what would be waited for without end

    @lru_cache(maxsize=1)
    def rows(table: str) -> np.ndarray:
        path, places = folder / f"{table}.csv", LAYOUTS[table].places
        before = (item for item in places.items() if item[1].field not in LATER_FIELDS)
        needed = [label(name, place.unit) for name, place in before]
        try:
            return read_table(path, is_text=CODES.__contains__, needed=needed)
        except DamagedTable as error:
            raise RunFileError(f"{path.name} is damaged: {error}") from None

    def column(table: str, name: str) -> np.ndarray:
        held, word = rows(table), label(name, LAYOUTS[table].places[name].unit)
        if word not in (held.dtype.names or ()):
            raise KeyError(name)
        values = held[word]
        return _codes(name, values) if name in CODES else values

    texts = _read_text(folder / ENGINE), _read_text(folder / FACTS)
    yield Stored(*texts, column, is_exact=False)  # a NaN has no sign in text


def _read_text(path: Path) -> str:
    """A text as :func:`write_text` wrote it, whatever ends of lines an editor gave it since."""
    return decoded(path.read_bytes()).replace("\r\n", "\n")


def _codes(column: str, texts: np.ndarray) -> np.ndarray:
    """Whole numbers for the words in a column."""
    codes = {word: code for code, word in enumerate(CODES[column])}
    return np.array([codes[text] for text in texts.tolist()], dtype=np.int64)
