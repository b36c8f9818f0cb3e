"""Friction of bearings and piston rings."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.laws.arguments import Motion, Stroke
from saleg.laws.base import Friction
from saleg.quantities import quantity


@dataclass(frozen=True)
class ViscousFriction(Friction):
    """Viscous friction with a fixed coefficient (Eq. 39): ``F = c_f v``.

    Parameters
    ----------
    coefficient : float
        Friction coefficient c_f [N s/m].
    """

    coefficient: float = quantity("N s/m", default=0.0, low=0)

    def at_dead_centre(self, held: float, stroke: Stroke) -> float:
        """Friction coefficient [N s/m]."""
        return self.coefficient

    def force(self, held: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 39."""
        return held * motion.v


@dataclass(frozen=True)
class BlairViscousFriction(Friction):
    """Viscous friction scaled with bore, stroke and speed (Eq. 40).

    ``c_f = A (pi b^2 / 8) S_max 60 f``, with f the frequency of the latest stroke.

    Parameters
    ----------
    factor : float
        Leading coefficient A [kg/m^2/s]; 13.7 is inferred from the thesis' base case.
    """

    factor: float = quantity("kg/m^2/s", default=13.7, low=0)

    def at_dead_centre(self, held: float, stroke: Stroke) -> float:
        """Friction coefficient [N s/m], Eq. 40."""
        frequency = 0.5 / stroke.duration
        return self.factor * 0.5 * stroke.piston_area * stroke.maximum * 60.0 * frequency

    def force(self, held: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 39."""
        return held * motion.v


@dataclass(frozen=True)
class FrictionShare(Friction):
    """Viscous friction tuned until it takes a given share of the fuel energy (3.1, 3.6.1).

    At each dead centre the coefficient moves towards the one that would have made the friction
    work of the last two strokes that share of their fresh fuel energy; without fresh fuel it is
    held.

    Parameters
    ----------
    share : float
        Share of the fuel energy [-]; DLR measured about 6 %.
    relaxation : float
        Part of the way taken at each dead centre [-].
    initial : float
        Coefficient before the first fuel is known [N s/m].
    """

    share: float = quantity("-", default=0.06, low=0, high=1)
    relaxation: float = quantity("-", default=0.5, low=0, high=1, open_low=True)
    initial: float = quantity("N s/m", default=10.0, low=0)

    def at_dead_centre(self, held: float, stroke: Stroke) -> float:
        """Friction coefficient [N s/m]."""
        if held < 0.0:
            return self.initial
        if stroke.fuel_energy <= 0.0 or stroke.speed_squared <= 0.0:
            return held
        wanted = self.share * stroke.fuel_energy / stroke.speed_squared
        return held + self.relaxation * (wanted - held)

    def force(self, held: float, motion: Motion) -> float:
        """Force against positive velocity [N], Eq. 39."""
        return held * motion.v
