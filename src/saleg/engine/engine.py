"""The engine: a translator between two chambers, with laws in slots.

Everything is a frozen dataclass of numbers in SI units; nothing here computes. See
:mod:`saleg.engine.paths` for reading and changing an engine by dotted paths.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass
from pathlib import Path
from typing import Any

from saleg.columns import least_of
from saleg.engine import paths
from saleg.engine.chambers import (
    Chamber,
    CombustionChamber,
    Fuel,
    GasChamber,
    Intake,
    OpenEnd,
    Translator,
)
from saleg.engine.charge_gas import other_gases, with_gas_of_charge
from saleg.engine.limits import is_within, limits_exceeded, paths_of, windows_too_wide
from saleg.engine.start import CompressedCharge, Start
from saleg.errors import InvalidEngine, LawError, SalegWarning
from saleg.laws import (
    FixedFrame,
    Law,
    LinearLoad,
    LinearSprings,
    NoScatter,
    ViscousFriction,
)
from saleg.laws.base import (
    CHAMBER_SLOTS,
    ENGINE_SLOTS,
    Alternator,
    Frame,
    Friction,
    Scatter,
    Springs,
)
from saleg.laws.contract import check_laws
from saleg.quantities import Problem, Quantities, fields_of, problems, unusual


@dataclass(frozen=True)
class Engine:
    """A free-piston engine: a translator between a left and a right chamber.

    Build a symmetric engine with :meth:`mirrored`; the position x is zero at the midpoint and
    positive to the right.

    Parameters
    ----------
    translator : Translator
    left, right : Cylinder, SealedCylinder, BounceChamber or OpenEnd
        None stands for an open end: an engine with one chamber, returned by its springs.
    springs, friction, alternator, frame, scatter : Law
        The laws in the engine's slots.
    start : Start
        How a run begins.
    name : str
        What people call it.

    Examples
    --------
    >>> import saleg
    >>> engine = saleg.machines.thesis_base()
    >>> engine.get("bore"), engine.is_mirrored
    (0.064, True)
    >>> engine.replace(bore=0.060).get("left.bore")
    0.06
    """

    translator: Translator
    left: Chamber
    right: Chamber
    springs: Springs = field(default_factory=LinearSprings)
    friction: Friction = field(default_factory=ViscousFriction)
    alternator: Alternator = field(default_factory=LinearLoad)
    frame: Frame = field(default_factory=FixedFrame)
    scatter: Scatter = field(default_factory=NoScatter)
    start: Start = field(default_factory=CompressedCharge)
    name: str = "engine"

    def __post_init__(self) -> None:
        for side in ("left", "right"):
            if getattr(self, side) is None:
                object.__setattr__(self, side, OpenEnd())

    @classmethod
    def mirrored(cls, translator: Translator, chamber: Chamber, **slots: Any) -> Engine:
        """Build an engine whose right chamber is the mirror image of its left one.

        Parameters
        ----------
        translator : Translator
        chamber : Cylinder, SealedCylinder or BounceChamber
            Used on both sides.
        **slots
            Further fields of :class:`Engine`.

        Returns
        -------
        Engine
        """
        return cls(translator=translator, left=chamber, right=chamber, **slots)

    @property
    def is_mirrored(self) -> bool:
        """Whether both chambers are alike."""
        try:
            return _alike(self.left, self.right)
        except Exception:  # arrays and the like where numbers should be: `problems` names them
            return False

    @property
    def chambers(self) -> tuple[Chamber, Chamber]:
        """Left and right chamber."""
        return self.left, self.right

    @property
    def gas_sides(self) -> tuple[str, ...]:
        """Sides with a chamber that holds gas: "left", "right" or both."""
        sides = zip(("left", "right"), self.chambers, strict=True)
        return tuple(side for side, chamber in sides if isinstance(chamber, GasChamber))

    @property
    def piston_areas(self) -> tuple[float, float]:
        """Area on which the pressure of either end acts [m^2]; of an open end, that opposite."""
        left, right = self.left.area, self.right.area
        only = left + right
        if len(self.gas_sides) == 2:
            return left, right
        return only, only

    @property
    def back_force(self) -> float:
        """Force of the constant pressures behind the pistons on the translator [N]."""
        left, right = (
            chamber.back_area * chamber.back_pressure if isinstance(chamber, GasChamber) else 0.0
            for chamber in self.chambers
        )
        return right - left

    @property
    def has_combustion(self) -> bool:
        """Whether at least one chamber burns fuel."""
        return any(isinstance(chamber, CombustionChamber) for chamber in self.chambers)

    @property
    def fires(self) -> bool:
        """Earlier name of :attr:`has_combustion`."""
        return self.has_combustion

    @property
    def laws(self) -> dict[str, Law]:
        """All laws by the path of their slot, such as ``"left.ignition"`` or ``"springs"``."""
        sides = zip(("left", "right"), self.chambers, strict=True)
        found = {f"{side}.{slot}": law for side, part in sides for slot, law in part.laws.items()}
        return found | {slot: getattr(self, slot) for slot in ENGINE_SLOTS}

    @property
    def needs_motored_pressure(self) -> bool:
        """Whether a heat-transfer law looks at the motored pressure; it is integrated then."""
        laws: list[Any] = [getattr(chamber, "heat_transfer", None) for chamber in self.chambers]
        return any(law is not None and law.needs_motored_pressure for law in laws)

    @property
    def maximum_stroke(self) -> float:
        """Greatest geometrically possible stroke [m]: the clearances at the midpoint together.

        Of a bounce chamber, or an open end, opposite a cylinder counts no more than the cylinder's
        own clearance: what it has beyond that is no room for the piston.
        """
        left, right = self.left.half_stroke, self.right.half_stroke
        burns = [isinstance(chamber, CombustionChamber) for chamber in self.chambers]
        if not any(burns):
            burns = [isinstance(chamber, GasChamber) for chamber in self.chambers]
        if burns == [True, False]:
            return left + least_of(left, right)
        if burns == [False, True]:
            return least_of(left, right) + right
        return left + right

    def get(self, path: str) -> Any:
        """Value at a dotted path, such as ``"intake.pressure"`` (SI).

        Raises
        ------
        UnknownPath
            With the nearest existing names.
        """
        return paths.get(self, path)

    def replace(self, /, **changes: Any) -> Engine:
        """Copy of the engine with some values, laws or parts replaced.

        Parameters
        ----------
        **changes
            New values (SI) by dotted path; paths with dots are passed as
            ``**{"intake.temperature": 300.0}``. A path of a chamber changes both sides unless
            ``left.`` or ``right.`` stands before it; where only one of them is a cylinder, it
            is the cylinder's. A law and one of its numbers may be given together. A gas made by
            :func:`saleg.fuels.fill` goes with the equivalence ratio and the retained share.

        Returns
        -------
        Engine
            Not validated: see :meth:`validate`.

        Raises
        ------
        UnknownPath
            With the nearest existing names.
        PathsClash
            If two names stand for one number: ``egr`` and ``gas_exchange.egr``, or ``bore`` and
            ``left.bore``.
        """
        return with_gas_of_charge(self, paths.replace(self, changes))

    def problems(self) -> list[Problem]:
        """Every wrong field of the engine; empty when it is valid."""
        found = _kind_problems(self)
        wrong = paths_of(self, found)
        by_themselves = self._each_part(problems)
        found += [problem for problem in by_themselves if not is_within(problem.path, wrong)]
        if all(isinstance(chamber, Chamber) for chamber in self.chambers):
            found += limits_exceeded(self, found)
        return found

    def unusual(self) -> list[Problem]:
        """Every number of a valid engine that is far from what has been built.

        Each names the usual range and, if one fits, the unit the number may have been given in.
        """
        return [*self._each_part(unusual), *windows_too_wide(self), *other_gases(self)]

    def _each_part(self, look: Callable[[Any, str], list[Problem]]) -> list[Problem]:
        """What is found in the parts, with their paths; chambers that are alike count once."""
        names = ["translator", *ENGINE_SLOTS, "start"]
        parts = [(name, getattr(self, name)) for name in names]
        if self.is_mirrored and isinstance(self.left, Chamber):
            parts.append(("", self.left))
        else:
            parts += [("left", self.left), ("right", self.right)]
        sound = [(path, part) for path, part in parts if isinstance(part, Quantities)]
        return [problem for path, part in sound for problem in look(part, path)]

    def validate(self) -> None:
        """Raise one error naming every wrong field.

        Raises
        ------
        InvalidEngine
            Its ``problems`` give field, value, unit and allowed range.
        """
        found = self.problems()
        if found:
            raise InvalidEngine(found + _law_problems(self))

    def check_laws(self) -> None:
        """Refuse laws that cannot be compiled, before any of them is called.

        Raises
        ------
        LawError
            Naming law and method.
        """
        check_laws(self.laws.values())

    def __repr__(self) -> str:
        kinds = ", ".join(type(chamber).__name__ for chamber in self.chambers)
        return f"<Engine {self.name!r}: {kinds}>"

    def _repr_html_(self) -> str:
        from saleg.display import engine_card

        return engine_card(self)

    def to_toml(self) -> str:
        """The engine as TOML text that :meth:`from_toml` reads back exactly."""
        from saleg.engine.toml import to_toml

        return to_toml(self)

    @classmethod
    def from_toml(cls, path: str | Path, laws: Sequence[type[Law]] = ()) -> Engine:
        """Read an engine file.

        Parameters
        ----------
        path : str or Path
            A TOML file as :meth:`to_toml` writes it.
        laws : sequence of Law classes, optional
            Laws of your own that the file may name.

        Returns
        -------
        Engine

        Raises
        ------
        EngineFileError
            Naming file and key.
        InvalidEngine
            Naming every value out of range.
        """
        from saleg.engine.toml import read_toml

        return read_toml(path, laws)


def check_engine(engine: Any) -> None:
    """Raise one error unless there is a valid engine.

    Raises
    ------
    InvalidEngine
    """
    if not isinstance(engine, Engine):
        raise InvalidEngine([Problem("engine", engine, "-", "must be a saleg.Engine")])
    engine.validate()


def engine_problems(engines: Any) -> list[Problem]:
    """Every wrong field of the `engines` a call is handed, each with its place among them."""
    if isinstance(engines, (str, bytes, Mapping)) or not isinstance(engines, Collection):
        return [Problem("engines", engines, "-", "must be a list of engines")]
    if not len(engines):
        return [Problem("engines", engines, "-", "there must be at least one")]
    found: list[Problem] = []
    once = {id(engine): (n, engine) for n, engine in reversed(list(enumerate(engines)))}
    for n, engine in sorted(once.values(), key=lambda item: item[0]):
        where = f"engines[{n}]"
        if isinstance(engine, Engine):
            found += (item._replace(path=f"{where}.{item.path}") for item in engine.problems())
        else:
            found.append(Problem(where, engine, "-", "must be a saleg.Engine"))
    return found


def warn_of_unusual(engine: Engine, *, frames: int = 1, **others: Any) -> None:
    """Warn once of all numbers of a valid engine that are far from what has been built.

    Parameters
    ----------
    engine : Engine
    frames : int
        Functions between this one and the user's line, which the warning names.
    **others
        What else the user gave, by name; of it, dataclasses are looked at.
    """
    found = engine.unusual()
    for name, given in others.items():
        if is_dataclass(given) and not isinstance(given, type):
            found += unusual(given, name)
    if found:
        lines = "\n".join(f"  {problem}" for problem in found)
        warnings.warn(f"unusual for an engine:\n{lines}", SalegWarning, stacklevel=2 + frames)


def _alike(one: Any, other: Any) -> bool:
    """Whether two parts are equal; with the same NaN in them ``==`` fails from Python 3.13 on."""
    if one is other or bool(one == other):
        return True
    if type(one) is not type(other) or not is_dataclass(one):
        return False
    kind: Any = type(one)
    names = [item.name for item in fields_of(kind)]
    return all(_alike(getattr(one, name), getattr(other, name)) for name in names)


_CHAMBER_PARTS: dict[str, type] = {**CHAMBER_SLOTS, "intake": Intake, "fuel": Fuel}


def _kind_problems(engine: Engine) -> list[Problem]:
    """Parts and laws that are not of the kind their place asks for."""
    found = []
    if not isinstance(engine.name, str):
        found.append(Problem("name", engine.name, "-", "must be text"))
    for name, kind in (("translator", Translator), ("start", Start), *ENGINE_SLOTS.items()):
        found += _kind_problem(getattr(engine, name), kind, name)
    for side, chamber in zip(("left", "right"), engine.chambers, strict=True):
        found += _kind_problem(chamber, Chamber, side)
        made: Any = type(chamber)
        for item in fields_of(made) if isinstance(chamber, Chamber) else ():
            if item.name in _CHAMBER_PARTS:
                part, kind = getattr(chamber, item.name), _CHAMBER_PARTS[item.name]
                found += _kind_problem(part, kind, f"{side}.{item.name}")
    if all(isinstance(chamber, OpenEnd) for chamber in engine.chambers):
        allowed = "must be a chamber that holds gas: left and right are both open ends (None)"
        found += [Problem(side, getattr(engine, side), "-", allowed) for side in ("left", "right")]
    return found


def _law_problems(engine: Engine) -> list[Problem]:
    """Laws of classes that cannot be compiled."""
    found = []
    for name in (*ENGINE_SLOTS, "left", "right"):
        part = getattr(engine, name)
        slots = {name: part}
        if isinstance(part, Chamber):
            slots = {f"{name}.{slot}": law for slot, law in part.laws.items()}
        for path, law in slots.items():
            if isinstance(law, Law):
                try:
                    check_laws([law])
                except LawError as error:
                    found.append(Problem(path, law, "-", str(error)))
    return found


def _kind_problem(value: Any, kind: type, path: str) -> list[Problem]:
    if isinstance(value, kind):
        return []
    article = "an" if kind.__name__[0] in "AEIOU" else "a"
    hint = "; saleg.fuels.fill sets fuel and gas" if kind is Fuel else ""
    return [Problem(path, value, "-", f"must be {article} {kind.__name__}{hint}")]
