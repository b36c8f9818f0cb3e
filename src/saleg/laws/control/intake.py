"""Control of the intake temperature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import Signals
from saleg.laws.control.base import IntakeControl
from saleg.laws.interpolation import linear
from saleg.laws.profiles import at_time
from saleg.laws.usual import COMMANDED_TEMPERATURE, POWER, TIME
from saleg.quantities import quantity, series


@dataclass(frozen=True)
class RatedIntake(IntakeControl):
    """The engine's own intake temperature."""

    def temperature(self, memory: Any, signals: Signals) -> float:
        """Intake temperature [K]."""
        return signals.rated_intake_temperature


@dataclass(frozen=True, kw_only=True)
class HeatedIntake(IntakeControl):
    """Intake temperature by an integral controller on the compression ratio (5.2).

    The map (Fig. 101) turns the power demanded into a compression ratio, clipped at its ends; what
    is beyond that is integrated, ``T = T_rated + K (integral of CR - CR_target)``, within limits: a
    warmer intake lights earlier and compresses less. It stands still while the alternator is a
    motor.

    Parameters
    ----------
    gain : float
        K [K/s].
    powers : tuple of float
        Powers of the map, rising [W].
    compression_ratios : tuple of float
        Compression ratios the engine settles at with those powers [-].
    times, demands : tuple of float
        Power demanded [W] over time [s], as for :class:`saleg.laws.PowerDemand`.
    lowest, highest : float
        Limits of the temperature [K].
    """

    gain: float = quantity("K/s", default=100.0, low=0)
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
    lowest: float = quantity("K", default=263.0, low=100.0, usual=COMMANDED_TEMPERATURE)
    highest: float = quantity("K", default=370.0, low=100.0, usual=COMMANDED_TEMPERATURE)

    def temperature(self, memory: Any, signals: Signals) -> float:
        """Intake temperature [K]; holds its distance from the rated one, and the time."""
        elapsed = signals.t - memory[1]
        memory[1] = signals.t
        rated = signals.rated_intake_temperature
        if signals.motoring == 0.0 and signals.was_motoring == 0.0:
            demand = at_time(signals.t, self.times, self.demands)
            target = linear(demand, self.powers, self.compression_ratios)
            memory[0] += self.gain * (signals.compression_ratio - target) * elapsed
            memory[0] = min(max(memory[0], self.lowest - rated), self.highest - rated)
        return rated + memory[0]


@dataclass(frozen=True, kw_only=True)
class MappedIntake(IntakeControl):
    """Intake temperature from a map over the power demanded, clipped at the ends of the map.

    Parameters
    ----------
    powers : tuple of float
        Powers of the map, rising [W].
    temperatures : tuple of float
        Intake temperatures that go with them [K].
    times, demands : tuple of float
        Power demanded [W] over time [s], as for :class:`saleg.laws.PowerDemand`.
    """

    powers: tuple[float, ...] = series(
        "W", default=(1800.0, 3800.0), low=0, rising=True, usual=POWER
    )
    temperatures: tuple[float, ...] = series(
        "K", default=(263.0, 263.0), low=100.0, length="powers", usual=COMMANDED_TEMPERATURE
    )
    times: tuple[float, ...] = series("s", default=(2.0, 2.0), never_falling=True, usual=TIME)
    demands: tuple[float, ...] = series(
        "W", default=(3800.0, 1800.0), low=0, length="times", usual=POWER
    )

    def temperature(self, memory: Any, signals: Signals) -> float:
        """Intake temperature [K]."""
        demand = at_time(signals.t, self.times, self.demands)
        return linear(demand, self.powers, self.temperatures)
