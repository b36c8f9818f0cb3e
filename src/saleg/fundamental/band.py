"""The tolerance band of heat against work in the basic system (2.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.checks import checked, whole
from saleg.fundamental.checks import GAMMA, SCALAR, require
from saleg.fundamental.numerics import bisect
from saleg.fundamental.otto import compression_ratio, equilibrium_force
from saleg.quantities import Limits

#: Ratios of specific heats for which gain and load can touch.
WITH_FOLD = Limits("-", 1.0, 2.0, True, True)


@dataclass(frozen=True)
class ToleranceBand:
    """Ratios of work force to heat, F_W*/Q_in*, with an attracting equilibrium.

    Attributes
    ----------
    lowest, highest : float or ndarray
        Below the first every start runs away; above the second none comes to rest at a stroke.
    fold : float or ndarray
        Depth at the lowest ratio [-]: attracting equilibria are less deep.
    """

    lowest: Any
    highest: Any
    fold: Any


def tolerance_band(gamma: Any = 1.4) -> ToleranceBand:
    """How far work force and heat may be apart for an attracting equilibrium of Eq. 28.

    That of the basic system: isentropic, burning at dead centre, constant work force. Neither
    midpoint pressure nor springs matter.

    Parameters
    ----------
    gamma : array_like
        Ratio of specific heats [-], below 2.

    Returns
    -------
    ToleranceBand

    Examples
    --------
    >>> band = tolerance_band(1.4)
    >>> round(float(band.lowest), 4), round(float(band.highest), 4)
    (0.3546, 0.4)
    """
    require(gamma=(gamma, WITH_FOLD))
    gamma = np.asarray(gamma, dtype=float)

    def rising(u: Any) -> Any:
        """Sign of the slope of Eq. 32 over depth."""
        left = ((1.0 - u) / (1.0 + u)) ** (gamma - 1.0)
        return 2.0 * u * (gamma - 1.0) * left / (1.0 - u * u) - (1.0 - left)

    fold = bisect(rising, np.full_like(gamma, 1e-4), np.full_like(gamma, 1.0 - 1e-14))
    lowest = equilibrium_force(-fold, gamma=gamma, heat=1.0)
    return ToleranceBand(lowest[()], (gamma - 1.0)[()], fold[()])


@checked(gamma=SCALAR, count=whole(1))
def equilibrium_branch(gamma: float, count: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Compression ratios and the ratios F_W*/Q_in* that hold them (Eq. 32).

    Parameters
    ----------
    gamma : float
        Ratio of specific heats [-].
    count : int
        Points.

    Returns
    -------
    compression_ratio, force_over_heat : ndarray, shape (count,)
    """
    require(gamma=(gamma, GAMMA))
    depth = np.tanh(0.5 * np.linspace(1e-3, np.log(60.0), count))
    return compression_ratio(-depth, depth), equilibrium_force(-depth, gamma=gamma, heat=1.0)
