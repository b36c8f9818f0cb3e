"""numpy's ``.npz``: one array per column, named ``table.column``, and texts; no pickles."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from saleg.export.description import Description
from saleg.export.place import RunFileError
from saleg.export.units import CODES

KIND = "npz file"


def write(description: Description, path: Path) -> None:
    """Write a description; columns go to the file in pieces, none is copied whole."""
    arrays = {
        f"{table}.{name}": column.values
        for table, columns in description.tables.items()
        for name, column in columns.items()
    }
    texts = {
        **description.texts,
        "units_json": json.dumps(description.units, indent=1),
        "codes_json": json.dumps(CODES, indent=1),
    }
    arrays |= {name: np.array(text) for name, text in texts.items()}
    with zipfile.ZipFile(path, "w") as archive:  # as np.savez, which may pickle
        for name, values in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy")
            with archive.open(entry, "w", force_zip64=True) as file:
                np.lib.format.write_array(file, values, allow_pickle=False)


class _Stored:
    """What an open file holds."""

    is_exact = True

    def __init__(self, arrays: Any):
        self._arrays = arrays
        self.engine_toml = str(arrays["engine_toml"])
        self.run_json = str(arrays["run_json"])

    def table(self, name: str) -> _Columns:
        """Columns of a table."""
        return _Columns(self._arrays, name)


class _Columns:
    """Columns of one table, read one by one."""

    def __init__(self, arrays: Any, table: str):
        self._arrays, self._table = arrays, table

    def __getitem__(self, name: str) -> np.ndarray:
        return self._arrays[f"{self._table}.{name}"]


@contextmanager
def opened(path: Path) -> Iterator[_Stored]:
    """Open a file for reading, column by column."""
    if not zipfile.is_zipfile(path):
        raise RunFileError("it is not an npz file, or it was cut short")
    with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
        yield _Stored(arrays)
