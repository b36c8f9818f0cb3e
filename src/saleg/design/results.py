"""A steady state with the component design that belongs to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any

from saleg.design.designs import Design
from saleg.design.geometry import Geometry
from saleg.design.masses import Masses
from saleg.design.operation import Operation
from saleg.engine import Engine
from saleg.fundamental.bridge import groups_of
from saleg.simulation.performance import Performance
from saleg.status import Status
from saleg.steady.state import SteadyState


@dataclass(eq=False, kw_only=True, repr=False)
class DesignedState(SteadyState):
    """Steady state of a design, with masses and dimensions that follow from it.

    All of :class:`saleg.SteadyState`, and:

    Attributes
    ----------
    design : Design
        What was evaluated.
    operation : Operation
        Stroke, frequency and power the components were sized for.
    masses : Masses
        Moving masses by component at that operation [kg].
    mass_error : float
        Sum of `masses` over the moving mass the orbit was computed with, less one [-]; where no
        orbit was found that mass is a guess.
    """

    design: Design = field(repr=False)
    operation: Operation
    masses: Masses
    mass_error: float

    @classmethod
    def of(cls, steady: SteadyState, design: Design, operation: Operation) -> DesignedState:
        """A steady state, seen as that of a design."""
        held = {item.name: getattr(steady, item.name) for item in fields(SteadyState)}
        masses = design.masses.masses(design.parameters, operation)
        error = masses.total / steady.moving_mass - 1.0
        return cls(**held, design=design, operation=operation, masses=masses, mass_error=error)

    @cached_property
    def geometry(self) -> Geometry:
        """Dimensions (Table 7)."""
        return Geometry.of(self.design.parameters, self.design.masses, self.operation)

    @property
    def shown_performance(self) -> Performance:
        """Figures of the orbit; where there is none, those of the last simulated cycle.

        The latter are no steady state: they show how far from one the engine is.
        """
        unsettled = self.status is Status.UNSTEADY and self.fallback is not None
        return self.fallback.performance if unsettled else self.quick_performance  # type: ignore[union-attr]

    @property
    def component_figures(self) -> dict[str, float]:
        """What the design adds to the figures of the cycle; units in :data:`COMPONENT_UNITS`.

        Without a steady state no mass belongs to the engine: what depends on it is NaN.
        """
        figures = component_figures(
            self.design, self.engine, self.operation, self.masses, self.shown_performance
        )
        if not self.found:
            for name in ("power_density", "frequency_ratio"):
                figures[name] = math.nan
        return figures

    def _repr_html_(self) -> str:
        from saleg.display import designed_card

        return designed_card(self)

    def draw(self, ax: Any = None) -> Any:
        """Drawing of the engine to scale: see :func:`saleg.plotting.design.engine_drawing`."""
        from saleg.plotting.design import engine_drawing

        return engine_drawing(self.geometry, ax)


def component_figures(
    design: Design, engine: Engine, operation: Operation, masses: Masses, p: Any
) -> dict[str, Any]:
    """What a design with a steady state adds to the figures of the cycle.

    Parameters
    ----------
    design : Design
        One, or many as a design of columns.
    engine : Engine
        With the moving mass of the orbit.
    operation : Operation
    masses : Masses
    p : object
        With the figures of the cycle ``power``, ``stroke`` and ``frequency``.
    """
    mass, bore = engine.translator.mass, design.parameters.bore
    geometry = Geometry.of(design.parameters, design.masses, operation)
    area = 0.25 * math.pi * bore**2
    figures: dict[str, Any] = {
        "power_density": p.power / mass,
        "displacement": 2.0 * area * p.stroke,
        "relative_stroke": p.stroke / engine.maximum_stroke,
        "alternator_diameter": geometry.mover_outer_diameter,
        "engine_length": geometry.length,
        **{f"{name}_mass": value for name, value in masses._asdict().items()},
        "mass_error": masses.total / mass - 1.0,
        "stroke_to_bore": engine.maximum_stroke / bore,
        **dict.fromkeys(GROUPS[1:], math.nan),
    }
    if design.parameters.spring_stiffness > 0.0:
        groups = groups_of(engine, engine.left)
        figures["dimensionless_pressure"] = groups.intake_pressure
        figures["dimensionless_heat"] = groups.heat
        figures["frequency_ratio"] = groups.frequency_ratio(p.frequency)
    return figures


#: The four dimensionless groups of Appendix C.
GROUPS = ("stroke_to_bore", "dimensionless_pressure", "dimensionless_heat", "frequency_ratio")

#: Units of :attr:`DesignedState.component_figures`.
COMPONENT_UNITS = {
    "power_density": "W/kg",
    "displacement": "m^3",
    "relative_stroke": "-",
    "alternator_diameter": "m",
    "engine_length": "m",
    "alternator_mass": "kg",
    "pistons_mass": "kg",
    "rod_mass": "kg",
    "springs_mass": "kg",
    "mass_error": "-",
    **dict.fromkeys(GROUPS, "-"),
}
