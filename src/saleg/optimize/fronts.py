"""Fronts: designs of which none is better in all objectives."""

from __future__ import annotations

import numpy as np


def first_front(objectives: np.ndarray, violation: np.ndarray) -> np.ndarray:
    """Rows that meet all limits and that no other such row dominates.

    Parameters
    ----------
    objectives : ndarray, shape (rows, objectives)
        The greater the better.
    violation : ndarray
        0 where all limits are met.

    Returns
    -------
    ndarray of int
        In order. Of equal rows the first.

    Examples
    --------
    >>> first_front(np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.5]]), np.zeros(3)).tolist()
    [0, 1]
    """
    rows = np.flatnonzero((violation == 0.0) & ~np.isnan(objectives).any(axis=1))
    kept: list[int] = []
    # In falling order of the sum nothing is dominated by what comes after it.
    for row in rows[np.argsort(-objectives[rows].sum(axis=1), kind="stable")]:
        better = objectives[kept] >= objectives[row]
        if not better.all(axis=1).any():
            kept.append(int(row))
    return np.array(sorted(kept), dtype=int)
