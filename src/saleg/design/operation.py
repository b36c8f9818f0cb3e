"""What the design of the components asks of a steady state."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from saleg.columns import column
from saleg.design.formulas import mean_speed
from saleg.engine.start import standard_charge

if TYPE_CHECKING:
    from saleg.engine import Engine

#: Share of the fuel energy that becomes electricity, and frequency [Hz], of a first guess.
GUESSED_EFFICIENCY = 0.35
GUESSED_FREQUENCY = 45.0


class Operation(NamedTuple):
    """Operating point of an engine.

    Attributes
    ----------
    stroke : float
        Stroke S [m].
    frequency : float
        Cycles per second [Hz].
    power : float
        Mean electrical power [W].
    """

    stroke: float
    frequency: float
    power: float

    @property
    def mean_speed(self) -> float:
        """Mean speed of the translator [m/s] (Eq. 61)."""
        return mean_speed(self.stroke, self.frequency)

    @classmethod
    def of_strokes(cls, strokes: np.ndarray) -> Operation:
        """Mean over some rows of STROKE_RECORD; over each of many, columns."""
        lengths = np.abs(strokes["x_end"] - strokes["x_start"])
        duration = strokes["duration"].sum(axis=-1)
        means = (
            lengths.mean(axis=-1),
            0.5 * strokes.shape[-1] / duration,
            strokes["electrical_energy"].sum(axis=-1) / duration,
        )
        return cls(*map(float if strokes.ndim == 1 else column, means))

    @classmethod
    def guess(cls, engine: Engine) -> Operation:
        """Where an engine should run: at its target stroke, with a third of its fuel's energy."""
        depth = getattr(engine.alternator, "target_stroke", 0.9)
        charge = standard_charge(engine.left)[1] * engine.left.fuel.lower_heating_value  # type: ignore[attr-defined]
        energy = GUESSED_EFFICIENCY * 2.0 * charge
        return cls(
            stroke=depth * engine.maximum_stroke,
            frequency=GUESSED_FREQUENCY,
            power=GUESSED_FREQUENCY * energy,
        )
