"""The return map from dead centre to dead centre, and its fixed points.

What an engine will do is settled by its state at a dead centre: after it has turned, before a
charge is renewed or lit there, which belongs to the stroke that begins. Written as a vector of
dimensionless numbers it can be compared, extrapolated and put back. A mirrored engine repeats
itself, seen in the mirror, after half a cycle.
"""

import numpy as np

from saleg.kernel.extrapolation import DEPTH, extrapolate, push, slowness
from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import END_OF_TIME, N_ALL, N_PEAKS, N_VECTOR, NO_DEAD_CENTRE, NOT_FOUND
from saleg.kernel.run_plainly import run_at
from saleg.kernel.state import begin_stroke, copy_row, keep_snapshot
from saleg.kernel.vector import distance, mirror, read_vector, write_vector

# Whether a map is that of half a cycle, seen in the mirror. Numpy's own: for Python's own numba
# compiles each function once per value.
HALF_CYCLE = np.bool_(True)
WHOLE_CYCLE = np.bool_(False)

# What do_orbit is asked for.
FIND = 0
CYCLE = 1
IMAGE = 2

# Half cycles of plain iteration before extrapolation begins.
WARM_UP = 2
# Distance from the fixed point, over the residual asked for, within which a point is taken.
NEAR = 100.0


@inline
def take_state(held, row, run):
    """Copy the state of one of many engines into the arguments of the integrator.

    `held` are searches or differences: both hold engines, chambers, states and longest times.
    """
    copy_row(run.engine, 0, held.engine, row)
    for side in range(2):
        copy_row(run.chambers, side, held.chambers, 2 * row + side)
    for n in range(N_ALL):
        run.y[n] = held.y[row, n]
    for n in range(N_PEAKS):
        run.peaks[n] = 0.0
    run.options[0].longest = held.longest[row]


@inline
def same_modes(C, modes):
    """Whether both chambers are in the modes kept, which are brought up to date."""
    same = True
    for side in range(2):
        same = same and modes[side] == C[side].mode
        modes[side] = C[side].mode
    return same


@inline
def strokes_per_map(mirrored):
    """Strokes from one return to the next."""
    return 1.0 if mirrored else 2.0


@compiled
def next_return(mapping, mirrored):
    """Go on for half a cycle, to be seen in the mirror, or a whole one.

    Returns why the integrator came back.
    """
    run = mapping.integration
    begin_return(run, mirrored)
    return end_return(run, mirrored, run_at(mapping.address, run))


@compiled
def begin_return(run, mirrored):
    """Ask the integrator for the way to the next return."""
    E, O, filled = run.engine[0], run.options[0], run.tables.filled[0]
    O.last_stroke = E.strokes + strokes_per_map(mirrored)
    O.t_end = E.t + O.longest
    filled.strokes = 0
    filled.events = 0


@compiled
def end_return(run, mirrored, code):
    """What the integrator came back with as a return, seen in the mirror if need be."""
    E = run.engine[0]
    if code == END_OF_TIME and E.strokes < run.options[0].last_stroke:
        return NO_DEAD_CENTRE
    if mirrored and code == END_OF_TIME:
        mirror(E, run.chambers, run.y, run.words.chambers)
    return code


@compiled
def whole_cycle(mapping, iterates, found):
    """Take one whole cycle from the present state, all peaks located, as the record of the orbit.

    A state that repeats itself in the mirror must repeat itself without. The state at its begin
    goes into the snapshots; `found.missed` is how far the cycle misses it.
    """
    begin_cycle(mapping.integration, iterates)
    code = next_return(mapping, WHOLE_CYCLE)
    end_cycle(mapping.integration, iterates, found)
    return code


@compiled
def begin_cycle(run, iterates):
    """Keep the present state as the begin of a whole cycle."""
    E, C, y = run.engine[0], run.chambers, run.y
    write_vector(E, C, y, iterates.point)
    keep_snapshot(run.words, y, run.snapshots.y)
    begin_stroke(E, C, y, run.peaks)
    run.options[0].peaks = 2


@compiled
def end_cycle(run, iterates, found):
    """Compare the present state with that at the begin of the cycle."""
    run.options[0].peaks = 0
    write_vector(run.engine[0], run.chambers, run.y, iterates.image)
    found.missed = distance(iterates.image, iterates.point)


@compiled
def resize(E, rows, strokes):
    """Moving mass that suits the latest strokes: ``m_0 + m_S S + m_W W^2 / S^3``.

    S is their mean length and W their mean electrical work. An engine whose mass is given has no
    fixed part m_0 and keeps it.
    """
    if E.mass_fixed <= 0.0:
        return
    length, work = 0.0, 0.0
    for n in range(strokes):
        length += abs(rows[n].x_end - rows[n].x_start) / strokes
        work += rows[n].electrical_energy / strokes
    E.mass = E.mass_fixed + E.mass_per_stroke * length + E.mass_per_work * work**2 / length**3


@compiled
def begin_second_half(run, mass):
    """Go on from the first half of a cycle, out of the mirror, with the mass it had [kg]."""
    E = run.engine[0]
    mirror(E, run.chambers, run.y, run.words.chambers)
    E.mass = mass
    begin_return(run, HALF_CYCLE)
    run.options[0].peaks, run.tables.filled[0].strokes = 2, 1


@compiled
def second_half(mapping, iterates, found):
    """Take the second half of a whole cycle whose first half was the last map, recorded."""
    run = mapping.integration
    begin_second_half(run, run.snapshots.engine[0].mass)
    code = end_return(run, WHOLE_CYCLE, run_at(mapping.address, run))
    end_cycle(run, iterates, found)
    return code


@compiled
def find_orbit(mapping, max_maps, tolerance, iterates, found):
    """Iterate and extrapolate the return map until a state returns to itself; take one cycle then.

    On return the records of `mapping` hold the state at the last dead centre and the rows of the
    cycle; `iterates` the begin of the cycle, the residual of the map before it and the end of the
    cycle. Returns the code of the integrator, or that nothing was found in `max_maps` maps.
    """
    begin_search(mapping.integration, iterates)
    code = settle(mapping, max_maps, tolerance, iterates, found)
    return whole_cycle(mapping, iterates, found) if code == END_OF_TIME else code


@compiled
def settle(mapping, max_maps, tolerance, iterates, found):
    """Iterate and extrapolate the return map until a state returns to itself.

    Returns the code of the integrator, or that nothing was found in `max_maps` maps.
    """
    for _ in range(max_maps):
        code = next_return(mapping, mapping.mirrored)
        mapping.integration.options[0].peaks = 0  # none but the first map may be recorded
        if code != END_OF_TIME:
            return code
        if has_settled(mapping.integration, mapping.mirrored, tolerance, iterates, found):
            return END_OF_TIME
    return NOT_FOUND


@compiled
def begin_search(run, iterates):
    """Take the present state as the first point."""
    write_vector(run.engine[0], run.chambers, run.y, iterates.point)
    same_modes(run.chambers, iterates.modes)
    iterates.counts[0] = iterates.counts[1] = 0


@compiled
def has_settled(run, mirrored, tolerance, iterates, found):
    """Whether the state just returned to is the fixed point; if not, go to a better one."""
    z, f, image = iterates.point, iterates.residual, iterates.image
    E, C, y = run.engine[0], run.chambers, run.y
    count, known = iterates.counts[0], iterates.counts[1]
    found.maps += 1.0
    resize(E, run.tables.strokes, int(strokes_per_map(mirrored)))
    write_vector(E, C, y, image)
    alike = same_modes(C, iterates.modes)
    found.residual = distance(image, z)
    for n in range(N_VECTOR):
        f[n] = image[n] - z[n]
    if not alike:
        known = 0
    if alike and found.residual <= tolerance:
        found.slowness = slowness(iterates, min(known, DEPTH))
        # A small residual is no small distance.
        if found.slowness * found.residual <= NEAR * tolerance:
            return True
    trusted = known > 0 and count >= WARM_UP
    trusted = trusted and extrapolate(iterates, min(known, DEPTH))
    if alike:
        push(z, f, iterates.points, iterates.residuals)
        known += 1
    iterates.counts[0], iterates.counts[1] = count + 1, known
    if trusted:
        for n in range(N_VECTOR):
            z[n] = image[n]
        read_vector(E, C, y, z)
    else:
        write_vector(E, C, y, z)
    return False


@compiled
def cycle_from(mapping, iterates, found):
    """One whole cycle from a given vector."""
    run = mapping.integration
    read_vector(run.engine[0], run.chambers, run.y, iterates.point)
    return whole_cycle(mapping, iterates, found)


@compiled
def image_of(mapping, iterates):
    """Image of a given vector; the modes are those of the records."""
    run = mapping.integration
    E, C, y = run.engine[0], run.chambers, run.y
    read_vector(E, C, y, iterates.point)
    begin_stroke(E, C, y, run.peaks)
    code = next_return(mapping, mapping.mirrored)
    write_vector(E, C, y, iterates.image)
    return code


@cached
def do_orbit(task, mapping, max_maps, tolerance, iterates, found):
    """Entry point: find a fixed point, or take the image of a vector or a cycle from it."""
    if task == FIND:
        return find_orbit(mapping, max_maps, tolerance, iterates, found[0])
    if task == CYCLE:
        return cycle_from(mapping, iterates, found[0])
    return image_of(mapping, iterates)
