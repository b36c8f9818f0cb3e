"""The folder of a sweep: what has been done is there whole, whatever happens next.

``sweep.json`` says what the sweep is of; ``points.csv`` holds its inputs; every piece of work that
is done is a file in ``parts``. At the end all of it is ``results.csv``, and the parts go.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import os
import shutil
import uuid
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batch.many import Columns, kind_of
from saleg.compiler.cache import locked
from saleg.engine.text_files import is_folder, named
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
        with _writing(self.path):
            if self.path.is_dir() and not (self.path / DESCRIPTION).exists():
                self._refuse_strangers(table_text(points))
            self.path.mkdir(parents=True, exist_ok=True)
            with open(self.path / LOCK, "ab"):
                pass
        with locked(self.path / LOCK):
            self._claim(json.loads(json.dumps(description)), points)
            yield

    def _refuse_strangers(self, points: str) -> None:
        """A folder without a description may hold what an interrupted start left, nothing else."""
        for entry in self.path.iterdir():
            ours = entry.name == LOCK or entry.name.startswith((f".{DESCRIPTION}", f".{POINTS}"))
            if entry.name == POINTS:
                ours = _read(entry) == points
            if not ours:
                raise SweepError(
                    f"{self.path} is no folder of a sweep: it holds {entry.name}; name another "
                    "folder"
                )

    def _claim(self, description: dict[str, Any], points: pd.DataFrame) -> None:
        path = self.path / DESCRIPTION
        if not path.exists():
            _write(self.path / POINTS, table_text(points))
            _write(path, json.dumps(description, indent=1) + "\n")
            return
        known = read_description(self.path)
        differing = [key for key in description if known.get(key) != description[key]]
        if _read(self.path / POINTS) != table_text(points):
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

    def done(self, counts: Mapping[int, int]) -> set[int]:
        """Which pieces are done, of some with their numbers of points; a damaged one is not."""
        return {number for number, count in counts.items() if self._whole(number, count)}

    def keep(self, number: int, columns: Columns) -> None:
        """Write a piece that is done."""
        plain = {name: _plain(values) for name, values in columns.items()}
        path = self._part(number)
        with _writing(path.parent):
            path.parent.mkdir(exist_ok=True)
        _write(path, json.dumps({"sha256": _digest(plain), "columns": plain}) + "\n")

    def piece(self, number: int) -> Columns:
        """Read a piece."""
        held = json.loads(_read(self._part(number)))["columns"]
        return {name: _restored(name, values) for name, values in held.items()}

    def _whole(self, number: int, count: int) -> bool:
        """Whether a piece is there as it was written, with as many points."""
        try:
            held = json.loads(_read(self._part(number)))
            columns = held["columns"]
            return held["sha256"] == _digest(columns) and len(columns["status"]) == count
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return False

    def finish(self, table: pd.DataFrame) -> None:
        """Write the whole table; the parts are no longer needed."""
        _write(self.path / RESULTS, table_text(table))
        self.clear()

    def clear(self) -> None:
        """Remove the parts."""
        shutil.rmtree(self.path / PARTS, ignore_errors=True)

    def table(self) -> pd.DataFrame:
        """The whole table, checked against what the sweep is of.

        Raises
        ------
        SweepError
            If either is damaged.
        """
        known = read_description(self.path)
        inputs, path = known.get("inputs"), self.path / RESULTS
        if not isinstance(inputs, dict) or not isinstance(known.get("count"), int):
            raise SweepError(f"{self.path / DESCRIPTION} is damaged: it lacks inputs or count")
        table = read_table(path)
        names = [str(name) for name in table]
        results = {"status"} if known["count"] else set()
        if names[: len(inputs)] != list(inputs) or not results <= set(names):
            raise _damaged(path, "its columns are not those of this sweep")
        if len(table) != known["count"]:
            raise _damaged(path, f"it has {len(table)} rows in place of {known['count']}")
        table.attrs["inputs"] = list(inputs)
        return table

    def _part(self, number: int) -> Path:
        return self.path / PARTS / f"{number:07d}.json"


def _digest(columns: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(columns).encode()).hexdigest()


def _damaged(path: Path, why: str) -> SweepError:
    return SweepError(f"{path} is damaged: {why}; remove it and run the sweep again")


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Name the file in what goes wrong with it."""
    with named(path, SweepError, "write"):
        yield


def _write(path: Path, text: str) -> None:
    """Write a text file so that it is there whole or not at all, readable as any other file."""
    temporary = path.with_name(f".{path.name}-{uuid.uuid4().hex}")
    with _writing(path):
        try:
            with open(temporary, "x", encoding="utf-8", newline="\n") as file:
                file.write(text)
            os.replace(temporary, path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def _read(path: Path) -> str:
    is_folder(path, SweepError)  # refuses what would be waited for without end
    with named(path, SweepError):
        content = path.read_bytes()
    try:
        return content.decode("utf-8")
    except ValueError:
        raise SweepError(f"{path} is damaged: it is no text") from None


def read_description(folder: Path) -> dict[str, Any]:
    """What a sweep is of, from its folder."""
    path = folder / DESCRIPTION
    try:
        held = json.loads(_read(path))
    except (ValueError, RecursionError) as error:
        raise SweepError(f"{folder} is no folder of a sweep: {error}") from None
    if not isinstance(held, dict):
        raise SweepError(f"{folder} is no folder of a sweep: {path} holds no table")
    return held


def read_table(path: Path) -> pd.DataFrame:
    """A table as :func:`table_text` writes it, exactly, with its units in ``.attrs``.

    Raises
    ------
    SweepError
        If it is none.
    """
    import pandas as pd

    text = _read(path)
    if not text.endswith("\n"):
        raise _damaged(path, "its last line is cut")
    labels, *rows = csv.reader(io.StringIO(text, newline=""))
    split = [label.rpartition(" [") for label in labels]
    names = [name for name, _, _ in split]
    if not all(names) or any(len(row) != len(names) for row in rows):
        raise _damaged(path, "a line has another number of values, or a column no name and unit")
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    data: dict[str, np.ndarray] = {}
    for name, texts in zip(names, columns, strict=True):
        try:
            data[name] = np.array([_value(name, text) for text in texts], dtype=kind_of(name))
        except ValueError:
            raise _damaged(path, f"a value of {name} is no number") from None
    frame = pd.DataFrame(data)
    units = [unit.rstrip("]") for _, _, unit in split]
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
