"""Dimensions of the engine (Figure 62, Table 7)."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

from saleg.design import formulas
from saleg.design.masses import ComponentMass, ConnectingRod, MassModel, SizedMover
from saleg.design.operation import Operation
from saleg.design.parameters import Parameters


@dataclass(frozen=True)
class Geometry:
    """Dimensions of the right half with the translator at its midpoint (Table 7); all in metres.

    Attributes
    ----------
    mover_outer_diameter, mover_inner_diameter : float
        Alternator mover, D_o and D_i [m]; NaN if its model does not tell.
    rod_diameter : float
        Connecting rod, D_R [m].
    bore : float
        Cylinder bore b [m].
    mover_end : float
        Midpoint to the end of the mover, L_A [m].
    bearing : float
        Midpoint to the inner rod bearing, L_B [m].
    port : float
        Midpoint to the opening edge of the ports, L_po [m].
    crown : float
        Midpoint to the piston crown, L_P [m].
    head : float
        Midpoint to the cylinder head, L_C [m].
    """

    mover_outer_diameter: float
    mover_inner_diameter: float
    rod_diameter: float
    bore: float
    mover_end: float
    bearing: float
    port: float
    crown: float
    head: float

    @classmethod
    def of(cls, parameters: Parameters, masses: MassModel, operation: Operation) -> Geometry:
        """Geometry of a design at its steady state (Eq. 60-64).

        A rod of another model leaves the crown where :class:`ConnectingRod` puts it; a mover
        without ``outer_diameter`` and ``inner_ratio`` has no known diameters.
        """
        length = parameters.half_stroke
        outer, inner = _diameters(masses.alternator, operation)
        bearing = formulas.bearing_position(operation.stroke, length)
        rod = masses.rod if isinstance(masses.rod, ConnectingRod) else ConnectingRod()
        crown = rod.crown(parameters, operation)
        return cls(
            mover_outer_diameter=outer,
            mover_inner_diameter=inner,
            rod_diameter=math.sqrt(4.0 * formulas.ROD_AREA / math.pi),
            bore=parameters.bore,
            mover_end=operation.stroke,
            bearing=bearing,
            port=formulas.port_position(parameters.port_location, length, crown),
            crown=crown,
            head=crown + length,
        )

    @property
    def length(self) -> float:
        """Distance from head to head [m]."""
        return 2.0 * self.head

    def to_dict(self) -> dict[str, float]:
        """All dimensions by name [m]."""
        return dataclasses.asdict(self)


def _diameters(mover: ComponentMass, operation: Operation) -> tuple[float, float]:
    """Outer and inner diameter of the mover [m]."""
    if not isinstance(mover, SizedMover):
        return math.nan, math.nan
    outer = mover.outer_diameter(operation)
    return outer, mover.inner_ratio * outer
