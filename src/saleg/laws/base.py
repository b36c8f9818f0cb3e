"""A law: a frozen dataclass of numbers with one or two short methods, filling one slot.

The same method runs twice: as ordinary Python, and compiled into the kernel, where ``self`` is a
record of the same numbers. Hence what a law may use: its own numbers, module-level numbers and
functions, ``math`` and ``np``. It does not call its other methods through ``self``.
"""

from __future__ import annotations

from typing import ClassVar

from saleg.laws.arguments import Charge, Gas, Motion, Stroke


class Law:
    """Base of all laws.

    Attributes
    ----------
    slot : str
        Name of the slot the law fills.
    compiled : tuple of str
        Methods the kernel calls; every law of a slot has all of them.
    """

    slot: ClassVar[str] = ""
    compiled: ClassVar[tuple[str, ...]] = ()


class GasProperties(Law):
    """Caloric properties of the ideal gas in a chamber; needs a field ``gas_constant`` [J/kg/K]."""

    slot = "gas_properties"
    compiled = ("gamma", "internal_energy")

    gas_constant: float

    def gamma(self, T: float) -> float:
        """Ratio of specific heats [-] at temperature `T` [K]."""
        raise NotImplementedError

    def internal_energy(self, T: float) -> float:
        """Specific internal energy [J/kg] at temperature `T` [K]: the integral of R/(gamma - 1)."""
        raise NotImplementedError


class HeatTransfer(Law):
    """Heat transfer from the gas to the wall."""

    slot = "heat_transfer"
    compiled = ("coefficient",)

    def coefficient(self, gas: Gas, charge: Charge) -> float:
        """Heat-transfer coefficient [W/m^2/K]."""
        raise NotImplementedError


class HeatRelease(Law):
    """Course of the heat release once the charge is lit."""

    slot = "heat_release"
    compiled = ("duration", "burn_rate", "burnt_fraction")

    def duration(self, gas: Gas, charge: Charge) -> float:
        """Combustion duration [s], asked once, at the start of combustion."""
        raise NotImplementedError

    def burn_rate(self, u: float) -> float:
        """Derivative of :meth:`burnt_fraction` [-] with respect to `u`."""
        raise NotImplementedError

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-] at `u`, the time since start of combustion over the duration."""
        raise NotImplementedError


class Ignition(Law):
    """Self-ignition by an integral that starts at port closing."""

    slot = "ignition"
    compiled = ("rate",)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]; the charge lights when the integral reaches 1."""
        raise NotImplementedError


class GasExchange(Law):
    """What the charge is made of when the ports close."""

    slot = "gas_exchange"
    compiled = ("charge",)

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


class Springs(Law):
    """Springs between translator and housing."""

    slot = "springs"
    compiled = ("force", "energy")

    def force(self, motion: Motion) -> float:
        """Force on the translator [N], positive to the right."""
        raise NotImplementedError

    def energy(self, motion: Motion) -> float:
        """Energy stored [J]."""
        raise NotImplementedError


class Friction(Law):
    """Friction of bearings and rings.

    `held` is one number the law keeps from dead centre to dead centre; what it means is the
    law's own affair.
    """

    slot = "friction"
    compiled = ("at_dead_centre", "force")

    def at_dead_centre(self, held: float, stroke: Stroke) -> float:
        """Return the number to hold until the next dead centre."""
        raise NotImplementedError

    def force(self, held: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        raise NotImplementedError


class Alternator(Law):
    """Linear alternator; `held` is its load weight, set anew at each dead centre."""

    slot = "alternator"
    compiled = ("at_dead_centre", "force", "electrical_power")

    def at_dead_centre(self, held: float, stroke: Stroke) -> float:
        """Return the load weight [-] until the next dead centre."""
        raise NotImplementedError

    def force(self, held: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        raise NotImplementedError

    def electrical_power(self, held: float, motion: Motion) -> float:
        """Electrical power delivered [W]."""
        raise NotImplementedError


#: Slots of one chamber and slots of the whole engine, by name.
CHAMBER_SLOTS: dict[str, type[Law]] = {
    law.slot: law for law in (GasProperties, HeatTransfer, HeatRelease, Ignition, GasExchange)
}
ENGINE_SLOTS: dict[str, type[Law]] = {law.slot: law for law in (Springs, Friction, Alternator)}
