"""A run as tables of columns and two texts: what every format writes and reads."""

from __future__ import annotations

import dataclasses
import json
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from saleg.checks import a, checked
from saleg.engine import Engine
from saleg.engine.start import Start
from saleg.engine.toml import laws_by_slot
from saleg.errors import RunFileError
from saleg.export.units import CODES, LAYOUTS
from saleg.laws.base import Law
from saleg.simulation.performance import UNITS as PERFORMANCE_UNITS
from saleg.simulation.run import Run
from saleg.simulation.tables import CYCLE_UNITS
from saleg.version import __version__

#: What the texts of a file say it is; the version grows when what is written changes its meaning.
FORMAT, FORMAT_VERSION = "saleg run", 1
#: Attributes of a run that are written as they are.
PLAIN = ("message", "duration", "evaluations", "steps", "settings")


class Column(NamedTuple):
    """One column of a table.

    Attributes
    ----------
    values : ndarray, one-dimensional
        Often a view into the records of the run.
    unit : str
        SI unit, ``"-"`` for a pure number, empty for counts and codes.
    words : tuple of str
        What the whole numbers of a column of codes stand for.
    """

    values: np.ndarray
    unit: str
    words: tuple[str, ...] = ()


Table = dict[str, Column]


@dataclass(frozen=True)
class Description:
    """A run, ready to be written in any format.

    Attributes
    ----------
    engine_toml : str
        The engine, as :meth:`Engine.to_toml` writes it.
    run_json : str
        Everything else that is no table: status, message, settings, versions, numbers of rows.
    tables : dict of str to Table
        ``performance`` and ``cycles`` for the reader; the tables of
        :data:`saleg.export.units.LAYOUTS` are those the run is made from again.
    """

    engine_toml: str
    run_json: str
    tables: dict[str, Table]

    @property
    def texts(self) -> dict[str, str]:
        """Texts of the engine and of the run, by the names of their files."""
        return {"engine_toml": self.engine_toml, "run_json": self.run_json}


class Stored(NamedTuple):
    """A run as a file holds it.

    Attributes
    ----------
    engine_toml, run_json : str
        As in a :class:`Description`.
    column : callable
        Reads a column, given the names of its table and of itself; KeyError if there is none.
    is_exact : bool
        Whether the numbers are there bit by bit, so that their checksums must agree; that of the
        texts always must.
    """

    engine_toml: str
    run_json: str
    column: Callable[[str, str], np.ndarray]
    is_exact: bool = True


@checked(run=a(Run))
def as_tables(run: Run) -> Description:
    """Describe a run as tables of columns and two texts.

    Parameters
    ----------
    run : Run

    Returns
    -------
    Description
        Its long columns are views: nothing of a history is copied.

    Raises
    ------
    RunFileError
        If the run's settings could not be read back.

    Examples
    --------
    >>> import saleg
    >>> run = saleg.simulate(saleg.machines.thesis_base(), 0.1)
    >>> as_tables(run).tables["cycles"]["stroke"].unit
    'm'
    """
    tables = {"performance": _performance(run), "cycles": _cycles(run)}
    records = _records(run)
    tables |= {name: _columns(name, rows) for name, rows in records.items()}
    facts = {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "saleg": __version__,
        "laws_not_of_saleg": sorted(law.__name__ for law in own_laws(run.engine)),
        **_facts(run),
        "orbit": None if run.orbit is None else _facts(run.orbit),
        "rows": {name: len(rows) for name, rows in records.items()},
        "checksums": {name: checksum(rows) for name, rows in records.items()},
    }
    engine = run.engine.to_toml()
    return Description(engine, _json(facts, engine), tables)


def own_laws(engine: Engine) -> set[type]:
    """Classes of an engine's laws and start that are not among those of saleg."""
    known = {law for laws in laws_by_slot().values() for law in laws.values()}
    return {type(law) for law in _laws(engine)} - known


def _laws(node: Any) -> Iterator[Law | Start]:
    for item in dataclasses.fields(node):
        value = getattr(node, item.name)
        if isinstance(value, (Law, Start)):
            yield value
        elif dataclasses.is_dataclass(value):
            yield from _laws(value)


def _facts(run: Run) -> dict[str, Any]:
    return {"status": run.status.value, **{name: getattr(run, name) for name in PLAIN}}


def checksum(rows: np.ndarray) -> int:
    """CRC-32 of records, read where they are."""
    return zlib.crc32(np.ascontiguousarray(rows).view(np.uint8).data)


def checksum_of_texts(facts: dict[str, Any], engine: str) -> int:
    """CRC-32 of the facts without the sum itself, and of the engine."""
    rest = {name: fact for name, fact in facts.items() if name != "checksum_of_texts"}
    return zlib.crc32((json.dumps(rest) + engine).encode())


def _json(facts: dict[str, Any], engine: str) -> str:
    """JSON text, which has to give back what went in."""
    try:
        plain = json.loads(json.dumps(facts, default=_plain_number))
    except TypeError as error:
        raise RunFileError(f"the settings of the run cannot be written: {error}") from None
    if plain != facts:
        raise RunFileError(
            f"the settings of the run could not be read back: {facts['settings']!r}; "
            "use numbers, text, lists and dictionaries with text as keys"
        )
    plain["checksum_of_texts"] = checksum_of_texts(plain, engine)
    return json.dumps(plain, indent=1)


def _plain_number(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} is neither number nor text")


def _performance(run: Run) -> Table:
    figures = run.performance.to_dict()
    return {name: Column(np.array([figures[name]]), PERFORMANCE_UNITS[name]) for name in figures}


def _cycles(run: Run) -> Table:
    frame = run.cycles
    table = {"cycle": Column(np.arange(len(frame)), "")}
    return table | {
        str(name): Column(frame[name].to_numpy(), CYCLE_UNITS[str(name)]) for name in frame.columns
    }


def _records(run: Run) -> dict[str, np.ndarray]:
    """Records of a run and its last cycle, by the name of their table."""
    found = {"strokes": run.strokes, "events": run.event_rows, "history": run.history_rows}
    if run.orbit is not None:
        found["orbit_strokes"] = run.orbit.strokes
        found["orbit_events"] = run.orbit.event_rows
        found["orbit"] = run.orbit.history_rows
    return {name: rows for name, rows in found.items() if rows is not None}


def _columns(table: str, rows: np.ndarray) -> Table:
    """Columns of records, as views."""
    return {
        name: Column(place.of(rows), place.unit, CODES.get(name, ()))
        for name, place in LAYOUTS[table].places.items()
    }
