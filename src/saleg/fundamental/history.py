"""Stroke by stroke: how the dead centres move, and where that ends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from saleg.checks import a, checked, whole
from saleg.fundamental.checks import DEPTH, SCALAR, require
from saleg.fundamental.otto import compression_ratio
from saleg.fundamental.stroke import Stroke
from saleg.fundamental.system import System

#: Depth beyond which an engine has run away: a compression ratio of a thousand, which is more
#: than ten times what engines survive.
RUNAWAY_DEPTH = 999.0 / 1001.0
#: Depth below which the oscillation has decayed [-].
DECAYED = 1e-3
#: Change of the depth from stroke to stroke, relative to it, below which it is at equilibrium.
SETTLED = 1e-7


class Outcome(StrEnum):
    """What became of an engine (2.3); rising or falling if it was watched too briefly to say."""

    RUNAWAY = "runaway"
    DECAY = "decay"
    EQUILIBRIUM = "equilibrium"
    RISING = "rising"
    FALLING = "falling"


class Path(NamedTuple):
    """Motion along strokes, dimensionless.

    Attributes
    ----------
    t, x, v, a : ndarray, shape (n,)
        Time, position, velocity and acceleration [-].
    """

    t: np.ndarray
    x: np.ndarray
    v: np.ndarray
    a: np.ndarray


@dataclass(frozen=True)
class History:
    """Strokes one after the other, as :func:`march` makes them.

    Attributes
    ----------
    strokes : tuple of Stroke
    """

    strokes: tuple[Stroke, ...]

    @property
    def dead_centres(self) -> np.ndarray:
        """Positions of the dead centres x* [-], the start included; shape (strokes + 1,)."""
        return np.array([self.strokes[0].start, *(stroke.end for stroke in self.strokes)])

    @property
    def compression_ratios(self) -> np.ndarray:
        """Geometric compression ratio of every stroke [-], shape (strokes,)."""
        centres = self.dead_centres
        return np.asarray(compression_ratio(centres[:-1], centres[1:]))

    @property
    def outcome(self) -> Outcome:
        """Whether it ran away, decayed or came to equilibrium, as far as the strokes show."""
        depth = np.abs(self.dead_centres)
        last = self.strokes[-1].depth
        if last > RUNAWAY_DEPTH:
            return Outcome.RUNAWAY
        if last < DECAYED:
            return Outcome.DECAY
        change = (depth[-1] - depth[-2]) / depth[-1]
        if abs(change) < SETTLED:
            return Outcome.EQUILIBRIUM
        return Outcome.RISING if change > 0.0 else Outcome.FALLING

    @property
    def frequency(self) -> float:
        """Frequency of the last full cycle, in sqrt(k/m) [-]; of a lone stroke done twice."""
        last = [float(stroke.duration) for stroke in (self.strokes * 2)[-2:]]
        return 1.0 / sum(last)

    def path(self, count: int = 201) -> Path:
        """Time, position, velocity and acceleration, `count` points or more in every stroke."""
        begin, parts = 0.0, []
        for stroke in self.strokes:
            x = stroke.positions(count)
            parts.append((begin + stroke.time(x), x, stroke.velocity(x), stroke.acceleration(x)))
            begin += float(stroke.duration)
        return Path(*(np.concatenate(column) for column in zip(*parts, strict=True)))


@checked(system=a(System), start=SCALAR, strokes=whole(0))
def march(system: System, start: float, strokes: int = 200) -> History:
    """Follow an engine from dead centre to dead centre, in closed form.

    Parameters
    ----------
    system : System
    start : float
        Left dead centre at which it starts at rest, x_l* [-]. The charge there burns whatever
        the ignition.
    strokes : int
        How many at most; it ends earlier once it has run away or decayed.

    Returns
    -------
    History

    Raises
    ------
    OutsideModel
        If `start` is not between -1 and 0.

    Examples
    --------
    >>> from saleg.fundamental import ConstantLoad
    >>> print(march(System(pressure=0.5, heat=1.0, load=ConstantLoad(0.30)), -0.5).outcome)
    runaway
    >>> print(march(System(pressure=0.5, heat=1.0, load=ConstantLoad(0.42)), -0.5).outcome)
    decay
    """
    done = [system.stroke(start)]
    while len(done) < strokes and not _is_over(done[-1]):
        done.append(done[-1].next())
    return History(tuple(done))


@checked(system=a(System))
def return_map(system: System, depth: Any) -> Any:
    """Depth at the end of a stroke over that at its beginning, beyond the first stroke.

    Parameters
    ----------
    system : System
    depth : array_like
        Distance of the dead centre from the midpoint [-], between 0 and 1.

    Returns
    -------
    ndarray or float
        Distance of the next one; almost 1 at the head, not positive if the midpoint is not passed.

    Raises
    ------
    OutsideModel
        If `depth` is not between 0 and 1.
    """
    require(depth=(depth, DEPTH))
    return from_depth(system, np.asarray(depth, dtype=float)).depth


def from_depth(system: System, depth: Any) -> Stroke:
    """Stroke to the right within an engine's life, from `depth` left of the midpoint [-]."""
    pressure = system.ignition.pressure_at_dead_centre(system, depth)
    return Stroke(system, -depth, 1.0, pressure, system.load.for_stroke(system, depth))


def _is_over(stroke: Stroke) -> bool:
    return bool(stroke.depth < DECAYED or stroke.depth > RUNAWAY_DEPTH)
