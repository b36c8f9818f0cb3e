"""Choices a law makes by the state of the gas or the motion, in a form that serves many engines.

Batches are calculated several engines at once, side by side: a comparison of what a law is shown
then has an answer for each of them, and no ``if`` can follow it. Written with these functions a law
serves one engine and several alike. In plain Python, and for one engine, they are what they say.
"""

from __future__ import annotations

from typing import TypeVar

Number = TypeVar("Number")


def where(condition: bool, a: Number, b: Number) -> Number:
    """`a` where a condition holds, else `b`.

    Both are calculated, so both must be calculable everywhere, as in
    ``where(x > 0.0, math.sqrt(max(x, 0.0)), 0.0)``. Conditions are joined with ``&`` and ``|``.

    Parameters
    ----------
    condition : bool
        A comparison.
    a, b : float
        Values where it holds, and where it does not; of any unit, the same for both [any].

    Returns
    -------
    float
        One of them [any].
    """
    return a if condition else b


def any_of(condition: bool) -> bool:
    """Whether a condition holds for any of the engines calculated together.

    For what need not be calculated where it holds for none: ``if any_of(x > 0.0): ...``.

    Parameters
    ----------
    condition : bool
        A comparison.

    Returns
    -------
    bool
        For one engine the condition itself.
    """
    return bool(condition)
