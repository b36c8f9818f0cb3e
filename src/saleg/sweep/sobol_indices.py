"""Global sensitivity: Sobol' indices of the performance to inputs and empirical constants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.checks import FLAG, FRAME, TEXT, checked, each
from saleg.errors import SweepError, shown
from saleg.status import Status
from saleg.sweep.points import Ranges, box, checked_seed, refuse_too_many

if TYPE_CHECKING:
    import pandas as pd

#: Resamples behind an interval, and its confidence level.
RESAMPLES, CONFIDENCE = 200, 0.95


class NoIndices(SweepError):
    """Indices that would hide failed designs, or points that are no design for indices."""


@dataclass(frozen=True, eq=False)
class Indices:
    """Sobol' indices of one figure.

    Attributes
    ----------
    figure : str
        Column they are of.
    table : DataFrame
        One row per input: ``first`` (share of the variance the input explains by itself),
        ``total`` (share that involves it), and the ends of their 95 % intervals [-].
    variance : float
        Variance of the figure over the points, in the square of its unit.
    """

    figure: str
    table: pd.DataFrame = field(repr=False)
    variance: float

    def _repr_html_(self) -> str:
        from saleg.display import indices_card

        return indices_card(self)

    def plot(self, ax: Any = None) -> Any:
        """Bars: see :func:`saleg.plotting.sweeps.indices`."""
        from saleg.plotting.sweeps import indices

        return indices(self, ax)


def saltelli_points(ranges: Ranges, count: int, seed: int = 0) -> pd.DataFrame:
    """Points from which Sobol' indices can be told: ``count (d + 2)`` for d inputs.

    Two independent samples A and B of `count` points each, then A with one column at a time from
    B (Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270).

    Parameters
    ----------
    ranges : mapping
        Lowest and highest value (SI) by name of the input; values between are equally likely.
    count : int
        Points of a sample, a power of two.
    seed : int
        The same seed gives the same points.

    Returns
    -------
    DataFrame

    Examples
    --------
    >>> len(saltelli_points({"bore": (0.05, 0.07), "egr": (0.0, 0.3)}, 8))
    32
    """
    import pandas as pd
    from scipy.stats import qmc

    low, high = box(ranges)
    if (
        not isinstance(count, (int, np.integer))
        or isinstance(count, bool)
        or count < 2
        or count & (count - 1)
    ):
        raise SweepError(f"count = {shown(count)}: must be a power of two")
    d = len(low)
    refuse_too_many(int(count) * (d + 2))
    both = qmc.Sobol(2 * d, seed=checked_seed(seed)).random(int(count))
    a, b = both[:, :d], both[:, d:]
    mixed = []
    for n in range(d):
        column = a.copy()
        column[:, n] = b[:, n]
        mixed.append(column)
    unit = np.concatenate([a, b, *mixed])
    return pd.DataFrame(low + unit * (high - low), columns=list(ranges))


@checked(table=FRAME, figure=TEXT, inputs=each(TEXT, "names").optional, unstable=FLAG)
def indices(
    table: pd.DataFrame,
    figure: str,
    inputs: Sequence[str] | None = None,
    *,
    unstable: bool = False,
) -> Indices:
    """Sobol' indices of a figure from a finished sweep of :func:`saltelli_points`.

    Parameters
    ----------
    table : DataFrame
        From :func:`saleg.sweep.run`, all rows in order.
    figure : str
        A column.
    inputs : sequence of str, optional
        Columns of the inputs; those the sweep knows unless given.
    unstable : bool
        Take figures of unstable orbits like any other. Without a column ``stable`` nothing tells
        them apart.

    Returns
    -------
    Indices

    Raises
    ------
    NoIndices
        If any design failed, has no such figure, or has an unstable orbit: a single one would
        spoil every index, and leaving it out would hide where the engine does not run.

    Examples
    --------
    >>> from saleg import sweep
    >>> points = saltelli_points({"egr": (0.10, 0.14), "intake_pressure": (1.0e5, 1.1e5)}, 16)
    >>> found = indices(sweep.run(points, multipliers=False), "power")
    >>> found.table.total.idxmax()
    'intake_pressure'
    """
    names = list(inputs if inputs is not None else table.attrs.get("inputs", ()))
    if not names:
        raise NoIndices("which columns are inputs? the table does not say; name them")
    if len(names) == 1:
        raise NoIndices(f"{names[0]} is the only input: it explains everything")
    missing = [name for name in names if name not in table]
    if missing:
        raise NoIndices(f"no column {missing[0]!r}; there are {', '.join(map(str, table))}")
    _refuse_failures(table, figure, unstable)
    count, rest = divmod(len(table), len(names) + 2)
    if rest or not _is_saltelli(table[names].to_numpy(), count):
        raise NoIndices("these points are none of saltelli_points for these inputs")
    return _of_values(table[figure].to_numpy(dtype=float), figure, names, count)


def _of_values(values: np.ndarray, figure: str, names: list[str], count: int) -> Indices:
    """Indices from the values of the figure at all points."""
    import pandas as pd
    from scipy.stats import sobol_indices

    variance = float(values[: 2 * count].var())
    if not variance > 1e-20 * float(np.abs(values).max()) ** 2:
        raise NoIndices(f"{figure} is the same at all points: there is nothing to explain")
    a, b, mixed = values[:count], values[count : 2 * count], values[2 * count :]
    func: Any = {
        "f_A": a[np.newaxis],
        "f_B": b[np.newaxis],
        "f_AB": mixed.reshape(len(names), 1, count),
    }
    found = sobol_indices(func=func, n=count)
    spread = found.bootstrap(confidence_level=CONFIDENCE, n_resamples=RESAMPLES)
    columns = {
        "first": found.first_order,
        "first_low": spread.first_order.confidence_interval.low,
        "first_high": spread.first_order.confidence_interval.high,
        "total": found.total_order,
        "total_low": spread.total_order.confidence_interval.low,
        "total_high": spread.total_order.confidence_interval.high,
    }
    frame = pd.DataFrame({name: np.ravel(held) for name, held in columns.items()}, index=names)
    frame.attrs["units"] = dict.fromkeys(columns, "-")
    return Indices(figure, frame, variance)


def _refuse_failures(table: pd.DataFrame, figure: str, unstable: bool) -> None:
    if figure not in table:
        raise NoIndices(f"no column {figure!r}; there are {', '.join(map(str, table))}")
    if table[figure].dtype.kind not in "fiu":
        raise NoIndices(f"{figure} holds no numbers")
    bad = ~np.isfinite(table[figure].to_numpy(dtype=float))
    kinds = np.where(bad, f"without {figure}", "unstable").astype(object)
    if "status" in table:
        failed = (table["status"] != str(Status.STEADY)).to_numpy()
        kinds[failed] = table["status"].to_numpy()[failed]
        bad |= failed
    if "stable" in table and not unstable:
        bad |= ~table["stable"].to_numpy(dtype=bool)
    if bad.any():
        found, counts = np.unique(kinds[bad].astype(str), return_counts=True)
        said = ", ".join(f"{n} {kind}" for kind, n in zip(found, counts, strict=True))
        allowed = ", or allow unstable orbits with unstable=True" if "unstable" in found else ""
        raise NoIndices(
            f"{int(bad.sum())} of {len(table)} designs have no steady {figure} ({said}): indices "
            f"would hide them; narrow the ranges to where the engine runs{allowed}"
        )


def _is_saltelli(points: np.ndarray, count: int) -> bool:
    """Whether the points are two samples and their mixtures."""
    if count < 2:
        return False
    a, b = points[:count], points[count : 2 * count]
    for n in range(points.shape[1]):
        mixed = points[(2 + n) * count : (3 + n) * count]
        wanted = a.copy()
        wanted[:, n] = b[:, n]
        if not np.array_equal(mixed, wanted):
            return False
    return True
