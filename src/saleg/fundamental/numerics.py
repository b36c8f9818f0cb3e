"""Two numerical tools: the first zero of an energy, and a quadrature for singular ends."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

#: Points of the scan for a sign change, and how close to the head it goes; what is not stopped
#: there counts as having reached it.
SCAN, AT_HEAD = 96, 1.0 - 1e-12
#: Step and reach of the double-exponential quadrature: beyond, weights fall below 1e-18.
STEP, BELOW, ABOVE = 0.05, -4.4, 3.2


def first_root(energy: Callable[[Any], Any], slope: Callable[[Any], Any], start: Any) -> Any:
    """First zero of a kinetic energy beyond a dead centre.

    A scan, finer towards both ends, brackets it; Newton's method, or bisection where that leaves
    the bracket, refines it to rounding. No step in time is made.

    Parameters
    ----------
    energy, slope : callable
        Kinetic energy and its derivative over position; vectorised.
    start : float or ndarray
        Dead centre, where the energy is zero [-].

    Returns
    -------
    float or ndarray
        The zero; `start` if the slope is not positive there, and if there is no zero the last
        point before the head, at 1.

    Examples
    --------
    >>> float(first_root(lambda s: 0.25 - s**2, lambda s: -2.0 * s, -0.5))
    0.5
    """
    start = np.asarray(start, dtype=float)
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, SCAN + 1))
    scan = start + np.expand_dims(share[1:], tuple(range(1, start.ndim + 1))) * (AT_HEAD - start)
    stopped = energy(scan) <= 0.0
    after = np.argmax(stopped, axis=0)
    high = np.take_along_axis(scan, after[np.newaxis], axis=0)[0]
    before = np.take_along_axis(scan, np.maximum(after - 1, 0)[np.newaxis], axis=0)[0]
    root = _refine(energy, slope, np.where(after > 0, before, start), high)
    root = np.where(stopped.any(axis=0), root, AT_HEAD)
    return np.where(slope(start) > 0.0, root, start)[()]


def _refine(energy: Any, slope: Any, low: Any, high: Any) -> Any:
    """Zero between `low`, where the energy is positive, and `high`, where it is not."""
    at = high
    for _ in range(200):
        value, steepness = energy(at), slope(at)
        low, high = np.where(value > 0.0, at, low), np.where(value > 0.0, high, at)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = at - value / steepness
        inside = (newton > low) & (newton < high)
        better = np.where(inside, newton, np.where(value == 0.0, at, 0.5 * (low + high)))
        if np.all(np.abs(better - at) <= 2e-16 * np.abs(at)):
            return better
        at = better
    return at


def bisect(function: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Zeros of a function between pairs of points at which its signs differ.

    Parameters
    ----------
    function : callable
        Vectorised.
    low, high : array_like
        Ends of the intervals.

    Returns
    -------
    ndarray
        Zeros, to rounding.

    Examples
    --------
    >>> float(bisect(np.cos, 0.0, 3.0) / np.pi)
    0.5
    """
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    sign = np.sign(function(low))
    for _ in range(100):
        middle = 0.5 * (low + high)
        same = np.sign(function(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def half_line(dimensions: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on (0, 1) of the double-exponential rule (Takahasi and Mori 1974).

    Nodes are correct relative to their distance from 0, where the integrand may be singular.

    Parameters
    ----------
    dimensions : int
        Dimensions of the array the nodes are to be broadcast with.

    Returns
    -------
    nodes, weights : ndarray, shape (n, 1, 1, ...)

    Examples
    --------
    >>> nodes, weights = half_line(0)
    >>> round(float(np.sum(weights / np.sqrt(nodes))), 13)
    2.0
    """
    nodes, weights = _rule()
    shape = (-1,) + dimensions * (1,)
    return nodes.reshape(shape), weights.reshape(shape)


@cache
def _rule() -> tuple[np.ndarray, np.ndarray]:
    steps = np.arange(BELOW, ABOVE, STEP)
    nodes = 1.0 / (1.0 + np.exp(-np.pi * np.sinh(steps)))
    return nodes, STEP * np.pi * np.cosh(steps) * nodes / (1.0 + np.exp(np.pi * np.sinh(steps)))
