"""Start of combustion: self-ignition, sparks, and what else lights a charge."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import Ignition, Validity
from saleg.laws.interpolation import bicubic, cubic_weights, interval, share, slopes
from saleg.laws.usual import ACTIVATION_ENERGY, GAS_PRESSURE, LENGTH
from saleg.quantities import quantity, series

#: Universal gas constant [cal/mol/K], and standard atmosphere [Pa].
GAS_CONSTANT_CAL = 1.98720425864
ATMOSPHERE = 101325.0
#: Molar masses [kg/mol] of air (21 % oxygen, 79 % nitrogen by volume) and of methane.
AIR = 0.02885
METHANE = 0.016043
OXYGEN_IN_AIR = 0.21
#: Source of the ranges of a table, and how far an air-fuel ratio may be from its fuel's.
TABLE = "its table"
SAME_FUEL = 0.05
HE = "He et al., Combust. Flame 142:266 (2005)"


@dataclass(frozen=True)
class CFRIgnition(Ignition):
    """Knock integral fitted to a CFR engine in HCCI operation (Eq. 54-55).

    ``integral of k dt / (A phi^-x exp(b p^n / T)) = 1`` with p in kPa inside the exponential.
    The source (Swan, Shahbakhti, Koch, SAE 2006-01-1086) integrates over crank angle; `k` turns
    crank degrees into time. Section 3.6.4 of the thesis lists the parameters under wrong names.

    Parameters
    ----------
    A : float
        Leading coefficient [-].
    b : float
        Temperature coefficient [K].
    n : float
        Exponent of pressure [-].
    x : float
        Exponent of the equivalence ratio [-].
    k : float
        Degrees of a cycle of the CFR engine, a four-stroke [-]; inferred, see the physics notes.
    """

    A: float = quantity("-", default=9.291e-7, low=0, open_low=True)
    b: float = quantity("K", default=16909.0)
    n: float = quantity("-", default=-0.1121)
    x: float = quantity("-", default=-0.688)
    k: float = quantity("-", default=720.0, low=0)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the knock integral [1/s]."""
        chemistry = math.exp(-self.b * (gas.p * 1e-3) ** self.n / gas.T)
        return self.k / self.A * charge.equivalence_ratio**self.x * chemistry


@dataclass(frozen=True)
class RCMIgnition(Ignition):
    """Ignition delay of iso-octane in a rapid compression machine (Eq. 56), in its own units.

    ``tau = A p^-1.05 phi^-0.77 x_O2^-1.41 exp(E / (R T))`` in s, with p in atm, x_O2 in mole
    percent and E in cal/mol (He et al., Combust. Flame 142:266, 2005). So used it needs about
    1000 K: the thesis' base case never fires; see :class:`RCMIgnitionPascal`.

    Parameters
    ----------
    A : float
        Leading coefficient [s in the correlation's units].
    pressure_exponent, equivalence_ratio_exponent, oxygen_exponent : float
        The exponents [-].
    activation_energy : float
        Activation energy E [cal/mol].

    Examples
    --------
    >>> round(1e3 * rcm_delay(10.0, 1000.0, 0.4, 21.0, RCMIgnition()), 2)
    7.43
    """

    valid_for = (
        Validity("pressure", 5.12 * ATMOSPHERE, 23.0 * ATMOSPHERE, HE),
        Validity("temperature", 943.0, 1027.0, HE),
        Validity("equivalence_ratio", 0.25, 1.0, HE),
    )

    A: float = quantity("s", default=1.3e-7, low=0, open_low=True)
    pressure_exponent: float = quantity("-", default=-1.05)
    equivalence_ratio_exponent: float = quantity("-", default=-0.77)
    oxygen_exponent: float = quantity("-", default=-1.41)
    activation_energy: float = quantity("cal/mol", default=33700.0, usual=ACTIVATION_ENERGY)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: one over the delay."""
        ratio = charge.equivalence_ratio**-self.equivalence_ratio_exponent
        mixture = oxygen_percent(charge) ** -self.oxygen_exponent * ratio / self.A
        pressure = (gas.p / ATMOSPHERE) ** -self.pressure_exponent
        return mixture * pressure * math.exp(-self.activation_energy / GAS_CONSTANT_CAL / gas.T)


@dataclass(frozen=True)
class RCMIgnitionPascal(RCMIgnition):
    """The same formula with the pressure in pascal, the reading with which the thesis' engine runs.

    With it the base case fires, later than with :class:`CFRIgnition`; the "significantly earlier"
    of section 3.6.4 comes with no reading of the units.

    Parameters
    ----------
    A, pressure_exponent, equivalence_ratio_exponent, oxygen_exponent, activation_energy : float
        As for :class:`RCMIgnition`, in its units [s, -, cal/mol], with the pressure in pascal.
    """

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: one over the delay."""
        ratio = charge.equivalence_ratio**-self.equivalence_ratio_exponent
        mixture = oxygen_percent(charge) ** -self.oxygen_exponent * ratio / self.A
        pressure = gas.p**-self.pressure_exponent
        return mixture * pressure * math.exp(-self.activation_energy / GAS_CONSTANT_CAL / gas.T)


def oxygen_percent(charge: Charge) -> float:
    """Mole percent of oxygen in a charge; its burnt gas counts as air without the oxygen."""
    air, burnt = charge.air / AIR, charge.burnt / AIR
    return 100.0 * OXYGEN_IN_AIR * air / (air + burnt + charge.fuel / METHANE)


def rcm_delay(p: float, T: float, phi: float, oxygen: float, law: RCMIgnition) -> float:
    """Ignition delay of Eq. 56 [s], at a pressure [atm], temperature [K] and mixture.

    Parameters
    ----------
    p, T, phi, oxygen : float
        Pressure [atm], temperature [K], equivalence ratio [-], oxygen [mole percent].
    law : RCMIgnition
        The coefficients.
    """
    mixture = phi**law.equivalence_ratio_exponent * oxygen**law.oxygen_exponent
    energy = math.exp(law.activation_energy / (GAS_CONSTANT_CAL * T))
    return law.A * p**law.pressure_exponent * mixture * energy


@dataclass(frozen=True)
class SparkAtClearance(Ignition):
    """A spark where the piston, on its way in, comes within a clearance of the head.

    The integral grows with the way from port closing to the spark, so it is exact.

    Parameters
    ----------
    clearance : float
        Clearance between crown and head at the spark [m]; a controller may have it come earlier.
    """

    is_timed: ClassVar[bool] = True

    clearance: float = quantity("m", default=0.020, low=0, usual=LENGTH)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: speed inward over the way to go."""
        spark = self.clearance + charge.spark_advance
        way = charge.V / gas.V * gas.clearance - spark
        return max(-gas.clearance_rate, 0.0) / max(way, 1e-9)


@dataclass(frozen=True)
class SparkAfterDelay(Ignition):
    """A spark some time after the ports have closed.

    If the piston has turned by then, the charge is not lit.

    Parameters
    ----------
    delay : float
        Time from port closing to the spark [s].
    """

    is_timed: ClassVar[bool] = True

    delay: float = quantity("s", default=7e-3, low=0, open_low=True, usual=(1e-5, 0.2))

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]."""
        return 1.0 / self.delay


@dataclass(frozen=True)
class SparkBeforeDeadCentre(Ignition):
    """A spark some time before the dead centre, which is foreseen from the stroke before.

    No crank tells where the dead centre will be. Counted is from the last one, as if the stroke
    were to last as long as the one before it; in a steady engine with two equal cylinders it does.
    Where the strokes either way differ by more than 1 %, ``run.range_exits`` says so; an engine
    with one cylinder, whose strokes always do, is refused. A dead centre foreseen nearer than
    `advance` as the ports close has the spark at once. A piston that turns before the spark leaves
    its charge unlit, so engines that fire unevenly may stay so with late sparks: in the thesis'
    base case with less than some 1 ms.

    Parameters
    ----------
    advance : float
        Time from the spark to the dead centre foreseen [s].
    """

    is_timed: ClassVar[bool] = True
    foresees_dead_centre: ClassVar[bool] = True
    valid_for = (Validity("stroke_ratio", 0.99, 1.01, "strokes either way are alike"),)

    advance: float = quantity("s", default=1e-3, low=0, usual=(1e-5, 0.2))

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: one over the time from port closing to the spark."""
        return 1.0 / max(charge.time_to_dead_centre - self.advance, 1e-9)


@dataclass(frozen=True)
class IgnitionAtPressure(Ignition):
    """Ignition at a pressure, as Chapter 2 has it (2.5).

    Parameters
    ----------
    pressure : float
        Pressure at which the charge lights [Pa].
    """

    pressure: float = quantity("Pa", default=40e5, low=0, open_low=True, usual=GAS_PRESSURE)

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: that of the pressure over the rise to go."""
        return gas.p_rate / max(self.pressure - charge.p, 1.0)


@dataclass(frozen=True)
class IgnitionAtDeadCentre(Ignition):
    """Ignition at the dead centre, wherever that is: the ideal of Chapter 2."""

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: zero."""
        return 0.0

    def lights_at_dead_centre(self, charge: Charge) -> float:
        """1 if a charge that has not lit before is lit at dead centre: always."""
        return 1.0


@dataclass(frozen=True)
class TabulatedDelay(Ignition):
    """Ignition delay from a table over pressure, temperature, equivalence ratio and burnt gas.

    The logarithm of the delay is interpolated by cubics in that of the pressure and in 1/T,
    linearly in the equivalence ratio and in the share of burnt gas; beyond the table the value at
    its border holds.
    :func:`saleg.fuels.ignition_delays` has tables from chemistry.

    Parameters
    ----------
    pressures : tuple of float
        Pressures, rising [Pa].
    temperatures : tuple of float
        Temperatures, rising [K].
    equivalence_ratios : tuple of float
        Equivalence ratios, rising [-].
    delays : tuple of float
        Delays [s], equivalence ratio running fastest, then temperature, pressure, burnt share.
    burnt_shares : tuple of float
        Shares of burnt gas in the charge by mass, rising [-].
    air_fuel_ratio : float
        Stoichiometric air-fuel ratio of the fuel of the table by mass [-]; 0 if not said.
    """

    pressures: tuple[float, ...] = series(
        "Pa", default=(10e5, 100e5), low=1.0, rising=True, usual=GAS_PRESSURE
    )
    temperatures: tuple[float, ...] = series("K", default=(700.0, 1300.0), low=1.0, rising=True)
    equivalence_ratios: tuple[float, ...] = series("-", default=(0.6,), low=0, rising=True)
    delays: tuple[float, ...] = series(
        "s",
        default=(0.1, 1e-4, 0.01, 1e-5),
        low=1e-30,
        length="burnt_shares*pressures*temperatures*equivalence_ratios",
    )
    burnt_shares: tuple[float, ...] = series("-", default=(0.0,), low=0, high=1, rising=True)
    air_fuel_ratio: float = quantity("-", default=0.0, low=0)

    derived: ClassVar[tuple[str, ...]] = (
        "ln_pressures",
        "cold_to_hot",
        "ln_delays",
        "pressure_slopes",
        "temperature_slopes",
    )

    @cached_property
    def ln_pressures(self) -> tuple[float, ...]:
        """Natural logarithms of the pressures."""
        return tuple(math.log(p) for p in self.pressures)

    @cached_property
    def cold_to_hot(self) -> tuple[float, ...]:
        """Temperatures as -1/T [1/K], which rises with them."""
        return tuple(-1.0 / T for T in self.temperatures)

    @cached_property
    def ln_delays(self) -> tuple[float, ...]:
        """Natural logarithms of the delays."""
        return tuple(math.log(delay) for delay in self.delays)

    @cached_property
    def pressure_slopes(self) -> tuple[float, ...]:
        """Slopes of those logarithms over that of the pressure [-]."""
        step = len(self.temperatures) * len(self.equivalence_ratios)
        return slopes(self.ln_pressures, self.ln_delays, step)

    @cached_property
    def temperature_slopes(self) -> tuple[float, ...]:
        """Slopes of those logarithms over -1/T [K]."""
        return slopes(self.cold_to_hot, self.ln_delays, len(self.equivalence_ratios))

    @property
    def ranges(self) -> tuple[Validity, ...]:
        """The table, and the fuel it was made for."""
        axes = {
            "pressure": self.pressures,
            "temperature": self.temperatures,
            "equivalence_ratio": self.equivalence_ratios,
            "burnt_share": self.burnt_shares,
        }
        table = tuple(Validity(name, axis[0], axis[-1], TABLE) for name, axis in axes.items())
        if self.air_fuel_ratio <= 0.0:
            return table
        least, most = (self.air_fuel_ratio * (1.0 + off) for off in (-SAME_FUEL, SAME_FUEL))
        return *table, Validity("air_fuel_ratio", least, most, "the fuel of its table")

    def rate(self, gas: Gas, charge: Charge) -> float:
        """Rate of the ignition integral [1/s]: one over the delay."""
        ln_p, heat, burnt = math.log(gas.p), -1.0 / gas.T, charge.burnt / charge.mass
        h = interval(burnt, self.burnt_shares)
        i = interval(ln_p, self.ln_pressures)
        j = interval(heat, self.cold_to_hot)
        k = interval(charge.equivalence_ratio, self.equivalence_ratios)
        richer = share(charge.equivalence_ratio, self.equivalence_ratios, k)
        diluted = share(burnt, self.burnt_shares, h)
        column = len(self.equivalence_ratios)
        row = len(self.temperatures) * column
        page = len(self.pressures) * row
        first = h * page + i * row + j * column + k
        steps = (row if len(self.pressures) > 1 else 0, column if len(self.temperatures) > 1 else 0)
        over_p = cubic_weights(ln_p, self.ln_pressures, i)
        over_T = cubic_weights(heat, self.cold_to_hot, j)
        tables = (self.ln_delays, self.pressure_slopes, self.temperature_slopes)
        ln_delay = bicubic(tables, first, steps, over_p, over_T)
        rise = 0.0
        if richer > 0.0:
            rise += richer * (bicubic(tables, first + 1, steps, over_p, over_T) - ln_delay)
        if diluted > 0.0:
            rise += diluted * (bicubic(tables, first + page, steps, over_p, over_T) - ln_delay)
        return math.exp(-ln_delay - rise)
