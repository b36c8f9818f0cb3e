"""Springs between translator and housing."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.laws.arguments import Motion
from saleg.laws.base import Springs
from saleg.quantities import quantity


@dataclass(frozen=True)
class LinearSprings(Springs):
    """Two equal linear springs (Eq. 41-42): ``F = -2 k x``.

    Parameters
    ----------
    stiffness : float
        Stiffness k of each spring [N/m].

    Examples
    --------
    >>> from saleg.laws import Motion
    >>> LinearSprings(30e3).force(Motion(t=0.0, x=0.01, v=0.0, direction=1.0))
    -600.0
    """

    stiffness: float = quantity("N/m", default=0.0, low=0)

    def force(self, motion: Motion) -> float:
        """Force on the translator [N], Eq. 42."""
        return -2.0 * self.stiffness * motion.x

    def energy(self, motion: Motion) -> float:
        """Energy stored in both springs [J]."""
        return self.stiffness * motion.x * motion.x
