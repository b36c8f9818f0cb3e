"""Charges that do not light."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.base import Misfires
from saleg.quantities import quantity


@dataclass(frozen=True)
class NoMisfires(Misfires):
    """Every charge is left to the ignition law."""

    def happens(self, charge_number: float) -> float:
        """1 if a charge does not light, else 0: never."""
        return 0.0


@dataclass(frozen=True)
class ScheduledMisfires(Misfires):
    """Some charges in a row do not light, once or again and again.

    Parameters
    ----------
    first : float
        Number of the first charge that fails; 1 is the first composed in the run [-].
    count : float
        How many in a row fail [-].
    period : float
        Charges from one first failure to the next [-]; 0 for a single series.
    """

    first: float = quantity("-", default=1.0, low=0)
    count: float = quantity("-", default=1.0, low=0)
    period: float = quantity("-", default=0.0, low=0)

    def happens(self, charge_number: float) -> float:
        """1 if a charge does not light, else 0."""
        since = charge_number - self.first
        if self.period > 0.0 and since >= 0.0:
            since -= self.period * math.floor(since / self.period)
        return 1.0 if 0.0 <= since < self.count else 0.0
