"""Changes of an engine and what became of it: one row per value."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from saleg.checks import SERIES, TEXT, Check, a, checked, each
from saleg.design import Design
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.errors import UnknownPath
from saleg.laws import Law
from saleg.quantities import is_number
from saleg.simulation.performance import UNITS as PERFORMANCE_UNITS
from saleg.simulation.run import Run
from saleg.studies.sensitivity.settle import is_stable, settle, without_loop

if TYPE_CHECKING:
    import pandas as pd

#: A dotted path, or a function from a value to the changes ``Engine.replace`` is to make.
Change = str | Callable[[Any], Mapping[str, Any]]
#: Values, or values by the names they are to have in tables and figures.
Values = Iterable[Any] | Mapping[Any, Any]
#: What these and the paths of several numbers must be.
CHANGE = Check(
    lambda value: value if isinstance(value, str) or callable(value) else None,
    "must be a path, or a function from a value to changes",
)
VALUES = Check(
    lambda value: value if isinstance(value, Iterable) and not isinstance(value, bytes) else None,
    "must be values in a list, or by name",
)
PATHS = each(TEXT, "paths")

#: Columns of a study beside those of :class:`saleg.Performance`, with units.
UNITS = {
    "relative": "-",
    "status": "-",
    "stable": "-",
    **PERFORMANCE_UNITS,
    "heat_transfer": "J",
    "heat_transfer_share": "-",
    "friction_share": "-",
    "message": "-",
}


class Case(NamedTuple):
    """One value of a study and the run it gave.

    Attributes
    ----------
    value : object
        The value, or its name if it is not a number.
    relative : float
        The value over that of the engine studied [-]; NaN where there is no such ratio.
    run : Run
    """

    value: Any
    relative: float
    run: Run


@dataclass(frozen=True, eq=False)
class Study:
    """An engine under one kind of change.

    Attributes
    ----------
    engine : Engine or Design
        What was studied, without the change.
    quantity : str
        What was changed: the path, or "value".
    unit : str
        Its unit.
    cases : tuple of Case
        One per value.
    """

    engine: Engine | Design
    quantity: str
    unit: str
    cases: tuple[Case, ...]

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per value, as :func:`vary` gives it."""
        return _table(self.engine, self.quantity, self.unit, map(_row, self.cases))

    @property
    def runs(self) -> dict[Any, Run]:
        """The runs by their values."""
        return {case.value: case.run for case in self.cases}


@checked(engine=a(Engine, Design), change=CHANGE, values=VALUES)
def study(engine: Engine | Design, change: Change, values: Values) -> Study:
    """Settle an engine or a design at every value, and keep the runs to be drawn.

    Parameters
    ----------
    engine : Engine or Design
        Mass and friction of an engine stay as they are; those of a design follow in its loop.
    change : str or callable
        Dotted path of a number or a law; or a function that makes the changes for ``replace`` from
        a value.
    values : iterable or mapping
        The values (SI), or values by name.

    Returns
    -------
    Study
        Runs that ended otherwise than steady are among them, with their status.

    Raises
    ------
    UnknownPath
        With the nearest existing names.

    Examples
    --------
    >>> import saleg
    >>> runs = study(saleg.machines.thesis_base(), "ignition.A", [5e-7, 1e-6]).runs
    >>> [round(1e3 * run.performance.start_of_combustion, 2) for run in runs.values()]
    [1.57, 1.43]
    """
    return Study(engine, *_named(engine, change), tuple(_cases(engine, change, values)))


@checked(engine=a(Engine, Design), change=CHANGE, values=VALUES)
def vary(engine: Engine | Design, change: Change, values: Values) -> pd.DataFrame:
    """Steady results of an engine or a design at every value of one of its numbers or laws.

    Parameters
    ----------
    engine : Engine or Design
        Mass and friction of an engine stay as they are; those of a design follow in its loop.
    change : str or callable
        Dotted path of a number or a law; or a function that makes the changes for ``replace`` from
        a value.
    values : iterable or mapping
        The values (SI), or values by name.

    Returns
    -------
    DataFrame
        One row per value, in SI units (``.attrs["units"]``): the value, the value over that of the
        engine, status and message, whether it is stable, the figures of
        :class:`saleg.Performance`, the heat lost to the walls in a cycle, and the shares of the
        fuel energy that went to the walls and to friction. Figures of a row that is not stable are
        those of its last cycle.

    Raises
    ------
    UnknownPath
        With the nearest existing names.

    Examples
    --------
    >>> import saleg
    >>> table = vary(saleg.machines.thesis_base(), "equivalence_ratio", [0.5, 0.6, 20.0])
    >>> table["status"].tolist()
    ['steady', 'steady', 'invalid']
    >>> table["relative"].round(3).tolist(), table["stroke"].round(3).tolist()
    ([0.833, 1.0, 33.333], [0.179, 0.181, 0.0])
    """
    return _table(engine, *_named(engine, change), map(_row, _cases(engine, change, values)))


@checked(engine=a(Engine, Design), paths=PATHS, factors=SERIES)
def vary_each(
    engine: Engine | Design, paths: Sequence[str], factors: Iterable[float]
) -> pd.DataFrame:
    """Vary several numbers of an engine or a design, one at a time, by the same factors.

    Parameters
    ----------
    engine : Engine or Design
    paths : sequence of str
        Dotted paths.
    factors : iterable of float
        New values over those of the engine [-].

    Returns
    -------
    DataFrame
        The tables of :func:`vary`, one under the other, with a column `parameter` for the path.
    """
    import pandas as pd

    factors = list(factors)
    tables = {
        path: vary(engine, path, [factor * engine.get(path) for factor in factors])
        for path in paths
    }
    units = {"parameter": "-", "value": "", **UNITS}
    joined = pd.concat(tables, names=["parameter"]).reset_index(level=0).reset_index(drop=True)
    joined.attrs.update(units=units, engine=without_loop(engine).to_toml())
    return joined


def _named(engine: Engine | Design, change: Change) -> tuple[str, str]:
    """Quantity that is changed, and its unit."""
    if not isinstance(change, str):
        return "value", "-"
    return change, engine.unit(change) if isinstance(engine, Design) else unit_of(engine, change)


def _cases(engine: Engine | Design, change: Change, values: Values) -> Iterator[Case]:
    """Settle one engine after the other."""
    base = _base(engine, change)
    for name, value in _by_name(values):
        changes = {change: value} if isinstance(change, str) else change(value)
        run = settle(engine.replace(**changes))
        relative = float(value) / base if is_number(value) and base else math.nan
        yield Case(name, relative, run)


def _by_name(values: Values) -> Iterator[tuple[Any, Any]]:
    """Names and values; a law has the name of its class, all else is its own name."""
    if isinstance(values, Mapping):
        yield from values.items()
        return
    for value in values:
        yield (type(value).__name__ if isinstance(value, Law) else value), value


def _base(engine: Engine | Design, change: Change) -> float:
    """The engine's own value; NaN where there is none, or one for each side."""
    try:
        value = engine.get(change) if isinstance(change, str) else math.nan
    except UnknownPath:
        return math.nan
    return float(value) if is_number(value) else math.nan


def _row(case: Case) -> dict[str, Any]:
    """A case as a row of the table."""
    run = case.run
    energy = run.energy
    fuel = energy.fuel if energy is not None and energy.fuel > 0.0 else math.nan
    lost, rubbed = (energy.heat_transfer, energy.friction) if energy else (math.nan, math.nan)
    return {
        "value": case.value,
        "relative": case.relative,
        "status": str(run.status),
        "stable": is_stable(run),
        **run.performance.to_dict(),
        "heat_transfer": lost,
        "heat_transfer_share": lost / fuel,
        "friction_share": rubbed / fuel,
        "message": run.message,
    }


def _table(
    engine: Engine | Design, quantity: str, unit: str, rows: Iterable[Mapping[str, Any]]
) -> pd.DataFrame:
    import pandas as pd

    table = pd.DataFrame(list(rows), columns=["value", *UNITS])
    text = without_loop(engine).to_toml()
    table.attrs.update(units={"value": unit, **UNITS}, quantity=quantity, engine=text)
    return table
