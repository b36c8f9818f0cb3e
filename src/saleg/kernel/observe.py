"""One row of the history: everything that can be seen at an instant."""

from saleg.kernel.breathing import breathes, has_own_pressure, mass_of, wall_of
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    BURNT,
    CURRENT,
    ELECTRICAL_ENERGY,
    FRAME_V,
    FRAME_X,
    HEAT_LOST,
    HEAT_RELEASED,
    IGNITION,
    N_STATE,
    OPEN,
    V,
    X,
)
from saleg.kernel.needs import FRAME_IS_WANTED
from saleg.kernel.peaks import pressure_rate
from saleg.kernel.rhs import alternator_action, gas_of
from saleg.kernel.slots import frame_transmitted, friction_force, springs_force
from saleg.kernel.state import clearance_of
from saleg.laws.arguments import Motion


@inline
def motored_pressure(E, C, side, y, motored):
    """Motored pressure [Pa]; the actual one where it is not integrated."""
    c = C[side]
    if c.mode == OPEN:
        return gas_of(E, C, side, y, False).p if has_own_pressure(C, side) else c.intake_pressure
    return gas_of(E, C, side, y, motored).p_motored


@compiled
def observe(P, E, C, y, dy, motored, row):
    """Fill a row of the history from the state `y` and its rates `dy`."""
    motion = Motion(E.t, y[X], y[V], E.direction, y[CURRENT])
    row.t, row.x, row.v, row.a = E.t, y[X], y[V], dy[V]
    for side in range(2):
        p, T = pressure_and_temperature(C, side, y)
        row.p[side] = p
        row.T[side] = T
        row.V[side] = C[side].area * clearance_of(C, side, y[X])
        row.p_rate[side] = p * pressure_rate(C, side, y, dy)
        row.p_motored[side] = motored_pressure(E, C, side, y, motored)
        row.heat_release[side] = dy[N_STATE + HEAT_RELEASED + side]
        row.heat_loss[side] = dy[N_STATE + HEAT_LOST + side]
        row.ignition[side] = y[IGNITION + side]
        row.mode[side] = C[side].mode
        row.mass[side] = mass_of(C, side, y)
        row.burnt[side] = y[BURNT + side] if breathes(C, side) else C[side].burnt
        row.wall_temperature[side] = wall_of(C, side, y)
    row.spring_force = springs_force(P, motion) + E.back_force
    row.friction_force = friction_force(P, E.friction_held, motion)
    row.alternator_force, _ = alternator_action(P, E, E.t, motion)
    row.electrical_power = dy[N_STATE + ELECTRICAL_ENERGY]
    row.load_weight = E.load_weight
    row.current = y[CURRENT]
    acceleration = dy[V]
    if FRAME_IS_WANTED:
        acceleration += dy[FRAME_V]
        row.frame_x, row.frame_v = y[FRAME_X], y[FRAME_V]
    force = -E.mass * acceleration
    row.shaking_force = frame_transmitted(P, force, row.frame_x, row.frame_v)
