"""The frame that carries the stators and the heads: fixed, or moving on its mounts.

A translator that is pushed one way pushes its frame the other way. Positions and velocities of an
engine are those of the translator as seen from the frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.base import Frame
from saleg.quantities import quantity


@dataclass(frozen=True)
class FixedFrame(Frame):
    """Frame that does not move: bolted to what is much heavier than the translator."""

    mirrors = True


@dataclass(frozen=True, kw_only=True)
class MountedFrame(Frame):
    """Frame of some mass on linear mounts.

    With the force F of springs, gas, alternator and friction on the translator of mass m, seen
    from a frame of mass M at X,

        M X'' = -F - k X - c X',    x'' = F / m - X''.

    Without mounts the frequency is that of a translator of the mass m M / (m + M).

    Parameters
    ----------
    mass : float
        Mass M of all that does not move with the translator [kg].
    stiffness : float
        Stiffness k of the mounts together [N/m]; 0 for a frame that floats freely.
    damping : float
        Damping c of the mounts together [N s/m].

    Examples
    --------
    >>> MountedFrame(mass=50.0, stiffness=2e4).transmitted(1000.0, 0.01, 0.0)
    200.0
    """

    states: ClassVar[tuple[str, ...]] = ("frame",)
    mirrors = True

    mass: float = quantity("kg", default=100.0, low=0, open_low=True, usual=(1, 1e6))
    stiffness: float = quantity("N/m", default=0.0, low=0, usual=(0, 1e8))
    damping: float = quantity("N s/m", default=0.0, low=0, usual=(0, 1e6))

    def acceleration(self, force: float, x: float, v: float) -> float:
        """Acceleration of the frame [m/s^2]."""
        return (force - self.stiffness * x - self.damping * v) / self.mass

    def transmitted(self, force: float, x: float, v: float) -> float:
        """Force on what the frame stands on [N]: that of its mounts."""
        return self.stiffness * x + self.damping * v

    def energy(self, x: float, v: float) -> float:
        """Kinetic energy of the frame and energy in its mounts [J]."""
        return 0.5 * self.mass * v * v + 0.5 * self.stiffness * x * x

    def loss(self, v: float) -> float:
        """Power that the mounts turn into heat [W]."""
        return self.damping * v * v
