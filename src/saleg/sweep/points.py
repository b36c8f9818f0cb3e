"""Points of a sweep: frames with one column per input and one row per point."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.errors import SweepError, raise_together, shown
from saleg.quantities import is_number, is_whole

if TYPE_CHECKING:
    import pandas as pd

#: Range of an input: lowest and highest value.
Ranges = Mapping[str, Sequence[float]]


#: Points of a set at most; more would fill the memory before any work is done.
MOST_POINTS = 10_000_000


def grid(values: Mapping[str, Sequence[float] | np.ndarray]) -> pd.DataFrame:
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

    columns = {name: _numbers(name, column) for name, column in _table(values).items()}
    if not columns:
        raise SweepError("a grid needs at least one input")
    refuse_too_many(math.prod(map(len, columns.values())))
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

    held = {name: _numbers(name, column) for name, column in _table(columns).items()}
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
    import pandas as pd
    from scipy.stats import qmc

    _check_sample(ranges, count, seed)
    low, high = box(ranges)
    unit = qmc.LatinHypercube(len(low), seed=checked_seed(seed)).random(_count(count))
    return pd.DataFrame(low + unit * (high - low), columns=list(ranges))


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
    import pandas as pd
    from scipy.stats import qmc

    _check_sample(ranges, count, seed)
    count = _count(count)
    if count & (count - 1):
        raise SweepError(f"count = {count}: a Sobol' set needs a power of two of points")
    low, high = box(ranges)
    unit = qmc.Sobol(len(low), seed=checked_seed(seed)).random(count)
    return pd.DataFrame(low + unit * (high - low), columns=list(ranges))


def box(ranges: Ranges) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest values of a box, checked."""
    raise_together(SweepError, _checks_of(ranges))
    low, high = np.array([[float(end) for end in ends] for ends in ranges.values()]).T
    return low, high


def _check_sample(ranges: Ranges, count: int, seed: int) -> None:
    """Refuse wrong arguments of a sample, all at once."""
    others = partial(_count, count), partial(checked_seed, seed)
    raise_together(SweepError, [*_checks_of(ranges), *others])


def _checks_of(ranges: Ranges) -> list[Callable[[], None]]:
    """Checks of the ranges of a box, one by one."""
    if not _table(ranges):
        raise SweepError("ranges are missing")
    return [partial(_check_range, *item) for item in ranges.items()]


def _check_range(name: str, given: Any) -> None:
    """Refuse what is no lower and higher value."""
    ends = _numbers(name, given)
    if len(ends) != 2 or not ends[0] < ends[1] or not all(map(math.isfinite, ends)):
        raise SweepError(f"{name} = {list(ends)}: must be a lower and a higher finite value")


def refuse_too_many(count: int) -> None:
    """Refuse a set of points that would fill the memory."""
    if count > MOST_POINTS:
        shown = f"{min(count, 10**300):.3g}"
        raise SweepError(
            f"{shown} points are more than {MOST_POINTS:.0e}: take fewer values, or split the sweep"
        )


def checked_seed(seed: int) -> int:
    """A seed, refused unless it always gives the same points."""
    if not is_whole(seed, 0):
        raise SweepError(f"seed = {shown(seed)}: must be a whole number >= 0")
    return int(seed)


def _table(values: Any) -> Mapping[str, Any]:
    if not isinstance(values, Mapping):
        raise SweepError(f"{shown(values)}: must be values by name, as {{'bore': [0.06, 0.07]}}")
    return values


def _numbers(name: str, values: Sequence[float]) -> list[float]:
    if isinstance(values, str) or not np.iterable(values):
        raise SweepError(f"{name} = {shown(values)}: must be a list of numbers")
    held = list(values)
    wrong = [value for value in held if not is_number(value)]
    if wrong or not held:
        raise SweepError(f"{name} = {held!r}: must be numbers, at least one")
    return [float(value) for value in held]


def _count(count: int) -> int:
    if not is_whole(count, 1):
        raise SweepError(f"count = {shown(count)}: must be a whole number >= 1")
    refuse_too_many(int(count))
    return int(count)
