"""Sensor of the position, as a controller that acts within the stroke reads it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from saleg.laws.control.base import PositionSensorLaw
from saleg.laws.usual import GAP
from saleg.quantities import quantity

#: Places of the memory a sensor of :class:`PositionSensor` keeps late positions in.
FIRST, PLACES = 4, 16
#: Modulus of the random numbers, and their multiplier (Park, Miller, Stockmeyer, CACM 36(7), 1993):
#: all products are whole numbers below 2^53, exact as floats.
MODULUS, MULTIPLIER = 2147483647.0, 48271.0


@dataclass(frozen=True, kw_only=True)
class PositionSensor(PositionSensorLaw):
    """Position with noise, resolution and delay.

    Parameters
    ----------
    sample_time : float
        Time between two samples [s].
    noise : float
        Standard deviation of a sample [m].
    resolution : float
        Step of the position [m]; 0 for none.
    delay : int
        By how many samples it is late, a whole number [-].
    seed : int
        Of the noise; equal seeds give equal noise [-].
    """

    sample_time: float = quantity("s", default=5e-5, low=1e-7, high=1.0, usual=(1e-6, 0.01))
    noise: float = quantity("m", default=0.0, low=0, usual=GAP)
    resolution: float = quantity("m", default=0.0, low=0, usual=GAP)
    delay: int = quantity("-", default=0, low=0, high=PLACES - 1, whole=True)
    seed: int = quantity("-", default=0, low=0, high=1_000_000_000, whole=True)

    def measured(self, memory: Any, x: float) -> float:
        """Position measured [m]; holds what is late and where the random numbers are."""
        if self.noise > 0.0:
            x += self.noise * normal_number(memory, self.seed)
        if self.resolution > 0.0:
            x = self.resolution * math.floor(x / self.resolution + 0.5)
        count = memory[1]
        memory[1] = count + 1.0
        memory[FIRST + int(count % PLACES)] = x
        return memory[FIRST + int((count - min(self.delay, count)) % PLACES)]


def normal_number(memory: Any, seed: float) -> float:
    """Next number of a standard normal distribution (Box and Muller); memory[0] holds the place."""
    if memory[0] == 0.0:
        memory[0] = 1.0 + seed
        for _ in range(4):  # seeds side by side begin far apart
            memory[0] = MULTIPLIER * memory[0] % MODULUS
    first = MULTIPLIER * memory[0] % MODULUS
    memory[0] = MULTIPLIER * first % MODULUS
    return math.sqrt(-2.0 * math.log(first / MODULUS)) * math.cos(
        2.0 * math.pi * memory[0] / MODULUS
    )
