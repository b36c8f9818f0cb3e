"""Control of the load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import Signals
from saleg.laws.control.base import LoadControl
from saleg.laws.profiles import at_time
from saleg.laws.usual import LENGTH, POWER, TIME
from saleg.quantities import quantity, series


@dataclass(frozen=True)
class StrokeRegulator(LoadControl):
    """The alternator's own regulator (Eq. 59) alone; no load while it is a motor."""

    def weight(self, memory: Any, signals: Signals) -> float:
        """Load weight [-], Eq. 59."""
        return 0.0 if signals.motoring > 0.0 else signals.regulated_weight


@dataclass(frozen=True, kw_only=True)
class DeadCentreRegulator(LoadControl):
    """Load that holds one dead centre: a piston that comes too near to its head is braked more.

    ``W = 1 - K_p e - K_i (integral of e)`` with ``e = 1 - d / d_target``, d the distance of the
    dead centre from the midpoint. The integral stands still while W is at a limit and e would
    drive it further, and while the alternator is a motor.

    Parameters
    ----------
    distance : float
        Distance d_target from the midpoint at which the dead centre is to be [m].
    right : float
        1 for the right dead centre, 0 for the left one [-].
    proportional_gain : float
        K_p [-].
    integral_gain : float
        K_i [1/s].
    maximum_weight : float
        Largest load weight [-].
    """

    distance: float = quantity("m", default=0.09, low=0, open_low=True, usual=LENGTH)
    right: float = quantity("-", default=0.0, low=0, high=1)
    proportional_gain: float = quantity("-", default=5.0, low=0)
    integral_gain: float = quantity("1/s", default=20.0, low=0)
    maximum_weight: float = quantity("-", default=2.0, low=0)

    def weight(self, memory: Any, signals: Signals) -> float:
        """Load weight [-]; holds the integral of the error, and its time."""
        elapsed = signals.t - memory[1]
        memory[1] = signals.t
        if signals.motoring > 0.0:
            return 0.0
        reached = signals.x_right if self.right > 0.0 else -signals.x_left
        error = 1.0 - reached / self.distance
        gathered = memory[0] + (error * elapsed if signals.was_motoring == 0.0 else 0.0)
        weight = 1.0 - self.proportional_gain * error - self.integral_gain * gathered
        if 0.0 <= weight <= self.maximum_weight or (weight < 0.0) == (error < 0.0):
            memory[0] = gathered
        return min(max(weight, 0.0), self.maximum_weight)


@dataclass(frozen=True, kw_only=True)
class ScaledLoad(LoadControl):
    """The regulated load times a factor over time (Fig. 107).

    Parameters
    ----------
    times : tuple of float
        Times, never falling [s]; two equal ones make a step.
    factors : tuple of float
        Factor at those times [-], constant before and after.
    """

    times: tuple[float, ...] = series("s", default=(2.0, 4.0), never_falling=True, usual=TIME)
    factors: tuple[float, ...] = series("-", default=(1.0, 2.0), low=0, length="times")

    def weight(self, memory: Any, signals: Signals) -> float:
        """Load weight [-]."""
        if signals.motoring > 0.0:
            return 0.0
        return at_time(signals.t, self.times, self.factors) * signals.regulated_weight


@dataclass(frozen=True, kw_only=True)
class PowerDemand(LoadControl):
    """Weighted mean of the stroke regulator and a PI controller on power (5.2): P+PI.

    ``W = (1 - w) W_A + w (1 + K_p e + K_i (integral of e))`` with the regulator's W_A (Eq. 59) and
    ``e = (P_demand - P) / P_rated``. The integral stands still while W is at a limit and e would
    drive it further, and while the alternator is a motor.

    Parameters
    ----------
    share : float
        Weight w of the command on power in the mean [-]; the dissertation does not give it.
    proportional_gain : float
        K_p [-].
    integral_gain : float
        K_i [1/s].
    rated_power : float
        P_rated [W].
    times : tuple of float
        Times of the demand, never falling [s]; two equal ones make a step.
    demands : tuple of float
        Power demanded at those times [W], constant before and after.
    maximum_weight : float
        Largest load weight [-].
    """

    share: float = quantity("-", default=0.5, low=0, high=1)
    proportional_gain: float = quantity("-", default=0.1, low=0)
    integral_gain: float = quantity("1/s", default=1.0, low=0)
    rated_power: float = quantity("W", default=3800.0, low=0, open_low=True, usual=POWER)
    times: tuple[float, ...] = series("s", default=(2.0, 2.0), never_falling=True, usual=TIME)
    demands: tuple[float, ...] = series(
        "W", default=(3800.0, 1800.0), low=0, length="times", usual=POWER
    )
    maximum_weight: float = quantity("-", default=1.1, low=0)

    def weight(self, memory: Any, signals: Signals) -> float:
        """Load weight [-]; holds the integral of the error, and its time."""
        elapsed = signals.t - memory[1]
        memory[1] = signals.t
        if signals.motoring > 0.0:
            return 0.0
        error = (at_time(signals.t, self.times, self.demands) - signals.power) / self.rated_power
        fired = signals.was_motoring == 0.0
        gathered = memory[0] + (error * elapsed if fired else 0.0)
        demanded = 1.0 + self.proportional_gain * error + self.integral_gain * gathered
        mean = (1.0 - self.share) * signals.regulated_weight + self.share * demanded
        within = 0.0 <= mean <= self.maximum_weight
        if within or (mean > self.maximum_weight) == (error < 0.0):
            memory[0] = gathered
        return min(max(mean, 0.0), self.maximum_weight)
