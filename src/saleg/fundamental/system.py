"""The system of Chapter 2: everything a stroke depends on but its start."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from saleg.errors import OutsideModel
from saleg.fundamental.checks import LEFT, require
from saleg.fundamental.gas import Gas, Isentropic
from saleg.fundamental.ignition import AtDeadCentre, Ignition
from saleg.fundamental.loads import ConstantLoad, Load, OttoLoad, Profile
from saleg.fundamental.stroke import Stroke
from saleg.quantities import Problem, problems, quantity


@dataclass(frozen=True, kw_only=True)
class System:
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
    >>> system = System(pressure=0.5, heat=1.0, load=ConstantLoad(0.365473))  # Eq. 32 for -0.8
    >>> round(float(system.stroke(-0.8).end), 5)
    0.8
    """

    pressure: float = quantity("-", low=0)
    heat: float = quantity("-", default=0.0, low=0)
    load: Load = field(default_factory=ConstantLoad)
    gas: Gas = field(default_factory=Isentropic)
    ignition: Ignition = field(default_factory=AtDeadCentre)

    def __post_init__(self) -> None:
        """Check the whole tree."""
        kinds = {"load": Load, "gas": Gas, "ignition": Ignition}
        found = problems(self)
        for item in fields(self):
            found += _kind_problem(getattr(self, item.name), kinds.get(item.name), item.name)
        if isinstance(self.load, OttoLoad):
            found += _kind_problem(self.load.profile, Profile, "load.profile")
        if found:
            raise OutsideModel(found)

    def motored_pressure(self, s: Any) -> Any:
        """Pressure of an unburnt charge compressed up to `s` [-] (Eq. 4)."""
        return self.pressure * (1.0 - s) ** -self.gas.compression

    def pressure_rise(self, s: Any) -> Any:
        """Rise in pressure of a charge that burns at `s` [-] (Eq. 21)."""
        return self.heat * (self.gas.gamma - 1.0) / (1.0 - s)

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


def _kind_problem(value: Any, kind: type | None, path: str) -> list[Problem]:
    if kind is None or isinstance(value, kind):
        return []
    return [Problem(path, value, "-", f"must be a {kind.__name__}")]
