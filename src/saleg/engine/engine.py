"""The engine: a translator between two chambers, with laws in slots.

Everything is a frozen dataclass of numbers in SI units; nothing here computes. See
:mod:`saleg.engine.paths` for reading and changing an engine by dotted paths.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, is_dataclass
from pathlib import Path
from typing import Any

from saleg.columns import least_of
from saleg.engine import paths
from saleg.engine.chambers import (
    Chamber,
    CombustionChamber,
    Cylinder,
    Fuel,
    GasChamber,
    Intake,
    OpenEnd,
    Translator,
)
from saleg.engine.charge_gas import is_gas_of_fuel, other_gases, with_gas_of_charge
from saleg.engine.start import CompressedCharge, Start
from saleg.errors import InvalidEngine, SalegWarning
from saleg.laws import (
    Crankcase,
    DirectInjection,
    FixedFrame,
    Law,
    LinearLoad,
    LinearSprings,
    NoScatter,
    PortFlow,
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
from saleg.quantities import Problem, fields_of, is_number, problems, unusual


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
        found = _slot_problems(self)
        if found:
            return found
        return self._each_part(problems) + _geometry_problems(self)

    def unusual(self) -> list[Problem]:
        """Every number of a valid engine that is far from what has been built.

        Each names the usual range and, if one fits, the unit the number may have been given in.
        """
        return [*self._each_part(unusual), *other_gases(self)]

    def _each_part(self, look: Callable[[Any, str], list[Problem]]) -> list[Problem]:
        """What is found in the parts, with their paths; chambers that are alike count once."""
        names = ["translator", *ENGINE_SLOTS, "start"]
        parts = [(name, getattr(self, name)) for name in names]
        if self.is_mirrored:
            parts.append(("", self.left))
        else:
            parts += [("left", self.left), ("right", self.right)]
        return [problem for path, part in parts for problem in look(part, path)]

    def validate(self) -> None:
        """Raise one error naming every wrong field.

        Raises
        ------
        InvalidEngine
            Its ``problems`` give field, value, unit and allowed range.
        """
        found = self.problems()
        if found:
            raise InvalidEngine(found)

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


def _slot_problems(engine: Engine) -> list[Problem]:
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
    return found


def _kind_problem(value: Any, kind: type, path: str) -> list[Problem]:
    if isinstance(value, kind):
        return []
    hint = "; saleg.fuels.fill sets fuel and gas" if kind is Fuel else ""
    return [Problem(path, value, "-", f"must be a {kind.__name__}{hint}")]


def lengths_fit(engine: Engine) -> Any:
    """Whether no lengths contradict each other; of an engine of columns, in each row."""
    most = engine.left.half_stroke + engine.right.half_stroke
    fit = True
    for chamber in engine.chambers:
        gap, port = chamber.head_gap, getattr(chamber, "port_closing", most / 2)
        fit = fit & (gap < chamber.half_stroke) & (gap < port) & (port < most)
    limits = (
        *_limits_of_flow(engine, most),
        *_limits_of_backs(engine),
        *_limits_of_injection(engine, most),
        *_limits_of_composition(engine),
    )
    for _, _, good, _, _ in limits:
        fit = fit & good
    return fit


def _geometry_problems(engine: Engine) -> list[Problem]:
    """Lengths that contradict each other."""
    found = []
    lengths = [chamber.half_stroke for chamber in engine.chambers]
    if not all(is_number(length) for length in lengths):
        return []
    most = sum(float(length) for length in lengths)
    sides = ("",) if engine.is_mirrored else ("left.", "right.")
    for side, chamber in zip(sides, engine.chambers, strict=False):
        gap, port = chamber.head_gap, getattr(chamber, "port_closing", most / 2)
        if is_number(gap) and gap >= chamber.half_stroke:
            allowed = f"must be < half_stroke ({chamber.half_stroke:g} m)"
            found.append(Problem(side + "head_gap", gap, "m", allowed))
        if is_number(port) and is_number(gap) and not gap < port < most:
            allowed = f"must be > head_gap ({gap:g} m) and < the maximum stroke ({most:g} m)"
            found.append(Problem(side + "port_closing", port, "m", allowed))
    if not found and all(_has_numbers(chamber) for chamber in engine.chambers):
        limits = (
            *_limits_of_flow(engine, most),
            *_limits_of_backs(engine),
            *_limits_of_injection(engine, most),
            *_limits_of_composition(engine),
            *_limits_of_foresight(engine),
        )
        for number, path, good, unit, allowed in limits:
            if not good and number < len(sides):
                path = sides[number] + path
                found.append(Problem(path, paths.get(engine, path), unit, allowed))
    return found


def _has_numbers(chamber: Chamber) -> bool:
    """Whether all of ports, crankcase, injection and the back of the piston are numbers."""
    slots = "gas_exchange", "supply", "injection"
    parts = [getattr(chamber, slot) for slot in slots if hasattr(chamber, slot)]
    kinds: list[Any] = [type(part) for part in parts]
    numbers = [
        getattr(part, item.name)
        for part, kind in zip(parts, kinds, strict=True)
        for item in fields_of(kind)
    ]
    if isinstance(chamber, GasChamber):
        numbers += [chamber.back_area, chamber.back_pressure]
    return all(map(is_number, numbers))


def _limits_of_backs(engine: Engine) -> Iterator[tuple[int, str, Any, str, str]]:
    """Limits of pressures behind the pistons, as :func:`_limits_of_flow` has them."""
    for side, chamber in enumerate(engine.chambers):
        opposite = engine.chambers[1 - side]
        if isinstance(chamber, OpenEnd):
            allowed = "must have a chamber with gas opposite"
            yield side, "pressure", isinstance(opposite, GasChamber), "Pa", allowed
        elif isinstance(opposite, OpenEnd):
            allowed = "must be 0 opposite an open end, whose pressure acts behind the piston"
            kept = chamber.back_pressure == 0.0  # type: ignore[attr-defined]
            yield side, "back_pressure", kept, "Pa", allowed
        else:
            area, pressure = chamber.back_area, chamber.back_pressure  # type: ignore[attr-defined]
            kept = (area > 0.0) | (pressure == 0.0)
            yield side, "back_area", kept, "m^2", "must be > 0 with a back_pressure"


def _limits_of_injection(engine: Engine, most: Any) -> Iterator[tuple[int, str, Any, str, str]]:
    """Limits of direct injection, as :func:`_limits_of_flow` has them."""
    for side, chamber in enumerate(engine.chambers):
        if not isinstance(chamber, CombustionChamber) or not chamber.injection.is_direct:
            continue
        first, allowed = most, "must be > head_gap and < the maximum stroke"
        if isinstance(chamber, Cylinder):
            first, allowed = chamber.port_closing, "must be > head_gap and < port_closing"
        place = chamber.injection.place
        kept = (chamber.head_gap < place) & (place < first)
        is_ours = isinstance(chamber.injection, DirectInjection)
        yield side, "injection.clearance" if is_ours else "injection", kept, "m", allowed


def _limits_of_composition(engine: Engine) -> Iterator[tuple[int, str, Any, str, str]]:
    """Limits of gases that follow the composition, as :func:`_limits_of_flow` has them."""
    for side, chamber in enumerate(engine.chambers):
        gas = getattr(chamber, "gas_properties", None)
        if gas is not None and gas.follows_composition:
            flows = any("contents" in law.states for law in chamber.laws.values() if law != gas)
            allowed = (
                "must be one gas, such as MixtureGas, in a chamber that gas flows or leaks into"
            )
            yield side, "gas_properties", not flows, "-", allowed
        allowed = "must be the fuel that gas_properties is made of: saleg.fuels.fill sets both"
        yield side, "fuel", is_gas_of_fuel(chamber), "-", allowed


def _limits_of_flow(engine: Engine, most: Any) -> Iterator[tuple[int, str, Any, str, str]]:
    """Limits of ports and crankcases: side, path, whether it is kept, unit and what is allowed."""
    for side, chamber in enumerate(engine.chambers):
        if not isinstance(chamber, Cylinder):
            continue
        ports, supply = chamber.gas_exchange, chamber.supply
        if isinstance(ports, PortFlow):
            room = most - chamber.port_closing
            allowed = "must be less than the way from port_closing to the maximum stroke"
            kept = ports.intake_delay < room
            yield side, "gas_exchange.intake_delay", kept, "m", allowed
        if isinstance(supply, Crankcase):
            allowed = "must be more than the piston displaces on its way from the midpoint"
            kept = supply.volume(most - chamber.half_stroke) > 0.0
            yield side, "supply.volume_at_midpoint", kept, "m^3", allowed
            allowed = "must be a PortFlow, or another law by which gas flows, with a crankcase"
            flows = "contents" in ports.states
            yield side, "gas_exchange", flows, "-", allowed


def _limits_of_foresight(engine: Engine) -> Iterator[tuple[int, str, Any, str, str]]:
    """Limits of laws that foresee dead centres, as :func:`_limits_of_flow` has them."""
    burns = all(isinstance(chamber, CombustionChamber) for chamber in engine.chambers)
    for side, chamber in enumerate(engine.chambers):
        if isinstance(chamber, CombustionChamber) and chamber.ignition.foresees_dead_centre:
            allowed = (
                "must not foresee the dead centre from the stroke before in an engine with one "
                "cylinder, whose strokes either way differ: take SparkAtClearance"
            )
            yield side, "ignition", burns, "-", allowed
