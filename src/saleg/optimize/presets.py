"""Presets: boxes, scores and settings of the dissertation (4.3, Figure 85, Appendix B VIII)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from saleg.design.designs import Design
from saleg.design.score import Score
from saleg.design.terms import Bell, Below, InvalidScore, Reached, Within
from saleg.design.weighted import Weighted, WeightedScore
from saleg.errors import Problem as Wrong
from saleg.errors import SalegWarning
from saleg.laws.usual import POWER
from saleg.optimize.methods import GeneticAlgorithm
from saleg.optimize.problem import InvalidProblem, Problem
from saleg.quantities import as_float, unusual_number

Bounds = Mapping[str, tuple[float, float]]

#: Box of designs that can be built, for a few kilowatts, in the order of the thesis' genes.
BOX: Bounds = {
    "bore": (0.020, 0.100),
    "half_stroke": (0.015, 0.100),
    "port_location": (0.05, 0.95),
    "intake_pressure": (1.0e5, 5.0e5),
    "intake_temperature": (300.0, 1000.0),
    "spring_stiffness": (15e3, 400e3),
    "equivalence_ratio": (0.35, 1.0),
    "egr": (0.0, 0.4),
}
#: Box of the script; fuel beyond an equivalence ratio of 1 finds no air, so it ends there.
SCRIPT_BOX: Bounds = {
    "bore": (0.010, 0.500),
    "half_stroke": (0.010, 0.500),
    "port_location": (0.05, 0.95),
    "intake_pressure": (0.9e5, 5.0e5),
    "intake_temperature": (250.0, 1000.0),
    "spring_stiffness": (15e3, 400e3),
    "equivalence_ratio": (0.2, 1.0),
    "egr": (0.0, 0.4),
}
#: Where the maps of the script end: efficiency, power [W], change of the compression ratio,
#: peak pressure [Pa].
MAPS = {
    "efficiency": (0.0, 1.0),
    "power": (200.0, 50e3),
    "cr_change": (-0.5, 0.5),
    "peak_pressure": (0.9e5, 350e5),
}
#: Width of the script's bell of power [W], which is not printed: with its tolerance of efficiency
#: the order in Table 11 asks for 620 to 740 W.
SCRIPT_POWER_WIDTH = 680.0


@dataclass(frozen=True)
class Preset:
    """A box with the settings of the genetic algorithm, as the dissertation has them.

    Attributes
    ----------
    box : mapping
        Bounds (SI).
    method : GeneticAlgorithm
    as_scripted : bool
        Whether scores are those of the printed script, in place of those of the text.
    """

    box: Bounds
    method: GeneticAlgorithm = field(default_factory=GeneticAlgorithm)
    as_scripted: bool = False

    def score(
        self,
        target_power: float | None = 4e3,
        compression_ratio: tuple[float, float] = (5.0, 35.0),
    ) -> Any:
        """Score of rows; that of the script has no term for the compression ratio.

        A power far from what has been built is warned of.
        """
        _warn_of_unusual_power(target_power)
        if self.as_scripted:
            return script_score(target_power)
        if not np.iterable(compression_ratio) or len(compression_ratio) != 2:
            need = "must be its lowest and highest value"
            raise InvalidScore([Wrong("compression_ratio", compression_ratio, "-", need)])
        low, high = compression_ratio
        return Score(
            target_power=target_power,
            least_compression_ratio=low,
            greatest_compression_ratio=high,
        )

    def problem(
        self,
        target_power: float | None = 4e3,
        compression_ratio: tuple[float, float] = (5.0, 35.0),
        bounds: Bounds | None = None,
    ) -> Problem:
        """Problem in this box, with that score."""
        score = self.score(target_power, compression_ratio)
        if bounds is not None and not isinstance(bounds, Mapping):
            need = "must be a mapping of names to (lowest, highest)"
            raise InvalidProblem([Wrong("bounds", bounds, "-", need)])
        return Problem({**self.box, **(bounds or {})}, score)


def _warn_of_unusual_power(target_power: Any) -> None:
    power = as_float(target_power)
    odd = "" if power is None else unusual_number("target_power", power, "W", POWER)
    if odd:
        warnings.warn(f"unusual for an engine: {odd}", SalegWarning, stacklevel=3)


def script_score(target_power: float | None = 4e3) -> WeightedScore:
    """Score of the printed script: weights of 2, and no pull to deliver at all.

    Stability is the change of the compression ratio from one half cycle to the next. The bells of
    stability and power are named there but not printed.

    Parameters
    ----------
    target_power : float, optional
        Power aimed at [W]; None leaves power out.

    Returns
    -------
    WeightedScore
    """
    terms = [
        Reached("efficiency", 0.4, 0.4),
        Bell("cr_change", 0.0, 0.1),
        Below("peak_pressure", 250e5, 20e5),
    ]
    if target_power is not None:
        terms.append(Bell("power", target_power, SCRIPT_POWER_WIDTH))
    held = tuple(Weighted(2.0, Within(term, *MAPS[term.figure])) for term in terms)
    return WeightedScore(held, needs_delivery=False)


#: Population and rates of the text, in a box that can be built.
thesis_text = Preset(BOX)
#: Box, score, population and rates of the printed script.
thesis_script = Preset(
    SCRIPT_BOX,
    GeneticAlgorithm(size=600, mutation=0.2, crossover=0.2, generations=20),
    as_scripted=True,
)


def thesis_problem(
    target_power: float | None = 4e3,
    compression_ratio: tuple[float, float] = (5.0, 35.0),
    bounds: Bounds | None = None,
    *,
    score: Any = None,
    design: Design | None = None,
    **fields: Any,
) -> Problem:
    """Problem of 4.3: eight parameters, and the score of Figure 85.

    Parameters
    ----------
    target_power : float, optional
        Power [W]; None for none, as in Table 12.
    compression_ratio : (float, float)
        Its range [-]; that of Tables 10 and 11 is 5 to 25.
    bounds : mapping, optional
        Bounds (SI) in place of those of :data:`BOX`, or of further parameters.
    score : callable, optional
        In place of that of Figure 85.
    design : Design, optional
        What the parameters replace something of.
    **fields
        Further fields of :class:`Problem`.

    Returns
    -------
    Problem

    Examples
    --------
    >>> problem = thesis_problem(2e3, (5.0, 25.0), {"intake_temperature": (250.0, 400.0)})
    >>> problem.bounds["intake_temperature"], len(problem.bounds)
    ((250.0, 400.0), 8)
    """
    whole = thesis_text.problem(target_power, compression_ratio, bounds)
    given = {"score": score, "swept": design}
    return whole.replace(**fields, **{name: v for name, v in given.items() if v is not None})
