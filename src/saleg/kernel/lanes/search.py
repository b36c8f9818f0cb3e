"""The search for fixed points of the return maps of many engines, W of them side by side.

What happens at a dead centre happens to each lane by itself, with the functions of
:mod:`saleg.kernel.orbit`. A lane whose search is over takes up the next engine at once. No engine
knows which others are beside it.
"""

from typing import Any, NamedTuple

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.lanes.group import Group, iterates_of, run_of
from saleg.kernel.layout import BEGIN, END_OF_TIME, GOES_ON, NOT_FOUND, WHOLE
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
    cycle : ndarray of int, shape (W,)
        Whether it has been found, and is on its whole cycle.
    """

    group: Group
    address: int
    iterates: Iterates
    row: Any
    cycle: Any


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
def begin_row(lanes, lane, row, mirrored, searches):
    """Take up an engine and set out."""
    mapping = mapping_of(lanes, lane, mirrored)
    take_up(searches, row, mapping)
    begin_search(mapping.integration, iterates_of(lanes.iterates, lane))
    lanes.row[lane], lanes.cycle[lane] = row, 0
    set_out(lanes, lane, mirrored)


@compiled
def end_row(lanes, lane, mirrored, code, searches):
    """Put down an engine whose search is over."""
    mapping, row = mapping_of(lanes, lane, mirrored), lanes.row[lane]
    iterates = iterates_of(lanes.iterates, lane)
    run = mapping.integration
    searches.codes[row] = code
    put_down(searches, row, mapping, iterates)
    if code == END_OF_TIME and run.engine[0].direction <= 0.0:
        run.options[0].part = WHOLE
        begin_on_the_left(mapping, iterates, searches.spare[0])
    keep_strokes(searches, row, mapping)
    run.options[0].peaks = 0
    lanes.row[lane] = -1


@compiled
def go_on(lanes, lane, mirrored, max_maps, tolerance, searches):
    """Do what is due when a lane has come back: judge the map, or the cycle; set out again."""
    run, iterates = run_of(lanes.group.runs, lane), iterates_of(lanes.iterates, lane)
    found, in_cycle = searches.found[lanes.row[lane]], lanes.cycle[lane] > 0
    code = end_return(run, mirrored and not in_cycle, lanes.group.codes[lane])
    if in_cycle:
        end_cycle(run, iterates, found)
        end_row(lanes, lane, mirrored, code, searches)
    elif code != END_OF_TIME:
        end_row(lanes, lane, mirrored, code, searches)
    elif has_settled(run, mirrored, tolerance, iterates, found):
        begin_cycle(run, iterates)
        lanes.cycle[lane] = 1
        set_out(lanes, lane, False)
    elif found.maps >= max_maps:
        end_row(lanes, lane, mirrored, NOT_FOUND, searches)
    else:
        set_out(lanes, lane, mirrored)


@cached
def find_orbits_side_by_side(lanes, mirrored, max_maps, tolerance, searches):
    """Entry point: look for the fixed point of every engine."""
    width, count, begun = lanes.row.shape[0], searches.codes.shape[0], 0
    while True:
        busy = False
        for lane in range(width):
            if lanes.row[lane] >= 0 and lanes.group.codes[lane] != GOES_ON:
                go_on(lanes, lane, mirrored, max_maps, tolerance, searches)
            if lanes.row[lane] < 0 and begun < count:
                begin_row(lanes, lane, begun, mirrored, searches)
                begun += 1
            busy = busy or lanes.row[lane] >= 0
        if not busy:
            return 0
        run_at(lanes.address, lanes.group)
