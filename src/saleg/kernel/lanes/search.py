"""The search for fixed points of the return maps of many engines, W of them side by side.

What happens at a dead centre happens to each lane by itself, with the functions of
:mod:`saleg.kernel.orbit`, while the others are there too: so all lanes do the same at the same
time, for instance compress on the right, and what none of them does costs nothing. A lane whose
search is over takes up the next engine. No engine knows which others are beside it: one that stands
on a line waits until all those are found from which its search begins.
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
    begin_second_half,
    end_cycle,
    end_return,
    has_settled,
)
from saleg.kernel.orbits import (
    FEW_MAPS,
    FINER_BESIDE,
    MOST_BEFORE,
    begin_anew,
    begin_on_line,
    begin_on_the_left,
    ends_beside,
    has_first_half,
    keep_begin,
    keep_cycle,
    keep_stroke,
    put_down,
    take_up,
)
from saleg.kernel.run_plainly import run_at
from saleg.kernel.tuples import Iterates, ReturnMapping

# First of the engines. Numpy's own, as in kernel/layout.py: else all is compiled for it once more.
FIRST = np.int64(0)
# Whether the first half of a cycle has been recorded in the search; numpy's own too.
HALF_IS_KNOWN = np.bool_(True)
NOTHING_IS_KNOWN = np.bool_(False)


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
    go_on(lanes, lane, mapping)


@compiled
def go_on(lanes, lane, mapping):
    """Begin the way that has been asked for."""
    mapping.integration.options[0].part = BEGIN
    run_at(mapping.address, mapping.integration)
    lanes.group.fresh[lane], lanes.group.codes[lane] = 1, GOES_ON


@compiled
def may_begin(searches, row):
    """Whether all those are found that a search on a line begins from."""
    for k in range(MOST_BEFORE):
        n = searches.before[row, k]
        if n >= 0 and searches.codes[n] == GOES_ON:
            return False
    return True


@compiled
def begin_row(searches, row, mapping, iterates):
    """Take up an engine and begin its search, along its line or else from its own start."""
    take_up(searches, row, mapping)
    searches.followed[row] = begin_on_line(searches, row, mapping, iterates)
    if not searches.followed[row]:
        begin_own(searches, row, mapping, iterates)


@compiled
def begin_own(searches, row, mapping, iterates):
    """Begin a search from an engine's own start."""
    begin_anew(searches, row, mapping)
    begin_search(mapping.integration, iterates)


@compiled
def is_over(searches, row, mapping, iterates, code, max_maps, tolerance):
    """Judge the map just taken; whether it was the last, the engine put down then."""
    run, found = mapping.integration, searches.found[row]
    followed = searches.followed[row]
    wanted = FINER_BESIDE * tolerance if followed else tolerance
    run.options[0].peaks = 0  # none but the first map may be recorded
    code = end_return(run, mapping.mirrored, code)
    if code == END_OF_TIME and not has_settled(run, mapping.mirrored, wanted, iterates, found):
        if iterates.counts[0] < (FEW_MAPS if followed else max_maps):
            return False
        code = NOT_FOUND
    if followed:
        if code != END_OF_TIME or not ends_beside(searches, row, mapping, tolerance, iterates):
            begin_own(searches, row, mapping, iterates)
            return False
        if has_first_half(searches, row, mapping, iterates):
            keep_begin(searches, row, run, 0)
            keep_stroke(searches, row, 0, run)
    searches.codes[row] = code
    put_down(searches, row, mapping, iterates)
    return True


@compiled
def search_all(lanes, mirrored, max_maps, tolerance, searches, begun, end):
    """Look for the fixed points of engines from one place in their order to another."""
    busy, rows = True, lanes.row
    while busy:
        busy = False
        for lane in range(rows.shape[0]):
            row, code = rows[lane], lanes.group.codes[lane]
            mapping, iterates = mapping_of(lanes, lane, mirrored), iterates_of(lanes, lane)
            if row >= 0 and is_over(searches, row, mapping, iterates, code, max_maps, tolerance):
                rows[lane] = -1
        for lane in range(rows.shape[0]):
            mapping, iterates = mapping_of(lanes, lane, mirrored), iterates_of(lanes, lane)
            free = rows[lane] < 0 and begun < end
            if free and may_begin(searches, searches.order[begun]):
                rows[lane], begun = searches.order[begun], begun + 1
                begin_row(searches, rows[lane], mapping, iterates)
            if rows[lane] >= 0:
                set_out(lanes, lane, mapping)
                busy = True
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
    """Judge and record the whole cycle just taken, or its second half where the first is known."""
    run = mapping.integration
    code = end_return(run, WHOLE_CYCLE, code)
    end_cycle(run, iterates, searches.found[row])
    searches.codes[row] = code
    put_down(searches, row, mapping, iterates)
    from_the_right = code == END_OF_TIME and run.engine[0].direction <= 0.0
    if from_the_right:
        run.options[0].part = WHOLE
        begin_on_the_left(mapping, iterates, searches.spare[0])
    if from_the_right or not searches.at_once[row]:
        keep_cycle(searches, row, run)
    else:
        keep_stroke(searches, row, 1, run)


@compiled
def begin_second_half_of(searches, row, mapping, iterates):
    """Take up an engine of whose cycle the first half has been recorded and go on with it."""
    take_up(searches, row, mapping)
    for n in range(N_VECTOR):
        iterates.point[n], iterates.residual[n] = searches.point[row, n], searches.residual[row, n]
    begin_second_half(mapping.integration, searches.starts.engine[row].mass)


@compiled
def next_found(searches, begun, end, at_once):
    """Place of the next engine whose fixed point has been found, with its first half or without."""
    while begun < end:
        row = searches.order[begun]
        if searches.codes[row] == END_OF_TIME and searches.at_once[row] == at_once:
            break
        begun += 1
    return begun


@compiled
def take_all_cycles(lanes, searches, at_once, begun, end):
    """Take the whole cycle, or what there is not yet of it, of every engine found."""
    begun, busy = next_found(searches, begun, end, at_once), True
    while busy:
        busy = False
        for lane in range(lanes.row.shape[0]):
            row, code = lanes.row[lane], lanes.group.codes[lane]
            mapping, iterates = mapping_of(lanes, lane, WHOLE_CYCLE), iterates_of(lanes, lane)
            if row >= 0:
                end_cycle_of(searches, row, mapping, iterates, code)
            lanes.row[lane] = -1
            if begun < end:
                row = searches.order[begun]
                if at_once:
                    begin_second_half_of(searches, row, mapping, iterates)
                    go_on(lanes, lane, mapping)
                else:
                    begin_cycle_of(searches, row, mapping, iterates)
                    set_out(lanes, lane, mapping)
                lanes.row[lane], busy = row, True
                begun = next_found(searches, begun + 1, end, at_once)
        if busy:
            run_at(lanes.address, lanes.group)


@compiled
def own_starts(searches):
    """How many engines begin from their own starts; they are the first in order."""
    count = FIRST
    for row in range(searches.order.shape[0]):
        count += searches.before[row, 0] < 0
    return count


@cached
def find_orbits_side_by_side(lanes, mirrored, max_maps, tolerance, searches):
    """Entry point: look for the fixed point of every engine.

    Those from which lines begin have their cycles first: at its end a state is nearer to the fixed
    point than where the search has left it, and what lies between two such states nearer too.
    """
    own, end = own_starts(searches), FIRST + searches.order.shape[0]
    search_all(lanes, mirrored, max_maps, tolerance, searches, FIRST, own)
    take_all_cycles(lanes, searches, NOTHING_IS_KNOWN, FIRST, own)
    search_all(lanes, mirrored, max_maps, tolerance, searches, own, end)
    take_all_cycles(lanes, searches, NOTHING_IS_KNOWN, own, end)
    take_all_cycles(lanes, searches, HALF_IS_KNOWN, own, end)
    return 0
