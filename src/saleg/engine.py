"""The engine: a translator between two chambers, with laws in slots.

Everything is a frozen dataclass of numbers in SI units; nothing here computes. See
:mod:`saleg.paths` for reading and changing an engine by dotted paths.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, NamedTuple

from saleg.errors import InvalidEngine
from saleg.laws import (
    CFRIgnition,
    ChangGas,
    Hohenberg,
    InstantExchange,
    Law,
    LinearLoad,
    LinearSprings,
    NoHeatTransfer,
    NoMisfires,
    ViscousFriction,
    Wiebe,
)
from saleg.laws.base import (
    CHAMBER_SLOTS,
    ENGINE_SLOTS,
    Alternator,
    Friction,
    GasExchange,
    GasProperties,
    HeatRelease,
    HeatTransfer,
    Ignition,
    Misfires,
    Springs,
)
from saleg.quantities import Problem, is_number, problems, quantity
from saleg.start import CompressedCharge, Start


@dataclass(frozen=True)
class Translator:
    """The moving part: pistons, rod, alternator mover and the springs' share.

    Parameters
    ----------
    mass : float
        Total moving mass [kg].
    """

    mass: float = quantity("kg", low=0, open_low=True)


@dataclass(frozen=True)
class Intake:
    """State of the intake manifold.

    Parameters
    ----------
    pressure : float
        Intake pressure [Pa].
    temperature : float
        Intake temperature [K].
    """

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0)


@dataclass(frozen=True)
class Fuel:
    """Fuel; the defaults stand for methane (3.4).

    Parameters
    ----------
    lower_heating_value : float
        Lower heating value [J/kg].
    air_fuel_ratio : float
        Stoichiometric air-fuel ratio by mass [-].
    """

    lower_heating_value: float = quantity("J/kg", default=48e6, low=0, open_low=True)
    air_fuel_ratio: float = quantity("-", default=17.5, low=0, open_low=True)


class Filling(NamedTuple):
    """State in which the charge of a chamber is known: at port closing, or at the midpoint.

    Attributes
    ----------
    pressure, temperature : float
        [Pa], [K].
    clearance : float
        Distance between crown and head there [m].
    """

    pressure: float
    temperature: float
    clearance: float


@dataclass(frozen=True, kw_only=True)
class Chamber:
    """What all chambers have in common.

    Parameters
    ----------
    bore : float
        Bore b [m].
    half_stroke : float
        Neutral clearance length L [m]: crown to head when the translator is at its midpoint.
    wall_temperature : float
        Temperature of head, liner and crown [K].
    head_gap : float
        Clearance at which the run ends with head contact [m].
    """

    bore: float = quantity("m", low=0, open_low=True)
    half_stroke: float = quantity("m", low=0, open_low=True)
    wall_temperature: float = quantity("K", default=550.0, low=100.0, high=3000.0)
    head_gap: float = quantity("m", default=1e-4, low=0, open_low=True)

    @property
    def filling(self) -> Filling:
        """State in which its charge is known."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class CombustionChamber(Chamber):
    """What all chambers that burn fuel have in common.

    Parameters
    ----------
    equivalence_ratio : float
        Equivalence ratio of the charge, phi [-]; 0 cuts the fuel.
    combustion_efficiency : float
        Share of the fuel that can burn, eta_comb [-].
    late_ignition : float
        1 if a charge that has not lit by its dead centre may still light itself later, while it is
        trapped; 0 if it may not [-].
    fuel : Fuel
    gas_properties, heat_transfer, heat_release, ignition, gas_exchange, misfires : Law
        The laws in the chamber's slots.
    """

    equivalence_ratio: float = quantity("-", default=0.6, low=0, high=10)
    combustion_efficiency: float = quantity("-", default=0.95, low=0, high=1)
    late_ignition: float = quantity("-", default=0.0, low=0, high=1)
    fuel: Fuel = field(default_factory=Fuel)
    gas_properties: GasProperties = field(default_factory=ChangGas)
    heat_transfer: HeatTransfer = field(default_factory=Hohenberg)
    heat_release: HeatRelease = field(default_factory=Wiebe)
    ignition: Ignition = field(default_factory=CFRIgnition)
    gas_exchange: GasExchange = field(default_factory=InstantExchange)
    misfires: Misfires = field(default_factory=NoMisfires)


@dataclass(frozen=True, kw_only=True)
class Cylinder(CombustionChamber):
    """A ported two-stroke combustion cylinder.

    Parameters
    ----------
    port_closing : float
        Clearance between crown and head at which the ports close, d_po [m].
    intake : Intake
    """

    port_closing: float = quantity("m", low=0, open_low=True)
    intake: Intake = field(default_factory=Intake)

    @property
    def filling(self) -> Filling:
        """State of the fresh charge as the ports close."""
        return Filling(self.intake.pressure, self.intake.temperature, self.port_closing)


@dataclass(frozen=True, kw_only=True)
class SealedCylinder(CombustionChamber):
    """A combustion chamber without ports, as Chapter 2 has it (2.3).

    At its bottom dead centre its charge is replaced by a fresh one of the same mass, wherever that
    is: heat is rejected in an instant, down to the curve ``p V^n`` through the midpoint state.

    Parameters
    ----------
    pressure : float
        Pressure of a fresh charge with the translator at its midpoint, P_mp [Pa].
    temperature : float
        Temperature there [K].
    curve_exponent : float
        Exponent n of the curve fresh charges lie on [-]; the ratio of specific heats in 2.3.
    """

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0)
    curve_exponent: float = quantity("-", default=1.4, low=1, open_low=True)

    @property
    def filling(self) -> Filling:
        """State of a fresh charge at the midpoint."""
        return Filling(self.pressure, self.temperature, self.half_stroke)


@dataclass(frozen=True, kw_only=True)
class BounceChamber(Chamber):
    """A closed gas spring.

    Parameters
    ----------
    pressure : float
        Pressure with the translator at its midpoint [Pa].
    temperature : float
        Temperature there [K].
    gas_properties, heat_transfer : Law
        The laws in the chamber's slots.
    """

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0)
    gas_properties: GasProperties = field(default_factory=ChangGas)
    heat_transfer: HeatTransfer = field(default_factory=NoHeatTransfer)

    @property
    def filling(self) -> Filling:
        """State at the midpoint."""
        return Filling(self.pressure, self.temperature, self.half_stroke)


@dataclass(frozen=True)
class Engine:
    """A free-piston engine: a translator between a left and a right chamber.

    Build a symmetric engine with :meth:`mirrored`; the position x is zero at the midpoint and
    positive to the right.

    Parameters
    ----------
    translator : Translator
    left, right : Cylinder, SealedCylinder or BounceChamber
    springs, friction, alternator : Law
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
    start: Start = field(default_factory=CompressedCharge)
    name: str = "engine"

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
        return self.left == self.right

    @property
    def chambers(self) -> tuple[Chamber, Chamber]:
        """Left and right chamber."""
        return self.left, self.right

    @property
    def fires(self) -> bool:
        """Whether at least one chamber burns fuel."""
        return any(isinstance(chamber, CombustionChamber) for chamber in self.chambers)

    @property
    def maximum_stroke(self) -> float:
        """Greatest geometrically possible stroke [m]."""
        return self.left.half_stroke + self.right.half_stroke

    def get(self, path: str) -> Any:
        """Value at a dotted path, such as ``"intake.pressure"`` (SI).

        Raises
        ------
        UnknownPath
            With the nearest existing names.
        """
        from saleg.paths import get

        return get(self, path)

    def replace(self, **changes: Any) -> Engine:
        """Copy of the engine with some values, laws or parts replaced.

        Parameters
        ----------
        **changes
            New values (SI) by dotted path; paths with dots are passed as
            ``**{"intake.temperature": 300.0}``. A path of a cylinder changes both sides unless
            ``left.`` or ``right.`` stands before it.

        Returns
        -------
        Engine
            Not validated: see :meth:`validate`.

        Raises
        ------
        UnknownPath
            With the nearest existing names.
        """
        from saleg.paths import replace

        return replace(self, changes)

    def problems(self) -> list[Problem]:
        """Every wrong field of the engine; empty when it is valid."""
        found = _slot_problems(self)
        if found:
            return found
        for part in ("translator", "springs", "friction", "alternator", "start"):
            found += problems(getattr(self, part), part)
        if self.is_mirrored:
            found += problems(self.left)
        else:
            found += problems(self.left, "left") + problems(self.right, "right")
        return found + _geometry_problems(self)

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

    def to_toml(self) -> str:
        """The engine as TOML text that :meth:`from_toml` reads back exactly."""
        from saleg.files import to_toml

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
        from saleg.files import read_toml

        return read_toml(path, laws)


_CHAMBER_PARTS: dict[str, type] = {**CHAMBER_SLOTS, "intake": Intake, "fuel": Fuel}


def _slot_problems(engine: Engine) -> list[Problem]:
    """Parts and laws that are not of the kind their place asks for."""
    found = []
    for name, kind in (("translator", Translator), ("start", Start), *ENGINE_SLOTS.items()):
        found += _kind_problem(getattr(engine, name), kind, name)
    for side, chamber in zip(("left", "right"), engine.chambers, strict=True):
        found += _kind_problem(chamber, Chamber, side)
        for item in fields(chamber) if isinstance(chamber, Chamber) else ():
            if item.name in _CHAMBER_PARTS:
                part, kind = getattr(chamber, item.name), _CHAMBER_PARTS[item.name]
                found += _kind_problem(part, kind, f"{side}.{item.name}")
    return found


def _kind_problem(value: Any, kind: type, path: str) -> list[Problem]:
    if isinstance(value, kind):
        return []
    return [Problem(path, value, "-", f"must be a {kind.__name__}")]


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
    return found
