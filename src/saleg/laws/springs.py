"""Springs between translator and housing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.arguments import Motion
from saleg.laws.base import Springs
from saleg.laws.interpolation import linear, linear_integral, next_point
from saleg.laws.usual import FORCE, GAS_PRESSURE, LENGTH, STIFFNESS, STOP_STIFFNESS
from saleg.quantities import quantity, series


@dataclass(frozen=True)
class LinearSprings(Springs):
    """A symmetric pair of linear springs (Eq. 41-42): ``F = -2 k x``.

    Parameters
    ----------
    stiffness : float
        Stiffness k of one spring [N/m].
    """

    mirrors: ClassVar[bool] = True

    stiffness: float = quantity("N/m", default=30e3, low=0, usual=STIFFNESS)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N], Eq. 42."""
        return -2.0 * self.stiffness * motion.x

    def energy(self, motion: Motion) -> float:
        """Energy stored in both springs [J]."""
        return self.stiffness * motion.x * motion.x


@dataclass(frozen=True)
class ProgressiveSprings(Springs):
    """A symmetric pair of springs with any stiffness profile, the same to either side.

    ``F = -2 sign(x) integral of k(s) ds from 0 to |x|``, k piecewise linear in the deflection and
    constant beyond its ends.

    Parameters
    ----------
    deflections : tuple of float
        Deflections from the midpoint, rising [m].
    stiffnesses : tuple of float
        Tangent stiffness of one spring there [N/m].
    """

    deflections: tuple[float, ...] = series(
        "m", default=(0.0, 0.1), low=0, rising=True, usual=LENGTH
    )
    stiffnesses: tuple[float, ...] = series(
        "N/m", default=(30e3, 45e3), low=0, length="deflections", usual=STIFFNESS
    )

    def force(self, motion: Motion) -> float:
        """Force on the translator [N]."""
        pull = 2.0 * linear_integral(abs(motion.x), self.deflections, self.stiffnesses)
        return -math.copysign(pull, motion.x)

    def energy(self, motion: Motion) -> float:
        """Energy stored in both springs [J]: the force is quadratic between the points."""
        reach = abs(motion.x)
        total, start = 0.0, 0.0
        for i in range(len(self.deflections) + 1):
            end = min(self.deflections[i], reach) if i < len(self.deflections) else reach
            width = end - start
            if width > 0.0:
                force = 2.0 * linear_integral(start, self.deflections, self.stiffnesses)
                k0 = 2.0 * linear(start, self.deflections, self.stiffnesses)
                k1 = 2.0 * linear(end, self.deflections, self.stiffnesses)
                total += width * (force + width * (k0 / 3.0 + k1 / 6.0))
                start = end
        return total

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position at which the stiffness has a corner [m]."""
        right = next_point(x, direction, self.deflections)
        left = -next_point(-x, -direction, self.deflections)
        return right if direction * (right - left) < 0.0 else left


@dataclass(frozen=True)
class PreloadedSprings(Springs):
    """Two springs that push against each other and lift off where one has no load left.

    Within ``|x| < preload / k`` both act, ``F = -2 k x``; beyond, one alone:
    ``F = -sign(x) (preload + k |x|)``. Without preload there is always just one: ``F = -k x``.

    Parameters
    ----------
    stiffness : float
        Stiffness k of one spring [N/m].
    preload : float
        Force in each spring at the midpoint [N].
    """

    stiffness: float = quantity("N/m", default=30e3, low=0, usual=STIFFNESS)
    preload: float = quantity("N", default=3e3, low=0, usual=FORCE)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N]."""
        left = max(self.preload - self.stiffness * motion.x, 0.0)
        right = max(self.preload + self.stiffness * motion.x, 0.0)
        return left - right

    def energy(self, motion: Motion) -> float:
        """Energy stored in both springs [J], above that at the midpoint.

        From ``(F_left^2 + F_right^2) / 2k``, in a form that is exact without stiffness too.
        """
        pull = self.stiffness * abs(motion.x)
        if pull <= self.preload:
            return pull * abs(motion.x)
        both = self.preload * self.preload / self.stiffness
        rest = abs(motion.x) - self.preload / self.stiffness
        return both + rest * (2.0 * self.preload + 0.5 * self.stiffness * rest)

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position at which a spring touches or lifts off [m]."""
        reach = self.preload / self.stiffness if self.stiffness > 0.0 else math.inf
        return next_point(x, direction, (-reach, reach))


@dataclass(frozen=True)
class OneSidedSprings(Springs):
    """A spring at either end that only pushes, from the position on at which it touches.

    ``F = k_l max(x_l - x, 0) - k_r max(x - x_r, 0)``; one alone leaves the other's stiffness at 0.

    Parameters
    ----------
    left_stiffness, right_stiffness : float
        Stiffness k of the spring at that end [N/m].
    left_contact, right_contact : float
        Position of the translator at which it begins to push [m].
    """

    left_stiffness: float = quantity("N/m", default=0.0, low=0, usual=STIFFNESS)
    right_stiffness: float = quantity("N/m", default=0.0, low=0, usual=STIFFNESS)
    left_contact: float = quantity("m", default=0.0)
    right_contact: float = quantity("m", default=0.0)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N]."""
        left = self.left_stiffness * max(self.left_contact - motion.x, 0.0)
        return left - self.right_stiffness * max(motion.x - self.right_contact, 0.0)

    def energy(self, motion: Motion) -> float:
        """Energy stored in both springs [J]."""
        left = max(self.left_contact - motion.x, 0.0)
        right = max(motion.x - self.right_contact, 0.0)
        return 0.5 * (self.left_stiffness * left * left + self.right_stiffness * right * right)

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position at which a spring touches or lifts off [m]."""
        left = next_point(x, direction, (self.left_contact,))
        right = next_point(x, direction, (self.right_contact,))
        return right if direction * (right - left) < 0.0 else left


def _rooms(s: float) -> tuple[float, float]:
    """Volumes left and right over those at the midpoint; a trial step may go beyond their ends."""
    return max(1.0 + s, 1e-6), max(1.0 - s, 1e-6)


@dataclass(frozen=True)
class AirSprings(Springs):
    """Two sealed volumes of air that push against each other, beside the cylinders (3.2, 4.4).

    ``F = A p [(L/(L+x))^n - (L/(L-x))^n]``: each is compressed along a polytrope and loses nothing.

    Parameters
    ----------
    area : float
        Area of each piston A [m^2].
    length : float
        Length L of each volume with the translator at its midpoint [m]; the translator must stay
        within.
    pressure : float
        Pressure p in both there [Pa].
    exponent : float
        Polytropic exponent n [-].
    """

    mirrors: ClassVar[bool] = True

    area: float = quantity("m^2", default=3e-3, low=0)
    length: float = quantity("m", default=0.07, low=0, open_low=True, usual=LENGTH)
    pressure: float = quantity("Pa", default=1e5, low=0, usual=GAS_PRESSURE)
    exponent: float = quantity("-", default=1.4, low=1, open_low=True)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N]."""
        left, right = _rooms(motion.x / self.length)
        n = self.exponent
        return self.area * self.pressure * (left**-n - right**-n)

    def energy(self, motion: Motion) -> float:
        """Energy stored in both volumes [J], above that at the midpoint."""
        left, right = _rooms(motion.x / self.length)
        m = self.exponent - 1.0
        rise = left**-m + right**-m - 2.0
        return self.area * self.pressure * self.length / m * rise


@dataclass(frozen=True)
class EndStops(Springs):
    """Linear springs and an elastic stop at either end.

    ``F = -2 k x``, and beyond the stops ``-k_stop (|x| - gap)`` more. The stops give back what they
    take.

    Parameters
    ----------
    stiffness : float
        Stiffness k of one spring [N/m].
    gap : float
        Distance of the stops from the midpoint [m].
    stop_stiffness : float
        Stiffness of a stop [N/m].
    """

    stiffness: float = quantity("N/m", default=30e3, low=0, usual=STIFFNESS)
    gap: float = quantity("m", default=0.095, low=0, usual=LENGTH)
    stop_stiffness: float = quantity("N/m", default=10e6, low=0, usual=STOP_STIFFNESS)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N]."""
        beyond = max(abs(motion.x) - self.gap, 0.0)
        stop = math.copysign(self.stop_stiffness * beyond, motion.x)
        return -2.0 * self.stiffness * motion.x - stop

    def energy(self, motion: Motion) -> float:
        """Energy stored in springs and stops [J]."""
        beyond = max(abs(motion.x) - self.gap, 0.0)
        stop = 0.5 * self.stop_stiffness * beyond * beyond
        return self.stiffness * motion.x * motion.x + stop

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position at which a stop is met or left [m]."""
        return next_point(x, direction, (-self.gap, self.gap))
