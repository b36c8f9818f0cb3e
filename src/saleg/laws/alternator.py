"""Linear alternator."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.laws.arguments import Motion, Stroke
from saleg.laws.base import Alternator
from saleg.quantities import quantity


@dataclass(frozen=True)
class LinearLoad(Alternator):
    """Force proportional to velocity (Eq. 47) with a stroke regulator (Eq. 59).

    ``F = W c_A v``, electrical power ``eta F v``. At each dead centre the load weight becomes
    ``W = 1 - G (S_target - S) / L``, never negative and at most `maximum_weight`.

    Parameters
    ----------
    load_constant : float
        Load constant c_A [N s/m].
    efficiency : float
        Electrical over mechanical power [-].
    regulator_gain : float
        Gain G of the stroke regulator [-]; 0 fixes the load.
    target_stroke : float
        Target stroke S_target as a share of the maximum stroke [-].
    maximum_weight : float
        Largest load weight W the machine can deliver [-].
    """

    load_constant: float = quantity("N s/m", default=70.0, low=0)
    efficiency: float = quantity("-", default=0.95, low=0, high=1)
    regulator_gain: float = quantity("-", default=7.5, low=0)
    target_stroke: float = quantity("-", default=0.9, low=0, high=1)
    maximum_weight: float = quantity("-", default=1e3, low=0)

    def at_dead_centre(self, held: float, stroke: Stroke) -> float:
        """Load weight W [-], Eq. 59."""
        error = self.target_stroke * stroke.maximum - stroke.length
        weight = 1.0 - self.regulator_gain * error / stroke.half_maximum
        return min(max(weight, 0.0), self.maximum_weight)

    def force(self, held: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 47."""
        return held * self.load_constant * motion.v

    def electrical_power(self, held: float, motion: Motion) -> float:
        """Electrical power [W], Eq. 45."""
        return self.efficiency * held * self.load_constant * motion.v * motion.v
