"""numpy's ``.npz``: one array per column, named ``table.column``, and texts; no pickles."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from saleg.errors import RunFileError
from saleg.export.description import Description, Stored
from saleg.export.units import CODES

KIND = "npz file"


def write(description: Description, path: Path) -> None:
    """Write a description; columns go to the file in pieces, none is copied whole."""
    arrays = {
        f"{table}.{name}": column.values
        for table, columns in description.tables.items()
        for name, column in columns.items()
    }
    units = {
        table: {name: column.unit for name, column in columns.items()}
        for table, columns in description.tables.items()
    }
    texts = {
        **description.texts,
        "units_json": json.dumps(units, indent=1),
        "codes_json": json.dumps(CODES, indent=1),
    }
    arrays |= {name: np.array(text) for name, text in texts.items()}
    with zipfile.ZipFile(path, "w") as archive:  # as np.savez, which may pickle
        for name, values in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy")
            with archive.open(entry, "w", force_zip64=True) as file:
                np.lib.format.write_array(file, values, allow_pickle=False)


@contextmanager
def opened(path: Path) -> Iterator[Stored]:
    """Open a file for reading, column by column."""
    if not zipfile.is_zipfile(path):
        raise RunFileError("it is not an npz file, or it was cut short")
    with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
        texts = str(arrays["engine_toml"]), str(arrays["run_json"])
        yield Stored(*texts, lambda table, name: arrays[f"{table}.{name}"])
