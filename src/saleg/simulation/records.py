"""Rows of a run, taken over from the kernel's buffers as they fill."""

from __future__ import annotations

import numpy as np

from saleg.kernel import layout
from saleg.kernel.tuples import Tables
from saleg.simulation.indicators import CR_CYCLES

#: Rows of history by which its buffer grows.
HISTORY_CHUNK = 20_000
STROKE_ROWS = 512
EVENTS_PER_STROKE = 10


class Kept:
    """Rows of one table in the pieces they came in, optionally only the last ones."""

    def __init__(self, dtype: np.dtype, last: int | None):
        self._last = last
        self._count = 0
        self._pieces = [np.zeros(0, dtype)]

    def add(self, rows: np.ndarray) -> None:
        """Take over a copy of some rows."""
        self._pieces = [rows.copy()] if self._count == 0 else [*self._pieces, rows.copy()]
        self._count += len(rows)
        if self._last is not None and self._count > 4 * self._last:
            self._pieces = [self.joined()]
            self._count = len(self._pieces[0])

    def joined(self) -> np.ndarray:
        """All rows kept, in order: an array only its readers share."""
        if len(self._pieces) > 1:  # numpy takes its time to join records, even those of one piece
            self._pieces = [np.concatenate(self._pieces)]
        rows = self._pieces[0]
        return rows if self._last is None else rows[-self._last :].copy()


class Records:
    """The kernel's buffers and what has been taken out of them.

    Parameters
    ----------
    history : bool
        Whether there is a history to record.
    keep_cycles : int or None
        Keep only about the last so many cycles, though no fewer than the figures look back on.
    """

    def __init__(self, history: bool, keep_cycles: int | None):
        last = None if keep_cycles is None else 2 * max(keep_cycles, CR_CYCLES + 1) + 4
        events = None if last is None else EVENTS_PER_STROKE * last
        self.strokes = np.zeros(STROKE_ROWS, layout.STROKE_RECORD)
        self.events = np.zeros(EVENTS_PER_STROKE * STROKE_ROWS, layout.EVENT_RECORD)
        self.history = np.zeros(HISTORY_CHUNK if history else 0, layout.HISTORY_RECORD)
        self.filled = np.zeros(1, layout.FILLED_RECORD)
        self.kept_strokes = Kept(layout.STROKE_RECORD, last)
        self.kept_events = Kept(layout.EVENT_RECORD, events)

    @property
    def tables(self) -> Tables:
        """The buffers as the kernel fills them."""
        return Tables(self.strokes, self.events, self.history, self.filled)

    def has(self, kind: int) -> bool:
        """Whether an event of a kind is in the buffer."""
        return bool((self.events["kind"][: self.filled[0]["events"]] == kind).any())

    def make_room(self) -> None:
        """Empty the buffers of strokes and events; let that of the history grow where it is.

        A long history is large: it is never copied, so it is never in memory twice.
        """
        filled = self.filled[0]
        self.kept_strokes.add(self.strokes[: filled["strokes"]])
        self.kept_events.add(self.events[: filled["events"]])
        filled["strokes"] = filled["events"] = 0
        if len(self.history) and len(self.history) - filled["history"] < HISTORY_CHUNK // 2:
            self.history.resize(len(self.history) + HISTORY_CHUNK, refcheck=False)

    def finished_history(self) -> np.ndarray | None:
        """The history cut to its length; None if none was recorded."""
        if not len(self.history):
            return None
        self.history.resize(int(self.filled[0]["history"]), refcheck=False)
        return self.history
