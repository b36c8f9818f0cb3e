"""Strokes that repeat themselves: where they are, whether they attract, where they vanish."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.checks import a, checked
from saleg.fundamental.balance import TINY, gain, indicated_work, multiplier
from saleg.fundamental.history import RUNAWAY_DEPTH, return_map
from saleg.fundamental.loads import Load
from saleg.fundamental.numerics import bisect
from saleg.fundamental.otto import compression_ratio
from saleg.fundamental.system import System

#: Logarithms of the compression ratios that are scanned for equilibria: up to a runaway.
SCANNED = np.linspace(1e-3, 2.0 * np.arctanh(RUNAWAY_DEPTH), 800)
#: Relative difference of gain and load that is rounding.
ROUNDING = 1e-10


@dataclass(frozen=True)
class Equilibrium:
    """A depth that a stroke reproduces.

    Attributes
    ----------
    depth : float
        Distance of both dead centres from the midpoint [-].
    multiplier : float
        Factor by which a small disturbance of the depth changes from stroke to stroke [-].
    """

    depth: float
    multiplier: float

    @property
    def attracting(self) -> bool:
        """Whether small disturbances die out."""
        return abs(self.multiplier) < 1.0

    @property
    def compression_ratio(self) -> float:
        """Geometric compression ratio [-]."""
        return float(compression_ratio(-self.depth, self.depth))


@dataclass(frozen=True)
class Fold:
    """Where two equilibria meet and vanish.

    Attributes
    ----------
    depth : float
        Distance of the dead centres from the midpoint [-].
    load : Load
        The load at which they meet.
    """

    depth: float
    load: Load

    @property
    def compression_ratio(self) -> float:
        """Geometric compression ratio [-]."""
        return float(compression_ratio(-self.depth, self.depth))


@checked(system=a(System))
def equilibria(system: System) -> tuple[Equilibrium, ...]:
    """All isolated equilibria of a system, in the order of their depth.

    Parameters
    ----------
    system : System

    Returns
    -------
    tuple of Equilibrium
        Empty if there are none, and if every depth is one, as with the load tied to the Otto
        cycle and combustion at dead centre.

    Examples
    --------
    >>> from saleg.fundamental import ConstantLoad
    >>> for found in equilibria(System(pressure=0.5, heat=1.0, load=ConstantLoad(0.36))):
    ...     print(f"{found.compression_ratio:.2f} {found.multiplier:.4f} {found.attracting}")
    2.26 0.9742 True
    6.77 1.0227 False
    """
    depth = _scan(system)
    depth = np.sort(np.append(depth, _turning(system, depth)))
    excess = _gain_over_load(system, depth) - 1.0
    if not np.any(np.isfinite(excess)) or np.max(np.abs(excess)) < ROUNDING:
        return ()
    change = np.flatnonzero(excess[:-1] * excess[1:] < 0.0)
    roots = bisect(lambda u: _gain_over_load(system, u) - 1.0, depth[change], depth[change + 1])
    # At the edge of misfiring the load may meet the gain without crossing it.
    roots = np.append(depth[:1][np.abs(excess[:1]) < 1e-8], roots)
    repeats = np.abs(return_map(system, roots) - roots) < 1e-6
    return tuple(Equilibrium(float(u), float(multiplier(system, u))) for u in roots[repeats])


@checked(system=a(System))
def folds(system: System) -> tuple[Fold, ...]:
    """Depths at which two equilibria meet as the load is made stronger or weaker.

    Parameters
    ----------
    system : System
        Of its load only the kind and the shape count, but it must take some work.

    Returns
    -------
    tuple of Fold

    Examples
    --------
    >>> from saleg.fundamental import ConstantLoad
    >>> fold, = folds(System(pressure=0.5, heat=1.0, load=ConstantLoad(1.0)))
    >>> round(fold.compression_ratio, 2), round(fold.load.amplitude, 4)
    (3.75, 0.3546)
    """
    found = []
    for u in _turning(system, _scan(system)).tolist():
        load = system.load.balanced(system, u, float(indicated_work(system, u)))
        found.append(Fold(u, load))
    return tuple(found)


def _gain_over_load(system: System, depth: Any) -> Any:
    """Indicated work over the work the load takes [-]; 1 at an equilibrium."""
    taken = system.load.for_stroke(system, depth).work(-depth, 2.0 * depth)
    with np.errstate(divide="ignore", invalid="ignore"):
        return gain(system, depth) / taken


def _scan(system: System) -> np.ndarray:
    """Depths to look at: all at which the charge fires, evenly in the logarithm of the ratio."""
    depth = np.tanh(0.5 * SCANNED)
    lit = system.ignition.position(system.gas)
    if np.isfinite(lit):
        depth = np.append(lit, depth[depth > lit])
    return depth


def _turning(system: System, depth: np.ndarray) -> np.ndarray:
    """Depths between the given ones at which gain over load is greatest or least."""

    def slope(u: Any) -> Any:
        slope = np.imag(_gain_over_load(system, u + 1j * TINY))
        return np.where(np.isfinite(slope), slope, 0.0)  # no load, no turning

    inner = depth[1:-1]
    sign = np.sign(slope(inner))
    change = np.flatnonzero(sign[:-1] * sign[1:] < 0.0)
    return bisect(slope, inner[change], inner[change + 1])
