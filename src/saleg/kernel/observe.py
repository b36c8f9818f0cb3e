"""One row of the history: everything that can be seen at an instant."""

from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    ELECTRICAL_ENERGY,
    HEAT_LOST,
    HEAT_RELEASED,
    IGNITION,
    LEFT,
    MOTORED,
    N_STATE,
    OPEN,
    RIGHT,
    THETA,
    V,
    X,
)
from saleg.kernel.rhs import gas_of, height_of
from saleg.kernel.slots import alternator_force, friction_force, springs_force
from saleg.laws.arguments import Motion


@inline
def motored_pressure(E, C, side, y, motored):
    """Motored pressure [Pa]; the actual one where it is not integrated."""
    c = C[side]
    if c.mode == OPEN:
        return c.intake_pressure
    theta = y[THETA + side]
    return gas_of(E, C, side, y[X], theta, y[MOTORED + side] if motored else theta).p_motored


@compiled
def observe(P, E, C, y, dy, motored, row):
    """Fill a row of the history from the state `y` and its rates `dy`."""
    motion = Motion(E.t, y[X], y[V], E.direction)
    row.t, row.x, row.v, row.a = E.t, y[X], y[V], dy[V]
    row.p_left, row.T_left = pressure_and_temperature(C, LEFT, y)
    row.p_right, row.T_right = pressure_and_temperature(C, RIGHT, y)
    row.V_left = C[LEFT].area * height_of(C, LEFT, y[X])
    row.V_right = C[RIGHT].area * height_of(C, RIGHT, y[X])
    row.p_motored_left = motored_pressure(E, C, LEFT, y, motored)
    row.p_motored_right = motored_pressure(E, C, RIGHT, y, motored)
    row.heat_release_left = dy[N_STATE + HEAT_RELEASED + LEFT]
    row.heat_release_right = dy[N_STATE + HEAT_RELEASED + RIGHT]
    row.heat_loss_left = dy[N_STATE + HEAT_LOST + LEFT]
    row.heat_loss_right = dy[N_STATE + HEAT_LOST + RIGHT]
    row.ignition_left = y[IGNITION + LEFT]
    row.ignition_right = y[IGNITION + RIGHT]
    row.mode_left = C[LEFT].mode
    row.mode_right = C[RIGHT].mode
    row.spring_force = springs_force(P, motion)
    row.friction_force = friction_force(P, E.friction_held, motion)
    row.alternator_force = alternator_force(P, E.load_weight, motion)
    row.electrical_power = dy[N_STATE + ELECTRICAL_ENERGY]
    row.load_weight = E.load_weight
