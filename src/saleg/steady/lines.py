"""Lines among many engines: rows that differ in one number, which follow each other along it.

Their steady states follow each other too, so that each leads to the next. Nothing but the numbers
says what lines there are: tables of a grid have them, in whatever order, random ones have none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from saleg.kernel.orbits import MOST_BEFORE

#: Rows of a line from which on it is worth following.
WORTH_IT = 5
#: Step over the one before it beyond which an extrapolation does not go on through both.
LONGEST_STEP = 2.0
#: Rows of a line after which one is searched for from its own start too.
CHECKED_EVERY = 32


class Lines(NamedTuple):
    """In what order rows are searched for, and which follow which.

    Attributes
    ----------
    order : ndarray of int, shape (n,)
    before : ndarray of int, shape (n, MOST_BEFORE)
        Rows that each follows, the nearest first; -1 for none.
    ahead : ndarray, shape (n, MOST_BEFORE)
        How far it is ahead of them, over the range of the numbers [-].
    checked : ndarray of bool, shape (n,)
        Rows at which a line has to prove itself: the last, and some on the way.
    stretch : ndarray of int, shape (n,)
        Rows from behind one of these to the next have the same; -1 for those on no line.
    """

    order: np.ndarray
    before: np.ndarray
    ahead: np.ndarray
    checked: np.ndarray
    stretch: np.ndarray

    @property
    def any(self) -> bool:
        """Whether any row follows another."""
        return bool((self.before >= 0).any())

    def around(self, rows: np.ndarray) -> np.ndarray:
        """Whether each row is on the stretch of one of some rows."""
        return (self.stretch >= 0) & np.isin(self.stretch, self.stretch[rows])


def no_lines(count: int) -> Lines:
    """Rows of which each is searched for from its own start."""
    shape = count, MOST_BEFORE
    return Lines(
        order=np.arange(count),
        before=np.full(shape, -1),
        ahead=np.zeros(shape),
        checked=np.full(count, False),
        stretch=np.full(count, -1),
    )


def lines_among(numbers: np.ndarray) -> Lines:
    """Lines among some rows.

    Parameters
    ----------
    numbers : ndarray, shape (n, k)
        The numbers of each row.

    Returns
    -------
    Lines
        Along the number that makes the fewest and so the longest lines; their first rows follow
        each other along the others.
    """
    lines = no_lines(len(numbers))
    scaled = _scaled(numbers)
    if scaled.shape[1]:
        lines.order[:] = _joined(lines, scaled, np.arange(len(numbers)))
    return lines


def _scaled(numbers: np.ndarray) -> np.ndarray:
    """The numbers that differ, over their ranges; those that go together once."""
    least, most = numbers.min(axis=0), numbers.max(axis=0)
    varied = (most > least) & np.isfinite(most - least)
    scaled = (numbers[:, varied] - least[varied]) / (most - least)[varied]
    scaled = np.round(scaled, 12)
    once = {column.tobytes(): n for n, column in enumerate(scaled.T)}
    return scaled[:, sorted(once.values())]


def _joined(lines: Lines, scaled: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Join some rows to lines; returns them in the order of their searches, first rows first."""
    found = _longest(scaled[rows])
    if found is None:
        return rows
    along, line = found
    sorted_ = np.lexsort((scaled[rows, along], line))
    rows, line = rows[sorted_], line[sorted_]
    is_first = np.append(True, np.diff(line) > 0)
    number = np.arange(len(rows)) - np.flatnonzero(is_first)[line]  # of the row on its line
    _follow(lines, rows, number, scaled[rows, along])
    is_last = np.append(is_first[1:], True)
    behind, number = rows[~is_first], number[~is_first]
    lines.checked[behind] = is_last[~is_first] | (number % CHECKED_EVERY == 0)
    ends = np.cumsum(lines.checked[behind])
    lines.stretch[behind] = lines.stretch.max() + 1 + ends - lines.checked[behind]
    first = _joined(lines, np.delete(scaled, along, axis=1), rows[is_first])
    return np.concatenate([first, behind])


def _longest(scaled: np.ndarray) -> tuple[int, np.ndarray] | None:
    """The column along which there are the fewest lines, and the line of each row, if any."""
    most_lines = len(scaled) // WORTH_IT
    varied = [len(np.unique(column)) > most_lines for column in scaled.T]
    candidates = np.flatnonzero(varied) if any(varied) else np.arange(len(varied))
    if most_lines < 1 or not len(candidates) > 0 or sum(varied) > 1:
        return None
    ways = []
    for along in candidates.tolist():
        others = np.delete(scaled, along, axis=1)
        line = np.unique(others, axis=0, return_inverse=True)[1].reshape(-1)
        ways.append((int(line.max()) + 1, -along, line))
    count, along, line = min(ways, key=lambda way: way[:2])
    return (-along, line) if count <= most_lines else None


def _follow(lines: Lines, rows: np.ndarray, number: np.ndarray, place: np.ndarray) -> None:
    """Let rows follow those before them on their lines.

    An extrapolation does not go through points that are closer together than the way from them.
    """
    reach, open_ = np.zeros(len(rows)), np.full(len(rows), True)
    for k in range(MOST_BEFORE):
        before = np.maximum(np.arange(len(rows)) - k - 1, 0)
        ahead = place - place[before]
        step = ahead - reach
        open_ = open_ & (number > k) & (step > 0.0)
        if k:
            open_ &= LONGEST_STEP * step >= reach / k
        lines.before[rows[open_], k] = rows[before[open_]]
        lines.ahead[rows[open_], k] = ahead[open_]
        reach = ahead
