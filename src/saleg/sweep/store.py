"""The folder of a sweep: what has been done is there whole, whatever happens next.

``sweep.json`` says what the sweep is of; ``points.csv`` holds its inputs; every piece of work that
is done is a file in ``parts``. At the end all of it is ``results.csv``, and the parts go.
"""

from __future__ import annotations

import csv
import io
import json
import math
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batches import Columns, kind_of
from saleg.kernel.cache import locked, write_atomically
from saleg.sweep.points import SweepError

if TYPE_CHECKING:
    import pandas as pd

DESCRIPTION, POINTS, RESULTS, PARTS, LOCK = (
    "sweep.json",
    "points.csv",
    "results.csv",
    "parts",
    ".lock",
)


class Folder:
    """Folder of one sweep.

    Parameters
    ----------
    path : Path
        Made if there is none.
    """

    def __init__(self, path: Path):
        self.path = path

    @contextmanager
    def opened(self, description: Mapping[str, Any], points: pd.DataFrame) -> Iterator[None]:
        """Make the folder this sweep's, and keep other processes out meanwhile.

        Raises
        ------
        SweepError
            If it is that of another sweep, or no folder of a sweep at all.
        """
        if self.path.is_dir() and not (self.path / DESCRIPTION).exists():
            ours = {LOCK, POINTS}
            strange = [
                entry.name
                for entry in self.path.iterdir()
                if entry.name not in ours
                and not entry.name.startswith((f".{DESCRIPTION}", f".{POINTS}"))
            ]
            if strange:
                raise SweepError(f"{self.path} is no folder of a sweep: it holds {strange[0]}")
        try:
            (self.path / PARTS).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise SweepError(f"cannot write {self.path}: {error.strerror}") from None
        with locked(self.path / LOCK):
            self._claim(json.loads(json.dumps(description)), points)
            yield

    def _claim(self, description: dict[str, Any], points: pd.DataFrame) -> None:
        path = self.path / DESCRIPTION
        if not path.exists():
            write_atomically(self.path / POINTS, table_text(points))
            write_atomically(path, json.dumps(description, indent=1) + "\n")
            return
        known = read_description(self.path)
        differing = [key for key in description if known.get(key) != description[key]]
        if (self.path / POINTS).read_text(encoding="utf-8") != table_text(points):
            differing.append("points")
        if differing:
            raise SweepError(
                f"{self.path} holds another sweep (other {', '.join(differing)}); name another "
                "folder"
            )

    @property
    def finished(self) -> bool:
        """Whether all is done."""
        return (self.path / RESULTS).exists()

    def done(self) -> set[int]:
        """Numbers of the pieces that are done."""
        return {int(file.stem) for file in (self.path / PARTS).glob("[0-9]*.json")}

    def keep(self, number: int, columns: Columns) -> None:
        """Write a piece that is done."""
        text = json.dumps({name: _plain(values) for name, values in columns.items()})
        write_atomically(self._part(number), text + "\n")

    def piece(self, number: int) -> Columns:
        """Read a piece."""
        held = json.loads(self._part(number).read_text(encoding="utf-8"))
        return {name: _restored(name, values) for name, values in held.items()}

    def finish(self, table: pd.DataFrame) -> None:
        """Write the whole table; the parts are no longer needed."""
        write_atomically(self.path / RESULTS, table_text(table))
        shutil.rmtree(self.path / PARTS, ignore_errors=True)

    def _part(self, number: int) -> Path:
        return self.path / PARTS / f"{number:07d}.json"


def read_description(folder: Path) -> dict[str, Any]:
    """What a sweep is of, from its folder."""
    try:
        held = json.loads((folder / DESCRIPTION).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise SweepError(f"{folder} is no folder of a sweep: {error}") from None
    return dict(held)


def read_table(path: Path) -> pd.DataFrame:
    """A table as :func:`table_text` writes it, exactly, with its units in ``.attrs``."""
    import pandas as pd

    with open(path, encoding="utf-8", newline="") as file:
        labels, *rows = csv.reader(file)
    names, units = [], []
    for label in labels:
        name, _, unit = label.rpartition(" [")
        names.append(name)
        units.append(unit.rstrip("]"))
    data: dict[str, np.ndarray] = {}
    for name, texts in zip(
        names, zip(*rows, strict=True) if rows else [()] * len(names), strict=True
    ):
        data[name] = np.array([_value(name, text) for text in texts], dtype=kind_of(name))
    frame = pd.DataFrame(data)
    frame.attrs["units"] = dict(zip(names, units, strict=True))
    return frame


def table_text(table: pd.DataFrame) -> str:
    """A table as CSV, units in its header, every number exactly."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    units = table.attrs["units"]
    writer.writerow([f"{name} [{units[name]}]" for name in table])
    columns = [table[name].tolist() for name in table]
    writer.writerows(zip(*columns, strict=True))
    return file.getvalue()


def _value(name: str, text: str) -> Any:
    if kind_of(name) is bool:
        return text == "True"
    return float(text) if kind_of(name) is float else text


def _plain(values: list[Any]) -> list[Any]:
    """Values as JSON knows them: what is no finite number becomes text."""
    return [
        repr(float(value)) if isinstance(value, float) and not math.isfinite(value) else value
        for value in map(_native, values)
    ]


def _native(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _restored(name: str, values: list[Any]) -> list[Any]:
    return [float(value) for value in values] if kind_of(name) is float else values
