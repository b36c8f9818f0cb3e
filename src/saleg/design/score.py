"""Score of a design from 0 to 1: targets and constraints of Figure 85.

The figure's curves are not tabulated. Shapes, targets and tolerances here are those the thesis'
appendix gives for efficiency and peak pressure; the others are named there, not printed, and are
exponentials of the same kind. Two things are added: an orbit known to be unstable earns nothing for
stability, and what delivers no power earns nothing at all.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from saleg.design.terms import (
    Bell,
    Below,
    InvalidScore,
    Limit,
    Range,
    Reached,
    Repeats,
)
from saleg.design.weighted import Weighted, mean_miss, weighted_mean
from saleg.quantities import Problem, Quantities, as_float, problems, quantity

#: Figures with a weight.
WEIGHED = ("efficiency", "stability", "power", "compression_ratio", "peak_pressure")


@dataclass(frozen=True, kw_only=True)
class Score(Quantities):
    """Weighted mean of how well targets and constraints are met (Figure 85).

    Parameters
    ----------
    efficiency, stability, power, compression_ratio, peak_pressure : float
        Weights; those of the figure are 3, 3, 2, 1, 1 [-]. That of power counts with a target only.
    target_efficiency : float
        Efficiency that earns most of its weight [-].
    efficiency_tolerance : float
        Efficiency below its target at which nothing is earned [-]. The printed results ask for 0.1;
        the script has 0.4, with which no design of Table 9 could score what the text says.
    target_power : float, optional
        Power [W]; none unless given.
    power_tolerance : float
        Width of the bell around the target power [W].
    tolerated_change : float
        Change of the left dead centre in half strokes (Eq. 68) at which stability has lost most
        of its weight [-]. An orbit with a multiplier beyond one has lost all of it.
    least_compression_ratio, greatest_compression_ratio : float
        Range of the compression ratio [-].
    greatest_pressure : float
        Greatest peak pressure [Pa].
    pressure_tolerance : float
        Excess at which the weight of the peak pressure is gone [Pa].

    Examples
    --------
    >>> best = {"efficiency": 0.5, "stability": 0.0, "compression_ratio": 20.0}
    >>> bool(Score()({**best, "peak_pressure": 100e5}) > 0.99)
    True
    """

    efficiency: float = quantity("-", default=3.0, low=0)
    stability: float = quantity("-", default=3.0, low=0)
    power: float = quantity("-", default=2.0, low=0)
    compression_ratio: float = quantity("-", default=1.0, low=0)
    peak_pressure: float = quantity("-", default=1.0, low=0)
    target_efficiency: float = quantity("-", default=0.4, low=0, high=1, open_low=True)
    efficiency_tolerance: float = quantity("-", default=0.1, low=0, open_low=True)
    target_power: float | None = None
    power_tolerance: float = quantity("W", default=1.5e3, low=0, open_low=True)
    tolerated_change: float = quantity("-", default=0.1, low=0, open_low=True)
    least_compression_ratio: float = quantity("-", default=5.0, low=1)
    greatest_compression_ratio: float = quantity("-", default=35.0, low=1)
    greatest_pressure: float = quantity("Pa", default=250e5, low=0, open_low=True)
    pressure_tolerance: float = quantity("Pa", default=20e5, low=0, open_low=True)

    def __post_init__(self) -> None:
        """Refuse fields out of range.

        Raises
        ------
        InvalidScore
        """
        super().__post_init__()
        found = problems(self)
        if self.target_power is not None:
            power = as_float(self.target_power)
            if power is None or not 0.0 < power < math.inf:
                need = "must be a number > 0, or None for no target"
                found.append(Problem("target_power", self.target_power, "W", need))
        counted = [name for name in WEIGHED if name != "power" or self.target_power is not None]
        if not found and not sum(getattr(self, name) for name in counted) > 0.0:
            found = [Problem("efficiency", 0.0, "-", "one of the weights must be > 0")]
        if not found and self.greatest_compression_ratio < self.least_compression_ratio:
            wrong, least = self.greatest_compression_ratio, self.least_compression_ratio
            found = [Problem("greatest_compression_ratio", wrong, "-", f"must be >= {least:g}")]
        if found:
            raise InvalidScore(found)

    @property
    def terms(self) -> tuple[Weighted, ...]:
        """Weights and terms, in the order of the figure."""
        ratios = self.least_compression_ratio, self.greatest_compression_ratio
        target = self.target_power
        terms = {
            "efficiency": Reached("efficiency", self.target_efficiency, self.efficiency_tolerance),
            "stability": Repeats(self.tolerated_change),
            "power": Bell("power", target, self.power_tolerance) if target else None,
            "compression_ratio": Range("compression_ratio", *ratios),
            "peak_pressure": Below(
                "peak_pressure", self.greatest_pressure, self.pressure_tolerance
            ),
        }
        return tuple(
            Weighted(getattr(self, name), term) for name, term in terms.items() if term is not None
        )

    @property
    def limits(self) -> tuple[Limit, ...]:
        """What the terms that count ask for, as hard limits."""
        return tuple(limit for weight, term in self.terms if weight for limit in term.limits)

    def miss(self, row: Mapping[str, Any]) -> Any:
        """How far a row is off, 0 to 1, where curves are flat at nothing: 0 near the targets."""
        return mean_miss(self.terms, row)

    def __call__(self, row: Mapping[str, Any]) -> Any:
        """Score [-] of a row, or of a whole frame, with these figures; 0 where one is missing.

        ``largest_multiplier`` is used where it is known; NaN in it stands for not known.
        """
        return weighted_mean(self.terms, row)
