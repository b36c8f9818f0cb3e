"""What the dissertation says of a figure, and what is found."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple


class Claim(NamedTuple):
    """One thing the dissertation says, beside what saleg finds.

    Attributes
    ----------
    what : str
        What is compared, with its unit in brackets.
    ours : callable
        Number found, in that unit, from what the figure shows.
    printed : str
        What the dissertation prints: a number or words.
    low, high : float
        Least and greatest number that a test lets pass, in that unit.
    """

    what: str
    ours: Callable[[Any], float]
    printed: str
    low: float
    high: float

    def deviation(self, value: float) -> float:
        """Deviation of a number from the printed one [-]; NaN where words are printed."""
        try:
            return value / float(self.printed) - 1.0
        except ValueError:
            return math.nan


class Shown(NamedTuple):
    """Figures that share a picture, and how ours compares.

    Attributes
    ----------
    figures : tuple of int
        Their numbers.
    title : str
        What they show.
    says : str
        One sentence on how ours compares with the printed one.
    claims : tuple of Claim
        What is compared by numbers.
    """

    figures: tuple[int, ...]
    title: str
    says: str
    claims: tuple[Claim, ...]


def near(what: str, ours: Callable[[Any], float], printed: float, share: float) -> Claim:
    """Claim that a number is the printed one within a share of it.

    Parameters
    ----------
    what : str
    ours : callable
    printed : float
        Number as printed, in the unit that `what` names.
    share : float
        Greatest deviation [-].
    """
    ends = sorted((printed * (1.0 - share), printed * (1.0 + share)))
    return Claim(what, ours, f"{printed:g}", *ends)
