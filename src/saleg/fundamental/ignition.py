"""When the charge burns, all of it at once: at dead centre, or at a pressure (2.3, 2.5)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.checks import a, checked, number
from saleg.fundamental.checks import SCALAR
from saleg.fundamental.gas import Gas, expansion_work
from saleg.quantities import Quantities, quantity

if TYPE_CHECKING:
    from saleg.fundamental.charge import Charge

#: A charge that comes within this share of the threshold has reached it: at equilibrium under
#: the Otto constraint it does so exactly at dead centre.
REACHED = 1e-9


class Ignition(Quantities):
    """Base of all ignitions.

    Positions `s` count along the motion; the charge is compressed against s = 1.
    """

    def position(self, gas: Gas) -> float:
        """Position at which the charge burns under way [-]; infinite if it does not."""
        return math.inf

    def added_pressure(self, system: Charge, s: Any) -> Any:
        """Pressure the burnt charge has over the unburnt one under way [-]."""
        return 0.0

    def added_work(self, system: Charge, s: Any) -> Any:
        """Work on the translator of that pressure, up to `s` [-]; negative."""
        return 0.0

    def pressure_at_dead_centre(self, system: Charge, depth: Any) -> Any:
        """Pressure of the charge as it begins to expand, `depth` from the midpoint [-]."""
        raise NotImplementedError

    def fires(self, system: Charge, depth: Any) -> Any:
        """Whether a charge compressed up to `depth` burns."""
        raise NotImplementedError

    def adverse_work(self, system: Charge, depth: float) -> float:
        """Work of the inverted part of the p-V loop around dead centre [-]."""
        return 0.0


@dataclass(frozen=True)
class AtDeadCentre(Ignition):
    """The charge burns at dead centre, wherever that is (2.3, Eq. 21)."""

    def pressure_at_dead_centre(self, system: Charge, depth: Any) -> Any:
        """Pressure of the charge as it begins to expand, `depth` from the midpoint [-]."""
        return system.motored_pressure(depth) + system.pressure_rise(depth)

    def fires(self, system: Charge, depth: Any) -> Any:
        """Whether a charge compressed up to `depth` burns: always."""
        return np.ones(np.shape(depth), dtype=bool)


@dataclass(frozen=True)
class AtPressure(Ignition):
    """The charge burns when its pressure reaches a threshold (2.5); if it never does, not at all.

    Every charge is compressed along the same curve, so it burns at the same place in every stroke.

    Parameters
    ----------
    ratio : float
        Threshold over midpoint pressure [-].

    Examples
    --------
    >>> from saleg.fundamental import Isentropic
    >>> early = AtPressure.share_of_start(0.2, -0.8, Isentropic(1.4))
    >>> round(early.position(Isentropic(1.4)), 3)
    0.369
    """

    ratio: float = quantity("-", low=1, open_low=True)

    @classmethod
    @checked(share=SCALAR, start=number(-1.0, 1.0, open_low=True, open_high=True), gas=a(Gas))
    def share_of_start(cls, share: float, start: float, gas: Gas) -> AtPressure:
        """Threshold as a share of the pressure at the start, as the thesis gives it.

        Parameters
        ----------
        share : float
            Threshold over the motored pressure at `start` [-].
        start : float
            Dead centre at which the simulation starts, x* [-].
        gas : Gas

        Returns
        -------
        AtPressure
        """
        return cls(share * (1.0 - abs(start)) ** -gas.compression)

    def position(self, gas: Gas) -> float:
        """Position at which the charge burns under way [-]."""
        return float(1.0 - self.ratio ** (-1.0 / gas.compression))

    def added_pressure(self, system: Charge, s: Any) -> Any:
        """Pressure the burnt charge has over the unburnt one under way [-]."""
        where = self.position(system.gas)
        grown = ((1.0 - where) / (1.0 - s)) ** system.gas.compression
        return np.where(s >= where, system.pressure_rise(where) * grown, 0.0)

    def added_work(self, system: Charge, s: Any) -> Any:
        """Work on the translator of that pressure, up to `s` [-]; negative."""
        where = self.position(system.gas)
        way = np.minimum(where - s, 0.0)
        rise = system.pressure_rise(where)
        return expansion_work(rise, 1.0 - where, way, system.gas.compression)

    def pressure_at_dead_centre(self, system: Charge, depth: Any) -> Any:
        """Pressure of the charge as it begins to expand, `depth` from the midpoint [-]."""
        where, motored = self.position(system.gas), system.motored_pressure(depth)
        grown = ((1.0 - where) / (1.0 - depth)) ** system.gas.compression
        burnt = system.pressure_rise(where) * grown
        return motored + np.where(self.fires(system, depth), burnt, 0.0)

    def fires(self, system: Charge, depth: Any) -> Any:
        """Whether a charge compressed up to `depth` burns."""
        return (1.0 - np.real(depth)) ** -system.gas.compression >= self.ratio * (1.0 - REACHED)

    def adverse_work(self, system: Charge, depth: float) -> float:
        """Work of the inverted part of the p-V loop around dead centre [-].

        From the place of ignition to dead centre and back the burnt charge takes more work than
        it returns if it loses heat, ``expansion > compression``; without loss it returns all.
        """
        gas, height = system.gas, 1.0 - depth
        way = max(depth - self.position(gas), 0.0)
        pressure = self.pressure_at_dead_centre(system, depth)
        taken = expansion_work(pressure, height, way, gas.compression)
        returned = expansion_work(pressure, height, way, gas.expansion)
        return max(float(taken - returned), 0.0)
