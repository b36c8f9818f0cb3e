"""Sensors between an engine and its controller: noise, delay, resolution."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from saleg.engine import Engine
from saleg.errors import InvalidController
from saleg.laws.arguments import Signals, Stroke
from saleg.laws.usual import GAP
from saleg.quantities import Quantities, problems, quantity
from saleg.simulation.indicators import compression_ratio, own_compression_ratio


@dataclass(frozen=True, kw_only=True)
class Sensors(Quantities):
    """Errors of measurement. Stroke, compression ratio and regulator follow from what is measured.

    The load weight the alternator's regulator (Eq. 59) asks for is that of the stroke measured.

    Parameters
    ----------
    position_noise : float
        Standard deviation of a position [m].
    position_resolution : float
        Step of the position [m].
    time_resolution : float
        Step of the time of a dead centre [s].
    power_noise : float
        Standard deviation of the power [W].
    power_resolution : float
        Step of the power [W].
    delay : int
        By how many dead centres the signals of dead centres are late.
    seed : int
        Of the noise; equal seeds give equal noise.
    """

    position_noise: float = quantity("m", default=0.0, low=0, usual=GAP)
    position_resolution: float = quantity("m", default=0.0, low=0, usual=GAP)
    time_resolution: float = quantity("s", default=0.0, low=0)
    power_noise: float = quantity("W", default=0.0, low=0)
    power_resolution: float = quantity("W", default=0.0, low=0)
    delay: int = quantity("-", default=0, low=0, high=10_000, whole=True)
    seed: int = quantity("-", default=0, low=0, whole=True)

    def validate(self) -> None:
        """Raise one error naming every wrong field.

        Raises
        ------
        InvalidController
        """
        found = problems(self, "sensors")
        if found:
            raise InvalidController(found)


class Measurement:
    """The sensors at work in one run.

    Parameters
    ----------
    sensors : Sensors
    engine : Engine
        Whose alternator has the regulator.
    """

    def __init__(self, sensors: Sensors, engine: Engine):
        sensors.validate()
        self._sensors, self._engine = sensors, engine
        self._random = np.random.default_rng(sensors.seed)
        self._within_stroke = np.random.default_rng((sensors.seed, 1))
        self._late: deque[Signals] = deque(maxlen=sensors.delay + 1)
        self._last: tuple[float, float] | None = None
        self._dead_centre = (0.0, 0.0, 0.0)

    def of(self, true: Signals) -> Signals:
        """Signals as the sensors measure them.

        Between two dead centres only the position is measured anew.
        """
        if self._late and self._dead_centre == (true.x, true.stroke, true.direction):
            noise = float(self._within_stroke.standard_normal())
            x = true.position + self._sensors.position_noise * noise
            position = _rounded(x, self._sensors.position_resolution)
            return self._shown(true)._replace(position=position)
        self._dead_centre = true.x, true.stroke, true.direction
        known = self._sensors
        noise, noise_of_power = self._random.standard_normal(2)
        x = _rounded(true.x + known.position_noise * noise, known.position_resolution)
        t = _rounded(true.t, known.time_resolution)
        power = _rounded(true.power + known.power_noise * noise_of_power, known.power_resolution)
        x_before, t_before = self._last or (x - true.stroke, t)
        self._last = x, t
        stroke = abs(x - x_before)
        ends = x, x + true.direction * stroke
        frequency = true.frequency
        if known.time_resolution > 0.0 and t > t_before:
            frequency = 0.5 / (t - t_before)
        seen = true._replace(
            x=x,
            stroke=stroke,
            compression_ratio=float(compression_ratio(self._engine, min(ends), max(ends))),
            x_left=min(ends),
            x_right=max(ends),
            compression_ratio_left=self._of_side(0, *ends),
            compression_ratio_right=self._of_side(1, *ends),
            position=x,
            frequency=frequency,
            power=power,
            regulated_weight=self._regulated(true, ends, frequency),
        )
        self._late.append(seen)
        return self._shown(true)

    def _of_side(self, side: int, *ends: float) -> float:
        """Compression ratio of one chamber between two positions."""
        return float(own_compression_ratio(self._engine, side, min(ends), max(ends)))

    def _regulated(self, true: Signals, ends: tuple[float, float], frequency: float) -> float:
        """Load weight the regulator asks for when it goes by the stroke measured."""
        if frequency <= 0.0:
            return true.regulated_weight
        area = 0.5 * sum(self._engine.piston_areas)
        most = true.maximum_stroke
        stroke, duration = abs(ends[1] - ends[0]), 0.5 / frequency
        seen = Stroke(stroke, duration, most, 0.5 * most, area, 0.0, 0.0, min(ends), max(ends))
        return float(self._engine.alternator.at_dead_centre(true.regulated_weight, seen))

    def _shown(self, true: Signals) -> Signals:
        """The signals of as many dead centres ago as they are late."""
        # Time and mode are the controller's own; all that is measured may be late.
        return self._late[0]._replace(
            t=true.t,
            direction=true.direction,
            motoring=true.motoring,
            was_motoring=true.was_motoring,
        )


def _rounded(value: float, step: float) -> float:
    """The nearest multiple of a step; the value itself if there is none, or none to speak of."""
    steps = value / step if step > 0.0 else math.inf
    return step * round(steps) if math.isfinite(steps) else float(value)
