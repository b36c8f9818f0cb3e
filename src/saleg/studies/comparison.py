"""Results side by side: their figures, what differs in their engines, and by how much."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.checks import Check, a, checked, each
from saleg.design.results import COMPONENT_UNITS, DesignedState
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.quantities import is_number
from saleg.simulation.performance import UNITS
from saleg.simulation.run import Run
from saleg.steady.state import SteadyState

if TYPE_CHECKING:
    import pandas as pd


def _read_results(given: Any) -> list[tuple[str, Run | SteadyState]] | None:
    """Names and results of a list or mapping; None if there are fewer than two or others."""
    names = list(given) if isinstance(given, Mapping) else None
    found = _EACH.read(list(given.values()) if isinstance(given, Mapping) else given)
    if found is None or len(found) < 2:
        return None
    return list(zip(names or [""] * len(found), found, strict=True))


_EACH = each(a(Run, SteadyState), "runs or steady states")
RESULTS = Check(
    _read_results,
    "must be two or more runs or steady states in a list or mapping; simulate an engine first, or "
    "solve for its steady state",
)


@checked(results=RESULTS)
def compare(results: Sequence[Run | SteadyState] | Mapping[str, Run | SteadyState]) -> pd.DataFrame:
    """Compare two or more runs, steady states or designs with the first of them.

    Parameters
    ----------
    results : sequence or mapping of str to Run or SteadyState
        By their names; engines' names, numbered where they are the same, unless given. A result
        that did not end well has its status behind its name.

    Returns
    -------
    DataFrame
        A column per result (SI), then for every one after the first its difference, ``"b - a"``,
        and relative difference, ``"b / a - 1"``. First rows: numbers of the engines that differ,
        by path (NaN where an engine has none); then the figures of :class:`saleg.Performance`, and
        of designs what the components add. Units of the rows in ``.attrs["units"]``.

    Raises
    ------
    WrongArguments
        If there are fewer than two results, or others.

    Examples
    --------
    >>> import saleg
    >>> base = saleg.machines.thesis_base()
    >>> runs = {f"{bore:g}": saleg.steady_state(base.replace(bore=bore)) for bore in (0.064, 0.06)}
    >>> table = saleg.compare(runs)
    >>> list(table.columns), float(table.loc["bore", "0.06 - 0.064"].round(6))
    (['0.064', '0.06', '0.06 - 0.064', '0.06 / 0.064 - 1'], -0.004)
    """
    from saleg.simulation.shown_table import Table

    named = _named(results)  # type: ignore[arg-type]  # pairs, as checked
    inputs, units = _inputs([result.engine for result in named.values()])
    figures = [_figures(result) for result in named.values()]
    known = {name for found in figures for name in found}
    units |= {name: unit for name, unit in {**UNITS, **COMPONENT_UNITS}.items() if name in known}
    columns = {
        name: np.array([{**given, **found}.get(row, math.nan) for row in units], dtype=float)
        for name, given, found in zip(named, inputs, figures, strict=True)
    }
    first, *others = list(columns)
    for name in others:
        columns[f"{name} - {first}"] = columns[name] - columns[first]
        with np.errstate(divide="ignore", invalid="ignore"):
            relative = columns[name] / columns[first] - 1.0
        columns[f"{name} / {first} - 1"] = np.where(columns[first] == 0.0, math.nan, relative)
    table = Table.of(columns, units, index=list(units))
    table.attrs["relative"] = [f"{name} / {first} - 1" for name in others]
    return table


def _named(pairs: Sequence[tuple[str, Run | SteadyState]]) -> dict[str, Run | SteadyState]:
    """Results by unique names."""
    named: dict[str, Run | SteadyState] = {}
    for name, result in pairs:
        text = str(name or result.engine.name)
        if not result.status.ended_well:
            text += f" ({result.status})"
        number = 1 + sum(known.partition(" #")[0] == text for known in named)
        named[text if number == 1 else f"{text} #{number}"] = result
    return named


def _figures(result: Run | SteadyState) -> dict[str, float]:
    """Figures of a result, and of a design what its components add."""
    added = result.component_figures if isinstance(result, DesignedState) else {}
    return {**result.performance.to_dict(), **added}


def _inputs(engines: Sequence[Engine]) -> tuple[list[dict[str, float]], dict[str, str]]:
    """Numbers of some engines that differ, by path, and their units."""
    mirrored = all(engine.is_mirrored for engine in engines)
    found = [dict(_numbers(engine, mirrored)) for engine in engines]
    paths = dict.fromkeys(path for numbers in found for path in numbers)
    differ = [path for path in paths if len({numbers.get(path) for numbers in found}) > 1]
    units = {}
    for path in differ:
        owner = next(engine for engine, has in zip(engines, found, strict=True) if path in has)
        units[path] = unit_of(owner, path)
    return [{path: has[path] for path in differ if path in has} for has in found], units


def _numbers(engine: Engine, mirrored: bool) -> Iterator[tuple[str, float]]:
    """Every number of an engine by its path, that of both sides once if they are alike."""
    for item in dataclasses.fields(engine):
        part, prefix = getattr(engine, item.name), f"{item.name}."
        if mirrored and item.name in ("left", "right"):
            prefix = ""
        if not (mirrored and item.name == "right") and dataclasses.is_dataclass(part):
            yield from _below(part, prefix)


def _below(node: Any, prefix: str) -> Iterator[tuple[str, float]]:
    for item in dataclasses.fields(node):
        value = getattr(node, item.name)
        if dataclasses.is_dataclass(value):
            yield from _below(value, f"{prefix}{item.name}.")
        elif is_number(value):
            yield f"{prefix}{item.name}", float(value)
