"""Masses of the moving components, each a replaceable model.

A mass model is any frozen dataclass of numbers with a method ``mass(parameters, operation)``; the
operation (stroke, frequency, power) is that of the steady state the mass itself leads to.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol, runtime_checkable

from saleg.columns import Column
from saleg.design import formulas
from saleg.design.operation import Operation
from saleg.design.parameters import Parameters
from saleg.errors import SalegError
from saleg.quantities import Quantities, is_number, quantity


class InvalidMass(SalegError, ValueError):
    """A mass model that gives no mass; names it."""


class ComponentMass(Protocol):
    """What a model of one component's mass offers."""

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Moving mass of the component [kg]."""


@runtime_checkable
class SizedMover(Protocol):
    """What a model of the mover offers if its diameters are to be known."""

    @property
    def inner_ratio(self) -> float:
        """Inner over outer diameter [-]."""

    def outer_diameter(self, operation: Operation) -> float:
        """Outer diameter [m]."""


@dataclass(frozen=True, kw_only=True)
class AlternatorMover(Quantities):
    """Tubular magnet mover sized for the steady state (Eq. 60).

    ``m = rho pi/4 (D_o^2 - D_i^2) 2 S`` with pole pitch and half length equal to the stroke.

    Parameters
    ----------
    specific_thrust : float
        Specific thrust force f_xr [N/m^2].
    poles : float
        Number of poles [-].
    efficiency : float
        Rated efficiency [-].
    inner_ratio : float
        Inner over outer diameter [-].
    density : float
        Effective density on that volume [kg/m^3]; the thesis gives none. 820 is inferred from
        Table 9 with room beneath the pistons and confirmed on Tables 10 and 12; it goes with
        ``ConnectingRod(crankcase=1.0)``. With Eq. 63 as printed it is 900
        (:meth:`MassModel.as_printed`).

    Examples
    --------
    >>> mover = AlternatorMover()
    >>> round(mover.mass(Parameters(), Operation(0.1807, 47.0, 22.6e3)), 3)
    0.732
    """

    specific_thrust: float = quantity(
        "N/m^2", default=formulas.SPECIFIC_THRUST, low=0, open_low=True
    )
    poles: float = quantity("-", default=2.0, low=0, open_low=True)
    efficiency: float = quantity("-", default=0.95, low=0, high=1, open_low=True)
    inner_ratio: float = quantity("-", default=0.8, low=0, high=1, open_high=True)
    density: float = quantity("kg/m^3", default=820.0, low=0)

    def outer_diameter(self, operation: Operation) -> float:
        """Outer diameter D_o [m] (Eq. 60); zero where no power is delivered."""
        if operation.power <= 0.0:
            return 0.0
        return formulas.alternator_diameter(
            operation.power,
            operation.stroke,
            operation.mean_speed,
            poles=self.poles,
            specific_thrust=self.specific_thrust,
            efficiency=self.efficiency,
        )

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Mass of the mover [kg]."""
        outer = self.outer_diameter(operation)
        area = 0.25 * math.pi * outer**2 * (1.0 - self.inner_ratio**2)
        return self.density * area * 2.0 * operation.stroke


@dataclass(frozen=True)
class PistonHeads:
    """Both piston heads (Eq. 65)."""

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Mass of both heads [kg]."""
        return formulas.piston_mass(parameters.bore)


@dataclass(frozen=True, kw_only=True)
class UnlikePistons(Quantities):
    """Head of the cylinder's piston and that of a gas spring's (Eq. 65, half of it each).

    Parameters
    ----------
    gas_spring_bore : float
        Bore of the gas spring [m].

    Examples
    --------
    >>> pistons = UnlikePistons(gas_spring_bore=Parameters().bore)
    >>> at = Operation(0.1807, 47.0, 22.6e3)
    >>> pistons.mass(Parameters(), at) == PistonHeads().mass(Parameters(), at)
    True
    """

    gas_spring_bore: float = quantity("m", default=0.064, low=0, open_low=True)

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Mass of both heads [kg]."""
        bores = parameters.bore, self.gas_spring_bore
        return 0.5 * (formulas.piston_mass(bores[0]) + formulas.piston_mass(bores[1]))


@dataclass(frozen=True)
class OnePiston:
    """Head of the only piston (half of Eq. 65), of an engine with an open end.

    Examples
    --------
    >>> at = Operation(0.1807, 47.0, 22.6e3)
    >>> 2.0 * OnePiston().mass(Parameters(), at) == PistonHeads().mass(Parameters(), at)
    True
    """

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Mass of the head [kg]."""
        return 0.5 * formulas.piston_mass(parameters.bore)


@dataclass(frozen=True)
class ConnectingRod(Quantities):
    """Rod from piston to piston (Eq. 62, 63, 66).

    Parameters
    ----------
    per_length : float
        Mass per length [kg/m]: 75 mm^2 of steel.
    crankcase : float
        Clearance between bearing and piston over the neutral clearance length L [-]: 1 as the text
        of Eq. 63 asks for, 0 as the equation is printed.
    """

    per_length: float = quantity("kg/m", default=0.585, low=0)
    crankcase: float = quantity("-", default=1.0, low=0)

    def crown(self, parameters: Parameters, operation: Operation) -> float:
        """Distance L_P from midpoint to crown [m] (Eq. 63)."""
        bearing = formulas.bearing_position(operation.stroke, parameters.half_stroke)
        return formulas.crown_position(bearing, self.crankcase * parameters.half_stroke)

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Mass of the rod [kg]."""
        return formulas.rod_mass(self.crown(parameters, operation), self.per_length)


@dataclass(frozen=True)
class MechanicalSprings(Quantities):
    """Springs whose moving mass grows with their stiffness (Eq. 67).

    Parameters
    ----------
    per_stiffness : float
        Mass per stiffness [kg m/N].
    """

    per_stiffness: float = quantity("kg m/N", default=10.0 / 350e3, low=0)

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Moving mass of the springs [kg]."""
        return formulas.spring_mass(parameters.spring_stiffness, self.per_stiffness)


@dataclass(frozen=True)
class AirSprings:
    """Springs of the same stiffness without moving mass, as bounce chambers would be (4.4)."""

    def mass(self, parameters: Parameters, operation: Operation) -> float:
        """Moving mass [kg]: none."""
        return 0.0


class Masses(NamedTuple):
    """Moving masses by component.

    Attributes
    ----------
    alternator, pistons, rod, springs : float
        Mass of the mover, both heads, the rod, and the moving share of the springs [kg].
    """

    alternator: float
    pistons: float
    rod: float
    springs: float

    @property
    def total(self) -> float:
        """Moving mass of the translator [kg]."""
        return self.alternator + self.pistons + self.rod + self.springs


@dataclass(frozen=True, kw_only=True)
class MassModel:
    """The models of all components, with room for the pistons unless others are given.

    Parameters
    ----------
    alternator, pistons, rod, springs : ComponentMass
        Anything with a method ``mass(parameters, operation)``. Diameters of the mover are NaN
        unless its model also has ``outer_diameter(operation)`` and ``inner_ratio``.

    Examples
    --------
    >>> light = MassModel(springs=AirSprings())
    >>> light.masses(Parameters(), Operation(0.18, 47.0, 22e3)).springs
    0.0
    """

    alternator: ComponentMass = field(default_factory=AlternatorMover)
    pistons: ComponentMass = field(default_factory=PistonHeads)
    rod: ComponentMass = field(default_factory=ConnectingRod)
    springs: ComponentMass = field(default_factory=MechanicalSprings)

    @classmethod
    def with_crankcase(cls) -> MassModel:
        """The default: a clearance of L beneath each piston, an alternator of 820 kg/m^3.

        The reading that meets the masses of Tables 9, 10 and 12 (docs/design.md).

        Returns
        -------
        MassModel
        """
        return cls()

    @classmethod
    def as_printed(cls) -> MassModel:
        """Eq. 63 as printed: no room beneath the pistons, an alternator of 900 kg/m^3.

        The rod is shorter by 2 L.

        Returns
        -------
        MassModel

        Examples
        --------
        >>> import saleg
        >>> design = saleg.design.Design(masses=MassModel.as_printed())
        >>> round(saleg.design.evaluate(design).moving_mass, 2)
        2.33
        """
        return cls(alternator=AlternatorMover(density=900.0), rod=ConnectingRod(crankcase=0.0))

    def masses(self, parameters: Parameters, operation: Operation) -> Masses:
        """Masses of the components at an operating point.

        Raises
        ------
        InvalidMass
            If a model gives no mass.
        """
        found = [getattr(self, name).mass(parameters, operation) for name in Masses._fields]
        for name, mass in zip(Masses._fields, found, strict=True):
            known = isinstance(mass, Column) or is_number(mass)
            if not known or not 0.0 <= mass < math.inf:
                raise InvalidMass(
                    f"masses.{name}: {type(getattr(self, name)).__name__}.mass gave {mass!r} at "
                    f"{operation}; it must give a number >= 0 [kg]"
                )
        plain: list[Any] = [m if isinstance(m, Column) else float(m) for m in found]
        return Masses(*plain)
