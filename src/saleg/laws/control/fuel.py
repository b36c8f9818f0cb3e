"""Control of the fuel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import Signals
from saleg.laws.control.actuators import lagging
from saleg.laws.control.base import FuelControl
from saleg.laws.interpolation import linear
from saleg.laws.profiles import at_time
from saleg.laws.usual import LAG, POWER, TIME
from saleg.quantities import quantity, series


@dataclass(frozen=True)
class RatedFuel(FuelControl):
    """The engine's own equivalence ratio, and no fuel while the alternator is a motor (5.1)."""

    def equivalence_ratio(self, memory: Any, signals: Signals) -> float:
        """Equivalence ratio [-]."""
        return 0.0 if signals.motoring > 0.0 else signals.rated_equivalence_ratio


@dataclass(frozen=True)
class NoFuel(FuelControl):
    """No fuel at all."""

    def equivalence_ratio(self, memory: Any, signals: Signals) -> float:
        """Equivalence ratio [-]: zero."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class FuelCut(FuelControl):
    """Rated fuel, cut for some strokes in a row (5.3).

    Each stroke composes one charge, so as many charges go without.

    Parameters
    ----------
    at : float
        The first stroke without begins at the first dead centre from here on [s].
    strokes : float
        How many strokes go without [-]; a large number for ever.
    """

    at: float = quantity("s", default=1.5, low=0, usual=TIME)
    strokes: float = quantity("-", default=1.0, low=0)

    def equivalence_ratio(self, memory: Any, signals: Signals) -> float:
        """Equivalence ratio [-]; holds the number of strokes since the cut, and the direction."""
        begins = signals.direction != memory[1]
        memory[1] = signals.direction
        if begins and signals.t >= self.at:
            memory[0] += 1.0
        if 0.0 < memory[0] <= self.strokes:
            return 0.0
        return 0.0 if signals.motoring > 0.0 else signals.rated_equivalence_ratio


@dataclass(frozen=True, kw_only=True)
class FuelOnDemand(FuelControl):
    """Equivalence ratio by an integral controller on the compression ratio (5.2).

    The map (Fig. 104) turns the power demanded into a compression ratio, clipped at its ends; what
    is missing is integrated, ``phi = phi_rated + K (integral of CR_target - CR)``, within limits.

    Parameters
    ----------
    gain : float
        K [1/s].
    powers : tuple of float
        Powers of the map, rising [W].
    compression_ratios : tuple of float
        Compression ratios the engine settles at with those powers [-].
    times, demands : tuple of float
        Power demanded [W] over time [s], as for :class:`saleg.laws.PowerDemand`.
    lowest, highest : float
        Limits of the equivalence ratio [-].
    """

    gain: float = quantity("1/s", default=0.3, low=0)
    powers: tuple[float, ...] = series(
        "W", default=(1800.0, 3800.0), low=0, rising=True, usual=POWER
    )
    compression_ratios: tuple[float, ...] = series(
        "-", default=(12.0, 18.0), low=1, length="powers"
    )
    times: tuple[float, ...] = series("s", default=(2.0, 2.0), never_falling=True, usual=TIME)
    demands: tuple[float, ...] = series(
        "W", default=(3800.0, 1800.0), low=0, length="times", usual=POWER
    )
    lowest: float = quantity("-", default=0.1, low=0)
    highest: float = quantity("-", default=0.7, low=0)

    def equivalence_ratio(self, memory: Any, signals: Signals) -> float:
        """Equivalence ratio [-]; holds its distance from the rated one, and the time."""
        elapsed = signals.t - memory[1]
        memory[1] = signals.t
        if signals.motoring > 0.0:
            return 0.0
        demand = at_time(signals.t, self.times, self.demands)
        target = linear(demand, self.powers, self.compression_ratios)
        rated = signals.rated_equivalence_ratio
        if signals.was_motoring == 0.0:
            memory[0] += self.gain * (target - signals.compression_ratio) * elapsed
            memory[0] = min(max(memory[0], self.lowest - rated), self.highest - rated)
        return rated + memory[0]


@dataclass(frozen=True, kw_only=True)
class MappedFuel(FuelControl):
    """Equivalence ratio from a map over power, and what is missing by an integral controller.

    ``phi = phi_map(P_demand) + K (integral of P_demand - P) / P_last`` within limits, P_last the
    greatest power of the map, which is clipped at its ends. The demand is followed with a lag: a
    leaner charge at once takes away more than the load, which is regulated once per
    stroke, gives back. The integral stands still while the alternator is a motor. Goes with
    :class:`MappedIntake` on the same map.

    Parameters
    ----------
    gain : float
        K [1/s].
    lag : float
        Time constant with which the demand is followed [s]; 0 follows at once.
    powers : tuple of float
        Powers of the map, rising [W].
    equivalence_ratios : tuple of float
        Equivalence ratios that go with them [-].
    times, demands : tuple of float
        Power demanded [W] over time [s], as for :class:`saleg.laws.PowerDemand`.
    lowest, highest : float
        Limits of the equivalence ratio [-].
    """

    gain: float = quantity("1/s", default=0.3, low=0)
    lag: float = quantity("s", default=0.0, low=0, usual=LAG)
    powers: tuple[float, ...] = series(
        "W", default=(1800.0, 3800.0), low=0, rising=True, usual=POWER
    )
    equivalence_ratios: tuple[float, ...] = series("-", default=(0.3, 0.65), low=0, length="powers")
    times: tuple[float, ...] = series("s", default=(2.0, 2.0), never_falling=True, usual=TIME)
    demands: tuple[float, ...] = series(
        "W", default=(3800.0, 1800.0), low=0, length="times", usual=POWER
    )
    lowest: float = quantity("-", default=0.1, low=0)
    highest: float = quantity("-", default=0.7, low=0)

    def equivalence_ratio(self, memory: Any, signals: Signals) -> float:
        """Equivalence ratio [-]; holds its distance from the map, time and lagging demand."""
        elapsed = signals.t - memory[1]
        memory[1] = signals.t
        demand = at_time(signals.t, self.times, self.demands)
        if memory[3] > 0.0:
            demand = lagging(memory[2], demand, elapsed, self.lag)
        memory[2], memory[3] = demand, 1.0
        if signals.motoring > 0.0:
            return 0.0
        planned = linear(demand, self.powers, self.equivalence_ratios)
        if signals.was_motoring == 0.0:
            missing = (demand - signals.power) / self.powers[len(self.powers) - 1]
            memory[0] += self.gain * missing * elapsed
            memory[0] = min(max(memory[0], self.lowest - planned), self.highest - planned)
        return min(max(planned + memory[0], self.lowest), self.highest)
