"""The state at a dead centre as a vector of dimensionless numbers, and its mirror image."""

from math import asinh, exp, inf, isfinite, log, sinh

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    AIR,
    BURNING,
    BURNT,
    CRANKCASE_BURNT,
    CRANKCASE_MASS,
    CRANKCASE_THETA,
    CURRENT,
    FRAME_V,
    FRAME_X,
    FRESH,
    FUEL,
    IGNITION,
    MOTORED,
    N_VECTOR,
    OPEN,
    THETA,
    VECTOR_PER_SIDE,
    WALL,
    V,
    X,
)

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


@compiled
def distance(a, b):
    """Greatest difference of two vectors."""
    worst = 0.0
    for n in range(N_VECTOR):
        worst = max(worst, abs(a[n] - b[n])) if isfinite(a[n] - b[n]) else inf
    return worst
