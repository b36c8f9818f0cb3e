"""Control of the alternator's force that tracks a trajectory within the stroke."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import ForceCommand, Instant
from saleg.laws.control.base import ForceControl
from saleg.laws.control.force import POSITION, tracked_velocity
from saleg.laws.interpolation import linear
from saleg.laws.usual import LAG, LENGTH, SMALL_FORCE
from saleg.quantities import quantity, series

#: Places of a memory after those of the tracked motion: acceleration expected until the next
#: sample, energies on the way left and right that misses have taught to add to the reference, and,
#: so many places on, the latest dead centres.
ACCELERATION, LEFT, RIGHT, SEEN = 3, 4, 5, 2
#: A dead centre that misses by more teaches no more than this [m]: its charge has failed.
FARTHEST_MISS = 2e-4


@dataclass(frozen=True, kw_only=True)
class TrajectoryTracking(ForceControl):
    """Track the motion of a steady state by energy, so that each stroke ends at its dead centre.

    At every sample the kinetic energy is compared with that of the reference at the same place on
    the same way, ``dE = m v^2 / 2 - E(x)``. The force of the alternator is that of the reference,
    its load, and against the motion ``gain dE / (way left to the dead centre)``: unless it is
    limited, dE falls as the way left to the power `gain`. What a charge has given too little or too
    much is so made up for before the stroke ends. What misses a dead centre again and again is
    learnt. While the state logic decides on a motor, the alternator is left to it.

    The velocity comes from the measured position by :func:`tracked_velocity`, which is told the
    acceleration of the reference. :func:`saleg.control.trajectory_tracking` makes one for a steady
    state.

    Parameters
    ----------
    mass : float
        Moving mass m [kg].
    positions : tuple of float
        Positions from left to right dead centre of the reference, rising [m].
    energies_right, energies_left : tuple of float
        Kinetic energy E of the reference there, on the way right and on the way left [J].
    resultants_right, resultants_left : tuple of float
        Force that accelerates it there, of all forces together [N].
    forces_right, forces_left : tuple of float
        Force of the alternator on it there [N].
    gain : float
        Power of the way left with which a deviation falls [-].
    least_way : float
        Shortest way left that counts [m].
    limit : float
        Largest force beside that of the reference [N].
    learning : float
        Share of a miss that the next stroke to the same side aims off by [-].
    time_constant : float
        Of the filter that turns positions into a velocity [s].
    delay : float
        Age of a position at the middle of the time for which its force acts [s].
    """

    mass: float = quantity("kg", default=5.0, low=0, open_low=True)
    positions: tuple[float, ...] = series("m", default=(-0.04, 0.04), rising=True, at_least=2)
    energies_right: tuple[float, ...] = series("J", default=(0.0, 0.0), length="positions")
    energies_left: tuple[float, ...] = series("J", default=(0.0, 0.0), length="positions")
    resultants_right: tuple[float, ...] = series("N", default=(0.0, 0.0), length="positions")
    resultants_left: tuple[float, ...] = series("N", default=(0.0, 0.0), length="positions")
    forces_right: tuple[float, ...] = series("N", default=(0.0, 0.0), length="positions")
    forces_left: tuple[float, ...] = series("N", default=(0.0, 0.0), length="positions")
    gain: float = quantity("-", default=3.0, low=0)
    least_way: float = quantity("m", default=0.003, low=0, open_low=True, usual=LENGTH)
    limit: float = quantity("N", default=1000.0, low=0, usual=SMALL_FORCE)
    learning: float = quantity("-", default=0.05, low=0, high=1)
    time_constant: float = quantity("s", default=1.5e-4, low=0, open_low=True, usual=LAG)
    delay: float = quantity("s", default=2.5e-5, low=0)

    def push(self, memory: Any, instant: Instant) -> ForceCommand:
        """Force until the next sample; holds the motion tracked and what has been learnt."""
        a = memory[ACCELERATION]
        v = tracked_velocity(memory, instant.x, instant.sample_time, self.time_constant, a)
        if instant.motoring != 0.0:
            memory[ACCELERATION] = 0.0
            return ForceCommand(0.0, 0.0)
        x = memory[POSITION] + self.delay * (v + 0.5 * self.delay * a)
        v += self.delay * a
        grid = self.positions
        learn(memory, LEFT, instant.x_left, grid[0], self.learning * self.resultants_left[0])
        learn(memory, RIGHT, instant.x_right, grid[-1], self.learning * self.resultants_right[-1])
        if v >= 0.0:
            way, left = 1.0, grid[-1] - x
            energy = energy_at(x, grid, self.energies_right, self.resultants_right) + memory[RIGHT]
            resultant = linear(x, grid, self.resultants_right)
            force = linear(x, grid, self.forces_right)
        else:
            way, left = -1.0, x - grid[0]
            energy = energy_at(x, grid, self.energies_left, self.resultants_left) + memory[LEFT]
            resultant = linear(x, grid, self.resultants_left)
            force = linear(x, grid, self.forces_left)
        beside = 0.5 * self.mass * v * v - energy
        wanted = -way * self.gain * beside / max(left, self.least_way)
        correction = min(max(wanted, -self.limit), self.limit)
        memory[ACCELERATION] = (resultant + correction) / self.mass
        return ForceCommand(1.0, force + correction)


def energy_at(
    x: float, grid: Sequence[float], energies: Sequence[float], resultants: Sequence[float]
) -> float:
    """Kinetic energy of a reference [J]; beyond its ends, where it is missing, less than none."""
    beyond = x - min(max(x, grid[0]), grid[-1])
    return linear(x, grid, energies) + beyond * linear(x, grid, resultants)


def learn(memory: Any, side: int, x: float, goal: float, share: float) -> None:
    """Change what is to be aimed at on a side [J] by where a new dead centre is [m].

    `share` is the force at the dead centre, times the share of a miss that is made up for [N].
    """
    before = memory[side + SEEN]
    if x != before and before != 0.0:
        memory[side] += share * min(max(x - goal, -FARTHEST_MISS), FARTHEST_MISS)
    memory[side + SEEN] = x
