"""State logic: when the alternator is a motor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import Signals
from saleg.laws.control.base import StateLogic
from saleg.quantities import quantity


@dataclass(frozen=True, kw_only=True)
class CompressionThreshold(StateLogic):
    """A motor below a compression ratio, a generator with fuel above it (5.1, 5.3).

    Parameters
    ----------
    threshold : float
        Compression ratio from which on the engine is fired [-]; 12 in the dissertation.
    hysteresis : float
        How far the compression ratio may fall below that before the motor comes back [-].
    latched : float
        1 if the motor never comes back once the engine has been fired, else 0 [-].
    """

    threshold: float = quantity("-", default=12.0, low=1)
    hysteresis: float = quantity("-", default=0.0, low=0)
    latched: float = quantity("-", default=0.0, low=0, high=1)

    def is_motor(self, memory: Any, signals: Signals) -> float:
        """1 for a motor, 0 for a generator; holds whether it has been fired."""
        if memory[0] > 0.0 and self.latched > 0.0:
            return 0.0
        fired = signals.was_motoring == 0.0 and memory[0] > 0.0
        limit = self.threshold - self.hysteresis if fired else self.threshold
        if signals.compression_ratio < limit:
            return 1.0
        memory[0] = 1.0
        return 0.0


@dataclass(frozen=True)
class AlwaysMotored(StateLogic):
    """Always a motor, as in the search for the resonance (Fig. 94, 95)."""

    def is_motor(self, memory: Any, signals: Signals) -> float:
        """1: a motor."""
        return 1.0


@dataclass(frozen=True)
class NeverMotored(StateLogic):
    """Always a generator."""

    def is_motor(self, memory: Any, signals: Signals) -> float:
        """0: a generator."""
        return 0.0
