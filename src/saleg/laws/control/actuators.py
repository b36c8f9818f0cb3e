"""Limits, lags and losses between a controller and the engine."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.arguments import Commands
from saleg.laws.control.base import ActuatorLaw
from saleg.laws.usual import COMMANDED_TEMPERATURE, GAS_PRESSURE, LAG, SMALL_FORCE
from saleg.quantities import quantity

#: Number of each command, from 1 on, as :meth:`Actuators.refused` gives it.
(
    MOTORING,
    LOAD_WEIGHT,
    AMPLITUDE,
    FREQUENCY,
    SWEEP,
    SETS_PHASE,
    PHASE,
    EQUIVALENCE_RATIO,
    INTAKE_TEMPERATURE,
    SETS_FORCE,
    FORCE,
    SPARK_ADVANCE,
    SPRING_PRESSURE,
) = (1.0 + place for place in range(len(Commands._fields)))


@dataclass(frozen=True, kw_only=True)
class Actuators(ActuatorLaw):
    """Limits of every command, and first-order lags between a command and what it sets.

    A command beyond its limits ends the run: a controller has to know them. Lags act from command
    to command: there what was set has moved by ``1 - exp(-elapsed / lag)`` of its way to what was
    asked for last, and stays until the next. The first command of a run is in place at once.

    Parameters
    ----------
    most_load, most_force, most_frequency, most_fuel : float
        Largest load weight [-], amplitude or force either way [N], frequency of the motor [Hz],
        equivalence ratio [-]; the least is zero.
    most_sweep : float
        Fastest change of the frequency, up or down [Hz/s].
    coldest, hottest : float
        Limits of the intake temperature [K].
    most_spring_pressure : float
        Largest pressure bounce chambers can be filled to [Pa].
    load_lag, force_lag, fuel_lag, intake_lag : float
        Time constants of load weight, amplitude of the motor, equivalence ratio and intake
        temperature [s]; 0 follows at once.
    motor_efficiency : float
        Of the conversion as a motor, either way [-].
    """

    most_load: float = quantity("-", default=10.0, low=0)
    most_force: float = quantity("N", default=1e5, low=0, usual=SMALL_FORCE)
    most_frequency: float = quantity("Hz", default=1e3, low=0)
    most_sweep: float = quantity("Hz/s", default=1e5, low=0)
    most_fuel: float = quantity("-", default=5.0, low=0)
    coldest: float = quantity("K", default=150.0, low=1.0, usual=COMMANDED_TEMPERATURE)
    hottest: float = quantity("K", default=1000.0, low=1.0, usual=COMMANDED_TEMPERATURE)
    most_spring_pressure: float = quantity("Pa", default=1e7, low=0, usual=GAS_PRESSURE)
    load_lag: float = quantity("s", default=0.0, low=0, usual=LAG)
    force_lag: float = quantity("s", default=0.0, low=0, usual=LAG)
    fuel_lag: float = quantity("s", default=0.0, low=0, usual=LAG)
    intake_lag: float = quantity("s", default=0.0, low=0, usual=LAG)
    motor_efficiency: float = quantity("-", default=0.95, low=0, high=1, open_low=True)

    def refused(self, wanted: Commands) -> float:
        """Number of the first command out of its limits or not finite, from 1 on; 0 if none is."""
        if not (wanted.motoring == 0.0 or wanted.motoring == 1.0):
            return MOTORING
        if not 0.0 <= wanted.load_weight <= self.most_load:
            return LOAD_WEIGHT
        if not 0.0 <= wanted.amplitude <= self.most_force:
            return AMPLITUDE
        if not 0.0 <= wanted.frequency <= self.most_frequency:
            return FREQUENCY
        if not abs(wanted.sweep) <= self.most_sweep:
            return SWEEP
        if not (wanted.sets_phase == 0.0 or wanted.sets_phase == 1.0):
            return SETS_PHASE
        if not math.isfinite(wanted.phase):
            return PHASE
        if not 0.0 <= wanted.equivalence_ratio <= self.most_fuel:
            return EQUIVALENCE_RATIO
        if not self.coldest <= wanted.intake_temperature <= self.hottest:
            return INTAKE_TEMPERATURE
        if not (wanted.sets_force == 0.0 or wanted.sets_force == 1.0):
            return SETS_FORCE
        if not abs(wanted.force) <= self.most_force:
            return FORCE
        if not math.isfinite(wanted.spark_advance):
            return SPARK_ADVANCE
        if not 0.0 <= wanted.spring_pressure <= self.most_spring_pressure:
            return SPRING_PRESSURE
        return 0.0

    def follow(self, actual: Commands, wanted: Commands, elapsed: float) -> Commands:
        """Where the actuators stand `elapsed` seconds after they stood at `actual`."""
        return Commands(
            wanted.motoring,
            lagging(actual.load_weight, wanted.load_weight, elapsed, self.load_lag),
            lagging(actual.amplitude, wanted.amplitude, elapsed, self.force_lag),
            wanted.frequency,
            wanted.sweep,
            wanted.sets_phase,
            wanted.phase,
            lagging(actual.equivalence_ratio, wanted.equivalence_ratio, elapsed, self.fuel_lag),
            lagging(actual.intake_temperature, wanted.intake_temperature, elapsed, self.intake_lag),
            wanted.sets_force,
            wanted.force,
            wanted.spark_advance,
            wanted.spring_pressure,
        )

    def motor_power(self, mechanical: float) -> float:
        """Electrical power delivered [W] for a mechanical power taken from the translator [W]."""
        if mechanical >= 0.0:
            return self.motor_efficiency * mechanical
        return mechanical / self.motor_efficiency


def lagging(actual: float, wanted: float, elapsed: float, lag: float) -> float:
    """First-order lag: where a quantity stands after some time on its way [units of `actual`]."""
    if lag <= 0.0:
        return wanted
    return wanted + (actual - wanted) * math.exp(-elapsed / lag)
