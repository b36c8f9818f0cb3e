"""Friction of bearings and piston rings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from saleg.laws.arguments import Motion, Stroke
from saleg.laws.base import Friction
from saleg.laws.usual import FRICTION, SMALL_FORCE
from saleg.quantities import quantity


@dataclass(frozen=True)
class NoFriction(Friction):
    """No friction at all."""

    mirrors: ClassVar[bool] = True

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Nothing to remember: zero."""
        return 0.0

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N]: zero."""
        return 0.0


@dataclass(frozen=True)
class ConstantFriction(Friction):
    """A constant force against the motion (Eq. 37): ``F = A (pi b^2 / 8) S f``.

    Blair's mean pressure for two-stroke engines; S and f, in rev/min, are those of the latest
    stroke. The force turns with the translator, at the dead centres and nowhere else.

    Parameters
    ----------
    factor : float
        Leading coefficient A [kg/m^2/s]; 150 in Blair's correlation.
    """

    mirrors: ClassVar[bool] = True

    factor: float = quantity("kg/m^2/s", default=150.0, low=0)

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Force [N], Eq. 37."""
        speed = 60.0 * 0.5 / stroke.duration
        return self.factor * 0.5 * stroke.piston_area * stroke.length * speed

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N]."""
        return memory * motion.direction


@dataclass(frozen=True)
class CoulombViscousFriction(Friction):
    """Coulomb and viscous friction together (Eq. 38): ``F = sign(v) (f1 + f2 |v|)``.

    Sandia's form; its coefficients were never published. The sign is that of the stroke: within a
    stroke the force is smooth, at a dead centre it turns with the translator.

    Parameters
    ----------
    coulomb : float
        Force f1 that does not depend on speed [N].
    viscous : float
        Coefficient f2 [N s/m].
    """

    mirrors: ClassVar[bool] = True

    coulomb: float = quantity("N", default=50.0, low=0, usual=SMALL_FORCE)
    viscous: float = quantity("N s/m", default=8.0, low=0, usual=FRICTION)

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Coulomb force [N]."""
        return self.coulomb

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 38."""
        return memory * motion.direction + self.viscous * motion.v


@dataclass(frozen=True)
class ViscousFriction(Friction):
    """Viscous friction with a fixed coefficient (Eq. 39): ``F = c_f v``.

    Parameters
    ----------
    coefficient : float
        Friction coefficient c_f [N s/m].
    """

    mirrors: ClassVar[bool] = True

    coefficient: float = quantity("N s/m", default=0.0, low=0, usual=FRICTION)

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Friction coefficient [N s/m]."""
        return self.coefficient

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 39."""
        return memory * motion.v


@dataclass(frozen=True)
class BlairViscousFriction(Friction):
    """Viscous friction scaled with bore, stroke and speed (Eq. 40).

    ``c_f = A (pi b^2 / 8) S_max 60 f``, with f the frequency of the latest stroke.

    Parameters
    ----------
    factor : float
        Leading coefficient A [kg/m^2/s]; 13.7 is inferred from the thesis' base case.
    """

    mirrors: ClassVar[bool] = True

    factor: float = quantity("kg/m^2/s", default=13.7, low=0)

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Friction coefficient [N s/m], Eq. 40."""
        frequency = 0.5 / stroke.duration
        return self.factor * 0.5 * stroke.piston_area * stroke.maximum * 60.0 * frequency

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 39."""
        return memory * motion.v


@dataclass(frozen=True)
class FrictionShare(Friction):
    """Viscous friction tuned until it takes a given share of the fuel energy (3.1, 3.6.1).

    At each dead centre the coefficient moves towards the one that would have made the friction
    work of the last two strokes that share of their fresh fuel energy; without fresh fuel it
    stays.

    Parameters
    ----------
    share : float
        Share of the fuel energy [-]; DLR measured about 6 %.
    relaxation : float
        Part of the way taken at each dead centre [-].
    initial : float
        Coefficient before the first fuel is known [N s/m].
    """

    mirrors: ClassVar[bool] = True

    share: float = quantity("-", default=0.06, low=0, high=1)
    relaxation: float = quantity("-", default=0.5, low=0, high=1, open_low=True)
    initial: float = quantity("N s/m", default=10.0, low=0)

    def at_dead_centre(self, memory: float, stroke: Stroke) -> float:
        """Friction coefficient [N s/m]."""
        if memory < 0.0:
            return self.initial
        if stroke.fuel_energy <= 0.0 or stroke.speed_squared <= 0.0:
            return memory
        wanted = self.share * stroke.fuel_energy / stroke.speed_squared
        return memory + self.relaxation * (wanted - memory)

    def force(self, memory: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 39."""
        return memory * motion.v
