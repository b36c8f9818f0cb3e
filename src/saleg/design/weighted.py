"""Scores that are weighted means of terms."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.design.terms import InvalidScore, Limit, Term
from saleg.quantities import Problem, is_number

if TYPE_CHECKING:
    from saleg.design.terms import Row


class Weighted(NamedTuple):
    """A term with its weight.

    Attributes
    ----------
    weight : float
        Weight in the mean [-].
    term : Term
        What it weighs.
    """

    weight: float
    term: Term


@dataclass(frozen=True)
class WeightedScore:
    """Weighted mean of terms, 0 to 1.

    Parameters
    ----------
    terms : iterable of (float, Term)
        Weights and terms.
    needs_delivery : bool
        Whether a row whose efficiency is known earns nothing at all unless it is > 0.

    Examples
    --------
    >>> from saleg.design.terms import Bell, Below
    >>> score = WeightedScore(((3, Bell("power", 4e3, 1e3)), (1, Below("peak_pressure", 2e7, 2e6))))
    >>> round(float(score({"power": 5e3, "peak_pressure": 1e7})), 3)
    0.526
    """

    terms: tuple[Weighted, ...]
    needs_delivery: bool = True

    def __post_init__(self) -> None:
        """Refuse weights and terms that make no sense.

        Raises
        ------
        InvalidScore
        """
        held, found = [], []
        if not isinstance(self.terms, Iterable):
            need = "must be a tuple of (weight, term)"
            raise InvalidScore([Problem("terms", self.terms, "-", need)])
        for number, item in enumerate(self.terms):
            weight, term = item if isinstance(item, tuple) and len(item) == 2 else (item, None)
            if not is_number(weight) or not 0.0 <= float(weight) < math.inf:
                found.append(Problem(f"terms[{number}]", weight, "-", "must be a weight >= 0"))
            elif isinstance(term, type) or not callable(getattr(term, "curve", None)):
                found.append(Problem(f"terms[{number}]", term, "-", "must be a term"))
            else:
                held.append(Weighted(float(weight), term))
        if not found and not sum(weight for weight, _ in held) > 0.0:
            found.append(Problem("terms", self.terms, "-", "one of the weights must be > 0"))
        if found:
            raise InvalidScore(found)
        object.__setattr__(self, "terms", tuple(held))

    @property
    def limits(self) -> tuple[Limit, ...]:
        """What the terms that count ask for, as hard limits."""
        return tuple(limit for weight, term in self.terms if weight for limit in term.limits)

    def miss(self, row: Row) -> Any:
        """How far a row is off, 0 to 1, where the curves are flat at nothing: see `mean_miss`."""
        return mean_miss(self.terms, row)

    def __call__(self, row: Row) -> Any:
        """Score of a row, or of every row of a table; 0 where a figure is missing."""
        return weighted_mean(self.terms, row, self.needs_delivery)


def weighted_mean(terms: Iterable[Weighted], row: Row, needs_delivery: bool = True) -> Any:
    """Weighted mean of terms for a row, or every row of a table; 0 where a figure is missing."""
    counted = [(weight, term) for weight, term in terms if weight > 0.0]
    with np.errstate(over="ignore", invalid="ignore"):
        met = sum(weight * term(row) for weight, term in counted)
        total = met / sum(weight for weight, _ in counted)
    if "efficiency" in row:
        share = np.asarray(row["efficiency"], dtype=float)
        sensible = (share > 0.0) | (~np.isnan(share) & (not needs_delivery))
        total = np.where(sensible & (share <= 1.0), total, 0.0)
    return np.nan_to_num(total, nan=0.0)


def mean_miss(terms: Iterable[Weighted], row: Row) -> Any:
    """Weighted mean of how far a row is off where curves are flat at nothing; 1 if not known.

    0 wherever every term earns something. A search that is told the score less this one feels a
    pull on the plateaus of the score too, and finds the same best design.
    """
    counted = [(weight, term) for weight, term in terms if weight > 0.0]
    with np.errstate(over="ignore", invalid="ignore"):
        off = sum(
            weight * (term.miss(row[term.figure]) if term.figure in row else 0.0)
            for weight, term in counted
        )
    return np.nan_to_num(off / sum(weight for weight, _ in counted), nan=1.0)
