"""Converter between a commanded force of the alternator and its DC bus."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.control.base import ConverterLaw
from saleg.laws.usual import POWER
from saleg.quantities import quantity


@dataclass(frozen=True, kw_only=True)
class Converter(ConverterLaw):
    """A converter with limits of current, voltage and power, and with losses.

    The current ``i = F / k_F`` takes the voltage ``k_F v + R i`` at the terminals; the winding's
    inductance is left out. The force wanted is cut down to what all limits allow; where the
    voltage induced alone exceeds that of the bus, there is none.

    Parameters
    ----------
    force_constant : float
        Force over current k_F [N/A], which is voltage over velocity too.
    resistance : float
        Resistance R of the winding [ohm].
    maximum_current : float
        Largest current [A].
    bus_voltage : float
        Voltage of the DC bus [V].
    maximum_power : float
        Largest power that the bus gives or takes [W].
    efficiency : float
        Of the electronics, either way [-].

    Examples
    --------
    >>> converter = Converter(force_constant=30.0, resistance=0.1, maximum_current=10.0)
    >>> converter.force(1000.0, 0.0)
    300.0
    >>> round(converter.power(-300.0, 2.0), 6)  # 600 W, less 10 W in the winding, at 95 %
    560.5
    """

    force_constant: float = quantity("N/A", default=30.0, low=0, open_low=True)
    resistance: float = quantity("ohm", default=0.1, low=0, open_low=True)
    maximum_current: float = quantity("A", default=300.0, low=0)
    bus_voltage: float = quantity("V", default=700.0, low=0, open_low=True)
    maximum_power: float = quantity("W", default=1e5, low=0, open_low=True, usual=POWER)
    efficiency: float = quantity("-", default=0.95, low=0, high=1, open_low=True)

    def force(self, wanted: float, v: float) -> float:
        """Force on the translator [N] that comes of the one wanted, at a velocity [m/s]."""
        way = 1.0 if wanted >= 0.0 else -1.0
        induced = way * self.force_constant * v  # positive where the force pushes along
        if abs(induced) >= self.bus_voltage:
            return 0.0
        current = min(abs(wanted) / self.force_constant, self.maximum_current)
        current = min(current, (self.bus_voltage - induced) / self.resistance)
        drawn, taken = self.efficiency * self.maximum_power, self.maximum_power / self.efficiency
        root = math.sqrt(induced * induced + 4.0 * self.resistance * drawn)
        current = min(current, 2.0 * drawn / (induced + root))
        beyond = induced * induced - 4.0 * self.resistance * taken
        if induced < 0.0 and beyond > 0.0:
            current = min(current, 2.0 * taken / (math.sqrt(beyond) - induced))
        return way * self.force_constant * current

    def power(self, force: float, v: float) -> float:
        """Power delivered to the DC bus [W]; negative where it is drawn from it."""
        current = force / self.force_constant
        drawn = force * v + self.resistance * current * current
        return -drawn / self.efficiency if drawn > 0.0 else -drawn * self.efficiency
