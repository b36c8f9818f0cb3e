"""What is swept: designs through the component loop, or an engine with a fixed mass."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any, Protocol

import numpy as np

from saleg.batch.identity import described, own_code
from saleg.batch.many import STABILITY_UNITS, steady_columns, steady_row
from saleg.batch.points import Evaluated, Solver, Values, refuse_parts
from saleg.batch.table import Columns, Row
from saleg.design.designs import Design
from saleg.design.many import EvaluatedDesign
from saleg.engine import Engine
from saleg.engine.columns import rows_of_columns
from saleg.engine.paths import unit_of
from saleg.errors import SweepError, UnknownPath, shown
from saleg.steady.solver import Effort, found_steady_state


class Subject(Evaluated, Protocol):
    """What a sweep needs to know of what it sweeps."""

    def describe(self) -> dict[str, Any]:
        """All that decides about the results, as plain data."""

    def solver(self, rtol: float, multipliers: bool, warm: bool, effort: Effort) -> Solver:
        """What makes a row of a point; may remember the point before."""


class DesignSubject(EvaluatedDesign):
    """Designs: inputs are the eight parameters, or paths of the engine and the mass models.

    Parameters
    ----------
    design : Design
        What is as it is unless a point says otherwise.
    """

    def describe(self) -> dict[str, Any]:
        """Parameters, masses and laws."""
        return {
            "kind": "design",
            "parameters": dataclasses.asdict(self.design.parameters),
            "masses": {
                item.name: described(getattr(self.design.masses, item.name), f"masses.{item.name}")
                for item in dataclasses.fields(self.design.masses)
            },
            **_laws(self.design.laws),
        }


@dataclasses.dataclass(frozen=True)
class EngineSubject:
    """An engine as it stands: inputs are its paths, the moving mass among them.

    Parameters
    ----------
    engine : Engine
        What is as it is unless a point says otherwise.
    """

    engine: Engine

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns."""
        return STABILITY_UNITS

    def unit(self, name: str) -> str:
        """Unit of an input."""
        unit = unit_of(self.engine, name)
        with suppress(UnknownPath):  # left and right differ: a number for both of them
            refuse_parts(name, self.engine.get(name))
        return unit

    def refuse_clash(self, names: Iterable[str]) -> None:
        """Refuse inputs of which two stand for one number."""
        self.engine.replace(**dict.fromkeys(names, math.nan))

    def describe(self) -> dict[str, Any]:
        """The engine."""
        return {"kind": "engine", **_laws(self.engine)}

    def solver(self, rtol: float, multipliers: bool, warm: bool, effort: Effort) -> Solver:
        """What makes a row of a point, from the engine's own starts."""
        if warm:
            raise SweepError("warm starts are for designs; an engine begins with its own starts")
        return EngineSolver(self.engine, rtol, multipliers, effort)


@dataclasses.dataclass(frozen=True)
class EngineSolver:
    """Rows of an engine with some numbers replaced."""

    engine: Engine
    rtol: float
    multipliers: bool
    effort: Effort

    def __call__(self, values: Values) -> Row:
        """Row of a point."""
        found = found_steady_state(self.engine.replace(**values), self.rtol, effort=self.effort)
        return steady_row(found, self.multipliers)

    def columns(self, points: Sequence[Values], total: int) -> Columns:
        """Rows of some points of a sweep of so many, column by column."""
        columns = {name: np.array([values[name] for values in points]) for name in points[0]}
        lots = rows_of_columns(self.engine, columns)
        how = self.rtol, self.multipliers, self.effort, total
        return steady_columns(lots, lambda place: self(points[place]), len(points), *how)


def _laws(engine: Engine) -> dict[str, Any]:
    """An engine with all its numbers, and what its file would not say: the code of own laws."""
    return {"laws": engine.to_toml(), "own_laws": own_code(engine)}


def subject_of(swept: Design | Engine | Subject | None) -> Subject:
    """What is swept, as a subject; the designs of Chapter 4 if nothing is given."""
    if swept is None:
        return DesignSubject(Design())
    if isinstance(swept, Design):
        return DesignSubject(swept)
    if isinstance(swept, Engine):
        return EngineSubject(swept)
    if isinstance(swept, type) or not callable(getattr(swept, "solver", None)):
        raise SweepError(
            f"cannot sweep {shown(swept)}: must be a Design, an Engine, or nothing for the designs "
            "of Chapter 4"
        )
    return swept
