"""The folder of a sweep: what has been done is there whole, whatever happens next.

``sweep.json`` says what the sweep is of; ``points.csv`` holds its inputs; every piece of work that
is done is a file in ``parts``. At the end all of it is ``results.csv``, and the parts go. What was
written is known by its SHA-256, so that an altered table is no result: that of the inputs stands in
``sweep.json``, that of the results in ``results.sha256``, as ``sha256sum --check`` reads it.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batch.table import Columns, kind_of
from saleg.errors import SweepError
from saleg.files.atomic import write_text
from saleg.files.lock import locked
from saleg.files.reading import decoded, is_folder, named
from saleg.files.tables import DamagedTable, labelled, read_table, write_table

if TYPE_CHECKING:
    import pandas as pd

DESCRIPTION, POINTS, RESULTS, DIGEST, PARTS, LOCK = (
    "sweep.json",
    "points.csv",
    "results.csv",
    "results.sha256",
    "parts",
    ".lock",
)
#: What a description without a format number was written in.
FIRST_FORMAT = 1


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
    def opened(
        self, identity: Mapping[str, Any], points: pd.DataFrame, begun_by: str
    ) -> Iterator[None]:
        """Make the folder this sweep's, and keep other processes out meanwhile.

        Parameters
        ----------
        identity : mapping
            All that decides about the results, as plain data.
        points : DataFrame
        begun_by : str
            Version that begins the sweep; written for the reader, any other may go on with it.

        Raises
        ------
        SweepError
            If it is that of another sweep, or no folder of a sweep at all.
        """
        with _writing(self.path):
            if self.path.is_dir():
                # Another process may be beginning: it makes the lock before all else.
                self._refuse_strangers(table_text(points), DESCRIPTION, LOCK)
            self.path.mkdir(parents=True, exist_ok=True)
            with open(self.path / LOCK, "ab"):
                pass
        with locked(self.path / LOCK):
            self._refuse_strangers(table_text(points), DESCRIPTION)
            self._claim(json.loads(json.dumps(identity)), points, begun_by)
            yield

    def _refuse_strangers(self, points: str, *signs: str) -> None:
        """Refuse a folder with more in it than an interrupted start left, and none of these."""
        for entry in self.path.iterdir():
            ours = entry.name == LOCK or entry.name.startswith((f".{DESCRIPTION}", f".{POINTS}"))
            if entry.name == POINTS:
                ours = _read(entry) == points
            if not ours and not any((self.path / sign).exists() for sign in signs):
                raise SweepError(
                    f"{self.path} is no folder of a sweep: it holds {entry.name}; name another "
                    "folder"
                )

    def _claim(self, identity: dict[str, Any], points: pd.DataFrame, begun_by: str) -> None:
        path = self.path / DESCRIPTION
        if not path.exists():
            _write(self.path / POINTS, table_text(points))
            begun = {"version": begun_by, "points_sha256": _digest(table_text(points))}
            _write(path, json.dumps(begun | identity, indent=1) + "\n")
            return
        known = {"format": FIRST_FORMAT, **read_description(self.path)}
        differing = [key for key in identity if known.get(key) != identity[key]]
        asked, written = table_text(points), known.get("points_sha256")
        if written is None:  # a folder made before the digest was kept
            written = _digest(_read(self.path / POINTS))
        if _digest(asked) != written:
            differing.append("points")
        if differing:
            raise SweepError(
                f"{self.path} holds another sweep (other {', '.join(differing)}); name another "
                "folder"
            )
        if not (self.path / POINTS).exists():
            _write(self.path / POINTS, asked)
        elif _read(self.path / POINTS) != asked:
            raise _damaged(self.path / POINTS, "it is not as it was written")

    @property
    def finished(self) -> bool:
        """Whether all is done."""
        return (self.path / RESULTS).exists()

    def keep(self, number: int, columns: Columns) -> None:
        """Write a piece that is done."""
        plain = {name: _plain(values) for name, values in columns.items()}
        path = self._part(number)
        with _writing(path.parent):
            path.parent.mkdir(exist_ok=True)
        digest = _digest(json.dumps(plain))
        _write(path, json.dumps({"sha256": digest, "columns": plain}) + "\n")

    def parts(self, total: int, chunk: int) -> dict[int, Columns]:
        """Pieces that are done, of all with so many points in chunks; a damaged one is not."""
        starts = enumerate(range(0, total, chunk))
        found = {number: self._piece(number, min(chunk, total - at)) for number, at in starts}
        return {number: columns for number, columns in found.items() if columns is not None}

    def _piece(self, number: int, count: int) -> Columns | None:
        """A piece with so many points as it was written; None if it is not whole."""
        try:
            known = json.loads(_read(self._part(number)))
            columns = known["columns"]
            if known["sha256"] == _digest(json.dumps(columns)) and len(columns["status"]) == count:
                return {name: np.array(columns[name], dtype=kind_of(name)) for name in columns}
        except (ValueError, TypeError, KeyError, RecursionError):  # SweepErrors among them
            pass
        return None

    def finish(self, table: pd.DataFrame) -> None:
        """Write the whole table; the parts are no longer needed."""
        text = table_text(table)
        _write(self.path / DIGEST, f"{_digest(text)}  {RESULTS}\n")  # first: it says nothing alone
        _write(self.path / RESULTS, text)
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
        if "points_sha256" in known or (self.path / DIGEST).exists():  # earlier ones have none
            digest = _read(self.path / DIGEST).partition(" ")[0]
            if digest != _digest(_read(path)):
                raise _damaged(path, f"it is not as it was written, by its SHA-256 in {DIGEST}")
        table = read_frame(path)
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


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _damaged(path: Path, why: str) -> SweepError:
    return SweepError(f"{path} is damaged: {why}; remove it and run the sweep again")


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Name the file in what goes wrong with it."""
    with named(path, SweepError, "write"):
        yield


def _write(path: Path, text: str) -> None:
    with _writing(path):
        write_text(path, text)


def _read(path: Path) -> str:
    is_folder(path, SweepError)  # refuses what would be waited for without end
    with named(path, SweepError):
        content = path.read_bytes()
    try:
        return decoded(content)
    except ValueError as error:
        raise SweepError(f"{path} is damaged: {error}") from None


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


def read_frame(path: Path) -> pd.DataFrame:
    """A table as :func:`table_text` writes it, exactly, with its units in ``.attrs``.

    Raises
    ------
    SweepError
        If it is none.
    """
    from saleg.simulation.shown_table import Table

    is_folder(path, SweepError)  # refuses what would be waited for without end
    try:
        with named(path, SweepError):
            rows = read_table(path, lambda label: kind_of(_split(label)[0]) is not float)
    except DamagedTable as error:
        raise _damaged(path, str(error)) from None
    units = dict(map(_split, rows.dtype.names or ()))
    if not all(units):
        raise _damaged(path, "a column has no name and unit")
    data = {}
    for field, name in zip(rows.dtype.names or (), units, strict=True):
        data[name] = rows[field] == "True" if kind_of(name) is bool else rows[field]
    return Table.of(data, units)


def table_text(table: pd.DataFrame) -> str:
    """A table as CSV, units in its header, every number exactly."""
    file = io.StringIO()
    write_table(file, labelled(table))
    return file.getvalue()


def _split(label: str) -> tuple[str, str]:
    """Name and unit of a column; no name if there is no unit."""
    name, _, unit = label.rpartition(" [")
    return name, unit.rstrip("]")


def _plain(values: np.ndarray) -> list[Any]:
    """Values as JSON knows them: what is no finite number becomes text."""
    return [
        repr(value) if isinstance(value, float) and not math.isfinite(value) else value
        for value in values.tolist()
    ]
