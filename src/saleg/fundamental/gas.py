"""The gas: how it is compressed and expanded (2.2, 2.6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.quantities import Quantities, quantity


class Gas(Quantities):
    """Base of all gases: a ratio of specific heats and an exponent for either way.

    Attributes
    ----------
    gamma : float
        Ratio of specific heats [-]: how much a given heat raises the pressure.
    compression, expansion : float
        Polytropic exponents [-].
    """

    gamma: float

    @property
    def compression(self) -> float:
        """Polytropic exponent of compression [-]."""
        raise NotImplementedError

    @property
    def expansion(self) -> float:
        """Polytropic exponent of expansion [-]."""
        raise NotImplementedError


@dataclass(frozen=True)
class Isentropic(Gas):
    """No heat transfer: both exponents are the ratio of specific heats (2.2).

    Parameters
    ----------
    gamma : float
        Ratio of specific heats [-].

    Examples
    --------
    >>> Isentropic(1.35).expansion
    1.35
    """

    gamma: float = quantity("-", default=1.4, low=1, open_low=True)

    @property
    def compression(self) -> float:
        """Polytropic exponent of compression [-]."""
        return self.gamma

    @property
    def expansion(self) -> float:
        """Polytropic exponent of expansion [-]."""
        return self.gamma


@dataclass(frozen=True)
class Polytropic(Gas):
    """Heat transfer by exponents that differ from the ratio of specific heats (2.6).

    Heat is lost on both ways where ``compression < gamma < expansion``.

    Parameters
    ----------
    gamma : float
        Ratio of specific heats [-].
    compression, expansion : float
        Polytropic exponents [-].

    Examples
    --------
    >>> gas = Polytropic(gamma=1.4, compression=1.35, expansion=1.45)
    >>> gas.compression < gas.gamma < gas.expansion
    True
    """

    gamma: float = quantity("-", default=1.4, low=1, open_low=True)
    compression: float = quantity("-", default=1.35, low=1, open_low=True)
    expansion: float = quantity("-", default=1.45, low=1, open_low=True)


def expansion_work(pressure: Any, height: Any, rise: Any, exponent: float) -> Any:
    """Work of a gas column on its piston along a polytrope.

    Parameters
    ----------
    pressure, height : array_like
        Pressure P* and height of the column, in half strokes, at the beginning [-].
    rise : array_like
        Change of the height, negative for a compression [-].
    exponent : float
        Polytropic exponent [-].

    Returns
    -------
    ndarray or float
        Work, in k L^2 [-]. Correct to rounding even where `rise` is tiny: quadratures next to a
        dead centre live on that.

    Examples
    --------
    >>> round(float(expansion_work(1.0, 1.0, 1.0, 2.0)), 12)  # 1 - 1/2
    0.5
    """
    power = 1.0 - exponent
    return pressure * height * np.expm1(power * np.log1p(rise / height)) / power
