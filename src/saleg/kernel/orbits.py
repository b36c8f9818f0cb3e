"""The search for fixed points of the return maps of many engines, one after the other.

All of one choice of laws: what the search works on belongs to one return map, into which the
numbers of each engine are copied, and out of which its results are. An engine that stands on a line
with others begins where their fixed points lead to, extrapolated by a cubic at most.
"""

from math import inf
from typing import Any, NamedTuple

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import END_OF_TIME, N_ALL, N_VECTOR
from saleg.kernel.orbit import HALF_CYCLE, NEAR, cycle_from, find_orbit, next_return, take_state
from saleg.kernel.state import begin_stroke, copy_row
from saleg.kernel.tuples import Snapshots
from saleg.kernel.vector import distance, mirror, read_vector, write_vector

# Fixed points an extrapolation goes through: a straight line's at least, a cubic's at most.
FEWEST_BEFORE = 2
MOST_BEFORE = 4
# Maps a search from an extrapolated point may take; from a start of its own it takes some ten.
FEW_MAPS = 12
# Distance of a fixed point from the extrapolated one beyond which it is on another branch.
FARTHEST_BESIDE = 0.1


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
        Rows that each may follow, the nearest first; -1 for none.
    ahead : ndarray, shape (n, MOST_BEFORE)
        How far it is ahead of them on their line.
    followed : ndarray of bool, shape (n,)
        Whether what was found was found from there.
    codes : ndarray of int, shape (n,)
        Why the integrator came back.
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
    """How many of the rows before on its line a row can follow."""
    for k in range(MOST_BEFORE):
        n = searches.before[row, k]
        if n < 0 or searches.codes[n] != END_OF_TIME:
            return k
        if not alike(searches, searches.before[row, 0], n):
            return k
    return MOST_BEFORE


@compiled
def extrapolate_line(searches, row, known, z):
    """Write the polynomial through the fixed points of the rows before, by Lagrange."""
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


@inline
def misses(searches, row, known, z):
    """How far an extrapolation through some fixed points would have missed that of a row."""
    extrapolate_line(searches, row, known, z)
    return distance(z, searches.image[row])


@compiled
def best_known(searches, row, z):
    """Through how many fixed points to extrapolate: what would have been best for the two before.

    Noise speaks for few, a curve for many. `z` is room for a vector.
    """
    most = known_before(searches, row)
    if most <= FEWEST_BEFORE:
        return most
    near, next_one = searches.before[row, 0], searches.before[row, 1]
    most = min(most, min(known_before(searches, near), known_before(searches, next_one)))
    best, least = FEWEST_BEFORE, inf
    for known in range(FEWEST_BEFORE, most + 1):
        missed = misses(searches, near, known, z) + misses(searches, next_one, known, z)
        if missed < least:
            best, least = known, missed
    return best


@compiled
def begin_beside(searches, row, near, mapping, z):
    """Go to a vector in the modes of a neighbour; false if the neighbour begins on the other side.

    Of what is not in the vector, the step and the state at which a charge was enclosed at bottom
    dead centre are the neighbour's too.
    """
    run = mapping.integration
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
def follow(searches, row, mapping, tolerance, iterates):
    """Look for a fixed point from where those before it on its line lead to; whether there is one.

    It counts if it is where it was expected, in the modes of its neighbour.
    """
    known = best_known(searches, row, iterates.residual)
    if known < FEWEST_BEFORE:
        return False
    near, found = searches.before[row, 0], searches.found[row]
    guess = searches.point[row]
    extrapolate_line(searches, row, known, guess)
    if not begin_beside(searches, row, near, mapping, guess):
        return False
    code = find_orbit(mapping, FEW_MAPS, tolerance, iterates, found)
    if code != END_OF_TIME or distance(iterates.image, guess) > FARTHEST_BESIDE:
        return False
    for side in range(2):
        if mapping.integration.chambers[side].mode != searches.chambers[2 * near + side].mode:
            return False
    # A few points say too little of what changes slowly: as slow as the neighbour's, then.
    found.slowness = searches.found[near].slowness
    return found.slowness * found.residual <= NEAR * tolerance


@compiled
def find_row(searches, row, mapping, max_maps, tolerance, iterates):
    """Look for the fixed point of an engine, along its line or else from its own start."""
    take_up(searches, row, mapping)
    searches.followed[row] = follow(searches, row, mapping, tolerance, iterates)
    if searches.followed[row]:
        return END_OF_TIME
    spent = mapping.integration.engine[0].evaluations
    take_up(searches, row, mapping)
    code = find_orbit(mapping, max_maps, tolerance, iterates, searches.found[row])
    mapping.integration.engine[0].evaluations += spent
    return code


@inline
def keep_cycle(searches, row, run):
    """Copy the cycle just recorded, and the state it began at, out of the return map."""
    starts, begun = searches.starts, run.snapshots
    copy_row(starts.engine, row, begun.engine, 1)
    for n in range(N_ALL):
        starts.y[row, n] = begun.y[1, n]
    for side in range(2):
        for n in range(run.words.kept_chambers.shape[2]):
            starts.chambers[2 * row + side, n] = run.words.kept_chambers[1, side, n]
        copy_row(searches.strokes, 2 * row + side, run.tables.strokes, side)


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
