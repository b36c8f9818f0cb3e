"""The folder of an optimisation: every design that was evaluated, whatever happens next.

``optimisation.json`` says what is optimised and how. ``designs.csv`` only grows, by a generation at
a time; ``progress.json`` says how far it is whole, with the SHA-256 of that; what comes after it is
dropped when the work goes on. The state of a search is not kept: it is got back by telling the
search again what it asked for, which takes milliseconds and is the same to the last bit for every
method.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.batch.table import TEXT
from saleg.errors import SalegError
from saleg.files.atomic import write_text
from saleg.files.lock import locked
from saleg.files.reading import as_path, is_folder, named, read_text
from saleg.files.tables import DamagedTable, labelled, read_table, write_table
from saleg.quantities import is_whole
from saleg.version import __version__

if TYPE_CHECKING:
    import pandas as pd

DESCRIPTION, DESIGNS, PROGRESS, LOCK = (
    "optimisation.json",
    "designs.csv",
    "progress.json",
    ".lock",
)
#: Grows when what is kept in a folder changes its meaning.
FORMAT = 1
#: Columns of truth values, and of whole numbers.
TRUTHS, WHOLE = ("stable", "verified", "copied"), ("generation",)


class OptimisationError(SalegError, ValueError):
    """An optimisation that does not belong to its folder, or a folder that is damaged."""


class Log:
    """The folder of one optimisation.

    Parameters
    ----------
    path : str or Path
        Made if there is none.
    """

    def __init__(self, path: str | Path):
        self.path = as_path(path, OptimisationError, "folder")
        self._bytes = 0
        self._designs = 0
        self._digest = hashlib.sha256()

    @contextmanager
    def opened(self, identity: Mapping[str, Any]) -> Iterator[pd.DataFrame | None]:
        """Make the folder this optimisation's, and keep other processes out meanwhile.

        Parameters
        ----------
        identity : mapping
            All that decides about the course, as plain data.

        Yields
        ------
        DataFrame or None
            Designs of the generations that are whole.

        Raises
        ------
        OptimisationError
            If the folder is that of another optimisation, or of something else.
        """
        wanted = json.loads(json.dumps({"format": FORMAT, **identity}))
        with named(self.path, OptimisationError, "write"):
            if is_folder(self.path, OptimisationError):
                self._refuse_strangers()
            elif self.path.exists():
                raise OptimisationError(f"{self.path} is a file; name a folder")
            self.path.mkdir(parents=True, exist_ok=True)
        with locked(self.path / LOCK):
            if (self.path / DESCRIPTION).exists():
                known = self._json(DESCRIPTION)
                other = [key for key in wanted if known.get(key) != wanted[key]]
                if other:
                    raise OptimisationError(
                        f"{self.path} holds another optimisation (other {', '.join(other)}); name "
                        "another folder"
                    )
            else:
                text = json.dumps({"version": __version__, **wanted}, indent=1) + "\n"
                self._write(DESCRIPTION, text)
            yield self._whole()

    def append(self, table: pd.DataFrame) -> None:
        """Add the designs of a generation."""
        file = io.StringIO()
        write_table(file, labelled(table))
        lines = file.getvalue()
        if self._bytes:
            lines = lines[lines.index("\n") + 1 :]
        with (
            named(self.path / DESIGNS, OptimisationError, "write"),
            open(self.path / DESIGNS, "ab") as log,
        ):
            log.write(lines.encode())
            log.flush()
            os.fsync(log.fileno())
        self._bytes += len(lines.encode())
        self._designs += len(table)
        self._digest.update(lines.encode())
        held = {"bytes": self._bytes, "designs": self._designs, "sha256": self._digest.hexdigest()}
        self._write(PROGRESS, json.dumps(held) + "\n")

    def _whole(self) -> pd.DataFrame | None:
        """Designs of the generations that are whole; what comes after them is dropped."""
        path, written = self.path / DESIGNS, None
        if (self.path / PROGRESS).exists():
            known = self._json(PROGRESS)
            written = known.get("sha256")  # which earlier folders lack
            self._bytes, self._designs = (known.get(name, -1) for name in ("bytes", "designs"))
            if not (is_whole(self._bytes, 0) and is_whole(self._designs, 0)):
                raise _damaged(self.path / PROGRESS, "it lacks its numbers of bytes and designs")
        with named(path, OptimisationError, "write"), open(path, "a+b") as log:
            log.seek(0)
            content = log.read()
            if len(content) < self._bytes:
                raise _damaged(path, f"it has {len(content)} bytes in place of {self._bytes}")
            self._digest.update(content[: self._bytes])
            if written not in (None, self._digest.hexdigest()):  # before anything is dropped
                raise _damaged(path, f"it is not as it was written, by its SHA-256 in {PROGRESS}")
            log.truncate(self._bytes)
        if not self._bytes:
            return None
        table = _read(path)
        if len(table) != self._designs:
            raise _damaged(path, f"it has {len(table)} rows in place of {self._designs}")
        return table

    def _refuse_strangers(self) -> None:
        """A folder without a description may hold what an interrupted start left, nothing else."""
        if (self.path / DESCRIPTION).exists():
            return
        for entry in self.path.iterdir():
            if entry.name != LOCK and not entry.name.startswith(f".{DESCRIPTION}"):
                raise OptimisationError(
                    f"{self.path} is no folder of an optimisation: it holds {entry.name}; name "
                    "another folder"
                )

    def _json(self, name: str) -> dict[str, Any]:
        try:
            held = json.loads(read_text(self.path / name, OptimisationError))
        except (ValueError, RecursionError) as error:
            raise _damaged(self.path / name, str(error)) from None
        if not isinstance(held, dict):
            raise _damaged(self.path / name, "it holds no table")
        return held

    def _write(self, name: str, text: str) -> None:
        with named(self.path / name, OptimisationError, "write"):
            write_text(self.path / name, text)


def _read(path: Path) -> pd.DataFrame:
    """Designs of a log, exactly, with their units."""
    import pandas as pd

    try:
        rows = read_table(path, lambda label: _name(label) in (*TEXT, *TRUTHS))
    except DamagedTable as error:
        raise _damaged(path, str(error)) from None
    columns = {_name(label): rows[label] for label in rows.dtype.names or ()}
    for name in TRUTHS:
        columns[name] = columns[name] == "True"
    for name in WHOLE:
        columns[name] = columns[name].astype(int)
    return pd.DataFrame(columns)


def _name(label: str) -> str:
    return label.rpartition(" [")[0]


def _damaged(path: Path, why: str) -> OptimisationError:
    return OptimisationError(
        f"{path} is damaged: {why}; remove its folder and optimise again, or name another one"
    )
