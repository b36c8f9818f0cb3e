"""What stands between an engine and its controller: noise, delay, resolution."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from saleg.errors import InvalidController
from saleg.laws.arguments import Signals
from saleg.quantities import Problem, problems, quantity


@dataclass(frozen=True, kw_only=True)
class Sensors:
    """Errors of measurement. Stroke and compression ratio follow from the positions measured.

    Parameters
    ----------
    position_noise : float
        Standard deviation of the position of a dead centre [m].
    position_resolution : float
        Step of the position [m].
    time_resolution : float
        Step of the time of a dead centre [s].
    power_noise : float
        Standard deviation of the power [W].
    power_resolution : float
        Step of the power [W].
    delay : int
        By how many dead centres the signals are late.
    seed : int
        Of the noise; equal seeds give equal noise.
    """

    position_noise: float = quantity("m", default=0.0, low=0)
    position_resolution: float = quantity("m", default=0.0, low=0)
    time_resolution: float = quantity("s", default=0.0, low=0)
    power_noise: float = quantity("W", default=0.0, low=0)
    power_resolution: float = quantity("W", default=0.0, low=0)
    delay: int = quantity("-", default=0, low=0, high=10_000)
    seed: int = quantity("-", default=0, low=0)

    def validate(self) -> None:
        """Raise one error naming every wrong field.

        Raises
        ------
        InvalidController
        """
        found = problems(self, "sensors")
        for name in ("delay", "seed"):
            value = getattr(self, name)
            if not isinstance(value, (int, np.integer)):
                found.append(Problem(f"sensors.{name}", value, "-", "must be a whole number"))
        if found:
            raise InvalidController(found)


class Measurement:
    """The sensors at work in one run.

    Parameters
    ----------
    sensors : Sensors
    """

    def __init__(self, sensors: Sensors):
        sensors.validate()
        self._sensors = sensors
        self._random = np.random.default_rng(sensors.seed)
        self._late: deque[Signals] = deque(maxlen=sensors.delay + 1)
        self._last: tuple[float, float] | None = None

    def of(self, true: Signals) -> Signals:
        """What is measured of the signals of a dead centre."""
        known = self._sensors
        noise, noise_of_power = self._random.standard_normal(2)
        x = _rounded(true.x + known.position_noise * noise, known.position_resolution)
        t = _rounded(true.t, known.time_resolution)
        power = _rounded(true.power + known.power_noise * noise_of_power, known.power_resolution)
        x_before, t_before = self._last or (x - true.stroke, t)
        self._last = x, t
        stroke = min(abs(x - x_before), (1.0 - 1e-9) * true.maximum_stroke)
        ratio = (true.maximum_stroke + stroke) / (true.maximum_stroke - stroke)
        frequency = 0.5 / (t - t_before) if t > t_before else true.frequency
        seen = true._replace(
            x=x, stroke=stroke, compression_ratio=ratio, frequency=frequency, power=power
        )
        self._late.append(seen)
        # Time and mode are the controller's own; all that is measured may be late.
        return self._late[0]._replace(
            t=true.t,
            direction=true.direction,
            motoring=true.motoring,
            was_motoring=true.was_motoring,
        )


def _rounded(value: float, step: float) -> float:
    """The nearest multiple of a step; the value itself if there is none."""
    return float(step * round(value / step)) if step > 0.0 else float(value)
