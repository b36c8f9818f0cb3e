"""The search for fixed points of the return maps of many engines, one after the other.

All of one choice of laws: what the search works on belongs to one return map, into which the
numbers of each engine are copied, and out of which its results are. An engine that stands on a line
between others begins at the polynomial through their fixed points. Where that is as good as the
fixed point, the map that shows it is the first half of the cycle that is recorded.
"""

from typing import Any, NamedTuple

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import END_OF_TIME, N_ALL, N_VECTOR
from saleg.kernel.orbit import (
    HALF_CYCLE,
    NEAR,
    begin_cycle,
    begin_search,
    cycle_from,
    find_orbit,
    next_return,
    second_half,
    settle,
    take_state,
    whole_cycle,
)
from saleg.kernel.state import begin_stroke, copy_row
from saleg.kernel.tuples import Snapshots
from saleg.kernel.vector import distance, mirror, read_vector, write_vector

# Fixed points an interpolation goes through: one on either side at least.
FEWEST_BEFORE = 2
MOST_BEFORE = 6
# Maps a search from an interpolated point may take; from a start of its own it takes some ten.
FEW_MAPS = 12
# Distance of a fixed point from the interpolated one beyond which it may be on another branch: of
# any, and over its distance from the nearer of its neighbours, had both a straight line between.
FARTHEST_BESIDE = 0.1
FARTHEST_OVER_WAY = 0.5
# Residual of a search along a line, over the one asked for: it may be that of the cycle recorded,
# not of the map before, and others begin from where it ends.
FINER_BESIDE = 0.5


class Searches(NamedTuple):
    """Engines whose fixed points are looked for, and what was found; a row per engine.

    Attributes
    ----------
    laws : ndarray, shape (n, k)
        Numbers of the laws.
    engine : ndarray of ENGINE_RECORD, shape (n,)
    chambers : ndarray of CHAMBER_RECORD, shape (2 n,)
    y : ndarray, shape (n, N_ALL)
        State at the start, and at the end of the search.
    longest : ndarray, shape (n,)
        Longest time to the next return [s].
    order : ndarray of int, shape (n,)
        Rows in the order in which they are searched for.
    before : ndarray of int, shape (n, MOST_BEFORE)
        Rows on its line that are searched for before each, one on either side and then the others,
        the nearest first; -1 for none.
    ahead : ndarray, shape (n, MOST_BEFORE)
        How far it is ahead of them on their line.
    followed : ndarray of bool, shape (n,)
        Whether what was found was found from there.
    at_once : ndarray of bool, shape (n,)
        Whether the first map of the search is the first half of the cycle.
    codes : ndarray of int, shape (n,)
        Why the integrator came back; GOES_ON if it has yet to.
    found : ndarray of SEARCH_RECORD, shape (n,)
        How the search went.
    spare : ndarray of SEARCH_RECORD, shape (1,)
        How what comes after it went.
    strokes : ndarray of STROKE_RECORD, shape (2 n,)
        The two strokes of the cycle, from its left dead centre.
    point, residual, image : ndarray, shape (n, N_VECTOR)
        As in :class:`~saleg.kernel.tuples.Iterates` after the search.
    starts : Snapshots
        States at the left dead centres at which the cycles begin; the chambers two for each row,
        as whole numbers of 8 bytes.
    """

    laws: Any
    engine: Any
    chambers: Any
    y: Any
    longest: Any
    order: Any
    before: Any
    ahead: Any
    followed: Any
    at_once: Any
    codes: Any
    found: Any
    spare: Any
    strokes: Any
    point: Any
    residual: Any
    image: Any
    starts: Snapshots


@inline
def take_up(searches, row, mapping):
    """Copy the numbers of an engine into the return map."""
    for n in range(searches.laws.shape[1]):
        mapping.integration.laws[n] = searches.laws[row, n]
    take_state(searches, row, mapping.integration)


@inline
def put_down(searches, row, mapping, iterates):
    """Copy what has become of an engine out of the return map."""
    run = mapping.integration
    copy_row(searches.engine, row, run.engine, 0)
    for side in range(2):
        copy_row(searches.chambers, 2 * row + side, run.chambers, side)
    for n in range(N_ALL):
        searches.y[row, n] = run.y[n]
    for n in range(N_VECTOR):
        searches.point[row, n] = iterates.point[n]
        searches.residual[row, n] = iterates.residual[n]
        searches.image[row, n] = iterates.image[n]


@compiled
def begin_on_the_left(mapping, iterates, found):
    """Take the cycle just recorded from its left dead centre, half a cycle on."""
    run = mapping.integration
    E, C, y = run.engine[0], run.chambers, run.y
    write_vector(E, C, y, iterates.point)
    read_vector(E, C, y, iterates.point)
    begin_stroke(E, C, y, run.peaks)
    next_return(mapping, HALF_CYCLE)
    mirror(E, C, y, run.words.chambers)
    write_vector(E, C, y, iterates.point)
    cycle_from(mapping, iterates, found)


@inline
def alike(searches, a, b):
    """Whether two engines were found in the same modes at dead centres of the same side."""
    same = searches.engine[a].direction == searches.engine[b].direction
    for side in range(2):
        same = same and searches.chambers[2 * a + side].mode == searches.chambers[2 * b + side].mode
    return same


@compiled
def known_before(searches, row):
    """Through how many of the rows found before it on its line a polynomial may go."""
    for k in range(MOST_BEFORE):
        n = searches.before[row, k]
        if n < 0 or searches.codes[n] != END_OF_TIME:
            return k
        if not alike(searches, searches.before[row, 0], n):
            return k
    return MOST_BEFORE


@compiled
def interpolate(searches, row, known, z):
    """Write the polynomial through the fixed points of rows on its line, by Lagrange."""
    ahead = searches.ahead[row]
    for m in range(N_VECTOR):
        z[m] = 0.0
    for i in range(known):
        weight = 1.0
        for j in range(known):
            if j != i:
                weight *= ahead[j] / (ahead[j] - ahead[i])
        for m in range(N_VECTOR):
            z[m] += weight * searches.image[searches.before[row, i], m]


@compiled
def begin_beside(searches, row, near, run, z):
    """Go to a vector in the modes of a neighbour; false if the neighbour begins on the other side.

    Of what is not in the vector, the step and the state at which a charge was enclosed at bottom
    dead centre are the neighbour's too.
    """
    E, C, theirs = run.engine[0], run.chambers, searches.engine[near]
    if E.direction != theirs.direction:
        return False
    E.next_step, E.ln_last_error = theirs.next_step, theirs.ln_last_error
    for side in range(2):
        c, beside = C[side], searches.chambers[2 * near + side]
        c.mode, c.armed, c.renewal_due = beside.mode, beside.armed, beside.renewal_due
        if c.curve_exponent > 0.0:
            c.p_closing, c.T_closing = beside.p_closing, beside.T_closing
            c.V_closing = beside.V_closing
    read_vector(E, C, run.y, z)
    begin_stroke(E, C, run.y, run.peaks)
    return True


@compiled
def begin_on_line(searches, row, mapping, iterates):
    """Begin a search where the fixed points beside a row on its line lead to; false if nowhere.

    The first half cycle is recorded.
    """
    known = known_before(searches, row)
    if known < FEWEST_BEFORE:
        return False
    run, guess = mapping.integration, searches.point[row]
    interpolate(searches, row, known, guess)
    if not begin_beside(searches, row, searches.before[row, 0], run, guess):
        return False
    begin_search(run, iterates)
    if mapping.mirrored:
        begin_cycle(run, iterates)
    return True


@compiled
def ends_beside(searches, row, mapping, tolerance, iterates):
    """Whether a fixed point is where it was expected, in the modes of its neighbours.

    Two neighbours on two branches would have it half their distance away.
    """
    near, far = searches.before[row, 0], searches.before[row, 1]
    ahead = searches.ahead[row]
    missed = distance(iterates.image, searches.point[row])
    way = distance(searches.image[near], searches.image[far])
    way *= min(abs(ahead[0]), abs(ahead[1])) / abs(ahead[0] - ahead[1])
    if missed > min(max(FARTHEST_OVER_WAY * way, NEAR * tolerance), FARTHEST_BESIDE):
        return False
    for side in range(2):
        if mapping.integration.chambers[side].mode != searches.chambers[2 * near + side].mode:
            return False
    # A few points say too little of what changes slowly: as slow as the neighbour's, then.
    found = searches.found[row]
    found.slowness = searches.found[near].slowness
    return found.slowness * found.residual <= NEAR * tolerance


@inline
def has_first_half(searches, row, mapping, iterates):
    """Whether the map that has just ended a search along a line is the first half of its cycle."""
    at_once = mapping.mirrored and iterates.counts[0] == 0
    if at_once:
        searches.found[row].maps = 0.0
    searches.at_once[row] = at_once
    return at_once


@compiled
def follow(searches, row, mapping, tolerance, iterates):
    """Look for a fixed point from where those beside it on its line lead to; whether there is one.

    It counts if it is where it was expected, in the modes of its neighbours.
    """
    found = searches.found[row]
    if not begin_on_line(searches, row, mapping, iterates):
        return False
    if settle(mapping, FEW_MAPS, FINER_BESIDE * tolerance, iterates, found) != END_OF_TIME:
        return False
    if not ends_beside(searches, row, mapping, tolerance, iterates):
        return False
    if has_first_half(searches, row, mapping, iterates):
        return second_half(mapping, iterates, found) == END_OF_TIME
    return whole_cycle(mapping, iterates, found) == END_OF_TIME


@compiled
def find_row(searches, row, mapping, max_maps, tolerance, iterates):
    """Look for the fixed point of an engine, along its line or else from its own start."""
    take_up(searches, row, mapping)
    searches.followed[row] = follow(searches, row, mapping, tolerance, iterates)
    if searches.followed[row]:
        return END_OF_TIME
    begin_anew(searches, row, mapping)
    return find_orbit(mapping, max_maps, tolerance, iterates, searches.found[row])


@inline
def begin_anew(searches, row, mapping):
    """Go to an engine's own start; what has been spent on it stays counted."""
    spent = mapping.integration.engine[0].evaluations
    take_up(searches, row, mapping)
    mapping.integration.engine[0].evaluations += spent
    mapping.integration.options[0].peaks = 0
    searches.followed[row] = searches.at_once[row] = False


@inline
def keep_begin(searches, row, run, at):
    """Copy a snapshot, the state the cycle began at, out of the return map."""
    starts, begun = searches.starts, run.snapshots
    copy_row(starts.engine, row, begun.engine, at)
    for n in range(N_ALL):
        starts.y[row, n] = begun.y[at, n]
    for side in range(2):
        for n in range(run.words.kept_chambers.shape[2]):
            starts.chambers[2 * row + side, n] = run.words.kept_chambers[at, side, n]


@inline
def keep_stroke(searches, row, stroke, run):
    """Copy a stroke of the cycle out of the return map."""
    copy_row(searches.strokes, 2 * row + stroke, run.tables.strokes, stroke)


@inline
def keep_cycle(searches, row, run):
    """Copy the cycle just recorded, and the state it began at, out of the return map."""
    keep_begin(searches, row, run, 1)
    keep_stroke(searches, row, 0, run)
    keep_stroke(searches, row, 1, run)


@cached
def find_orbits(mapping, max_maps, tolerance, iterates, searches):
    """Entry point: look for the fixed point of every engine."""
    run = mapping.integration
    for at in range(searches.order.shape[0]):
        row = searches.order[at]
        code = find_row(searches, row, mapping, max_maps, tolerance, iterates)
        searches.codes[row] = code
        put_down(searches, row, mapping, iterates)
        if code == END_OF_TIME and run.engine[0].direction <= 0.0:
            begin_on_the_left(mapping, iterates, searches.spare[0])
        keep_cycle(searches, row, run)
    return 0
