"""The search for fixed points of the return maps of many engines, W of them side by side.

What happens at a dead centre happens to each lane by itself, with the functions of
:mod:`saleg.kernel.orbit`, while the others are there too: so all lanes do the same at the same
time, for instance compress on the right, and what none of them does costs nothing. A lane whose
search is over takes up the next engine. No engine knows which others are beside it.
"""

from typing import Any, NamedTuple

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.lanes.group import Group, iterates_of, run_of
from saleg.kernel.layout import BEGIN, END_OF_TIME, GOES_ON, N_VECTOR, NOT_FOUND, WHOLE
from saleg.kernel.orbit import (
    begin_cycle,
    begin_return,
    begin_search,
    end_cycle,
    end_return,
    has_settled,
)
from saleg.kernel.orbits import begin_on_the_left, keep_strokes, put_down, take_up
from saleg.kernel.run_plainly import run_at
from saleg.kernel.tuples import Iterates, ReturnMapping


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


@compiled
def set_out(lanes, lane, mirrored):
    """Begin the way to the next return: half a cycle seen in the mirror, or a whole one."""
    run = run_of(lanes.group.runs, lane)
    begin_return(run, mirrored)
    run.options[0].part = BEGIN
    run_at(lanes.group.address, run)
    lanes.group.fresh[lane], lanes.group.codes[lane] = 1, GOES_ON


@compiled
def begin_search_of(lanes, lane, row, mirrored, searches):
    """Take up an engine and begin its search."""
    mapping = mapping_of(lanes, lane, mirrored)
    take_up(searches, row, mapping)
    begin_search(mapping.integration, iterates_of(lanes.iterates, lane))
    lanes.row[lane] = row
    set_out(lanes, lane, mirrored)


@compiled
def begin_cycle_of(lanes, lane, row, searches):
    """Take up an engine whose fixed point has been found and begin its whole cycle."""
    mapping, iterates = mapping_of(lanes, lane, False), iterates_of(lanes.iterates, lane)
    take_up(searches, row, mapping)
    for n in range(N_VECTOR):
        iterates.residual[n] = searches.residual[row, n]
    begin_cycle(mapping.integration, iterates)
    lanes.row[lane] = row
    set_out(lanes, lane, False)


@compiled
def end_row(lanes, lane, mapping, code, searches):
    """Put down an engine."""
    row = lanes.row[lane]
    searches.codes[row] = code
    put_down(searches, row, mapping, iterates_of(lanes.iterates, lane))
    lanes.row[lane] = -1


@compiled
def end_map(lanes, lane, mirrored, max_maps, tolerance, searches):
    """Judge the map a lane has come back from; set out again unless its search is over."""
    mapping, iterates = mapping_of(lanes, lane, mirrored), iterates_of(lanes.iterates, lane)
    run, found = mapping.integration, searches.found[lanes.row[lane]]
    code = end_return(run, mirrored, lanes.group.codes[lane])
    if code != END_OF_TIME or has_settled(run, mirrored, tolerance, iterates, found):
        end_row(lanes, lane, mapping, code, searches)
    elif found.maps >= max_maps:
        end_row(lanes, lane, mapping, NOT_FOUND, searches)
    else:
        set_out(lanes, lane, mirrored)


@compiled
def end_cycle_of(lanes, lane, mirrored, searches):
    """Judge and record the whole cycle a lane has come back from."""
    mapping, iterates = mapping_of(lanes, lane, mirrored), iterates_of(lanes.iterates, lane)
    run, row = mapping.integration, lanes.row[lane]
    code = end_return(run, False, lanes.group.codes[lane])
    end_cycle(run, iterates, searches.found[row])
    end_row(lanes, lane, mapping, code, searches)
    if code == END_OF_TIME and run.engine[0].direction <= 0.0:
        run.options[0].part = WHOLE
        begin_on_the_left(mapping, iterates, searches.spare[0])
    keep_strokes(searches, row, mapping)


@compiled
def search_all(lanes, mirrored, max_maps, tolerance, searches):
    """Look for the fixed point of every engine."""
    begun, busy = 0, True
    while busy:
        busy = False
        for lane in range(lanes.row.shape[0]):
            if lanes.row[lane] >= 0:
                end_map(lanes, lane, mirrored, max_maps, tolerance, searches)
            if lanes.row[lane] < 0 and begun < searches.codes.shape[0]:
                begin_search_of(lanes, lane, begun, mirrored, searches)
                begun += 1
            busy = busy or lanes.row[lane] >= 0
        if busy:
            run_at(lanes.address, lanes.group)


@compiled
def take_all_cycles(lanes, mirrored, searches):
    """Take the whole cycle of every engine whose fixed point has been found."""
    begun, busy = 0, True
    while busy:
        busy = False
        for lane in range(lanes.row.shape[0]):
            if lanes.row[lane] >= 0:
                end_cycle_of(lanes, lane, mirrored, searches)
            while begun < searches.codes.shape[0] and searches.codes[begun] != END_OF_TIME:
                begun += 1
            if begun < searches.codes.shape[0]:
                begin_cycle_of(lanes, lane, begun, searches)
                begun += 1
            busy = busy or lanes.row[lane] >= 0
        if busy:
            run_at(lanes.address, lanes.group)


@cached
def find_orbits_side_by_side(lanes, mirrored, max_maps, tolerance, searches):
    """Entry point: look for the fixed point of every engine."""
    search_all(lanes, mirrored, max_maps, tolerance, searches)
    take_all_cycles(lanes, mirrored, searches)
    return 0
