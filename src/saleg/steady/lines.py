"""Lines among many engines: rows that differ in one number, which follow each other along it.

Their steady states follow each other too, so that those beside one lead to it. Some rows of a line
are searched for by themselves; then, again and again, the rows in the middle between two that are
known. Nothing but the numbers says what lines there are: tables of a grid have them, in whatever
order, random ones have none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from saleg.kernel.orbits import MOST_BEFORE

#: Rows of a line from which on it is worth following.
WORTH_IT = 5
#: Rows of a line after which one is searched for from its own start.
OWN_EVERY = 32
#: Sum of the magnitudes of the weights of an interpolation, beyond which it goes through fewer
#: points: as many times it may magnify how far these are off.
MOST_WEIGHT = 2.0
#: Where the rows stand through which an interpolation may go, counted along the line from the one
#: before: one on either side, then those nearest, more on one side where the other has no more.
BESIDE = (0, 1, -1, 2, -2, 3, -3, 4, -4, 5)


class Lines(NamedTuple):
    """In what order rows are searched for, and from which each search begins.

    Attributes
    ----------
    order : ndarray of int, shape (n,)
    before : ndarray of int, shape (n, MOST_BEFORE)
        Rows between which each lies, one on either side, then those next to them, the nearest
        first; -1 for none.
    ahead : ndarray, shape (n, MOST_BEFORE)
        How far it is ahead of them, over the range of the numbers [-].
    stretch : ndarray of int, shape (n,)
        The same for rows between two that are searched for by themselves; -1 for these.
    """

    order: np.ndarray
    before: np.ndarray
    ahead: np.ndarray
    stretch: np.ndarray

    @property
    def any(self) -> bool:
        """Whether any search begins from other rows."""
        return bool((self.before >= 0).any())

    def around(self, rows: np.ndarray) -> np.ndarray:
        """Whether each row is on the stretch of one of some rows."""
        return (self.stretch >= 0) & np.isin(self.stretch, self.stretch[rows])


def no_lines(count: int) -> Lines:
    """Rows of which each is searched for from its own start."""
    shape = count, MOST_BEFORE
    return Lines(np.arange(count), np.full(shape, -1), np.zeros(shape), np.full(count, -1))


def lines_among(numbers: np.ndarray) -> Lines:
    """Lines among some rows.

    Parameters
    ----------
    numbers : ndarray, shape (n, k)
        The numbers of each row.

    Returns
    -------
    Lines
        Along the number that makes the fewest and so the longest lines.
    """
    lines, scaled = no_lines(len(numbers)), _scaled(numbers)
    found = _longest(scaled) if scaled.shape[1] else None
    if found is not None:
        along, line = found
        _halve(lines, line, scaled[:, along])
    return lines


def _scaled(numbers: np.ndarray) -> np.ndarray:
    """The numbers that differ, over their ranges; those that go together once."""
    least, most = numbers.min(axis=0), numbers.max(axis=0)
    varied = (most > least) & np.isfinite(most - least)
    scaled = (numbers[:, varied] - least[varied]) / (most - least)[varied]
    scaled = np.round(scaled, 12)
    once = {column.tobytes(): n for n, column in enumerate(scaled.T)}
    return scaled[:, sorted(once.values())]


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


def _halve(lines: Lines, line: np.ndarray, place: np.ndarray) -> None:
    """Let rows begin from those on either side, each in the middle between rows known before."""
    rows = np.lexsort((place, line))
    again = np.append(False, (np.diff(line[rows]) == 0) & (np.diff(place[rows]) == 0.0))
    alone, rows = rows[again], rows[~again]  # what stands there twice is no neighbour
    line, place = line[rows], place[rows]
    own = np.flatnonzero(_are_own(line))
    known, levels, neighbours = own, [own], [np.zeros((0, MOST_BEFORE), int)]
    while True:
        gaps = np.flatnonzero(np.diff(known) > 1)
        if not len(gaps):
            break
        middle = (known[gaps] + known[gaps + 1]) // 2
        levels.append(middle)
        neighbours.append(_beside(known, gaps, line))
        known = np.sort(np.append(known, middle))
    lines.order[:] = np.append(alone, rows[np.concatenate(levels)])
    between, beside = np.concatenate([own[:0], *levels[1:]]), np.concatenate(neighbours)
    ahead = place[between, np.newaxis] - place[beside]
    there = (beside >= 0) & (np.arange(MOST_BEFORE) < _most_before(ahead, beside >= 0))
    lines.before[rows[between]] = np.where(there, rows[beside], -1)
    lines.ahead[rows[between]] = np.where(there, ahead, 0.0)
    lines.stretch[rows[between]] = np.searchsorted(own, between)


def _are_own(line: np.ndarray) -> np.ndarray:
    """Which rows of sorted lines are searched for by themselves: both ends and some between."""
    changes = np.diff(line) != 0
    first, last = np.append(True, changes), np.append(changes, True)
    start = np.maximum.accumulate(np.where(first, np.arange(len(line)), 0))
    own: np.ndarray = last | ((np.arange(len(line)) - start) % OWN_EVERY == 0)
    return own


def _beside(known: np.ndarray, gaps: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Known rows of its line beside each gap behind some of them, the nearest first; -1 for none.

    Rows are numbered along the sorted lines.
    """
    at = gaps[:, np.newaxis] + np.array(BESIDE)
    beside = known[np.clip(at, 0, len(known) - 1)]
    there = (at >= 0) & (at < len(known)) & (line[beside] == line[known[gaps], np.newaxis])
    nearest = np.argsort(~there, axis=1, kind="stable")[:, :MOST_BEFORE]
    found: np.ndarray = np.take_along_axis(np.where(there, beside, -1), nearest, 1)
    return found


def _most_before(ahead: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Through how many points to interpolate, as a column: so that their errors do not grow."""
    apart = ahead[:, np.newaxis, :] - ahead[:, :, np.newaxis]
    with np.errstate(divide="ignore", invalid="ignore"):
        factors = ahead[:, np.newaxis, :] / apart
    itself = np.arange(MOST_BEFORE)
    factors[:, itself, itself] = 1.0
    most = np.full((len(ahead), 1), 2)
    for count in range(3, MOST_BEFORE + 1):
        weights = factors[:, :count, :count].prod(axis=2)
        good = (np.abs(weights).sum(axis=1) <= MOST_WEIGHT) & there[:, count - 1]
        most[good] = count
    return most
