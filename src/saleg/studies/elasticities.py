"""Elasticities: by how many percent a figure of the steady state changes with one of an input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batch.many import steady_states
from saleg.checks import TEXT, a, checked, each, number
from saleg.engine import Engine, check_engine
from saleg.engine.paths import MAIN_INPUTS
from saleg.errors import UnknownPath
from saleg.quantities import as_float
from saleg.steady.solver import DEFAULT_TOLERANCE

if TYPE_CHECKING:
    import pandas as pd

#: Figures whose change is told unless others are given.
MAIN_FIGURES = (
    "power",
    "efficiency",
    "stroke",
    "compression_ratio",
    "frequency",
    "peak_pressure",
)


@checked(
    engine=a(Engine),
    inputs=each(TEXT, "paths"),
    figures=each(TEXT, "names of figures"),
    change=number(low=1e-6, high=0.2),
    rtol=number(low=1e-13, high=1e-3),
)
def elasticities(
    engine: Engine,
    inputs: Sequence[str] = MAIN_INPUTS,
    figures: Sequence[str] = MAIN_FIGURES,
    *,
    change: float = 0.01,
    rtol: float = DEFAULT_TOLERANCE,
) -> pd.DataFrame:
    """Elasticities of the steady state: relative change of a figure over that of an input.

    Each input is made a little larger and a little smaller, and the steady state solved for; the
    central difference is ``d ln(figure) / d ln(input)``. Of chambers that are not alike both
    change by the same factor.

    Parameters
    ----------
    engine : Engine
    inputs : sequence of str
        Paths of numbers. Those that are 0 are left out, and of the usual ones those that the engine
        does not have.
    figures : sequence of str
        Names of :class:`saleg.Performance`.
    change : float
        Relative change of the input to either side [-].
    rtol : float
        Tolerance of the steady states [-].

    Returns
    -------
    DataFrame
        A row per input, a column per figure [-]; NaN where a steady state is missing or the figure
        is not defined. What :func:`saleg.steady_states` leaves out, the adverse work, is no
        column.

    Raises
    ------
    InvalidEngine
        Naming every wrong field of the engine.
    UnknownPath
        Naming every input asked for that the engine does not have.

    Examples
    --------
    >>> import saleg
    >>> table = elasticities(saleg.machines.thesis_base(), ["moving_mass"], ["frequency"])
    >>> round(float(table.loc["moving_mass", "frequency"]), 1)  # a spring and a mass have -0.5
    -0.4
    """
    import pandas as pd

    check_engine(engine)
    if tuple(inputs) != MAIN_INPUTS:
        _refuse_unknown(engine, inputs)
    changed = {path: pair for path in inputs if (pair := _pair(engine, path, change)) is not None}
    engines = [engine, *(one for pair in changed.values() for one in pair)]
    solved = steady_states(engines, rtol=rtol)
    names = [name for name in figures if name in solved]
    values = solved[names].to_numpy(dtype=float, copy=True)
    values[~solved["status"].isin(("steady", "idling")).to_numpy()] = np.nan
    with np.errstate(all="ignore"):
        rows = (values[1::2] - values[2::2]) / (2.0 * change * values[0])
    rows[~np.isfinite(rows)] = np.nan
    table = pd.DataFrame(rows, index=pd.Index(list(changed), name="input"), columns=names)
    table.attrs["units"] = dict.fromkeys(names, "-")
    return table


def _refuse_unknown(engine: Engine, inputs: Sequence[str]) -> None:
    """Raise one error naming every path that leads nowhere, on no side."""
    wrong = []
    for path in inputs:
        try:
            engine.get(path)
        except UnknownPath as error:
            if not dict(_numbers(engine, path)):
                wrong.append(str(error))
    if wrong:
        raise UnknownPath("\n".join(wrong))


def _pair(engine: Engine, path: str, change: float) -> tuple[Engine, Engine] | None:
    """The engine with more and with less of an input; None where it has none of it."""
    places = dict(_numbers(engine, path))
    if not any(places.values()):
        return None
    more, less = (
        engine.replace(**{place: factor * value for place, value in places.items()})
        for factor in (1.0 + change, 1.0 - change)
    )
    return more, less


def _numbers(engine: Engine, path: str) -> Iterator[tuple[str, float]]:
    """Number at a path, or at that path of either side where they differ."""
    for places in ((path,), (f"left.{path}", f"right.{path}")):
        found: Mapping[str, Any] = dict(_known(engine, places))
        if found:
            yield from found.items()
            return


def _known(engine: Engine, places: Sequence[str]) -> Iterator[tuple[str, float]]:
    for place in places:
        try:
            value = as_float(engine.get(place))
        except UnknownPath:
            continue
        if value is not None:
            yield place, value
