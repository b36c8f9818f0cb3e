"""Sweeps as TOML files.

::

    [sweep]                 # all of it optional
    machine = "thesis-base" # an engine with a fixed mass; without it, component design
    multipliers = true
    warm = false
    chunk = 32
    rtol = 1e-6

    [fixed]                 # values by name, SI
    equivalence_ratio = 0.5

    [grid]                  # or [list], [latin_hypercube], [sobol]
    bore = { from = 0.05, to = 0.08, count = 31 }
    egr = [0.0, 0.1, 0.2]
    "heat_transfer.a" = [60.0, 70.0]  # a dotted name needs its quotes

The two random sets take ``count``, ``seed`` and a table ``ranges`` of ``name = [low, high]``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design.designs import Design
from saleg.design.subjects import subject_of
from saleg.design.toml_tables import (
    WrongTable,
    base_of,
    fixed_of,
    refuse_dotted,
    refuse_unknown,
    table_of,
    with_fixed,
)
from saleg.engine import Engine
from saleg.engine.toml import parsed
from saleg.errors import SweepError
from saleg.quantities import is_number
from saleg.sweep.points import grid, latin_hypercube, listed, refuse_too_many, sobol

if TYPE_CHECKING:
    import pandas as pd

#: Keys of evenly spaced values.
SPAN = {"from", "to", "count"}
#: Keys of [sweep] with their types.
SETTINGS: dict[str, type] = {
    "multipliers": bool,
    "warm": bool,
    "chunk": int,
    "rtol": float,
}
WANTED = {bool: "true or false", int: "a whole number", float: "a number"}
RANDOM = ("count", "seed", "ranges")


@dataclass(frozen=True, eq=False)
class SweepFile:
    """A sweep as a file has it.

    Attributes
    ----------
    points : DataFrame
    swept : Design or Engine
    settings : dict
        Keywords of :func:`saleg.sweep.run`.
    """

    points: pd.DataFrame
    swept: Design | Engine
    settings: dict[str, Any]


def read(path: str | Path) -> SweepFile:
    """Read a sweep file.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    SweepFile

    Raises
    ------
    EngineFileError
        If it is no TOML file.
    SweepError
        Naming the file and what is wrong in it.
    UnknownPath
        If there is no value of a name.
    PathsClash
        If two names, in ``[fixed]`` or among the inputs, stand for one number.
    """
    tables = parsed(path)
    try:
        refuse_unknown(tables, ["sweep", "fixed", *KINDS])
        settings = table_of(tables, "sweep")
        refuse_unknown(settings, ["machine", *SETTINGS], "sweep.")
        kinds = [kind for kind in KINDS if kind in tables]
        if len(kinds) != 1:
            given = " and ".join(f"[{kind}]" for kind in kinds) or "none"
            wanted = ", ".join(f"[{kind}]" for kind in KINDS)
            raise SweepError(f"needs one of {wanted}, and no more; has {given}")
        points = KINDS[kinds[0]](table_of(tables, kinds[0]))
        fixed = fixed_of(tables)
        both = [name for name in points if name in fixed]
        if both:
            raise SweepError(f"{both[0]} stands in [fixed] and in [{kinds[0]}]: remove one")
        base = base_of(settings)
        subject_of(base).refuse_clash([*fixed, *points])
        return SweepFile(points, with_fixed(base, fixed), _settings(settings))
    except (SweepError, WrongTable) as error:
        raise SweepError(f"{path}: {error}") from None


def _settings(given: Mapping[str, Any]) -> dict[str, Any]:
    found = {}
    for name, kind in SETTINGS.items():
        if name in given:
            if type(given[name]) not in (kind, int if kind is float else kind):
                raise SweepError(f"sweep.{name} = {given[name]!r}: must be {WANTED[kind]}")
            found[name] = given[name]
    return found


def _grid(table: Mapping[str, Any]) -> pd.DataFrame:
    refuse_dotted(table, SPAN)
    return grid({name: _values(name, held) for name, held in table.items()})


def _listed(table: Mapping[str, Any]) -> pd.DataFrame:
    refuse_dotted(table)
    return listed(table)


def _values(name: str, held: Any) -> Any:
    """Values of one input: a list, or from, to and count."""
    if not isinstance(held, dict):
        return held
    ends: list[Any] = [held.get(key) for key in ("from", "to", "count")]
    if set(held) != SPAN or not all(is_number(end) and math.isfinite(end) for end in ends):
        raise SweepError(f"{name} = {held}: needs the finite numbers from, to and count")
    if not isinstance(ends[2], int) or ends[2] < 2:
        raise SweepError(f"{name}: count = {ends[2]}: must be a whole number >= 2")
    refuse_too_many(ends[2])
    return list(np.linspace(*ends))


def _random(
    make: Callable[..., pd.DataFrame],
) -> Callable[[Mapping[str, Any]], pd.DataFrame]:
    def points(table: Mapping[str, Any]) -> pd.DataFrame:
        refuse_unknown(table, RANDOM)
        refuse_dotted(table_of(table, "ranges"))
        return make(table_of(table, "ranges"), table.get("count"), table.get("seed", 0))

    return points


#: Tables that give points, by name.
KINDS: dict[str, Callable[[Mapping[str, Any]], Any]] = {
    "grid": _grid,
    "list": _listed,
    "latin_hypercube": _random(latin_hypercube),
    "sobol": _random(sobol),
}
