"""Measured traces of a cycle: time with position and pressures."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

import numpy as np

from saleg.errors import SalegError
from saleg.files.reading import as_path, read_text
from saleg.files.units import UnitError, head_of, to_si
from saleg.quantities import as_float

#: What a trace may hold, with its SI unit; columns of the history of a run.
CHANNELS = {"x": "m", "p_left": "Pa", "p_right": "Pa"}
#: What they are called.
WORDS = {"x": "position", "p_left": "pressure left", "p_right": "pressure right"}
#: How heads of columns may call them.
NAMES = {
    "t": ("t", "time"),
    "x": ("x", "position"),
    "p_left": ("p left", "pressure left", "left pressure", "p", "pressure"),
    "p_right": ("p right", "pressure right", "right pressure"),
}
#: Standard deviation of a channel over the range of its values, where it is not said.
USUAL_NOISE = 0.01
FEWEST = 8


class TraceError(SalegError, ValueError):
    """A trace that is none."""


@dataclass(frozen=True, eq=False)
class Trace:
    """A measured trace, at best of one whole cycle; its time may begin anywhere.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Time [s], rising.
    x : ndarray, shape (n,), optional
        Position of the translator from its midpoint, positive to the right [m].
    p_left, p_right : ndarray, shape (n,), optional
        Pressures [Pa].
    noise : mapping of str to float
        Standard deviation of a channel in its SI unit; a hundredth of its range where it is not
        said.
    name : str

    Raises
    ------
    TraceError
        Naming what is wrong.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0.0, 0.02, 50)
    >>> trace = Trace(t, x=0.09 * np.cos(314.0 * t), noise={"x": 1e-4})
    >>> trace.channels, trace.sigma("x")
    (['x'], 0.0001)
    """

    t: np.ndarray
    x: np.ndarray | None = None
    p_left: np.ndarray | None = None
    p_right: np.ndarray | None = None
    noise: Mapping[str, float] = field(default_factory=dict)
    name: str = "measured"

    def __post_init__(self) -> None:
        """Take numbers as arrays of floats; refuse what is no trace."""
        for name in ("t", *CHANNELS):
            values = getattr(self, name)
            if values is not None:
                object.__setattr__(self, name, _array(name, values))
        for name in self.channels:
            if self[name].shape != self.t.shape:
                raise TraceError(f"{name}: {len(self[name])} values for {len(self.t)} of t")
        for name in ("p_left", "p_right"):
            if name in self.channels and not np.median(self[name]) > 0.0:  # noise may go below
                raise TraceError(f"{name}: pressures must be absolute, > 0 Pa but for noise")
        if not self.channels:
            raise TraceError(f"a trace needs one of {', '.join(CHANNELS)}")
        if len(self.t) < FEWEST:
            raise TraceError(f"a trace needs at least {FEWEST} instants, not {len(self.t)}")
        if not (np.diff(self.t) > 0.0).all():
            raise TraceError("t: every time must be later than the one before")
        for name, value in self.noise.items():
            if name not in CHANNELS or not (as_float(value) or 0.0) > 0.0:
                raise TraceError(f"noise of {name!r} = {value!r}: must be > 0, of a channel")

    @property
    def channels(self) -> list[str]:
        """Names of what was measured, of "x", "p_left" and "p_right"."""
        return [name for name in CHANNELS if getattr(self, name) is not None]

    def __getitem__(self, channel: str) -> np.ndarray:
        """Values of a channel (SI)."""
        values: np.ndarray = getattr(self, channel)
        return values

    def sigma(self, channel: str) -> float:
        """Standard deviation of a channel, in its SI unit."""
        usual = USUAL_NOISE * float(np.ptp(self[channel])) or 1.0
        return float(self.noise.get(channel, usual))

    @classmethod
    def read(cls, path: str | PathLike[str], noise: Mapping[str, float] | None = None) -> Trace:
        """Read a trace from a CSV file whose header names columns and units.

        Columns are ``time``, ``position`` and ``pressure left``, ``pressure right`` (or ``t``,
        ``x``, ``p``), each with its unit in brackets, such as ``pressure left [bar]``; others are
        left out. With semicolons between columns, decimals may have a comma.

        Parameters
        ----------
        path : path-like
        noise : mapping of str to float, optional
            As for the trace itself, in SI units.

        Returns
        -------
        Trace

        Raises
        ------
        TraceError
            Naming the file, and the line or column that is wrong.
        """
        path = as_path(path, TraceError)
        text = read_text(path, TraceError)
        try:
            columns = _columns(text)
            return cls(**columns, noise=noise or {}, name=path.stem)
        except (TraceError, UnitError) as error:
            raise TraceError(f"{path}: {error}") from None

    def __repr__(self) -> str:
        return f"<Trace {self.name!r}: {len(self.t)} instants of {', '.join(self.channels)}>"


def _array(name: str, values: Any) -> np.ndarray:
    try:
        found = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise TraceError(f"{name}: must be numbers") from None
    if found.ndim != 1 or not np.isfinite(found).all():
        raise TraceError(f"{name}: must be finite numbers in one dimension")
    found.setflags(write=False)
    return found


def _columns(text: str) -> dict[str, np.ndarray]:
    """Columns of a file by the names of a trace, in SI."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if not lines:
        raise TraceError("is empty")
    mark = ";" if ";" in lines[0] else ","
    head, *rows = csv.reader(lines, delimiter=mark)
    found: dict[str, np.ndarray] = {}
    for place, cell in enumerate(head):
        name, unit = _head(cell)
        if name is None:
            continue
        if name in found:
            raise TraceError(f"column {cell.strip()!r}: there is another for the same")
        if not unit:
            raise TraceError(f"column {cell.strip()!r}: needs its unit, as in 'time [ms]'")
        factor, offset = to_si(unit, {"t": "s", **CHANNELS}[name])
        values = [_number(row, place, line, mark) for line, row in enumerate(rows, 2)]
        found[name] = factor * np.array(values) + offset
    if "t" not in found:
        raise TraceError(f"no column of time; there are {', '.join(cell.strip() for cell in head)}")
    return found


def _head(cell: str) -> tuple[str | None, str]:
    """Name in a trace and unit of a column; no name for others."""
    words, unit = head_of(cell)
    words = re.sub(r"[\s_]+", " ", words).strip().lower()
    name = next((name for name, known in NAMES.items() if words in known), None)
    return name, unit


def _number(row: list[str], place: int, line: int, mark: str) -> float:
    cell = row[place].strip() if place < len(row) else ""
    try:
        return float(cell.replace(",", ".") if mark == ";" else cell)
    except ValueError:
        raise TraceError(f"line {line}, column {place + 1}: {cell!r} is no number") from None
