"""Score of a design from 0 to 1: targets and constraints of Figure 85.

The figure's curves are not tabulated. Shapes, targets and tolerances here are those the thesis'
appendix gives for efficiency and peak pressure; the two for stability and compression ratio,
which it does not give in full, are exponentials of the same kind. Two things are added: an orbit
known to be unstable earns nothing for stability, and what delivers no power earns nothing at all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.errors import WrongFields
from saleg.quantities import Problem, Quantities, problems, quantity


class InvalidScore(WrongFields):
    """A score with fields out of range; `problems` lists them all."""

    whole = "score"


#: Figures with a weight.
WEIGHED = ("efficiency", "stability", "compression_ratio", "peak_pressure")


@dataclass(frozen=True, kw_only=True)
class Score(Quantities):
    """Weighted mean of how well targets and constraints are met; without a target power.

    Parameters
    ----------
    efficiency, stability, compression_ratio, peak_pressure : float
        Weights; those of the figure are 3, 3, 1, 1 [-].
    target_efficiency : float
        Efficiency that earns most of its weight [-].
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
    compression_ratio: float = quantity("-", default=1.0, low=0)
    peak_pressure: float = quantity("-", default=1.0, low=0)
    target_efficiency: float = quantity("-", default=0.4, low=0, high=1, open_low=True)
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
        if not found and not sum(self._weights.values()) > 0.0:
            found = [Problem("efficiency", 0.0, "-", "one of the four weights must be > 0")]
        if not found and self.greatest_compression_ratio < self.least_compression_ratio:
            wrong, least = self.greatest_compression_ratio, self.least_compression_ratio
            found = [Problem("greatest_compression_ratio", wrong, "-", f"must be >= {least:g}")]
        if found:
            raise InvalidScore(found)

    @property
    def _weights(self) -> dict[str, float]:
        """Weights by figure."""
        return {name: getattr(self, name) for name in WEIGHED}

    def __call__(self, row: Mapping[str, Any]) -> Any:
        """Score [-] of a row, or of a whole frame, with these figures; 0 where one is missing.

        ``largest_multiplier`` is used where it is known; NaN in it stands for not known.
        """
        repeats = _near(row["stability"] / self.tolerated_change)
        if "largest_multiplier" in row:
            repeats = np.where(np.greater(row["largest_multiplier"], 1.0), 0.0, repeats)
        met = {
            "efficiency": _reached(row["efficiency"] / self.target_efficiency, 2.0),
            "stability": repeats,
            "compression_ratio": _within(
                row["compression_ratio"],
                self.least_compression_ratio,
                self.greatest_compression_ratio,
            ),
            "peak_pressure": _reached(
                (self.greatest_pressure + self.pressure_tolerance - row["peak_pressure"])
                / self.pressure_tolerance,
                1.0,
            ),
        }
        weights = self._weights
        total = sum(weights[name] * met[name] for name in met) / sum(weights.values())
        delivers = np.greater(row["efficiency"], 0.0)
        return np.nan_to_num(np.where(delivers, total, 0.0), nan=0.0)


def _reached(share: Any, rate: float) -> Any:
    """0 at zero, most of 1 where the target is reached."""
    return 1.0 - np.exp(-rate * np.maximum(share, 0.0) ** 6)


def _near(share: Any) -> Any:
    """1 at zero, small beyond one."""
    return np.exp(-2.0 * np.asarray(share) ** 2)


def _within(value: Any, low: float, high: float) -> Any:
    """1 within a range, falling off at its ends over a tenth of their values."""
    below = np.maximum(low - value, 0.0) / (0.1 * low)
    above = np.maximum(value - high, 0.0) / (0.1 * high)
    return np.exp(-2.0 * (below**2 + above**2))
