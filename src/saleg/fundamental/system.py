"""The system of Chapter 2: everything a stroke depends on but its start."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.fundamental.checks import LEFT, require
from saleg.fundamental.ignition import AtDeadCentre
from saleg.fundamental.parameters import Parameters
from saleg.fundamental.stroke import Stroke


@dataclass(frozen=True, kw_only=True)
class System(Parameters):
    """A symmetric free-piston engine in dimensionless terms (Eq. 7-10, 27).

    At each dead centre the charge there has burnt, and the other one is put back on the curve
    through the midpoint pressure, ready for compression.

    Parameters
    ----------
    pressure : float
        Midpoint pressure P_mp* [-] (Eq. 9); 0 leaves the springs alone.
    heat : float
        Heat Q_in* of a stroke [-] (Eq. 27).
    load : Load
        Work force; none unless given.
    gas : Gas
        Ratio of specific heats and exponents; isentropic at 1.4 unless given.
    ignition : Ignition
        When the charge burns; at dead centre unless given.

    Raises
    ------
    OutsideModel
        Naming every field outside the model.

    Examples
    --------
    >>> from saleg.fundamental import ConstantLoad
    >>> system = System(pressure=0.5, heat=1.0, load=ConstantLoad(0.365473))  # Eq. 32 for -0.8
    >>> round(float(system.stroke(-0.8).end), 5)
    0.8
    """

    def stroke(self, start: Any) -> Stroke:
        """Stroke to the right from rest, its charge burning at the start.

        Parameters
        ----------
        start : array_like
            Left dead centre x_l* [-], between -1 and 0.

        Returns
        -------
        Stroke

        Raises
        ------
        OutsideModel
            If `start` is not between -1 and 0.
        """
        require(start=(start, LEFT))
        depth = -np.asarray(start, dtype=float)
        pressure = AtDeadCentre().pressure_at_dead_centre(self, depth)
        return Stroke(self, -depth, 1.0, pressure, self.load.for_stroke(self, depth))
