"""What is swept: designs through the component loop, or an engine with a fixed mass."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, Protocol

from saleg.batch.many import UNITS as STEADY_UNITS
from saleg.batch.many import Row, steady_row
from saleg.design.designs import Design
from saleg.design.many import UNITS as DESIGN_UNITS
from saleg.design.many import Follower
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.errors import UnknownPath
from saleg.quantities import is_number
from saleg.steady.solver import found_steady_state
from saleg.sweep.identity import described, own_code
from saleg.sweep.points import SweepError

Values = Mapping[str, float]


class Subject(Protocol):
    """What a sweep needs to know of what it sweeps."""

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns, in their order."""

    def unit(self, name: str) -> str:
        """Unit of an input; raises UnknownPath if there is none of that name."""

    def refuse_clash(self, names: list[str]) -> None:
        """Refuse inputs of which two stand for one number."""

    def describe(self) -> dict[str, Any]:
        """All that decides about the results, as plain data."""

    def solver(self, rtol: float, multipliers: bool, warm: bool) -> Callable[[Values], Row]:
        """What makes a row of a point; may remember the point before."""


@dataclasses.dataclass(frozen=True)
class DesignSubject:
    """Designs: inputs are the eight parameters, or paths of the engine and the mass models."""

    design: Design

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns."""
        return DESIGN_UNITS

    def unit(self, name: str) -> str:
        """Unit of an input; refuses what the parameters or the loop decide about."""
        unit = self.design.unit(name)
        _refuse_parts(name, self.design.get(name))
        self.design.replace({name: float("nan")})  # an object of its own, to be found again
        return unit

    def refuse_clash(self, names: list[str]) -> None:
        """Refuse inputs of which two stand for one number."""
        self.design.replace(dict.fromkeys(names, math.nan))

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

    def solver(self, rtol: float, multipliers: bool, warm: bool) -> Callable[[Values], Row]:
        """What makes a row of a point."""
        return Follower(self.design, rtol, multipliers, warm)


@dataclasses.dataclass(frozen=True)
class EngineSubject:
    """An engine as it stands: inputs are its paths, the moving mass among them."""

    engine: Engine

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns."""
        return STEADY_UNITS

    def unit(self, name: str) -> str:
        """Unit of an input."""
        unit = unit_of(self.engine, name)
        with suppress(UnknownPath):  # left and right differ: a number for both of them
            _refuse_parts(name, self.engine.get(name))
        return unit

    def refuse_clash(self, names: list[str]) -> None:
        """Refuse inputs of which two stand for one number."""
        self.engine.replace(**dict.fromkeys(names, math.nan))

    def describe(self) -> dict[str, Any]:
        """The engine."""
        return {"kind": "engine", **_laws(self.engine)}

    def solver(self, rtol: float, multipliers: bool, warm: bool) -> Callable[[Values], Row]:
        """What makes a row of a point, from the engine's own starts."""
        if warm:
            raise SweepError("warm starts are for designs; an engine begins with its own starts")

        def row(values: Values) -> Row:
            found = found_steady_state(self.engine.replace(**values), rtol)
            return steady_row(found, multipliers)

        return row


def _refuse_parts(name: str, value: Any) -> None:
    if not is_number(value):
        raise SweepError(f"{name} is no number but a {type(value).__name__}: name one of its own")


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
            f"cannot sweep {swept!r}: must be a Design, an Engine, or nothing for the designs of "
            "Chapter 4"
        )
    return swept
