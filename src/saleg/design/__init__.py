"""Component design (4.1): from eight parameters to masses, dimensions and a steady state.

The moving mass follows from components that are sized for the steady state, which follows from
the moving mass; both are solved together.

Examples
--------
>>> import saleg
>>> found = saleg.design.evaluate(bore=0.064, half_stroke=0.1, equivalence_ratio=0.6)
>>> print(found.status)
steady
>>> round(found.masses.alternator, 2), round(found.geometry.length, 2)
(0.73, 0.99)
"""

from saleg.design import formulas
from saleg.design.designs import Design, InvalidDesign, thesis_laws
from saleg.design.geometry import Geometry
from saleg.design.loop import evaluate, solve
from saleg.design.many import evaluate_many
from saleg.design.masses import (
    AirSprings,
    AlternatorMover,
    ComponentMass,
    ConnectingRod,
    InvalidMass,
    Masses,
    MassModel,
    MechanicalSprings,
    OnePiston,
    PistonHeads,
    UnlikePistons,
)
from saleg.design.operation import Operation
from saleg.design.parameters import Parameters
from saleg.design.results import DesignedState
from saleg.design.score import Score
from saleg.design.terms import InvalidScore

__all__ = [
    "AirSprings",
    "AlternatorMover",
    "ComponentMass",
    "ConnectingRod",
    "Design",
    "DesignedState",
    "Geometry",
    "InvalidDesign",
    "InvalidMass",
    "InvalidScore",
    "MassModel",
    "Masses",
    "MechanicalSprings",
    "OnePiston",
    "Operation",
    "Parameters",
    "PistonHeads",
    "Score",
    "UnlikePistons",
    "evaluate",
    "evaluate_many",
    "formulas",
    "solve",
    "thesis_laws",
]
