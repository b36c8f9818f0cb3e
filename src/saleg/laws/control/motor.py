"""Control of the alternator as a motor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from saleg.laws.arguments import Drive, Signals
from saleg.laws.control.base import MotorControl
from saleg.laws.usual import FREQUENCY, SMALL_FORCE
from saleg.quantities import quantity


@dataclass(frozen=True, kw_only=True)
class ResonanceSearch(MotorControl):
    """Raise the frequency towards resonance by the missing compression (Eq. 69).

    ``f = f_base + K_p E + K_i (integral of E)`` with ``E = (CR_target - CR) / CR_target``, which
    is held between dead centres; so the frequency rises evenly within a stroke. While the engine
    is fired E counts as zero.

    Parameters
    ----------
    base_frequency : float
        Frequency f_base to begin with, below resonance [Hz].
    amplitude : float
        Amplitude of the force [N].
    target : float
        Compression ratio CR_target [-].
    proportional_gain : float
        K_p [Hz].
    integral_gain : float
        K_i [Hz/s].
    literal_phase : float
        0 to integrate the frequency to the motor's angle, as an inverter does; 1 for the force
        ``sin(2 pi f t)`` with the present f, whose angle jumps with every change of f [-].
    keeps_integral : float
        1 to go on from the integral reached when the motor comes back after the engine was fired,
        0 to begin again at the base frequency [-].
    keeps_phase : float
        1 to go on with the angle the motor would have reached meanwhile, 0 to begin in phase with
        the motion: at zero force, pushing along. Without effect on the literal phase [-].
    """

    base_frequency: float = quantity("Hz", default=30.0, low=0, high=1e4, usual=FREQUENCY)
    amplitude: float = quantity("N", default=264.0, low=0, usual=SMALL_FORCE)
    target: float = quantity("-", default=19.0, low=1)
    proportional_gain: float = quantity("Hz", default=1.0, low=0)
    integral_gain: float = quantity("Hz/s", default=5.0, low=0)
    literal_phase: float = quantity("-", default=0.0, low=0, high=1)
    keeps_integral: float = quantity("-", default=0.0, low=0, high=1)
    keeps_phase: float = quantity("-", default=0.0, low=0, high=1)

    def drive(self, memory: Any, signals: Signals) -> Drive:
        """Force until the next dead centre, Eq. 69; holds integral, error and time of the error."""
        returns = signals.motoring > 0.0 and signals.was_motoring == 0.0
        if signals.was_motoring > 0.0:
            memory[0] += memory[1] * (signals.t - memory[2])
        elif returns and self.keeps_integral == 0.0:
            memory[0] = 0.0
        error = 0.0
        if signals.motoring > 0.0:
            error = (self.target - signals.compression_ratio) / self.target
        memory[1], memory[2] = error, signals.t
        frequency = self.base_frequency + self.proportional_gain * error
        frequency = max(frequency + self.integral_gain * memory[0], 0.0)
        sweep = self.integral_gain * error
        if self.literal_phase > 0.0:  # the same angle, written from this dead centre on
            phase = 2.0 * math.pi * frequency * signals.t
            return Drive(self.amplitude, frequency + sweep * signals.t, 2.0 * sweep, 1.0, phase)
        along = 0.0 if signals.direction >= 0.0 else math.pi
        sets = 1.0 if returns and self.keeps_phase == 0.0 else 0.0
        return Drive(self.amplitude, frequency, sweep, sets, along)


@dataclass(frozen=True, kw_only=True)
class SteadyMotor(MotorControl):
    """A sine of fixed frequency and amplitude (Fig. 94, 95).

    Parameters
    ----------
    amplitude : float
        Amplitude of the force [N].
    frequency : float
        Frequency [Hz].
    """

    amplitude: float = quantity("N", default=66.0, low=0, usual=SMALL_FORCE)
    frequency: float = quantity("Hz", default=35.0, low=0, high=1e4, usual=FREQUENCY)

    def drive(self, memory: Any, signals: Signals) -> Drive:
        """Force until the next dead centre."""
        return Drive(self.amplitude, self.frequency, 0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class PhaseLockedMotor(MotorControl):
    """A sine in phase with the motion, at the frequency of the latest stroke.

    From any frequency it is at resonance once the motion has turned twice: the force is zero at a
    dead centre and pushes along from there on, and the motion keeps its own time.

    Parameters
    ----------
    base_frequency : float
        Frequency until the first stroke is measured [Hz], below or above resonance.
    amplitude : float
        Amplitude of the force [N].
    """

    base_frequency: float = quantity("Hz", default=30.0, low=0, high=1e4, usual=FREQUENCY)
    amplitude: float = quantity("N", default=264.0, low=0, usual=SMALL_FORCE)

    def drive(self, memory: Any, signals: Signals) -> Drive:
        """Force until the next dead centre."""
        # From an equilibrium that rounding misses, the first stroke has no length.
        if signals.frequency == 0.0 or signals.stroke < 1e-9:
            return Drive(self.amplitude, self.base_frequency, 0.0, 0.0, 0.0)
        along = 0.0 if signals.direction >= 0.0 else math.pi
        return Drive(self.amplitude, signals.frequency, 0.0, 1.0, along)
