"""Parts of the state a choice of laws needs: what a composed module steps, and what it leaves out.

Every number of the state has its place in the vector (:mod:`saleg.kernel.layout`) whatever the laws
are, so that snapshots, the vector of a dead centre and saved runs are alike for all engines and
the search for steady states is compiled once. What is not needed stays as it was set there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from saleg.kernel import layout
from saleg.laws.base import Alternator, Law

#: First entry of some that stand side by side, and the one after the last.
Stretch = tuple[int, int]

QUADRATURES: Stretch = (layout.N_STATE, layout.N_ALL)


class Needs(NamedTuple):
    """Parts of the state that not every engine has.

    Attributes
    ----------
    motored_pressure : bool
        Pressures without combustion: a law looks at them, or the user wants them.
    current : bool
        Current in the alternator: its law has a rate for it.
    """

    motored_pressure: bool
    current: bool

    @classmethod
    def of(cls, classes: Sequence[type[Law]], motored_pressure: bool) -> Needs:
        """Needs of some law classes."""
        alternators = [law for law in classes if issubclass(law, Alternator)]
        has_rate = any(law.current_rate is not Alternator.current_rate for law in alternators)
        return cls(motored_pressure, has_rate)

    @property
    def states(self) -> list[Stretch]:
        """Entries of the state that are stepped."""
        return [(layout.X, layout.MOTORED), *(one for one, wanted in self._optional if wanted)]

    @property
    def kept(self) -> list[Stretch]:
        """Entries of the state that stay as they are."""
        return [one for one, wanted in self._optional if not wanted]

    @property
    def _optional(self) -> list[tuple[Stretch, bool]]:
        """Entries of the state that not every engine has, and whether this one does."""
        return [
            ((layout.MOTORED, layout.CURRENT), self.motored_pressure),
            ((layout.CURRENT, layout.N_STATE), self.current),
        ]

    @property
    def text(self) -> str:
        """What stands for :mod:`saleg.kernel.needs` in a composed module."""
        return (
            f"MOTORED_PRESSURE_IS_WANTED = {self.motored_pressure}\n"
            f"CURRENT_IS_WANTED = {self.current}\n"
        )
