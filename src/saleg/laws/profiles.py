"""Quantities given over time, for laws: plain functions that run compiled and as Python."""

from __future__ import annotations

from collections.abc import Sequence

from saleg.laws.interpolation import linear


def at_time(t: float, times: Sequence[float], values: Sequence[float]) -> float:
    """Value of a profile: linear between its times, constant before and after.

    Two equal times make a step, which takes effect at that time.
    """
    if t >= times[len(times) - 1]:
        return values[len(times) - 1]
    if t < times[0]:
        return values[0]
    return linear(t, times, values)
