"""Parts of the state a choice of laws needs: what a composed module steps, and what it leaves out.

Every number of the state has its place in the vector (:mod:`saleg.kernel.layout`) whatever the laws
are, so that snapshots, the vector of a dead centre and saved runs are alike for all engines and
the search for steady states is compiled once. What is not needed stays as it was set there.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from saleg.kernel import layout
from saleg.laws.base import Alternator, Law

#: First entry of some that stand side by side, and the one after the last.
Stretch = tuple[int, int]

#: What is summed from dead centre to dead centre: for all engines, and for chambers that breathe.
QUADRATURES: Stretch = (layout.N_STATE, layout.N_PLAIN)
TOTALS: Stretch = (layout.SUPPLIED, layout.MOUNT_LOSS)
#: The states of the frame, and what is summed of it.
FRAME: Stretch = (layout.FRAME_X, layout.SUPPLIED)
FRAME_TOTALS: Stretch = (layout.MOUNT_LOSS, layout.N_ALL)


class Needs(NamedTuple):
    """Parts of the state that not every engine has.

    Attributes
    ----------
    motored_pressure : bool
        Pressures without combustion: a law looks at them, or the user wants them.
    current : bool
        Current in the alternator: its law has a rate for it.
    chambers : frozenset of str
        States of the chambers that laws ask for, by their names in
        :data:`saleg.kernel.layout.CHAMBER_STATES`.
    frame : bool
        Position and velocity of the frame: it moves.
    composition : bool
        Whether the gas of a chamber changes with its composition.
    injection : bool
        Whether fuel is injected into a closed chamber.
    """

    motored_pressure: bool
    current: bool
    chambers: frozenset[str] = frozenset()
    frame: bool = False
    composition: bool = False
    injection: bool = False

    @classmethod
    def of(cls, classes: Sequence[type[Law]], motored_pressure: bool) -> Needs:
        """Needs of some law classes."""
        alternators = [law for law in classes if issubclass(law, Alternator)]
        has_rate = any(law.current_rate is not Alternator.current_rate for law in alternators)
        composition = any(getattr(law, "follows_composition", False) for law in classes)
        injection = any(getattr(law, "is_direct", False) for law in classes)
        names = asked_for(classes)
        chambers = names.intersection(layout.CHAMBER_STATES)
        frame = "frame" in names
        return cls(motored_pressure, has_rate, chambers, frame, composition, injection)

    @property
    def states(self) -> list[Stretch]:
        """Entries of the state that are stepped."""
        return [(layout.X, layout.MOTORED), *(one for one, wanted in self._optional if wanted)]

    @property
    def sums(self) -> list[Stretch]:
        """Entries of the state that are summed from dead centre to dead centre."""
        return [QUADRATURES] + [TOTALS] * bool(self.chambers) + [FRAME_TOTALS] * self.frame

    @property
    def kept(self) -> list[Stretch]:
        """Entries of the state that stay as they are, but for those beyond the last wanted."""
        return [one for one, wanted in self._optional if not wanted and one[0] < self._length]

    @property
    def _optional(self) -> list[tuple[Stretch, bool]]:
        """Entries of the state that not every engine has, and whether this one does."""
        return [
            ((layout.MOTORED, layout.CURRENT), self.motored_pressure),
            ((layout.CURRENT, layout.N_STATE), self.current),
            *((place, name in self.chambers) for name, place in layout.CHAMBER_STATES.items()),
            (FRAME, self.frame),
        ]

    @property
    def _length(self) -> int:
        """Length of the state up to its last entry that is wanted."""
        return layout.N_ALL if self.chambers or self.frame else layout.N_PLAIN

    @property
    def text(self) -> str:
        """What stands for :mod:`saleg.kernel.needs` in a composed module."""
        return (
            f"MOTORED_PRESSURE_IS_WANTED = {self.motored_pressure}\n"
            f"CURRENT_IS_WANTED = {self.current}\n"
            f"COMPOSITION_IS_WANTED = {self.composition}\n"
            f"INJECTION_IS_WANTED = {self.injection}\n"
            f"CONTENTS_ARE_WANTED = {'contents' in self.chambers}\n"
            f"WALL_TEMPERATURE_IS_WANTED = {'wall_temperature' in self.chambers}\n"
            f"CRANKCASE_IS_WANTED = {'crankcase' in self.chambers}\n"
            f"FRAME_IS_WANTED = {self.frame}\n"
            f"N_WANTED = {self._length}\n"
        )


def asked_for(classes: Iterable[type[Law]]) -> frozenset[str]:
    """States that some law classes ask for, by name."""
    return frozenset(name for law in classes for name in law.states)
