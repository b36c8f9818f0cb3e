"""The search for fixed points of the return maps of many engines, W of them side by side.

What happens at a dead centre happens to each lane by itself, with the functions of
:mod:`saleg.kernel.orbit`, while the others are there too: so all lanes do the same at the same
time, for instance compress on the right, and what none of them does costs nothing. A lane whose
search is over takes up the next engine. No engine knows which others are beside it.
"""

from typing import Any, NamedTuple

import numpy as np

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.lanes.group import Group, run_of
from saleg.kernel.layout import BEGIN, END_OF_TIME, GOES_ON, N_VECTOR, NOT_FOUND, WHOLE
from saleg.kernel.orbit import (
    WHOLE_CYCLE,
    begin_cycle,
    begin_return,
    begin_search,
    end_cycle,
    end_return,
    has_settled,
)
from saleg.kernel.orbits import begin_on_the_left, keep_cycle, put_down, take_up
from saleg.kernel.run_plainly import run_at
from saleg.kernel.tuples import Iterates, ReturnMapping

# First of the engines. Numpy's own, as in kernel/layout.py: else all is compiled for it once more.
FIRST = np.int64(0)


class Lanes(NamedTuple):
    """Searches that go on side by side.

    Attributes
    ----------
    group : Group
        The engines.
    address : int
        Address of what steps them.
    iterates : Iterates
        Vectors of each lane: the first index of every array is the lane.
    row : ndarray of int, shape (W,)
        Row of the engine in each lane, -1 if there is none.
    """

    group: Group
    address: int
    iterates: Iterates
    row: Any


@inline
def mapping_of(lanes, lane, mirrored):
    """Return map of the engine in a lane."""
    return ReturnMapping(run_of(lanes.group.runs, lane), lanes.group.address, mirrored)


@inline
def iterates_of(lanes, lane):
    """Vectors of the search of a lane."""
    iterates = lanes.iterates
    return Iterates(
        iterates.point[lane],
        iterates.residual[lane],
        iterates.image[lane],
        iterates.points[lane],
        iterates.residuals[lane],
        iterates.gram[lane],
        iterates.modes[lane],
        iterates.counts[lane],
    )


@compiled
def set_out(lanes, lane, mapping):
    """Begin the way to the next return."""
    begin_return(mapping.integration, mapping.mirrored)
    mapping.integration.options[0].part = BEGIN
    run_at(mapping.address, mapping.integration)
    lanes.group.fresh[lane], lanes.group.codes[lane] = 1, GOES_ON


@compiled
def begin_row(searches, row, mapping, iterates):
    """Take up an engine and begin its search."""
    take_up(searches, row, mapping)
    begin_search(mapping.integration, iterates)


@compiled
def is_over(searches, row, mapping, iterates, code, max_maps, tolerance):
    """Judge the map just taken; whether it was the last, the engine put down then."""
    run, found = mapping.integration, searches.found[row]
    code = end_return(run, mapping.mirrored, code)
    if code == END_OF_TIME and not has_settled(run, mapping.mirrored, tolerance, iterates, found):
        if found.maps < max_maps:
            return False
        code = NOT_FOUND
    searches.codes[row] = code
    put_down(searches, row, mapping, iterates)
    return True


@compiled
def search_all(lanes, mirrored, max_maps, tolerance, searches):
    """Look for the fixed point of every engine."""
    begun, busy = FIRST, True
    while busy:
        busy = False
        for lane in range(lanes.row.shape[0]):
            row, code = lanes.row[lane], lanes.group.codes[lane]
            mapping, iterates = mapping_of(lanes, lane, mirrored), iterates_of(lanes, lane)
            if row >= 0 and is_over(searches, row, mapping, iterates, code, max_maps, tolerance):
                row = -1
            if row < 0 and begun < searches.codes.shape[0]:
                row, begun = begun, begun + 1
                begin_row(searches, row, mapping, iterates)
            if row >= 0:
                set_out(lanes, lane, mapping)
                busy = True
            lanes.row[lane] = row
        if busy:
            run_at(lanes.address, lanes.group)


@compiled
def begin_cycle_of(searches, row, mapping, iterates):
    """Take up an engine whose fixed point has been found and begin its whole cycle."""
    take_up(searches, row, mapping)
    for n in range(N_VECTOR):
        iterates.residual[n] = searches.residual[row, n]
    begin_cycle(mapping.integration, iterates)


@compiled
def end_cycle_of(searches, row, mapping, iterates, code):
    """Judge and record the whole cycle just taken."""
    run = mapping.integration
    code = end_return(run, WHOLE_CYCLE, code)
    end_cycle(run, iterates, searches.found[row])
    searches.codes[row] = code
    put_down(searches, row, mapping, iterates)
    if code == END_OF_TIME and run.engine[0].direction <= 0.0:
        run.options[0].part = WHOLE
        begin_on_the_left(mapping, iterates, searches.spare[0])
    keep_cycle(searches, row, run)


@compiled
def take_all_cycles(lanes, searches):
    """Take the whole cycle of every engine whose fixed point has been found."""
    begun, busy = FIRST, True
    while busy:
        busy = False
        for lane in range(lanes.row.shape[0]):
            row, code = lanes.row[lane], lanes.group.codes[lane]
            mapping, iterates = mapping_of(lanes, lane, WHOLE_CYCLE), iterates_of(lanes, lane)
            if row >= 0:
                end_cycle_of(searches, row, mapping, iterates, code)
                row = -1
            while begun < searches.codes.shape[0] and searches.codes[begun] != END_OF_TIME:
                begun += 1
            if begun < searches.codes.shape[0]:
                row, begun = begun, begun + 1
                begin_cycle_of(searches, row, mapping, iterates)
                set_out(lanes, lane, mapping)
                busy = True
            lanes.row[lane] = row
        if busy:
            run_at(lanes.address, lanes.group)


@cached
def find_orbits_side_by_side(lanes, mirrored, max_maps, tolerance, searches):
    """Entry point: look for the fixed point of every engine."""
    search_all(lanes, mirrored, max_maps, tolerance, searches)
    take_all_cycles(lanes, searches)
    return 0
