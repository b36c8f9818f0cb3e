"""HDF5: a group per table, a dataset with its unit per column; the texts are attributes."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from saleg.export.description import Column, Description, Stored
from saleg.export.extras import extra

KIND = "HDF5 file"
NEEDS = ("h5py",)
#: What a file takes beside its columns [bytes], with some to spare.
OVERHEAD = 2_000_000


def attributes(column: Column) -> dict[str, Any]:
    """Unit of a column, and the words for its codes as netCDF's conventions (CF) have them."""
    if not column.words:
        return {"units": column.unit} if column.unit else {}
    return {
        "flag_values": np.arange(len(column.words)),
        "flag_meanings": " ".join(word.replace(" ", "_") for word in column.words),
    }


def write(description: Description, path: Path) -> None:
    """Write a description; columns go to the file one by one."""
    with writing(description, path), extra("h5py").File(path, "w", track_order=True) as file:
        file.attrs.update(description.texts)
        for table, columns in description.tables.items():
            group = file.create_group(table, track_order=True)
            for name, column in columns.items():
                group.create_dataset(name, data=column.values).attrs.update(attributes(column))


@contextmanager
def writing(description: Description, path: Path) -> Iterator[None]:
    """Refuse a disk without room, on which the HDF5 library can crash the whole process."""
    columns = [column for table in description.tables.values() for column in table.values()]
    size = sum(column.values.nbytes for column in columns)
    if shutil.disk_usage(path.parent).free < size + OVERHEAD:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    try:
        yield
    except RuntimeError as error:  # so the library calls what goes wrong in closing a file
        raise OSError(str(error)) from error


@contextmanager
def opened(path: Path) -> Iterator[Stored]:
    """Open a file for reading, column by column."""
    with extra("h5py").File(path, "r") as file:
        texts = str(file.attrs["engine_toml"]), str(file.attrs["run_json"])
        yield Stored(*texts, lambda table, name: file[table][name][()])
