"""Published machines beside ours, and what their sources leave open that would explain the rest."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from saleg.checks import a, checked
from saleg.engine import Engine
from saleg.errors import InvalidEngine
from saleg.machines import OpenQuantity, Published, PublishedMachine
from saleg.steady.solver import DEFAULT_TOLERANCE, found_steady_state

#: Points of the range of an open quantity at which engines are solved, beside the one assumed:
#: shares of the way from there to either end.
SHARES = (0.5, 1.0)
#: By how much another result may become worse where a quantity is said to explain one [-].
WORSE = 0.02


class Compared(NamedTuple):
    """A published result beside ours.

    Attributes
    ----------
    result : Published
    ours : float
        Our value [in the SI unit of the figure]; NaN where the engine does not run steadily.
    deviation : float
        Over the published value [-].
    """

    result: Published
    ours: float
    deviation: float


class Cause(NamedTuple):
    """Value of an open quantity that brings a result nearest to what is published.

    Attributes
    ----------
    path : str
        The quantity.
    value : float
        Its value there [in the unit of the field].
    deviation : float
        Deviation of the result there [-].
    worst : str
        Label of the other result that becomes worse by most; empty where none becomes worse by
        more than two percent.
    worst_deviation : float
        Its deviation there [-].
    """

    path: str
    value: float
    deviation: float
    worst: str
    worst_deviation: float

    @property
    def explains(self) -> bool:
        """Whether the quantity alone explains the result: met within 2 %, and nothing worse."""
        return abs(self.deviation) <= WORSE and not self.worst


class Explanation(NamedTuple):
    """What open quantities do to a result, one at a time, all else as assumed.

    Attributes
    ----------
    result : Published
    least, greatest : float
        Ends of our value over all ranges [in the SI unit of the figure].
    explaining : tuple of Cause
        Quantities that alone explain the result.
    nearest : Cause or None
        The one that brings it nearest; None where no quantity brings it nearer.
    """

    result: Published
    least: float
    greatest: float
    explaining: tuple[Cause, ...]
    nearest: Cause | None


class _Solved:
    """Results of a machine with some of its numbers changed; each engine is solved once."""

    def __init__(self, machine: PublishedMachine) -> None:
        self.machine = machine
        self._figures = cache(self._solve)

    def deviation(self, result: Published, changes: Mapping[str, float]) -> float:
        """Deviation of a result [-]; NaN without a steady state."""
        return result.deviation(self.value(result, changes))

    def value(self, result: Published, changes: Mapping[str, float]) -> float:
        """Our value of a result [in the SI unit of its figure]."""
        value = self._figure(result.figure, {**changes, **result.at})
        if result.over is None:
            return value
        return value / self._figure(result.figure, {**changes, **result.over})

    def _figure(self, name: str, changes: Mapping[str, float]) -> float:
        return self._figures(tuple(sorted(changes.items()))).get(name, math.nan)

    def _solve(self, changes: tuple[tuple[str, float], ...]) -> dict[str, float]:
        engine = self.machine.engine().replace(**dict(changes))
        if changes and self.machine.held:
            held = _held(engine, self.machine.held)
            return {} if held is None else _figures(held)
        return _figures(engine)


def _figures(engine: Engine) -> dict[str, float]:
    """Figures of the steady state of an engine; none without one."""
    found = found_steady_state(engine, DEFAULT_TOLERANCE)
    return found.quick_performance.to_dict() if found.found else {}


def _held(engine: Engine, held: Sequence[Published]) -> Engine | None:
    """Engine with what its source left open set anew, so that all held results are met."""
    from scipy.optimize import root

    def with_factors(logarithms: np.ndarray) -> Engine:
        factors = zip(held, np.exp(logarithms), strict=True)
        return engine.replace(
            **{one.held_by: float(engine.get(one.held_by) * factor) for one, factor in factors}
        )

    def miss(logarithms: np.ndarray) -> list[float]:
        figures = _figures(with_factors(logarithms))
        return [one.deviation(figures.get(one.figure, math.inf)) for one in held]

    with np.errstate(all="ignore"):
        try:
            solved = root(miss, np.zeros(len(held)), options={"eps": 1e-6, "maxfev": 40})
        except InvalidEngine:  # on its way the search left what an engine can be
            return None
    return with_factors(solved.x) if np.abs(solved.fun).max() < 1e-3 else None


@checked(machine=a(PublishedMachine))
def compare_published(machine: PublishedMachine) -> list[Compared]:
    """Published results of a machine beside ours.

    Parameters
    ----------
    machine : saleg.machines.PublishedMachine

    Returns
    -------
    list of Compared
        In the order in which they are published.

    Examples
    --------
    >>> import saleg
    >>> rows = compare_published(saleg.machines.PUBLISHED["newcastle"])
    >>> rows[0].result.label, abs(rows[0].deviation) < 0.001
    ('stroke', True)
    """
    solved = _Solved(machine)
    values = [solved.value(result, {}) for result in machine.published]
    return [
        Compared(result, value, result.deviation(value))
        for result, value in zip(machine.published, values, strict=True)
    ]


@checked(machine=a(PublishedMachine))
def explain_published(machine: PublishedMachine) -> list[Explanation]:
    """Open quantities of a machine that would explain where our results deviate.

    Each is taken through its plausible range with all else as assumed, and the engine solved at
    four points beside the one assumed; where a result meets the published value between two of
    them, once more there. What is set by a published result is set anew each time.

    Parameters
    ----------
    machine : saleg.machines.PublishedMachine

    Returns
    -------
    list of Explanation
        For each result to be met.
    """
    solved = _Solved(machine)
    return [_explained(solved, result) for result in machine.published if not result.held_by]


def _explained(solved: _Solved, result: Published) -> Explanation:
    """What each quantity does to a result."""
    causes, seen = [], [solved.value(result, {})]
    for quantity in solved.machine.open_quantities:
        values = list(_candidates(solved, result, quantity))
        seen += [solved.value(result, {quantity.path: value}) for value in values]
        tried = [_at(solved, result, quantity.path, value) for value in values]
        causes.append(min(tried, key=lambda one: (not one.explains, _size(one.deviation))))
    nearest = min(causes, key=lambda one: _size(one.deviation), default=None)
    if nearest is not None and _size(nearest.deviation) >= _size(solved.deviation(result, {})):
        nearest = None
    explaining = tuple(one for one in causes if one.explains)
    least, greatest = float(np.nanmin(seen)), float(np.nanmax(seen))
    return Explanation(result, least, greatest, explaining, nearest)


def _candidates(solved: _Solved, result: Published, quantity: OpenQuantity) -> Iterator[float]:
    """Values of a quantity that are solved for, and those at which a result should be met."""
    path = quantity.path
    points = _points(quantity, float(solved.machine.engine().get(path)))
    off = [solved.deviation(result, {path: value}) for value in points]
    yield from points
    for (low, before), (high, after) in pairwise(zip(points, off, strict=True)):
        if before * after < 0.0:
            yield low + (high - low) * before / (before - after)


def _points(quantity: OpenQuantity, assumed: float) -> list[float]:
    """Values of a quantity, rising, the one assumed among them."""
    ends = (quantity.low, quantity.high)
    beside = {assumed + share * (end - assumed) for end in ends for share in SHARES}
    return sorted(beside | {assumed})


def _at(solved: _Solved, result: Published, path: str, value: float) -> Cause:
    """A result with one quantity changed, and the other result that suffers most."""
    changes = {path: value}
    off = solved.deviation(result, changes)
    worst, worst_deviation, most = "", math.nan, WORSE
    for other in solved.machine.published:
        there = solved.deviation(other, changes)
        worse = _size(there) - _size(solved.deviation(other, {}))
        if other is not result and worse > most:
            worst, worst_deviation, most = other.label, there, worse
    return Cause(path, value, off, worst, worst_deviation)


def _size(deviation: float) -> float:
    """Magnitude of a deviation [-]; infinite where the engine does not run."""
    return math.inf if math.isnan(deviation) else abs(deviation)
