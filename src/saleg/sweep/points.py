"""Points of a sweep: frames with one column per input and one row per point."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from saleg.errors import SalegError
from saleg.quantities import is_number

if TYPE_CHECKING:
    import pandas as pd

#: Range of an input: lowest and highest value.
Ranges = Mapping[str, Sequence[float]]


class SweepError(SalegError, ValueError):
    """A sweep that makes no sense, or does not belong to its folder."""


def grid(values: Mapping[str, Sequence[float]]) -> pd.DataFrame:
    """Every value of every input with every other; the last input runs fastest.

    Parameters
    ----------
    values : mapping
        Values (SI) by name of the input.

    Returns
    -------
    DataFrame

    Examples
    --------
    >>> len(grid({"bore": [0.05, 0.06], "egr": [0.0, 0.1, 0.2]}))
    6
    """
    import pandas as pd

    columns = {name: _numbers(name, column) for name, column in values.items()}
    if not columns:
        raise SweepError("a grid needs at least one input")
    return pd.DataFrame(list(itertools.product(*columns.values())), columns=list(columns))


def listed(columns: Mapping[str, Sequence[float]]) -> pd.DataFrame:
    """Points one by one: the n-th values of all inputs belong together.

    Parameters
    ----------
    columns : mapping
        Values (SI) by name of the input, all equally many.

    Returns
    -------
    DataFrame

    Examples
    --------
    >>> len(listed({"bore": [0.05, 0.06], "egr": [0.0, 0.1]}))
    2
    """
    import pandas as pd

    held = {name: _numbers(name, column) for name, column in columns.items()}
    lengths = {name: len(column) for name, column in held.items()}
    if not held or len(set(lengths.values())) > 1:
        raise SweepError(f"a list needs as many values of every input; there are {lengths}")
    return pd.DataFrame(held)


def latin_hypercube(ranges: Ranges, count: int, seed: int = 0) -> pd.DataFrame:
    """Latin hypercube: in every input one point in each of `count` equal slices.

    Parameters
    ----------
    ranges : mapping
        Lowest and highest value (SI) by name of the input.
    count : int
        Number of points.
    seed : int
        The same seed gives the same points.

    Returns
    -------
    DataFrame

    Examples
    --------
    >>> points = latin_hypercube({"bore": (0.05, 0.07)}, 4)
    >>> sorted(int(x) for x in (points.bore - 0.05) / 0.005)
    [0, 1, 2, 3]
    """
    from scipy.stats import qmc

    return _scaled(ranges, qmc.LatinHypercube(len(ranges), seed=seed).random(_count(count)))


def sobol(ranges: Ranges, count: int, seed: int = 0) -> pd.DataFrame:
    """Scrambled Sobol' sequence: fills the box evenly, best with a power of two of points.

    Parameters
    ----------
    ranges : mapping
        Lowest and highest value (SI) by name of the input.
    count : int
        Number of points, a power of two.
    seed : int
        The same seed gives the same points.

    Returns
    -------
    DataFrame

    Examples
    --------
    >>> len(sobol({"bore": (0.05, 0.07), "egr": (0.0, 0.3)}, 8))
    8
    """
    from scipy.stats import qmc

    count = _count(count)
    if count & (count - 1):
        raise SweepError(f"count = {count}: a Sobol' set needs a power of two of points")
    return _scaled(ranges, qmc.Sobol(len(ranges), seed=seed).random(count))


def box(ranges: Ranges) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest values of a box, checked."""
    if not ranges:
        raise SweepError("ranges are missing")
    for name, ends in ranges.items():
        ends = _numbers(name, ends)
        if len(ends) != 2 or not ends[0] < ends[1]:
            raise SweepError(f"{name} = {list(ends)}: must be a lower and a higher value")
    low, high = np.array([[float(end) for end in ends] for ends in ranges.values()]).T
    return low, high


def _scaled(ranges: Ranges, unit: np.ndarray) -> pd.DataFrame:
    import pandas as pd

    low, high = box(ranges)
    return pd.DataFrame(low + unit * (high - low), columns=list(ranges))


def _numbers(name: str, values: Sequence[float]) -> list[float]:
    if isinstance(values, str) or not np.iterable(values):
        raise SweepError(f"{name} = {values!r}: must be a list of numbers")
    held = list(values)
    wrong = [value for value in held if not is_number(value)]
    if wrong or not held:
        raise SweepError(f"{name} = {held!r}: must be numbers, at least one")
    return [float(value) for value in held]


def _count(count: int) -> int:
    if not isinstance(count, (int, np.integer)) or isinstance(count, bool) or count < 1:
        raise SweepError(f"count = {count!r}: must be a whole number >= 1")
    return int(count)
