"""A law: a frozen dataclass of numbers with one or two short methods, filling one slot.

The same method runs twice: as ordinary Python, and compiled into the kernel, where ``self`` is a
record of the same numbers. Hence what a law may use: its own numbers, module-level numbers and
functions, ``math`` and ``np``. It does not call its other methods through ``self``.
"""

from __future__ import annotations

import math
from typing import ClassVar, NamedTuple

from saleg.laws.arguments import Charge, Gas, Motion, Parts, Stroke
from saleg.quantities import Quantities


class Validity(NamedTuple):
    """Range of one quantity for which a law was made.

    Attributes
    ----------
    quantity : str
        "temperature" [K], "pressure" [Pa], "mean_piston_speed" [m/s], "equivalence_ratio",
        "burnt_share" of the charge by mass, "air_fuel_ratio" of the fuel, or "stroke_ratio",
        duration of the stroke towards the head over that of the one before [-].
    low, high : float
        The range, in the SI unit of the quantity.
    source : str
        Who says so.
    """

    quantity: str
    low: float
    high: float
    source: str


class Law(Quantities):
    """Base of all laws.

    Attributes
    ----------
    slot : str
        Name of the slot the law fills.
    compiled : tuple of str
        Methods the kernel calls; every law of a slot has all of them.
    optional : tuple of str
        Those among them with a default that suits most laws.
    at_every_step : tuple of str
        Those among them, of gas and charge, whose formula is reduced to fewer powers
        (:mod:`saleg.compiler.strength_reduction`).
    valid_for : tuple of Validity
        Ranges the law was made for; a run says where it left them. Where they follow from its
        numbers it has them as :attr:`ranges`.
    earlier_names : dict of str to str
        Methods that have another name now: a law that has only the earlier one is taken at that.
    mirrors : bool
        Whether its forces are the same in the mirror whatever its numbers; if not, a search for
        steady states finds out.
    states : tuple of str
        States of a chamber that the law asks for, by the names in
        :data:`saleg.kernel.layout.CHAMBER_STATES`: they are integrated then. Without one that asks
        they cost nothing.
    derived : tuple of str
        Properties that are series of numbers which follow from its own (``cached_property``), such
        as their logarithms: they are computed once and stand beside its numbers, compiled too.
    """

    slot: ClassVar[str] = ""
    compiled: ClassVar[tuple[str, ...]] = ()
    optional: ClassVar[tuple[str, ...]] = ()
    at_every_step: ClassVar[tuple[str, ...]] = ()
    valid_for: ClassVar[tuple[Validity, ...]] = ()
    earlier_names: ClassVar[dict[str, str]] = {}
    mirrors: ClassVar[bool] = False
    states: ClassVar[tuple[str, ...]] = ()
    derived: ClassVar[tuple[str, ...]] = ()

    @property
    def ranges(self) -> tuple[Validity, ...]:
        """Ranges a law of these numbers was made for: `valid_for` unless it says otherwise."""
        return self.valid_for

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        for earlier, name in cls.earlier_names.items():
            if earlier in vars(cls) and name not in vars(cls):
                setattr(cls, name, vars(cls)[earlier])


class GasProperties(Law):
    """Caloric properties of the ideal gas in a chamber; needs a field ``gas_constant`` [J/kg/K].

    One gas for the whole cycle; or, of a law that follows the composition, the sum of fuel, air and
    burnt gas as they stand in the chamber. That one asks for the state "contents" and has
    :meth:`heat_capacity_of`, :meth:`energy_of` and :attr:`gas_constants` as well; gamma and
    internal energy are then those of a fresh charge, for what happens before a run.

    Attributes
    ----------
    follows_composition : bool
        Whether it does.
    """

    slot = "gas_properties"
    compiled = ("gamma", "internal_energy", "breakpoint", "heat_capacity_of", "energy_of")
    optional = ("breakpoint", "heat_capacity_of", "energy_of")
    follows_composition: ClassVar[bool] = False
    earlier_names: ClassVar[dict[str, str]] = {"kink": "breakpoint"}

    gas_constant: float

    def gamma(self, T: float) -> float:
        """Ratio of specific heats [-] at temperature `T` [K]."""
        raise NotImplementedError

    def internal_energy(self, T: float) -> float:
        """Specific internal energy [J/kg] at temperature `T` [K]: the integral of R/(gamma - 1)."""
        raise NotImplementedError

    def breakpoint(self) -> float:
        """Temperature at which gamma is not smooth [K], so that steps end there; 0 for none."""
        return 0.0

    def heat_capacity_of(self, T: float, parts: Parts) -> float:
        """Heat capacity of parts of the gas at constant volume [J/K], the sum over them."""
        return 0.0

    def energy_of(self, T: float, parts: Parts) -> float:
        """Internal energy of parts of the gas [J], or its rate [W]: the sum over them.

        Of each it is the enthalpy above the temperature at which the heating value is told, less
        ``R T``; so the heating value is all that combustion adds.
        """
        return 0.0

    @property
    def gas_constants(self) -> tuple[float, float, float]:
        """Specific gas constants of fuel, air and burnt gas [J/kg/K]."""
        return (self.gas_constant,) * 3


class HeatTransfer(Law):
    """Heat transfer from the gas to the wall.

    Attributes
    ----------
    needs_motored_pressure : bool
        Whether it looks at ``gas.p_motored``; every run with the law then integrates it.
    """

    slot = "heat_transfer"
    compiled = ("coefficient",)
    at_every_step = ("coefficient",)
    needs_motored_pressure: ClassVar[bool] = False

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]."""
        raise NotImplementedError


class HeatRelease(Law):
    """Course of the heat release once the charge is lit."""

    slot = "heat_release"
    compiled = ("duration", "burn_rate", "burnt_fraction", "next_breakpoint")
    optional = ("next_breakpoint",)

    def duration(self, gas: Gas, charge: Charge) -> float:
        """Combustion duration [s], asked once, at the start of combustion."""
        raise NotImplementedError

    def burn_rate(self, u: float) -> float:
        """Derivative of :meth:`burnt_fraction` [-] with respect to `u`."""
        raise NotImplementedError

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-] at `u`, the time since start of combustion over the duration."""
        raise NotImplementedError

    def next_breakpoint(self, u: float) -> float:
        """Least phase above `u` at which the burn rate is not smooth [-]; 1 or more for none.

        Steps end there, and up to there they see the rate on the near side of it.
        """
        return 1.0


class Ignition(Law):
    """Start of combustion by an integral that starts at port closing.

    Attributes
    ----------
    is_timed : bool
        Whether a spark or an injection sets the moment; else the charge lights itself.
    foresees_dead_centre : bool
        Whether it looks at ``charge.time_to_dead_centre``, which is right where strokes either way
        last equally long: an engine with one cylinder is refused.
    """

    slot = "ignition"
    is_timed: ClassVar[bool] = False
    foresees_dead_centre: ClassVar[bool] = False
    compiled = ("rate", "lights_at_dead_centre")
    optional = ("lights_at_dead_centre",)
    at_every_step = ("rate",)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]; the charge lights when the integral reaches 1."""
        raise NotImplementedError

    def lights_at_dead_centre(self, charge: Charge) -> float:
        """1 if a charge that has not lit before is lit at dead centre, else 0."""
        return 0.0


class Injection(Law):
    """How fuel reaches the charge of a cylinder: with the fresh gas, or once its ports are closed.

    Attributes
    ----------
    is_direct : bool
        Whether it is injected into the closed cylinder.
    """

    slot = "injection"
    compiled = ("fuel_state",)
    optional = compiled
    is_direct: ClassVar[bool] = False

    @property
    def place(self) -> float:
        """Clearance between crown and head at which fuel is injected [m]; 0 if it is not."""
        return 0.0

    def fuel_state(self) -> tuple[float, float]:
        """Temperature of the fuel injected [K] and latent heat of vaporisation there [J/kg]."""
        return 300.0, 0.0


class Misfires(Law):
    """Charges that do not light, whatever the ignition law says."""

    slot = "misfires"
    compiled = ("happens",)

    def happens(self, charge_number: float) -> float:
        """1 if a charge does not light, else 0.

        Parameters
        ----------
        charge_number : float
            Charges of this cylinder composed so far, this one included [-]; the one the run
            starts with is number 0.
        """
        raise NotImplementedError


class Completeness(Law):
    """Completeness of the combustion: the share of a charge's fuel that can burn."""

    slot = "completeness"
    compiled = ("share",)

    def share(self, gas: Gas, charge: Charge) -> float:
        """Share of the fuel that burns [-], asked once, at the start of combustion.

        Of the fuel there is air for, and times the `combustion_efficiency` of the chamber. What
        does not burn stays in the gas and leaves with the exhaust.
        """
        raise NotImplementedError


class GasExchange(Law):
    """Gas exchange of a ported cylinder.

    In an instant: :meth:`charge` says what the charge is made of when the ports close, and while
    they are open the cylinder stands at the state of its intake. Or by flow: see
    :class:`FlowExchange`.
    """

    slot = "gas_exchange"
    compiled = ("charge", "areas", "exhaust", "fresh_share", "next_breakpoint")
    optional = ("areas", "exhaust", "fresh_share", "next_breakpoint")

    def charge(
        self,
        mass: float,
        fuel: float,
        air: float,
        burnt: float,
        equivalence_ratio: float,
        air_fuel_ratio: float,
    ) -> tuple[float, float, float, float]:
        """Compose a charge of `mass` [kg] from what stood in the cylinder when its ports opened.

        Returns fuel, air, burnt gas and the fresh fuel among the fuel [kg].
        """
        raise NotImplementedError

    def areas(self, opening: float) -> tuple[float, float]:
        """Effective areas of intake and exhaust [m^2], discharge coefficients included.

        Parameters
        ----------
        opening : float
            Distance of the crown beyond `port_closing`, away from the head [m].
        """
        return 0.0, 0.0

    def exhaust(self) -> tuple[float, float]:
        """Pressure [Pa] and temperature [K] beyond the exhaust."""
        return 1e5, 300.0

    def fresh_share(self, share: float) -> float:
        """Share of fresh gas in what leaves through the ports, given that in the cylinder [-]."""
        return share

    def next_breakpoint(self, opening: float, direction: float) -> float:
        """Next opening at which an area is not smooth [m], on the way out (1) or in (-1).

        Infinite if there is none. Steps end there.
        """
        return direction * math.inf


class FlowExchange(GasExchange):
    """Gas exchange by flow through ports: the masses in the cylinder are integrated.

    A law of its kind has :meth:`~GasExchange.areas` and :meth:`~GasExchange.exhaust`, and
    :meth:`~GasExchange.fresh_share` unless the gas mixes perfectly.
    """

    states = ("contents",)

    def charge(
        self,
        mass: float,
        fuel: float,
        air: float,
        burnt: float,
        equivalence_ratio: float,
        air_fuel_ratio: float,
    ) -> tuple[float, float, float, float]:
        """Fuel, air, burnt gas and fresh fuel [kg]: what flowed in and out is what is there."""
        return fuel, air, burnt, 0.0


class Leak(Law):
    """Opening between a chamber and a space of constant state: a gap, or a valve."""

    slot = "leak"
    compiled = ("area", "beyond")

    def area(self, gas: Gas) -> float:
        """Effective area [m^2], discharge coefficient included."""
        raise NotImplementedError

    def beyond(self) -> tuple[float, float]:
        """Pressure [Pa] and temperature [K] beyond; what comes in is air."""
        raise NotImplementedError


class Supply(Law):
    """What stands before the intake ports of a cylinder.

    The state of the intake, or for a law that asks for the state "crankcase" a space under the
    piston that draws from the intake and is compressed by it.
    """

    slot = "supply"
    compiled = ("volume", "piston_area", "inlet_area")
    optional = compiled

    def volume(self, displacement: float) -> float:
        """Volume of the crankcase [m^3] with the piston some way from its midpoint, outward [m]."""
        return 1.0

    def piston_area(self) -> float:
        """Area of the piston on the crankcase's side [m^2]."""
        return 0.0

    def inlet_area(self, rise: float) -> float:
        """Effective area of the inlet [m^2], given how far it is below the intake's pressure [Pa].

        0 for a valve that is shut.
        """
        return 0.0


class Wall(Law):
    """Temperature of the wall of a chamber.

    Constant, or for a law that asks for the state "wall_temperature" integrated.
    """

    slot = "wall"
    compiled = ("temperature_rate",)
    optional = compiled

    def temperature_rate(self, temperature: float, heat: float) -> float:
        """Rate of the temperature [K/s], given it [K] and the heat from the gas [W]."""
        return 0.0


class Springs(Law):
    """Springs between translator and housing."""

    slot = "springs"
    compiled = ("force", "energy", "next_breakpoint")
    optional = ("next_breakpoint",)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N], positive to the right."""
        raise NotImplementedError

    def energy(self, motion: Motion) -> float:
        """Energy stored [J]."""
        raise NotImplementedError

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position after `x` on the way right (`direction` 1) or left (-1) [m]; inf for none.

        One at which the force, continuous though, is not smooth: steps end there.
        """
        return math.inf


class Friction(Law):
    """Friction of bearings and rings.

    `memory` is one number the law keeps from dead centre to dead centre, for instance its
    coefficient; the meaning is its own.
    """

    slot = "friction"
    compiled = ("at_dead_centre", "force")

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Number to remember until the next dead centre; `memory` is -1 at the start of a run."""
        raise NotImplementedError

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        raise NotImplementedError


class Alternator(Law):
    """Linear alternator; its load weight is set anew at each dead centre."""

    slot = "alternator"
    compiled = ("at_dead_centre", "force", "electrical_power", "current_rate", "next_breakpoint")
    optional = ("current_rate", "next_breakpoint")

    def at_dead_centre(self, load_weight: float, stroke: Stroke) -> float:
        """Load weight [-] until the next dead centre."""
        raise NotImplementedError

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        raise NotImplementedError

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power delivered [W]."""
        raise NotImplementedError

    def current_rate(self, load_weight: float, motion: Motion) -> float:
        """Rate of the current [A/s], for a law that has one (``motion.current``)."""
        return 0.0

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position after `x` at which the force is not smooth [m], as of :class:`Springs`."""
        return math.inf


class Frame(Law):
    """Frame of the engine: all that does not move with the translator.

    Fixed, or for a law that asks for the state "frame" moving: its position and velocity [m, m/s]
    are integrated then, `force` [N] being that which springs, gas, alternator and friction exert on
    it.
    """

    slot = "frame"
    compiled = ("acceleration", "transmitted", "energy", "loss")
    optional = compiled

    def acceleration(self, force: float, x: float, v: float) -> float:
        """Acceleration of the frame [m/s^2]."""
        return 0.0

    def transmitted(self, force: float, x: float, v: float) -> float:
        """Force on what the frame stands on [N]."""
        return force

    def energy(self, x: float, v: float) -> float:
        """Kinetic energy of the frame, and energy that its mounts store [J]."""
        return 0.0

    def loss(self, v: float) -> float:
        """Power that its mounts turn into heat [W]."""
        return 0.0


class Scatter(Law):
    """What differs from charge to charge: factors on what the other laws say, asked once a charge.

    `charge_number` counts the charges of a cylinder; `side` is 0 for the left one, 1 for the right.
    """

    slot = "scatter"
    compiled = ("fuel_factor", "delay_factor", "duration_factor")
    optional = compiled

    def fuel_factor(self, charge_number: float, side: float) -> float:
        """Fuel metered to a charge over that commanded [-]."""
        return 1.0

    def delay_factor(self, charge_number: float, side: float) -> float:
        """Value that the ignition integral has to reach [-]."""
        return 1.0

    def duration_factor(self, charge_number: float, side: float) -> float:
        """Combustion duration over that of the burn law [-]."""
        return 1.0


#: Slots of one chamber and slots of the whole engine, by name.
CHAMBER_SLOTS: dict[str, type[Law]] = {
    law.slot: law
    for law in (
        GasProperties,
        HeatTransfer,
        HeatRelease,
        Ignition,
        GasExchange,
        Injection,
        Misfires,
        Completeness,
        Leak,
        Supply,
        Wall,
    )
}
ENGINE_SLOTS: dict[str, type[Law]] = {
    law.slot: law for law in (Springs, Friction, Alternator, Frame, Scatter)
}
