"""Cyclic variability: fuel, ignition and combustion that differ from charge to charge."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.base import Scatter
from saleg.quantities import quantity

# What the draws of a charge are for; each has a sequence of its own.
FUEL, DELAY, DURATION = 1, 2, 3
# No draw is farther from the mean than so many standard deviations.
FARTHEST = 3.0
WORD = 0xFFFFFFFF


def scrambled(word: int) -> int:
    """A word of 32 bits that depends on all bits of another one; the products fit 64 bits."""
    word = (((word >> 16) ^ word) * 0x45D9F3B) & WORD
    word = (((word >> 16) ^ word) * 0x45D9F3B) & WORD
    return (word >> 16) ^ word


def uniform(seed: float, charge_number: float, side: float, purpose: int, draw: int) -> float:
    """A number between 0 and 1, ends left out, that depends on nothing but the arguments."""
    word = scrambled((int(seed) + 0x3C6EF372) & WORD)
    word = scrambled(word ^ (int(charge_number) & WORD))
    word = scrambled(word ^ (8 * purpose + 2 * draw + int(side) + 0x1F83D9AB))
    return (word + 0.5) / 4294967296.0


def normal(seed: float, charge_number: float, side: float, purpose: int) -> float:
    """A standard normal number (Box and Muller), limited to three standard deviations."""
    radius = math.sqrt(-2.0 * math.log(uniform(seed, charge_number, side, purpose, 0)))
    angle = 2.0 * math.pi * uniform(seed, charge_number, side, purpose, 1)
    return min(max(radius * math.cos(angle), -FARTHEST), FARTHEST)


@dataclass(frozen=True)
class NoScatter(Scatter):
    """Every charge is as metered."""


@dataclass(frozen=True, kw_only=True)
class CyclicVariability(Scatter):
    """Normal scatter of fuel, ignition delay and combustion duration, from charge to charge.

    Each charge has draws of its own, which depend on the seed, its number and its side alone: a run
    is the same whatever runs beside it, and can be done again from any snapshot.

    Parameters
    ----------
    seed : float
        A whole number; another one gives other draws [-].
    fuel : float
        Standard deviation of the fuel metered, over its mean [-].
    delay : float
        Standard deviation of the ignition delay, over its mean [-].
    duration : float
        Standard deviation of the combustion duration, over its mean [-].

    Examples
    --------
    >>> law = CyclicVariability(fuel=0.05)
    >>> law.fuel_factor(7.0, 0.0) == law.fuel_factor(7.0, 0.0) != law.fuel_factor(8.0, 0.0)
    True
    >>> law.delay_factor(7.0, 0.0)
    1.0
    """

    seed: float = quantity("-", default=0, low=0, high=2**31 - 1, whole=True)
    fuel: float = quantity("-", default=0.0, low=0, high=0.3)
    delay: float = quantity("-", default=0.0, low=0, high=0.3)
    duration: float = quantity("-", default=0.0, low=0, high=0.3)

    def fuel_factor(self, charge_number: float, side: float) -> float:
        """Fuel metered to a charge over its mean [-]."""
        return 1.0 + self.fuel * normal(self.seed, charge_number, side, FUEL)

    def delay_factor(self, charge_number: float, side: float) -> float:
        """Ignition delay of a charge over its mean [-]."""
        return 1.0 + self.delay * normal(self.seed, charge_number, side, DELAY)

    def duration_factor(self, charge_number: float, side: float) -> float:
        """Combustion duration of a charge over its mean [-]."""
        return 1.0 + self.duration * normal(self.seed, charge_number, side, DURATION)
