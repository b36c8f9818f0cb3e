"""Parts of an engine: translator, intake, fuel, and the chambers with the laws in their slots."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from saleg.laws import (
    CFRIgnition,
    ChangGas,
    CompleteCombustion,
    FixedWall,
    Hohenberg,
    InstantExchange,
    NoHeatTransfer,
    NoLeak,
    NoMisfires,
    Plenum,
    PortMixing,
    Wiebe,
)
from saleg.laws.base import (
    CHAMBER_SLOTS,
    Completeness,
    GasExchange,
    GasProperties,
    HeatRelease,
    HeatTransfer,
    Ignition,
    Injection,
    Law,
    Leak,
    Misfires,
    Supply,
    Wall,
)
from saleg.laws.usual import GAP, LENGTH
from saleg.quantities import Quantities, fields_of, quantity

#: Ranges of what has been built, from a bore of 3 mm to ship engines and gas springs; a value
#: outside is allowed but likely in another unit.
BORE = 1e-4, 1.0
AIR_FUEL_RATIO = 1.0, 60.0
MASS = 1e-4, 1e3
PRESSURE = 1e4, 2e7
TEMPERATURE = 200.0, 1500.0
WALL = 100.0, 1500.0
HEATING_VALUE = 1e6, 2e8


@dataclass(frozen=True)
class Translator(Quantities):
    """The moving part: pistons, rod, alternator mover and the springs' share.

    Parameters
    ----------
    mass : float
        Total moving mass [kg].
    """

    mass: float = quantity("kg", low=0, open_low=True, usual=MASS)


@dataclass(frozen=True)
class Intake(Quantities):
    """State of the intake manifold.

    Parameters
    ----------
    pressure : float
        Intake pressure [Pa].
    temperature : float
        Intake temperature [K].
    """

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0, usual=TEMPERATURE)


@dataclass(frozen=True)
class Fuel(Quantities):
    """Fuel; the defaults stand for methane (3.4).

    Parameters
    ----------
    lower_heating_value : float
        Lower heating value [J/kg].
    air_fuel_ratio : float
        Stoichiometric air-fuel ratio by mass [-].
    """

    lower_heating_value: float = quantity(
        "J/kg", default=48e6, low=0, open_low=True, usual=HEATING_VALUE
    )
    air_fuel_ratio: float = quantity("-", default=17.5, low=0, open_low=True, usual=AIR_FUEL_RATIO)


class ReferenceState(NamedTuple):
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


class Chamber(Quantities):
    """What stands at either end of the translator: a chamber with gas, or an open end.

    Attributes
    ----------
    half_stroke : float
        Neutral clearance length L [m]: room for the crown when the translator is at its midpoint.
    head_gap : float
        Clearance at which the run ends with head contact [m].
    """

    half_stroke: float
    head_gap: float

    @property
    def area(self) -> float:
        """Area of the bore [m^2]; of an open end, whose gas nobody follows, none."""
        return 0.0

    @property
    def laws(self) -> dict[str, Law]:
        """Laws of the chamber by slot; only a chamber that burns fuel has laws of combustion."""
        kind: Any = type(self)
        return {slot: getattr(self, slot) for slot in _slots_of(kind)}

    @cached_property
    def states(self) -> frozenset[str]:
        """States its laws ask for, beside pressure: see :attr:`saleg.laws.Law.states`."""
        return frozenset(name for law in self.laws.values() for name in law.states)

    @property
    def is_sealed(self) -> bool:
        """Whether it keeps its gas for ever."""
        return False

    @property
    def reference_state(self) -> ReferenceState:
        """State in which its charge is known."""
        raise NotImplementedError


@lru_cache(maxsize=64)
def _slots_of(kind: Any) -> tuple[str, ...]:
    """Slots that chambers of a class have; looked up at every step of a search."""
    names = {item.name for item in fields_of(kind)}
    return tuple(slot for slot in CHAMBER_SLOTS if slot in names)


@dataclass(frozen=True, kw_only=True)
class GasChamber(Chamber):
    """What all chambers that hold gas have in common.

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
    back_area : float
        Area on which a constant pressure acts behind the piston, against the chamber [m^2].
    back_pressure : float
        That pressure [Pa].
    leak, wall : Law
        Gap past the rings, and what the temperature of the wall does.
    gas_properties : Law
        Ratio of specific heats of its gas.
    """

    bore: float = quantity("m", low=0, open_low=True, usual=BORE)
    half_stroke: float = quantity("m", low=0, open_low=True, usual=LENGTH)
    wall_temperature: float = quantity("K", default=550.0, low=100.0, high=3000.0, usual=WALL)
    head_gap: float = quantity("m", default=1e-4, low=0, open_low=True, usual=GAP)
    back_area: float = quantity("m^2", default=0.0, low=0)
    back_pressure: float = quantity("Pa", default=0.0, low=0)
    leak: Leak = field(default_factory=NoLeak)
    wall: Wall = field(default_factory=FixedWall)
    if TYPE_CHECKING:  # declared where files have it
        gas_properties: GasProperties = field(default_factory=ChangGas)

    @property
    def area(self) -> float:
        """Area of the bore [m^2]."""
        return math.pi * self.bore**2 / 4.0


@dataclass(frozen=True, kw_only=True)
class OpenEnd(Chamber):
    """The end of an engine that has one chamber only: its back, open to the surroundings.

    The pressure of the surroundings acts on the bore of the chamber opposite. ``right=None`` of an
    engine stands for ``OpenEnd()``.

    Parameters
    ----------
    pressure : float
        Pressure of the surroundings [Pa].
    half_stroke : float
        Room for the translator beyond its midpoint [m].
    head_gap : float
        What is left of it when the run ends with head contact [m].
    """

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    half_stroke: float = quantity("m", default=1.0, low=0, open_low=True, usual=LENGTH)
    head_gap: float = quantity("m", default=1e-4, low=0, open_low=True, usual=GAP)

    @property
    def reference_state(self) -> ReferenceState:
        """State of the surroundings."""
        return ReferenceState(self.pressure, 300.0, self.half_stroke)


@dataclass(frozen=True, kw_only=True)
class CombustionChamber(GasChamber):
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
    heat_transfer, heat_release, ignition, completeness, gas_exchange, injection, misfires : Law
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
    completeness: Completeness = field(default_factory=CompleteCombustion)
    gas_exchange: GasExchange = field(default_factory=InstantExchange)
    injection: Injection = field(default_factory=PortMixing)
    misfires: Misfires = field(default_factory=NoMisfires)


@dataclass(frozen=True, kw_only=True)
class Cylinder(CombustionChamber):
    """A ported two-stroke combustion cylinder.

    Parameters
    ----------
    port_closing : float
        Clearance between crown and head at which the ports close, d_po [m].
    intake : Intake
    supply : Law
        What stands before the intake ports.
    """

    port_closing: float = quantity("m", low=0, open_low=True, usual=LENGTH)
    intake: Intake = field(default_factory=Intake)
    supply: Supply = field(default_factory=Plenum)

    @property
    def reference_state(self) -> ReferenceState:
        """State of the fresh charge as the ports close."""
        return ReferenceState(self.intake.pressure, self.intake.temperature, self.port_closing)


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

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0, usual=TEMPERATURE)
    curve_exponent: float = quantity("-", default=1.4, low=1, open_low=True)

    @property
    def reference_state(self) -> ReferenceState:
        """State of a fresh charge at the midpoint."""
        return ReferenceState(self.pressure, self.temperature, self.half_stroke)


@dataclass(frozen=True, kw_only=True)
class BounceChamber(GasChamber):
    """A closed gas spring.

    Parameters
    ----------
    pressure : float
        Pressure with the translator at its midpoint [Pa].
    temperature : float
        Temperature there [K].
    heat_transfer : Law
        What heat it loses to its wall.
    """

    pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=PRESSURE)
    temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0, usual=TEMPERATURE)
    gas_properties: GasProperties = field(default_factory=ChangGas)
    heat_transfer: HeatTransfer = field(default_factory=NoHeatTransfer)

    @property
    def is_sealed(self) -> bool:
        """Whether it keeps its gas for ever: no law lets any in or out."""
        return "contents" not in self.states

    @property
    def reference_state(self) -> ReferenceState:
        """State at the midpoint."""
        return ReferenceState(self.pressure, self.temperature, self.half_stroke)
