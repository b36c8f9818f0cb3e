"""The return map from dead centre to dead centre, and its fixed points.

What an engine will do is settled by its state at a dead centre: after it has turned, before a
charge is renewed or lit there, which belongs to the stroke that begins. Written as a vector of
dimensionless numbers it can be compared, extrapolated and put back. A mirrored engine repeats
itself, seen in the mirror, after half a cycle.
"""

from math import asinh, exp, inf, isfinite, log, sinh

import numpy as np

from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import (
    AIR,
    BURNING,
    BURNT,
    CRANKCASE_BURNT,
    CRANKCASE_MASS,
    CRANKCASE_THETA,
    CURRENT,
    END_OF_TIME,
    FRAME_V,
    FRAME_X,
    FRESH,
    FUEL,
    IGNITION,
    MOTORED,
    N_ALL,
    N_PEAKS,
    N_VECTOR,
    NO_DEAD_CENTRE,
    NOT_FOUND,
    OPEN,
    THETA,
    VECTOR_PER_SIDE,
    WALL,
    V,
    X,
)
from saleg.kernel.run_plainly import run_at
from saleg.kernel.state import begin_stroke, copy_row, keep_snapshot

# Whether a map is that of half a cycle, seen in the mirror. Numpy's own: for Python's own numba
# compiles each function once per value.
HALF_CYCLE = np.bool_(True)
WHOLE_CYCLE = np.bool_(False)

# What do_orbit is asked for.
FIND = 0
CYCLE = 1
IMAGE = 2

# Points an extrapolation looks back on, and the pivot, over its own square, that ends that.
DEPTH = 4
SINGULAR = 1e-10
# Half cycles of plain iteration before extrapolation begins, and how far it may go at once.
WARM_UP = 2
FARTHEST = 0.5
# Distance from the fixed point, over the residual asked for, within which a point is taken.
NEAR = 100.0
# Entries of the vector: first those of the engine, then per side.
Z_POSITION = 0
Z_LN_SPEED = 1
Z_WEIGHT = 2
Z_FRICTION = 3
Z_STROKE = 4
Z_FUEL_ENERGY = 5
Z_SPEED_SQUARED = 6
Z_AMPERES = 7
Z_FRAME_X = 8
Z_FRAME_V = 9
Z_CHAMBERS = 10
Z_LN_PRESSURE = 0
Z_INTEGRAL = 1
Z_LN_MOTORED = 2
Z_LN_MASS = 3
Z_FUEL = 4
Z_AIR = 5
Z_BURNT = 6
Z_RATIO = 7
Z_BURN_PHASE = 8
Z_LN_DURATION = 9
Z_TO_BURN = 10
Z_FRESH = 11
Z_WALL = 12
Z_LN_CRANKCASE = 13
Z_CRANKCASE_MASS = 14
Z_CRANKCASE_BURNT = 15
Z_LN_LIT = 16
Z_LN_CLOSING_PRESSURE = 17
Z_LN_CLOSING_TEMPERATURE = 18
# Unit of a wall's temperature in the vector [K]: a power of two, which rounds nothing.
WALL_SCALE = 512.0
Z_LN_MASS_MOVING = Z_CHAMBERS + 2 * VECTOR_PER_SIDE


@compiled
def write_vector(E, C, y, z):
    """Write the state at a dead centre as a vector of numbers of the order of one."""
    z[Z_POSITION] = y[X] / E.length_scale
    z[Z_LN_SPEED] = log(max(E.mean_piston_speed, 1e-300))
    z[Z_WEIGHT] = E.load_weight
    z[Z_FRICTION] = asinh(E.friction_held)  # what a law remembers may be of any size
    z[Z_STROKE] = E.stroke / E.length_scale
    z[Z_FUEL_ENERGY] = E.last_fuel_energy / (E.mass * E.speed_scale**2)
    z[Z_SPEED_SQUARED] = E.last_speed_squared / (E.speed_scale * E.length_scale)
    z[Z_AMPERES] = y[CURRENT] / E.current_scale
    z[Z_FRAME_X] = E.frame_is_held * y[FRAME_X] / E.length_scale
    z[Z_FRAME_V] = E.frame_is_slowed * y[FRAME_V] / E.speed_scale
    z[Z_LN_MASS_MOVING] = log(E.mass) if E.mass_fixed > 0.0 else 0.0
    for side in range(2):
        c = C[side]
        first = Z_CHAMBERS + VECTOR_PER_SIDE * side
        closed = c.mode != OPEN or c.by_flow > 0.0
        z[first + Z_LN_PRESSURE] = y[THETA + side] if closed else 0.0
        z[first + Z_INTEGRAL] = y[IGNITION + side] if closed else 0.0
        z[first + Z_LN_MOTORED] = y[MOTORED + side] if closed else 0.0
        z[first + Z_LN_MASS] = log(c.mass)
        z[first + Z_FUEL] = c.fuel / c.mass
        z[first + Z_AIR] = c.air / c.mass
        z[first + Z_BURNT] = c.burnt / c.mass
        z[first + Z_RATIO] = c.equivalence_ratio
        burning = c.mode == BURNING
        z[first + Z_BURN_PHASE] = (E.t - c.t_ignition) / c.duration if burning else 0.0
        z[first + Z_LN_DURATION] = log(c.duration) if burning else 0.0
        z[first + Z_TO_BURN] = c.fuel_to_burn / c.mass if burning else 0.0
        z[first + Z_FRESH] = y[FRESH + side] / c.mass
        z[first + Z_WALL] = y[WALL + side] / WALL_SCALE
        crankcase = y[CRANKCASE_MASS + side]
        z[first + Z_LN_CRANKCASE] = y[CRANKCASE_THETA + side]
        z[first + Z_CRANKCASE_MASS] = log(crankcase) if crankcase > 0.0 else 0.0
        z[first + Z_CRANKCASE_BURNT] = y[CRANKCASE_BURNT + side] / max(crankcase, 1e-300)
        z[first + Z_LN_LIT] = log(c.mass_lit) if burning and c.breathes > 0.0 else 0.0
        trapped = c.mode != OPEN and c.by_flow > 0.0
        z[first + Z_LN_CLOSING_PRESSURE] = log(c.p_closing) if trapped else 0.0
        z[first + Z_LN_CLOSING_TEMPERATURE] = log(c.T_closing) if trapped else 0.0


@inline
def read_contents(C, side, y, z, first):
    """Set from a vector the states of a chamber that only some laws ask for."""
    c = C[side]
    if c.breathes > 0.0:
        c.burnt = c.mass - c.fuel - c.air
        y[FUEL + side], y[AIR + side], y[BURNT + side] = c.fuel, c.air, c.burnt
        y[FRESH + side] = z[first + Z_FRESH] * c.mass
        if c.mode == BURNING:
            c.mass_lit = exp(z[first + Z_LN_LIT])
    if c.mode != OPEN and c.by_flow > 0.0:
        c.p_closing = exp(z[first + Z_LN_CLOSING_PRESSURE])
        c.T_closing = exp(z[first + Z_LN_CLOSING_TEMPERATURE])
    y[WALL + side] = z[first + Z_WALL] * WALL_SCALE
    c.wall_temperature = y[WALL + side]
    if y[CRANKCASE_MASS + side] > 0.0:
        y[CRANKCASE_THETA + side] = z[first + Z_LN_CRANKCASE]
        y[CRANKCASE_MASS + side] = exp(z[first + Z_CRANKCASE_MASS])
        y[CRANKCASE_BURNT + side] = z[first + Z_CRANKCASE_BURNT] * y[CRANKCASE_MASS + side]


@compiled
def read_vector(E, C, y, z):
    """Set the state from a vector; modes, and all else that is not in it, stay as they are."""
    if E.mass_fixed > 0.0:
        E.mass = exp(z[Z_LN_MASS_MOVING])
    y[X] = z[Z_POSITION] * E.length_scale
    y[V] = 0.0
    E.x_dead_centre = y[X]
    E.t_dead_centre = E.t
    E.mean_piston_speed = exp(z[Z_LN_SPEED])
    E.load_weight = z[Z_WEIGHT]
    E.friction_held = sinh(z[Z_FRICTION])
    E.stroke = z[Z_STROKE] * E.length_scale
    E.last_fuel_energy = z[Z_FUEL_ENERGY] * (E.mass * E.speed_scale**2)
    E.last_speed_squared = z[Z_SPEED_SQUARED] * (E.speed_scale * E.length_scale)
    y[CURRENT] = z[Z_AMPERES] * E.current_scale
    if E.frame_is_held > 0.0:
        y[FRAME_X] = z[Z_FRAME_X] * E.length_scale
    if E.frame_is_slowed > 0.0:
        y[FRAME_V] = z[Z_FRAME_V] * E.speed_scale
    for side in range(2):
        c = C[side]
        first = Z_CHAMBERS + VECTOR_PER_SIDE * side
        c.mass = exp(z[first + Z_LN_MASS])
        c.fuel = max(z[first + Z_FUEL], 0.0) * c.mass
        c.air = max(z[first + Z_AIR], 0.0) * c.mass
        c.burnt = z[first + Z_BURNT] * c.mass
        c.equivalence_ratio = z[first + Z_RATIO]
        read_contents(C, side, y, z, first)
        if c.mode == OPEN and c.by_flow <= 0.0:
            continue
        y[THETA + side] = z[first + Z_LN_PRESSURE]
        y[IGNITION + side] = z[first + Z_INTEGRAL]
        y[MOTORED + side] = z[first + Z_LN_MOTORED]
        if c.mode == BURNING:
            c.duration = exp(z[first + Z_LN_DURATION])
            phase = min(max(z[first + Z_BURN_PHASE], 0.0), 1.0)
            c.t_ignition = E.t - phase * c.duration
            c.t_end = c.t_ignition + c.duration
            c.fuel_to_burn = z[first + Z_TO_BURN] * c.mass


@compiled
def mirror(E, C, y, words):
    """Exchange left and right, so that a right dead centre becomes a left one.

    `words` are the records of the chambers as whole numbers of 8 bytes, shape (2, n).
    """
    for n in range(words.shape[1]):
        words[0, n], words[1, n] = words[1, n], words[0, n]
    C[0].sign, C[1].sign = 1.0, -1.0
    for first in (THETA, IGNITION, MOTORED):
        y[first], y[first + 1] = y[first + 1], y[first]
    for first in range(FUEL, FRAME_X, 2):
        y[first], y[first + 1] = y[first + 1], y[first]
    y[X], y[V], y[CURRENT] = -y[X], -y[V], -y[CURRENT]
    y[FRAME_X], y[FRAME_V] = -y[FRAME_X], -y[FRAME_V]
    E.x_dead_centre = -E.x_dead_centre
    E.direction = -E.direction


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


@compiled
def distance(a, b):
    """Greatest difference of two vectors."""
    worst = 0.0
    for n in range(N_VECTOR):
        worst = max(worst, abs(a[n] - b[n])) if isfinite(a[n] - b[n]) else inf
    return worst


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
def solve(gram, size):
    """Solve a small symmetric system in place by elimination; false if it is nearly singular.

    Row i of `gram` is the i-th equation, its right-hand side in column `size`; on return that
    column holds the solution.
    """
    for i in range(size):
        if not gram[i, i] > SINGULAR * gram[i, size + 1]:
            return False
        for j in range(i + 1, size):
            factor = gram[j, i] / gram[i, i]
            for m in range(i, size + 1):
                gram[j, m] -= factor * gram[i, m]
    for i in range(size - 1, -1, -1):
        for m in range(i + 1, size):
            gram[i, size] -= gram[i, m] * gram[m, size]
        gram[i, size] /= gram[i, i]
    return True


@inline
def inner_product(f, a, b, share):
    """Inner product of ``f - a`` and ``f - share b``.

    Summed side by side: the mirror image of an engine has the same to the last digit, so that no
    search depends on the side.
    """
    middle, left, right = 0.0, 0.0, 0.0
    for n in range(Z_CHAMBERS):
        middle += (f[n] - a[n]) * (f[n] - share * b[n])
    for n in range(Z_CHAMBERS, Z_CHAMBERS + VECTOR_PER_SIDE):
        m = n + VECTOR_PER_SIDE
        left += (f[n] - a[n]) * (f[n] - share * b[n])
        right += (f[m] - a[m]) * (f[m] - share * b[m])
    n = Z_LN_MASS_MOVING
    return middle + (f[n] - a[n]) * (f[n] - share * b[n]) + (left + right)


@compiled
def mix(z, f, z_old, f_old, depth, gram):
    """Weights of the latest images whose residuals cancel best; false if they are undefined."""
    for i in range(depth):
        for j in range(i, depth):
            gram[i, j] = inner_product(f, f_old[i], f_old[j], 1.0)
            gram[j, i] = gram[i, j]
        gram[i, depth + 1] = gram[i, i]  # against which its pivot is judged
        gram[i, depth] = inner_product(f, f_old[i], f, 0.0)
    return solve(gram, depth)


@compiled
def extrapolate(iterates, known):
    """Anderson's step: the mixture of the latest images whose residuals cancel best.

    Writes the next point in place of the image; returns whether it is near enough to trust.
    """
    z, f, z_old, f_old = iterates.point, iterates.residual, iterates.points, iterates.residuals
    target, gram = iterates.image, iterates.gram
    depth = known
    while depth > 0 and not mix(z, f, z_old, f_old, depth, gram):
        depth -= 1
    farthest = 0.0
    for n in range(N_VECTOR):
        image = z[n] + f[n]
        step = 0.0
        for i in range(depth):
            step += gram[i, depth] * (image - z_old[i, n] - f_old[i, n])
        target[n] = image - step
        farthest = max(farthest, abs(step))
    return depth > 0 and farthest <= FARTHEST


@compiled
def slowness(iterates, known):
    """Distance from the fixed point over the residual, at most, between the latest points.

    What decays by a factor m per return is ``1 / (1 - m)`` residuals away from where it will end.
    """
    z, f, z_old, f_old = iterates.point, iterates.residual, iterates.points, iterates.residuals
    slowest = 1.0
    for i in range(known):
        way, change = distance(z, z_old[i]), distance(f, f_old[i])
        if way > slowest * change:
            slowest = way / max(change, 1e-300)
    return slowest


@compiled
def push(z, f, z_old, f_old):
    """Remember a point and its residual as the latest."""
    for i in range(DEPTH - 1, 0, -1):
        for n in range(N_VECTOR):
            z_old[i, n], f_old[i, n] = z_old[i - 1, n], f_old[i - 1, n]
    for n in range(N_VECTOR):
        z_old[0, n], f_old[0, n] = z[n], f[n]


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
def find_orbit(mapping, max_maps, tolerance, iterates, found):
    """Iterate and extrapolate the return map until a state returns to itself; take one cycle then.

    On return the records of `mapping` hold the state at the last dead centre and the rows of the
    cycle; `iterates` the begin of the cycle, the residual of the map before it and the end of the
    cycle. Returns the code of the integrator, or that nothing was found in `max_maps` maps.
    """
    begin_search(mapping.integration, iterates)
    for _ in range(max_maps):
        code = next_return(mapping, mapping.mirrored)
        if code != END_OF_TIME:
            return code
        if has_settled(mapping.integration, mapping.mirrored, tolerance, iterates, found):
            return whole_cycle(mapping, iterates, found)
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
