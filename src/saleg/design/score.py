"""Score of a design from 0 to 1: targets and constraints of Figure 85.

The figure's curves are not tabulated. Shapes, targets and tolerances here are those the thesis'
appendix gives for efficiency and peak pressure; the two for stability and compression ratio,
which it does not give in full, are exponentials of the same kind.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.quantities import quantity


@dataclass(frozen=True, kw_only=True)
class Score:
    """Weighted mean of how well targets and constraints are met; without a target power.

    Parameters
    ----------
    efficiency, stability, compression_ratio, peak_pressure : float
        Weights; those of the figure are 3, 3, 1, 1 [-].
    target_efficiency : float
        Efficiency that earns most of its weight [-].
    tolerated_change : float
        Change of the left dead centre in half strokes (Eq. 68) at which stability has lost most
        of its weight [-].
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

    def __call__(self, row: Mapping[str, Any]) -> Any:
        """Score [-] of a row, or of a whole frame, with these figures; 0 where one is missing."""
        met = {
            "efficiency": _reached(row["efficiency"] / self.target_efficiency, 2.0),
            "stability": _near(row["stability"] / self.tolerated_change),
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
        weights = {name: getattr(self, name) for name in met}
        total = sum(weights[name] * met[name] for name in met) / sum(weights.values())
        return np.nan_to_num(total, nan=0.0)


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
