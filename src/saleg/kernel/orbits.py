"""The search for fixed points of the return maps of many engines, one after the other.

All of one choice of laws: what the search works on belongs to one return map, into which the
numbers of each engine are copied, and out of which its results are.
"""

from typing import Any, NamedTuple

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import END_OF_TIME, N_ALL, N_PEAKS, N_VECTOR
from saleg.kernel.orbit import (
    cycle_from,
    find_orbit,
    mirror,
    next_return,
    read_vector,
    write_vector,
)
from saleg.kernel.state import begin_stroke, copy_row


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
    """

    laws: Any
    engine: Any
    chambers: Any
    y: Any
    longest: Any
    codes: Any
    found: Any
    spare: Any
    strokes: Any
    point: Any
    residual: Any
    image: Any


@inline
def take_up(searches, row, mapping):
    """Copy the numbers of an engine into the return map."""
    run = mapping.integration
    for n in range(searches.laws.shape[1]):
        run.laws[n] = searches.laws[row, n]
    copy_row(run.engine, 0, searches.engine, row)
    for side in range(2):
        copy_row(run.chambers, side, searches.chambers, 2 * row + side)
    for n in range(N_ALL):
        run.y[n] = searches.y[row, n]
    for n in range(N_PEAKS):
        run.peaks[n] = 0.0
    run.options[0].longest = searches.longest[row]


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
def keep_strokes(searches, row, mapping):
    """Copy the two strokes of the cycle of an engine out of the return map."""
    for stroke in range(2):
        strokes = mapping.integration.tables.strokes
        copy_row(searches.strokes, 2 * row + stroke, strokes, stroke)


@compiled
def begin_on_the_left(mapping, iterates, found):
    """Take the cycle just recorded from its left dead centre, half a cycle on."""
    run = mapping.integration
    E, C, y = run.engine[0], run.chambers, run.y
    write_vector(E, C, y, iterates.point)
    read_vector(E, C, y, iterates.point)
    begin_stroke(E, C, y, run.peaks)
    next_return(mapping, True)
    mirror(E, C, y, run.words.chambers)
    write_vector(E, C, y, iterates.point)
    cycle_from(mapping, iterates, found)


@cached
def find_orbits(mapping, max_maps, tolerance, iterates, searches):
    """Entry point: look for the fixed point of every engine."""
    run = mapping.integration
    for row in range(searches.codes.shape[0]):
        take_up(searches, row, mapping)
        code = find_orbit(mapping, max_maps, tolerance, iterates, searches.found[row])
        searches.codes[row] = code
        put_down(searches, row, mapping, iterates)
        if code == END_OF_TIME and run.engine[0].direction <= 0.0:
            begin_on_the_left(mapping, iterates, searches.spare[0])
        keep_strokes(searches, row, mapping)
    return 0
