"""What turns dimensionless quantities into SI ones, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.columns import Column, sqrt
from saleg.errors import OutsideModel
from saleg.quantities import Quantities, problems, quantity


@dataclass(frozen=True, kw_only=True)
class Scales(Quantities):
    """The scales of Eq. 8-10 and 27: SI quantity over scale is the dimensionless one.

    Parameters
    ----------
    half_stroke : float
        Half of the maximum stroke L [m]: the scale of length.
    bore : float
        Bore b [m].
    stiffness : float
        Rate k of each of the two springs [N/m].
    mass : float
        Moving mass m [kg].

    Raises
    ------
    OutsideModel
        Naming every field that is not positive.

    Examples
    --------
    >>> scales = Scales(half_stroke=0.1, bore=0.064, stiffness=30e3, mass=2.39)
    >>> scales.energy, scales.force  # k L^2 [J], k L [N]
    (300.0, 3000.0)
    >>> round(1.05e5 / scales.pressure, 4)  # a dimensionless pressure
    0.1126
    """

    half_stroke: float = quantity("m", low=0, open_low=True)
    bore: float = quantity("m", low=0, open_low=True)
    stiffness: float = quantity("N/m", low=0, open_low=True)
    mass: float = quantity("kg", low=0, open_low=True)

    def __post_init__(self) -> None:
        """Check all fields."""
        super().__post_init__()
        held = vars(self).values()
        if all(isinstance(value, (float, Column)) and 0.0 < value < math.inf for value in held):
            return
        found = problems(self)
        if found:
            raise OutsideModel(found)

    @property
    def length(self) -> float:
        """Scale of positions, L [m] (Eq. 8)."""
        return self.half_stroke

    @property
    def area(self) -> float:
        """Area of a piston [m^2]."""
        return 0.25 * math.pi * self.bore**2

    @property
    def pressure(self) -> float:
        """Scale of pressures, 4 k L / (pi b^2) [Pa] (Eq. 9)."""
        return self.force / self.area

    @property
    def time(self) -> float:
        """Scale of times, sqrt(m/k) [s] (Eq. 10)."""
        return sqrt(self.mass / self.stiffness)

    @property
    def frequency(self) -> float:
        """Scale of frequencies, sqrt(k/m) [Hz]."""
        return 1.0 / self.time

    @property
    def velocity(self) -> float:
        """Scale of velocities, L sqrt(k/m) [m/s]."""
        return self.length / self.time

    @property
    def acceleration(self) -> float:
        """Scale of accelerations, L k/m [m/s^2]."""
        return self.length / self.time**2

    @property
    def force(self) -> float:
        """Scale of forces, k L [N] (Eq. 27)."""
        return self.stiffness * self.length

    @property
    def energy(self) -> float:
        """Scale of heat and work, k L^2 [J] (Eq. 27)."""
        return self.force * self.length
