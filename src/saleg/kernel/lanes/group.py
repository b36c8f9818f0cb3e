"""What engines that are integrated side by side are kept in.

Each lane has the arguments of an integration by itself, as one engine has: whatever happens at the
end of a step, an event above all, happens to them. Steps are taken with copies of these numbers in
rows of W.
"""

from typing import Any, NamedTuple

import numpy as np

from saleg.kernel.jit import inline
from saleg.kernel.layout import ENGINE_RECORD, N_PEAKS
from saleg.kernel.tuples import Integration, Scratch, Snapshots, Spare, Tables, Words

#: What is remembered of a step, of each lane: its length and its end, the event it is aimed at;
#: whether it is one more after a rejected one; whether the state has just moved, so that another
#: step is due; whether the lane has an engine on its way; and whether its peaks are looked for.
STEP_RECORD = np.dtype(
    [
        (name, np.float64)
        for name in (
            "h",
            "end",
            "aim",
            "rejected",
            "moved",
            "busy",
            "watched",
            "t_end",
            "last_step",
        )
    ]
    + [("peaks", np.float64, (N_PEAKS,)), ("trail", np.float64, (N_PEAKS + 1,))]
)
# Fields of the engine's record that steps or events change, the first of it: the others stay as
# they are until the next return. And those of a step whose peaks are not looked for.
N_CHANGING = list(ENGINE_RECORD.fields or ()).index("evaluations") + 1
UNWATCHED = list(STEP_RECORD.fields or ()).index("peaks")


class Rows(NamedTuple):
    """Numbers of all lanes in rows of W.

    Attributes
    ----------
    laws, engine, chambers, y, y_new, rates, step : ndarray of float
        Records and states, a row per number.
    """

    laws: Any
    engine: Any
    chambers: Any
    y: Any
    y_new: Any
    rates: Any
    step: Any


class Flat(NamedTuple):
    """Records of each lane as numbers, in the same memory; a row per lane.

    Attributes
    ----------
    laws, engine, chambers, step : ndarray of float
    """

    laws: Any
    engine: Any
    chambers: Any
    step: Any


class Group(NamedTuple):
    """Engines side by side.

    Attributes
    ----------
    address : int
        Address of the integrator of one engine.
    law : ndarray of one record
        What the record of the laws is like.
    runs : Integration
        Its arguments for each lane: the first index of most arrays is the lane.
    flat : Flat
    rows : Rows
    step : ndarray of STEP_RECORD, shape (W, 1)
        What is remembered of the step of each lane.
    fresh : ndarray of int, shape (W,)
        Whether a lane's numbers have yet to be copied into the rows.
    codes : ndarray of int, shape (W,)
        Why a lane came back; GOES_ON if it has yet to.
    """

    address: int
    law: Any
    runs: Integration
    flat: Flat
    rows: Rows
    step: Any
    fresh: Any
    codes: Any


@inline
def run_of(runs, lane):
    """Arguments of the integration of a lane."""
    tables, words, scratch, spare = runs.tables, runs.words, runs.scratch, runs.scratch.spare
    begun = runs.snapshots
    return Integration(
        runs.laws[lane],
        runs.engine[lane],
        runs.chambers[lane],
        runs.y[lane],
        runs.peaks[lane],
        runs.tableau,
        runs.order,
        runs.options[lane],
        Tables(tables.strokes[lane], tables.events, tables.history, tables.filled[lane]),
        Snapshots(begun.engine[lane], begun.chambers[lane], begun.y[lane]),
        Words(
            words.engine[lane],
            words.chambers[lane],
            words.kept_engine[lane],
            words.kept_chambers[lane],
        ),
        Scratch(
            scratch.rates[lane],
            scratch.y_new[lane],
            Spare(
                spare.y,
                spare.dy,
                spare.rates,
                spare.y_new,
                spare.trail[lane],
                spare.slopes[lane],
            ),
        ),
        runs.control,
    )


@inline
def put(rows, lane, width, numbers):
    """Copy numbers of a lane into the rows."""
    for n in range(numbers.shape[0]):
        rows[n * width + lane] = numbers[n]


@inline
def take(rows, lane, width, numbers):
    """Copy numbers of a lane out of the rows."""
    for n in range(numbers.shape[0]):
        numbers[n] = rows[n * width + lane]
