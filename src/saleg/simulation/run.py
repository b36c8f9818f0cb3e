"""Results of a run. They only read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.engine import Engine
from saleg.kernel.layout import EVENT_NAMES
from saleg.simulation.net_output import Auxiliaries, NetOutput, net_output_of
from saleg.simulation.performance import EnergyBalance, Performance
from saleg.simulation.plausibility import remarks_on
from saleg.simulation.scavenging import Scavenging, scavenging_of
from saleg.simulation.shaking import Shaking, shaking_of
from saleg.simulation.tables import cycle_table, dead_centre_table, event_table, history_table
from saleg.simulation.validity import ValidityReport, validity_of
from saleg.status import Status

if TYPE_CHECKING:
    import pandas as pd

    from saleg.plotting import Plots


@dataclass(eq=False)
class Run:
    """A simulated stretch of time.

    Attributes
    ----------
    engine : Engine
        The engine that ran.
    status : Status
        How the run ended.
    message : str
        What happened, when, and what to try.
    duration : float
        Time simulated [s].
    strokes : ndarray
        One record per stroke (see :mod:`saleg.kernel.layout`); read-only.
    event_rows, history_rows : ndarray
        Records of events and steps, read-only; what `events` and `history` show as tables.
    evaluations, steps : int
        Right-hand sides evaluated and steps taken, events included.
    settings : dict
        How the run was integrated.
    replay : callable, optional
        Integrates the last cycle again, for `orbit`.
    """

    engine: Engine
    status: Status
    message: str
    duration: float
    strokes: np.ndarray = field(repr=False)
    event_rows: np.ndarray = field(repr=False)
    history_rows: np.ndarray | None = field(repr=False)
    evaluations: int = 0
    steps: int = 0
    settings: dict[str, Any] = field(default_factory=dict)
    replay: Callable[[], Run] | None = field(default=None, repr=False)

    @property
    def fired(self) -> bool:
        """Whether the last cycle released heat in at least one chamber."""
        last = self.last_cycle_strokes
        return last is not None and float(last["heat_released"].sum()) > 0.0

    @property
    def last_cycle_strokes(self) -> np.ndarray | None:
        """Records of the last full cycle, left to left dead centre; None without one.

        Until a run has settled, those of an engine and of its mirror image are different strokes.
        """
        start = last_cycle_start(self.strokes)
        return None if start is None else self.strokes[start : start + 2]

    def __post_init__(self) -> None:
        """Show the records, but let nobody write to them."""
        self.strokes, self.event_rows = read_only(self.strokes), read_only(self.event_rows)
        if self.history_rows is not None:
            self.history_rows = read_only(self.history_rows)

    @property
    def cycles(self) -> pd.DataFrame:
        """Table of the cycles, left dead centre to left dead centre; units in ``.attrs``.

        A copy: what is changed in it does not change the run.
        """
        return self._cycles.copy()

    @property
    def dead_centres(self) -> pd.DataFrame:
        """Table of the strokes: signals at its end, and commands during it.

        A copy, units in ``.attrs``.
        """
        return self._dead_centres.copy()

    @property
    def events(self) -> pd.DataFrame:
        """Table of the events: time, kind, side, and the state there.

        A copy, units in ``.attrs``.
        """
        return self._events.copy()

    @property
    def history(self) -> pd.DataFrame | None:
        """Table of the recorded steps, two rows at an event (before and after); None if not kept.

        A table of its own whose numbers are those of the records, which cannot be written to:
        take a ``.copy()`` to change single ones.
        """
        return None if self.history_rows is None else history_table(self.history_rows)

    @cached_property
    def _cycles(self) -> pd.DataFrame:
        return cycle_table(self.engine, self.strokes)

    @cached_property
    def _dead_centres(self) -> pd.DataFrame:
        return dead_centre_table(self.engine, self.strokes)

    @cached_property
    def _events(self) -> pd.DataFrame:
        return event_table(self.event_rows, EVENT_NAMES)

    @cached_property
    def orbit(self) -> Run | None:
        """The last full cycle again, with its whole history and all peaks located; or None."""
        return self.replay() if self.replay is not None else None

    @cached_property
    def range_exits(self) -> list[dict[str, Any]]:
        """Exits of the last full cycle from the ranges its laws were made for; empty without one.

        See :func:`.ranges.range_exits`; ``pandas.DataFrame(run.range_exits)`` is a table.
        """
        from saleg.simulation.ranges import range_exits

        cycle = self if is_orbit(self) else self.orbit
        if cycle is None or cycle.history_rows is None:
            return []
        return range_exits(self.engine, cycle.strokes, cycle.history_rows)

    @property
    def remarks(self) -> list[str]:
        """Figures of the last full cycle that no engine built comes near, as text; often none."""
        start = last_cycle_start(self.strokes)
        cycle = self.strokes[:0] if start is None else self.strokes[start : start + 2]
        return remarks_on(self.engine, vars(self.performance), cycle)

    @property
    def validity(self) -> ValidityReport:
        """Laws outside their ranges, implausible figures, and what a published machine supports."""
        cycle = self.strokes[:0] if self.last_cycle_strokes is None else self.last_cycle_strokes
        return validity_of(self.engine, self.performance, cycle, self.range_exits)

    @cached_property
    def performance(self) -> Performance:
        """Figures of the last full cycle; zeros and NaN for a run that stalled."""
        if self.status in (Status.STALLED, Status.INVALID):
            return Performance.of_nothing(self.engine)
        start = last_cycle_start(self.strokes)
        if start is None:
            return Performance.of_nothing(self.engine)
        before = self.strokes[: start + 2]
        if self.orbit is None:
            return Performance.of_cycle(self.engine, before[-2:], before)
        orbit = self.orbit
        return Performance.of_cycle(self.engine, orbit.strokes, before, orbit.history_rows)

    @cached_property
    def energy(self) -> EnergyBalance | None:
        """Energy balance of the last full cycle; None if no stroke is known before it."""
        start = last_cycle_start(self.strokes)
        if start is None or start == 0:
            return None
        return EnergyBalance.between(self.strokes[start - 1], self.strokes[start : start + 2])

    @cached_property
    def scavenging(self) -> tuple[Scavenging, Scavenging]:
        """Gas exchange of the left and the right cylinder in the last full cycle.

        NaN for a chamber whose ports let no gas flow, and without a full cycle.
        """
        return scavenging_of(self.engine, self.last_cycle_strokes)

    @cached_property
    def shaking(self) -> Shaking:
        """Force on what the engine stands on, and motion of its frame, in the last full cycle."""
        history = self.orbit.history_rows if self.orbit is not None else None
        return shaking_of(self.last_cycle_strokes, history)

    def net_output(self, auxiliaries: Auxiliaries | None = None) -> NetOutput:
        """Power of the last full cycle once charger, electronics and consumers are paid for.

        Parameters
        ----------
        auxiliaries : Auxiliaries, optional
            Their efficiencies and the state of the surroundings.

        Returns
        -------
        NetOutput

        Raises
        ------
        InvalidEngine
            If a number of the auxiliaries is out of range.
        """
        return net_output_of(self.engine, self.last_cycle_strokes, auxiliaries)

    @property
    def plot(self) -> Plots:
        """Figures of the run: ``run.plot.pressure_volume()`` and so on; ``dir`` lists them."""
        from saleg.plotting import Plots

        return Plots(self)

    def save(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Save the run with its engine, so that :meth:`load` gives an equal one.

        Parameters
        ----------
        path : str or path
            The suffix chooses the format: ``.npz``, ``.mat``, ``.h5``, ``.nc``; a name without one
            is a folder of CSV tables. The file is there whole or not at all.
        overwrite : bool
            Replace what :meth:`save` put there earlier.

        Raises
        ------
        RunFileError
            If something is in the way, or cannot be written.
        """
        from saleg.export import save

        save(self, path, overwrite=overwrite)

    @classmethod
    def load(cls, path: str | PathLike[str], *, laws: Sequence[type] = ()) -> Run:
        """Load a run; nothing is simulated again.

        Parameters
        ----------
        path : str or path
            File or folder :meth:`save` wrote.
        laws : sequence of Law or Start classes, optional
            Classes of your own that the engine uses.

        Returns
        -------
        Run

        Raises
        ------
        RunFileError
            Naming the file and what is wrong with it.
        """
        from saleg.export import load

        return load(path, laws=laws)

    def __repr__(self) -> str:
        return f"<Run of {self.engine.name!r}: {self.duration:.4g} s, {self.status}>"

    def _repr_html_(self) -> str:
        from saleg.display import run_card

        return run_card(self)

    def __str__(self) -> str:
        from saleg.simulation.report import describe_run

        return describe_run(self)


def read_only(records: np.ndarray) -> np.ndarray:
    """A view of records that cannot be written to."""
    view = records.view()
    view.flags.writeable = False
    return view


def is_orbit(run: Run) -> bool:
    """Whether a run is itself the record of one cycle, as that of a steady state is."""
    whole = len(run.strokes) == 2 and run.strokes["direction"][0] > 0.0
    return whole and run.replay is None and run.history_rows is not None


def last_cycle_start(strokes: np.ndarray) -> int | None:
    """Index of the first of the two strokes of the last full cycle."""
    for start in range(len(strokes) - 2, max(len(strokes) - 4, -1), -1):
        if strokes["direction"][start] > 0.0 and strokes["direction"][start + 1] < 0.0:
            return start
    return None
