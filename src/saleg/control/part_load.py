"""Part load at the best efficiency: for each power the steady state that burns the least fuel."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batch.many import STABILITY_UNITS, steady_states
from saleg.checks import SOME, a, checked
from saleg.control.maps import fuel_map, intake_map
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.errors import InvalidController, UnknownPath, WrongArguments, nearest
from saleg.files.atomic import new_file
from saleg.files.tables import labelled, write_table
from saleg.quantities import Problem, as_float, is_number
from saleg.status import Status

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

#: Margins of operation: how fast a disturbance dies away, and the threshold of the state logic
#: (section 5.1) with some room.
MARGINS: dict[str, tuple[float, float]] = {
    "largest_multiplier": (0.0, 0.9),
    "compression_ratio": (12.2, 25.0),
}
#: Columns of the table that hold no numbers.
WORDS = ("status", "message", "method", "stable", "kind")
#: Powers of a map unless told otherwise; every how many-th value of the maps that end where orbits
#: end stands in its grid.
POWERS, EVERY = 25, 2


@dataclass(frozen=True, eq=False)
class PartLoadMap:
    """Most efficient steady states over power.

    Attributes
    ----------
    paths : tuple of str
        The quantities varied.
    table : DataFrame
        One steady state per power, rising: the quantities under their paths, then status,
        performance, multipliers.
    states : DataFrame
        All steady states it was chosen from, in the same columns, and whether they are within the
        margins (``within``).
    """

    paths: tuple[str, ...]
    table: pd.DataFrame
    states: pd.DataFrame

    def column(self, name: str) -> tuple[float, ...]:
        """A column of the table, in its SI unit, such as ``"power"`` [W]."""
        return tuple(self.table[name].tolist())

    def save(self, path: str | Path, *, overwrite: bool = False) -> None:
        """Save the table as CSV, units in its header.

        Parameters
        ----------
        path : str or Path
        overwrite : bool
            Whether a file that is there is replaced.
        """
        with (
            new_file(Path(path), overwrite) as target,
            target.open("w", encoding="utf-8", newline="") as file,
        ):
            write_table(file, labelled(self.table))


@checked(
    engine=a(Engine),
    values=a(Mapping).optional,
    powers=SOME.optional,
    margins=a(Mapping),
)
def part_load_map(
    engine: Engine,
    values: Mapping[str, Sequence[float]] | None = None,
    *,
    powers: Sequence[float] | None = None,
    margins: Mapping[str, tuple[float, float]] = MARGINS,
    executor: Executor | None = None,
) -> PartLoadMap:
    """Map of the most efficient steady state at each power, within margins.

    Steady states over a grid; along its lines each power is crossed by interpolation, the crossing
    with the best efficiency is solved for itself. So every row of the table is a steady state,
    and where neighbours have left the margins or there is no orbit, the map ends.

    Parameters
    ----------
    engine : Engine
    values : mapping of str to sequence of float, optional
        Values (SI) of each quantity varied, by its path: intake temperature and equivalence ratio
        to where orbits end (:func:`intake_map`, :func:`fuel_map`) unless given. Intake pressure or
        the load constant may be among them.
    powers : sequence of float, optional
        Powers wanted [W]; evenly between the least and the greatest of the grid unless given.
    margins : mapping of str to (float, float)
        Least and greatest value of columns of the table, such as ``largest_multiplier`` [-].
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.

    Returns
    -------
    PartLoadMap

    Raises
    ------
    WrongArguments
        Naming all quantities, values and margins that make no sense.
    InvalidController
        If fewer than two powers can be had within the margins.
    """
    _check(engine, values, margins)
    grid = dict(values) if values is not None else _to_the_ends(engine, executor)
    points = np.array(list(itertools.product(*grid.values())), dtype=float)
    shape = tuple(len(along) for along in grid.values())
    states = _solved(engine, list(grid), points, margins, executor)
    orbits = states[_is_orbit(states)]
    if powers is None and len(orbits):
        powers = np.linspace(orbits.power.min(), orbits.power.max(), POWERS).tolist()
    places = [_best(states, points, shape, margins, float(power)) for power in powers or ()]
    chosen = np.array([place for place in places if place is not None])
    table = states.iloc[:0]
    if len(chosen):
        table = _solved(engine, list(grid), chosen, margins, executor)
        units = table.attrs["units"]
        table = table[table.within].sort_values("power").drop_duplicates("power")
        table = table.drop(columns="within").reset_index(drop=True)
        table.attrs["units"] = units
    if len(table) < 2:
        wrong = f"{len(table)} steady states within the margins"
        raise InvalidController([Problem("values", wrong, "", "a map needs at least two")])
    return PartLoadMap(tuple(grid), table, states)


def _check(engine: Engine, values: Mapping[str, Any] | None, margins: Mapping[str, Any]) -> None:
    """Refuse quantities that are no numbers of the engine, and margins of no column."""
    wrong = []
    if values is not None and not values:
        wrong.append(Problem("values", values, "", "must have at least one quantity"))
    for path, along in (values or {}).items():
        name = f"values[{path!r}]"
        try:
            if not is_number(engine.get(path)):
                wrong.append(Problem(name, along, "", f"'{path}' is no number of this engine"))
        except UnknownPath as error:
            wrong.append(Problem(name, along, "", str(error)))
        if SOME.read(along) is None:
            wrong.append(Problem(name, along, "", SOME.wanted + SOME.told(along)))
    known = [*(name for name in STABILITY_UNITS if name not in WORDS), *(values or {})]
    for column, ends in margins.items():
        name = f"margins[{column!r}]"
        if column not in known:
            text = f"no column '{column}'{nearest(column, known)}"
            wrong.append(Problem(name, ends, "", text))
        try:
            low, high = map(as_float, ends)
        except (TypeError, ValueError):
            low = high = None
        if low is None or high is None or not low <= high:
            wrong.append(Problem(name, ends, "", "must be a least and a greatest value"))
    if wrong:
        raise WrongArguments(wrong, "arguments of part_load_map()")


def _to_the_ends(engine: Engine, executor: Executor | None) -> dict[str, list[float]]:
    """Intake temperatures and equivalence ratios from those of the engine to where orbits end."""
    maps = intake_map(engine, executor=executor), fuel_map(engine, executor=executor)
    return {known.path: known.table[known.path].tolist()[::EVERY] for known in maps}


def _solved(
    engine: Engine,
    paths: list[str],
    points: np.ndarray,
    margins: Mapping[str, tuple[float, float]],
    executor: Executor | None,
) -> pd.DataFrame:
    """Steady states at some points, and whether each is stable and within the margins."""
    engines = [engine.replace(**dict(zip(paths, point, strict=True))) for point in points.tolist()]
    table = steady_states(engines, multipliers=True, executor=executor)
    units = {path: unit_of(engine, path) for path in paths} | table.attrs["units"]
    for n, path in enumerate(paths):
        table.insert(n, path, points[:, n])
    within = _is_orbit(table)
    for name, (least, greatest) in margins.items():
        within &= table[name].between(least, greatest)
    table["within"] = within
    table.attrs["units"] = units | {"within": "-"}
    return table


def _is_orbit(table: pd.DataFrame) -> pd.Series:
    """Which rows are stable steady states that deliver power."""
    steady = table.status == str(Status.STEADY)
    return steady & table.stable.astype(bool) & (table.power > 0.0)


def _best(
    states: pd.DataFrame,
    points: np.ndarray,
    shape: tuple[int, ...],
    margins: Mapping[str, tuple[float, float]],
    power: float,
) -> np.ndarray | None:
    """Point of the best efficiency among those where lines of the grid cross a power.

    Crossings lie between neighbours of which both are orbits; they themselves, not the neighbours,
    have to be within the margins.
    """
    names = ["power", "efficiency", *margins]
    figures = states[names].to_numpy(dtype=float, copy=True)
    figures[~_is_orbit(states).to_numpy()] = np.nan
    columns = np.hstack([figures, points]).reshape(*shape, -1)
    found = []
    for axis in range(len(shape)):
        lines = np.moveaxis(columns, axis, 0)
        before, after = lines[:-1].reshape(-1, lines.shape[-1]), lines[1:]
        after = after.reshape(before.shape)
        steps = after[:, 0] - before[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            u = (power - before[:, 0]) / steps
        crossed = (u >= 0.0) & (u <= 1.0)  # false where either end is no orbit
        some = before[crossed] + u[crossed, None] * (after[crossed] - before[crossed])
        found.append(some)
    crossings = np.vstack(found)
    for n, (least, greatest) in enumerate(margins.values(), start=2):
        crossings = crossings[(crossings[:, n] >= least) & (crossings[:, n] <= greatest)]
    if not len(crossings):
        return None
    best: np.ndarray = crossings[crossings[:, 1].argmax(), len(names) :]
    return best
