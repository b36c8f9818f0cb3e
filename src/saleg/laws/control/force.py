"""Control of the alternator's force within the stroke."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import ForceCommand, Instant
from saleg.laws.control.base import ForceControl
from saleg.laws.usual import FREQUENCY, LAG, SMALL_FORCE
from saleg.quantities import quantity

#: Places of a memory: position and velocity tracked, whether they are; direction of the push and
#: when it began.
POSITION, VELOCITY, TRACKS, WAY, SINCE = range(5)


@dataclass(frozen=True, kw_only=True)
class PushAlong(ForceControl):
    """Push along the motion with a constant force, wherever the resonance is.

    Force in phase with the velocity feeds the motion at every instant, so it grows at its own
    frequency until friction takes as much: there is no frequency to be searched. The velocity comes
    from the measured position alone. While the state logic decides on a motor, this is the motor.

    Parameters
    ----------
    limit : float
        Force [N].
    time_constant : float
        Of the filter that turns positions into a velocity [s], see :func:`tracked_velocity`.
    threshold : float
        Velocity against the push at which it turns round [m/s]; above the noise of the filter.
    lowest_frequency : float
        A push that nothing has answered turns round after half a period of this [Hz].
    """

    limit: float = quantity("N", default=264.0, low=0, usual=SMALL_FORCE)
    time_constant: float = quantity("s", default=4e-4, low=0, open_low=True, usual=LAG)
    threshold: float = quantity("m/s", default=0.05, low=0)
    lowest_frequency: float = quantity("Hz", default=5.0, low=0, open_low=True, usual=FREQUENCY)

    def push(self, memory: Any, instant: Instant) -> ForceCommand:
        """Force until the next sample; holds the motion tracked and the direction of the push."""
        v = tracked_velocity(memory, instant.x, instant.sample_time, self.time_constant)
        if instant.motoring == 0.0:
            memory[WAY] = 0.0
            return ForceCommand(0.0, 0.0)
        unanswered = instant.t - memory[SINCE] > 0.5 / self.lowest_frequency
        if memory[WAY] == 0.0:
            way = -1.0 if v < 0.0 else 1.0
        elif memory[WAY] * v < -self.threshold or unanswered:
            way = -memory[WAY]
        else:
            way = memory[WAY]
        if way != memory[WAY]:
            memory[WAY], memory[SINCE] = way, instant.t
        return ForceCommand(1.0, way * self.limit)


def tracked_velocity(
    memory: Any, x: float, sample_time: float, time_constant: float, acceleration: float = 0.0
) -> float:
    """Velocity [m/s] from measured positions, by a critically damped g-h filter.

    It is the steady Kalman filter of a motion with constant velocity whose noise makes both poles
    ``exp(-sample_time / time_constant)`` (Brookner, Tracking and Kalman Filtering Made Easy, 1998,
    1.2); a sine comes out late by ``2 arctan(2 pi f time_constant)``, unless its acceleration is
    told.

    Parameters
    ----------
    memory : array
        Its first three numbers are the filter's [m, m/s, -]; zero at first.
    x : float
        Position measured [m].
    sample_time : float
        Time since the sample before [s].
    time_constant : float
        Of both poles [s].
    acceleration : float
        What is known of it since the sample before [m/s^2].
    """
    if memory[TRACKS] == 0.0:
        memory[POSITION], memory[VELOCITY], memory[TRACKS] = x, 0.0, 1.0
        return 0.0
    pole = math.exp(-sample_time / time_constant)
    gained = sample_time * acceleration
    expected = memory[POSITION] + sample_time * (memory[VELOCITY] + 0.5 * gained)
    error = x - expected
    memory[POSITION] = expected + (1.0 - pole * pole) * error
    memory[VELOCITY] += gained + (1.0 - pole) * (1.0 - pole) * error / sample_time
    return memory[VELOCITY]
