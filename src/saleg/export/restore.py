"""From what a file holds back to the run that was saved."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from saleg.checks import a, checked
from saleg.engine import Engine
from saleg.engine.toml import read_toml
from saleg.errors import RunFileError, SalegError
from saleg.export.description import (
    FORMAT,
    FORMAT_VERSION,
    PLAIN,
    Description,
    Stored,
    checksum,
    checksum_of_texts,
)
from saleg.export.units import GENERATIONS, LATER_FIELDS, LAYOUTS, UNKNOWN_BEFORE
from saleg.simulation.run import Run
from saleg.status import Status


@checked(description=a(Description))
def from_tables(description: Description, laws: Sequence[type] = ()) -> Run:
    """Make a run from its description; nothing is simulated again.

    Parameters
    ----------
    description : Description
    laws : sequence of Law or Start classes, optional
        Classes of your own that the engine uses.

    Returns
    -------
    Run
        Equal to the one described, its last cycle included.

    Raises
    ------
    WrongArguments
        If it is no description.
    RunFileError
        Saying what is missing or strange.
    """
    tables = description.tables
    texts = description.engine_toml, description.run_json
    return restored(Stored(*texts, lambda table, name: tables[table][name].values), laws)


def restored(stored: Stored, laws: Sequence[type] = ()) -> Run:
    """Make a run from what a file holds; as :func:`from_tables`."""
    facts = _facts(stored)
    engine = _engine(stored.engine_toml, facts["laws_not_of_saleg"], laws)
    rows = {name: _rows(stored, name, count) for name, count in facts["rows"].items()}
    if stored.is_exact:
        for name, held in rows.items():
            if facts["checksums"][name] not in map(checksum, _as_ever(held)):
                raise RunFileError(f"it is damaged: {name} are not what was saved")
    orbit = None
    if facts["orbit"] is not None:
        tables = (rows["orbit_strokes"], rows["orbit_events"], rows.get("orbit"))
        orbit = _run(engine, facts["orbit"], *tables)
    run = _run(engine, facts, rows["strokes"], rows["events"], rows.get("history"))
    if orbit is not None:
        run.replay = lambda: orbit
    return run


def _as_ever(rows: np.ndarray) -> Iterator[np.ndarray]:
    """Records as they are, and as earlier versions had them."""
    yield rows
    for n in range(len(GENERATIONS)):
        yield _without(rows, {name for names in GENERATIONS[n:] for name in names})


def _without(rows: np.ndarray, left_out: set[str]) -> np.ndarray:
    """Records without some fields."""
    names = [name for name in rows.dtype.names or () if name not in left_out]
    kept = np.empty(len(rows), np.dtype([(name, rows.dtype[name]) for name in names]))
    for name in names:
        kept[name] = rows[name]
    return kept


def _run(
    engine: Engine,
    facts: dict[str, Any],
    strokes: np.ndarray,
    events: np.ndarray,
    history: np.ndarray | None,
) -> Run:
    return Run(
        engine=engine,
        status=Status(facts["status"]),
        strokes=strokes,
        event_rows=events,
        history_rows=history,
        **{name: facts[name] for name in PLAIN},
    )


def _facts(stored: Stored) -> dict[str, Any]:
    """The facts of a run, once it is sure that this version understands them."""
    facts = json.loads(stored.run_json)
    if not isinstance(facts, dict) or facts.get("format") != FORMAT:
        raise RunFileError(f"it is not a {FORMAT}")
    if facts.get("version") != FORMAT_VERSION:
        raise RunFileError(
            f"it has version {facts.get('version')} of the format, written by saleg "
            f"{facts.get('saleg')}; this saleg reads version {FORMAT_VERSION}"
        )
    if checksum_of_texts(facts, stored.engine_toml) != facts["checksum_of_texts"]:
        raise RunFileError(
            "its engine or its facts are not what was saved; the results of a changed engine are "
            "those of a new run"
        )
    return facts


def _engine(text: str, needed: Sequence[str], laws: Sequence[type]) -> Engine:
    """Engine from its text; a law of the user's must be handed in, even if saleg has its name."""
    given = {law.__name__ for law in laws}
    missing = [name for name in needed if name not in given]
    if missing:
        raise RunFileError(
            f"its engine uses {', '.join(missing)}, not among the laws of saleg; "
            f"hand in the class: laws=[{', '.join(missing)}]"
        )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "engine.toml"
        path.write_text(text, encoding="utf-8", newline="\n")
        try:
            return read_toml(path, [law for law in laws if law.__name__ in needed])
        except SalegError as error:
            raise RunFileError(str(error).replace(str(path), "its engine")) from None


def _rows(stored: Stored, table: str, count: int) -> np.ndarray:
    """Records of a table, filled column by column."""
    dtype, places = LAYOUTS[table]
    rows = np.zeros(0, dtype)
    for name, place in places.items():
        try:
            values = stored.column(table, name)
        except KeyError:
            if place.field not in LATER_FIELDS:
                raise
            values = np.full(count, np.nan if place.field in UNKNOWN_BEFORE else 0.0)
        if values.shape != (count,):
            raise RunFileError(
                f"{table}.{name} should have {count} rows but has {values.size}: "
                "it was cut short or changed"
            )
        if len(rows) != count:  # not before a column of that length was seen
            rows = np.empty(count, dtype)
        np.copyto(place.of(rows), values, casting="safe")
    return rows
