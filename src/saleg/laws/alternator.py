"""Linear alternator."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from saleg.checks import NUMBER, POSITIVE, checked
from saleg.laws.arguments import Motion, Stroke
from saleg.laws.base import Alternator
from saleg.laws.interpolation import bilinear, next_point
from saleg.laws.usual import FORCE, FREQUENCY, LENGTH, LOAD_CONSTANT, SMALL_FORCE
from saleg.quantities import quantity, series


@dataclass(frozen=True, kw_only=True)
class RegulatedAlternator(Alternator):
    """What all alternators under the stroke regulator (Eq. 59) have in common.

    At each dead centre the load weight becomes ``W = 1 - G (S_target - S) / L``, never negative and
    at most `maximum_weight`.

    Parameters
    ----------
    regulator_gain : float
        Gain G of the stroke regulator [-]; 0 fixes the load.
    target_stroke : float
        Target stroke S_target as a share of the maximum stroke [-].
    maximum_weight : float
        Largest load weight W the machine can deliver [-].
    """

    regulator_gain: float = quantity("-", default=7.5, low=0)
    target_stroke: float = quantity("-", default=0.9, low=0, high=1)
    maximum_weight: float = quantity("-", default=1e3, low=0)

    def at_dead_centre(self, load_weight: float, stroke: Stroke) -> float:
        """Load weight W [-], Eq. 59."""
        error = self.target_stroke * stroke.maximum - stroke.length
        weight = 1.0 - self.regulator_gain * error / stroke.half_maximum
        return min(max(weight, 0.0), self.maximum_weight)


@dataclass(frozen=True, kw_only=True)
class LinearLoad(RegulatedAlternator):
    """Force proportional to velocity (Eq. 47) with the stroke regulator (Eq. 59).

    ``F = W c_A v``, electrical power ``eta F v``.

    Parameters
    ----------
    load_constant : float
        Load constant c_A [N s/m].
    efficiency : float
        Electrical over mechanical power [-].
    regulator_gain, target_stroke, maximum_weight : float
        Of the stroke regulator (Eq. 59) [-], see :class:`RegulatedAlternator`.
    """

    mirrors: ClassVar[bool] = True

    load_constant: float = quantity("N s/m", default=70.0, low=0, usual=LOAD_CONSTANT)
    efficiency: float = quantity("-", default=0.95, low=0, high=1)

    @classmethod
    @checked(flux_gradient=NUMBER, load_resistance=POSITIVE, efficiency=POSITIVE)
    def from_circuit(
        cls,
        flux_gradient: float,
        load_resistance: float,
        *,
        efficiency: float = 0.95,
        **regulator: float,
    ) -> LinearLoad:
        """Load of an equivalent circuit as Eq. 46 and 47 have it: ``c_A = k^2 / (eta R)``.

        The electrical power is that of the induced voltage on the load, ``(k v)^2 / R``; all losses
        are in the efficiency. :class:`CircuitAlternator` has a resistance of the coils instead.

        Parameters
        ----------
        flux_gradient : float
            Change of the linked flux with position, k [V s/m].
        load_resistance : float
            Resistance R of the load [ohm].
        efficiency : float
            Electrical over mechanical power eta [-].
        **regulator
            See :class:`RegulatedAlternator`.

        Returns
        -------
        LinearLoad

        Examples
        --------
        >>> round(LinearLoad.from_circuit(50.0, 37.3).load_constant, 1)
        70.6
        """
        constant = flux_gradient**2 / (efficiency * load_resistance)
        return cls(load_constant=constant, efficiency=efficiency, **regulator)

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 47."""
        return load_weight * self.load_constant * motion.v

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W], Eq. 45."""
        return self.efficiency * load_weight * self.load_constant * motion.v * motion.v


@dataclass(frozen=True, kw_only=True)
class ConstantForce(RegulatedAlternator):
    """A force of constant magnitude against the motion: the work force of Chapter 2 (2.3).

    ``F = W A``; it turns with the translator, at the dead centres and nowhere else.

    Parameters
    ----------
    amplitude : float
        Force A at a load weight of one [N].
    efficiency : float
        Electrical over mechanical power [-].
    regulator_gain, target_stroke, maximum_weight : float
        Of the stroke regulator (Eq. 59) [-], see :class:`RegulatedAlternator`.
    """

    mirrors: ClassVar[bool] = True

    amplitude: float = quantity("N", default=1000.0, low=0, usual=FORCE)
    efficiency: float = quantity("-", default=0.95, low=0, high=1)

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        return load_weight * self.amplitude * motion.direction

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W]."""
        return self.efficiency * load_weight * self.amplitude * motion.direction * motion.v


@dataclass(frozen=True, kw_only=True)
class CosineForce(RegulatedAlternator):
    """A force against the motion that is greatest at the midpoint (Eq. 33).

    ``F = W A cos(pi x / 2 L)``: none at the heads.

    Parameters
    ----------
    amplitude : float
        Amplitude A at a load weight of one [N]. By Eq. 34 the work over the whole stroke 2 L is
        that of a constant force of 2 A / pi.
    half_stroke : float
        Half of the maximum stroke L [m].
    efficiency : float
        Electrical over mechanical power [-].
    regulator_gain, target_stroke, maximum_weight : float
        Of the stroke regulator (Eq. 59) [-], see :class:`RegulatedAlternator`.
    """

    mirrors: ClassVar[bool] = True

    amplitude: float = quantity("N", default=1500.0, low=0, usual=FORCE)
    half_stroke: float = quantity("m", default=0.1, low=0, open_low=True, usual=LENGTH)
    efficiency: float = quantity("-", default=0.95, low=0, high=1)

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 33."""
        shape = math.cos(0.5 * math.pi * motion.x / self.half_stroke)
        return load_weight * self.amplitude * shape * motion.direction

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W]."""
        shape = math.cos(0.5 * math.pi * motion.x / self.half_stroke)
        return self.efficiency * load_weight * self.amplitude * shape * motion.direction * motion.v


@dataclass(frozen=True, kw_only=True)
class CircuitAlternator(RegulatedAlternator):
    """Equivalent circuit with inductance and coil resistance (Eq. 43-46); the current is a state.

    ``L di/dt = k v - (r + R / W) i``, force ``k i``, electrical power ``i^2 R / W``: the regulator
    acts on the load resistance. As the inductance vanishes the force tends to that of
    :class:`LinearLoad` with ``c_A = k^2 / (r + R)`` and an efficiency of ``R / (r + R)`` at W = 1.

    Parameters
    ----------
    flux_gradient : float
        Change of the linked flux with position, k [V s/m].
    inductance : float
        Inductance L of the coils [H].
    coil_resistance : float
        Resistance r of the coils [ohm].
    load_resistance : float
        Resistance R of the load at a load weight of one [ohm].
    least_weight : float
        Load weight at which the circuit counts as open: the load resistance grows no further [-].
    regulator_gain, target_stroke, maximum_weight : float
        Of the stroke regulator (Eq. 59) [-], see :class:`RegulatedAlternator`.
    """

    mirrors: ClassVar[bool] = True

    flux_gradient: float = quantity("V s/m", default=50.0)
    inductance: float = quantity("H", default=5e-3, low=0, open_low=True, usual=(1e-9, 1.0))
    coil_resistance: float = quantity("ohm", default=1.8, low=0)
    load_resistance: float = quantity("ohm", default=33.9, low=0, open_low=True)
    least_weight: float = quantity("-", default=0.02, low=0, open_low=True)

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 46."""
        return self.flux_gradient * motion.current

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W], Eq. 43."""
        load = self.load_resistance / max(load_weight, self.least_weight)
        return load * motion.current * motion.current

    def current_rate(self, load_weight: float, motion: Motion) -> float:
        """Rate of the current [A/s], Eq. 43-44."""
        load = self.load_resistance / max(load_weight, self.least_weight)
        voltage = self.flux_gradient * motion.v
        return (voltage - (self.coil_resistance + load) * motion.current) / self.inductance


@dataclass(frozen=True, kw_only=True)
class FluxProfile(RegulatedAlternator):
    """Linear load with a flux that depends on position, and cogging.

    ``F = W c_A phi(x)^2 v + F_cog(x)`` with the flux gradient over its mean
    ``phi = 1 + sum of a_n cos(2 pi n x / wavelength) + b_n sin(2 pi n x / wavelength)`` and the
    cogging force ``sum of c_n sin(2 pi n x / wavelength)``, which has zero mean and gives back what
    it takes. A wavelength longer than the stroke describes end effects.

    Parameters
    ----------
    load_constant : float
        Load constant c_A [N s/m].
    efficiency : float
        Electrical power over the mechanical power of the load [-].
    wavelength : float
        Wavelength of the first harmonic [m].
    cosines, sines : tuple of float
        Fourier coefficients a_n, b_n of the flux gradient, from n = 1 on [-].
    cogging : tuple of float
        Fourier coefficients c_n of the cogging force, from n = 1 on [N].
    regulator_gain, target_stroke, maximum_weight : float
        Of the stroke regulator (Eq. 59) [-], see :class:`RegulatedAlternator`.
    """

    load_constant: float = quantity("N s/m", default=70.0, low=0, usual=LOAD_CONSTANT)
    efficiency: float = quantity("-", default=0.95, low=0, high=1)
    wavelength: float = quantity("m", default=0.05, low=0, open_low=True, usual=LENGTH)
    cosines: tuple[float, ...] = series("-", default=(0.1,))
    sines: tuple[float, ...] = series("-", default=(0.0,))
    cogging: tuple[float, ...] = series("N", default=(0.0,))

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        phase = 2.0 * math.pi * motion.x / self.wavelength
        flux = relative_flux(phase, self.cosines, self.sines)
        cogging = fourier_sines(phase, self.cogging)
        return load_weight * self.load_constant * flux * flux * motion.v + cogging

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W]."""
        phase = 2.0 * math.pi * motion.x / self.wavelength
        flux = relative_flux(phase, self.cosines, self.sines)
        return self.efficiency * load_weight * self.load_constant * (flux * motion.v) ** 2


def relative_flux(phase: float, cosines: tuple[float, ...], sines: tuple[float, ...]) -> float:
    """Flux gradient over its mean [-] at a phase [rad] of the first harmonic."""
    total = 1.0 + fourier_sines(phase, sines)
    for n in range(len(cosines)):
        total += cosines[n] * math.cos((n + 1) * phase)
    return total


def fourier_sines(phase: float, coefficients: tuple[float, ...]) -> float:
    """Sum of sines at a phase [rad] of the first harmonic."""
    total = 0.0
    for n in range(len(coefficients)):
        total += coefficients[n] * math.sin((n + 1) * phase)
    return total


@dataclass(frozen=True, kw_only=True)
class ForceMap(RegulatedAlternator):
    """Measured force over position and velocity, bilinear, times the load weight.

    Parameters
    ----------
    positions : tuple of float
        Positions from the midpoint, rising [m]; one will do if the force does not depend on it.
    velocities : tuple of float
        Velocities, rising, through both directions [m/s].
    forces : tuple of float
        Force against positive velocity at a load weight of one [N], for one position after the
        other, velocities running fastest.
    efficiency : float
        Electrical over mechanical power [-].
    regulator_gain, target_stroke, maximum_weight : float
        Of the stroke regulator (Eq. 59) [-], see :class:`RegulatedAlternator`.
    """

    positions: tuple[float, ...] = series("m", default=(0.0,), rising=True)
    velocities: tuple[float, ...] = series("m/s", default=(-20.0, 20.0), rising=True, at_least=2)
    forces: tuple[float, ...] = series(
        "N", default=(-1400.0, 1400.0), length="positions*velocities"
    )
    efficiency: float = quantity("-", default=0.95, low=0, high=1)

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        return load_weight * bilinear(
            motion.x, motion.v, self.positions, self.velocities, self.forces
        )

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W]."""
        force = load_weight * bilinear(
            motion.x, motion.v, self.positions, self.velocities, self.forces
        )
        return self.efficiency * force * motion.v

    def next_breakpoint(self, x: float, direction: float) -> float:
        """Next position of the table [m]."""
        return next_point(x, direction, self.positions)


@dataclass(frozen=True, kw_only=True)
class SinusoidalMotor(Alternator):
    """The alternator as a motor that pushes with a sine of fixed frequency (5.1).

    Force on the translator ``F_0 sin(2 pi f t + phase)``; where it brakes, it generates.

    Parameters
    ----------
    amplitude : float
        Amplitude F_0 of the force [N].
    frequency : float
        Frequency f [Hz].
    phase : float
        Phase at time zero [rad].
    efficiency : float
        Of the conversion, either way [-].
    """

    amplitude: float = quantity("N", default=264.0, low=0, usual=SMALL_FORCE)
    frequency: float = quantity("Hz", default=35.0, low=0, usual=FREQUENCY)
    phase: float = quantity("rad", default=0.0)
    efficiency: float = quantity("-", default=0.95, low=0, high=1, open_low=True)

    def at_dead_centre(self, load_weight: float, stroke: Stroke) -> float:
        """Load weight [-]: one, it is not regulated."""
        return 1.0

    def force(self, load_weight: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        angle = 2.0 * math.pi * self.frequency * motion.t + self.phase
        return -self.amplitude * math.sin(angle)

    def electrical_power(self, load_weight: float, motion: Motion) -> float:
        """Electrical power [W]; negative where it drives."""
        angle = 2.0 * math.pi * self.frequency * motion.t + self.phase
        mechanical = -self.amplitude * math.sin(angle) * motion.v
        if mechanical >= 0.0:
            return self.efficiency * mechanical
        return mechanical / self.efficiency
