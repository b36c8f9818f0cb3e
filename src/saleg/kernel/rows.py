"""Rows of strokes and events, as a run leaves them."""

from saleg.kernel.breathing import breathes, follows, injects
from saleg.kernel.charges import burnt_mass, internal_energy
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    ALTERNATOR_IMPULSE,
    ALTERNATOR_WORK,
    BURNING,
    CRANKCASE_WORK,
    CURRENT,
    ELECTRICAL_ENERGY,
    ELECTRICAL_SQUARED,
    ENTHALPY_OUT,
    EXPELLED,
    EXPELLED_FRESH,
    EXPELLED_FUEL,
    FRAME_V,
    FRAME_X,
    FRICTION_WORK,
    GAS_WORK,
    HEAT_LOST,
    HEAT_RELEASED,
    MOUNT_LOSS,
    N_STATE,
    PEAK_ACCELERATION,
    PEAK_PRESSURE,
    PEAK_PRESSURE_RISE,
    PEAK_TEMPERATURE,
    PEAK_VELOCITY,
    PORT_WORK,
    SPEED_SQUARED,
    SUPPLIED,
    SUPPLIED_FUEL,
    V,
    X,
)
from saleg.kernel.needs import CONTENTS_ARE_WANTED, FRAME_IS_WANTED, INJECTION_IS_WANTED
from saleg.kernel.slots import frame_energy, springs_energy
from saleg.laws.arguments import Motion


@inline
def has_room(O, tables):
    """Whether one more step can be recorded."""
    filled = tables.filled[0]
    return (
        tables.strokes.shape[0] - filled.strokes >= 1
        and (O.events == 0 or tables.events.shape[0] - filled.events >= 12)
        and (O.history == 0 or tables.history.shape[0] - filled.history >= 2 + O.dense)
    )


@compiled
def record_event(E, C, O, y, kind, side, tables):
    """Append a row to the event table."""
    if not O.events:
        return
    filled = tables.filled[0]
    row = tables.events[filled.events]
    filled.events += 1
    row.t = E.t
    row.kind = kind
    row.side = side
    row.x = y[X]
    row.v = y[V]
    p, T = pressure_and_temperature(C, side, y)
    row.p = p
    row.T = T


@compiled
def write_stroke(P, E, C, y, peaks, row):
    """Fill the row of the stroke that ends here."""
    row.t = E.t
    row.duration = E.t - E.t_dead_centre
    row.x_start, row.x_end = E.x_dead_centre, y[X]
    row.direction = E.direction
    row.load_weight, row.friction_held = E.load_weight, E.friction_held
    row.motoring, row.motor_amplitude = E.motoring, E.motor_amplitude
    row.motor_frequency = E.motor_frequency + E.motor_sweep * (E.t - E.t_command)
    row.equivalence_ratio, row.intake_temperature = E.equivalence_ratio, E.intake_temperature
    row.alternator_work = y[N_STATE + ALTERNATOR_WORK]
    row.electrical_energy = y[N_STATE + ELECTRICAL_ENERGY]
    row.electrical_squared = y[N_STATE + ELECTRICAL_SQUARED]
    row.alternator_impulse = y[N_STATE + ALTERNATOR_IMPULSE]
    row.friction_work = y[N_STATE + FRICTION_WORK]
    row.speed_squared = y[N_STATE + SPEED_SQUARED]
    row.peak_acceleration = peaks[PEAK_ACCELERATION]
    row.peak_velocity = peaks[PEAK_VELOCITY]
    row.spring_energy = springs_energy(P, Motion(E.t, y[X], y[V], E.direction, y[CURRENT]))
    row.spring_energy -= E.back_force * y[X]
    if FRAME_IS_WANTED:
        v = y[FRAME_V]
        row.frame_energy = frame_energy(P, y[FRAME_X], v) + 0.5 * E.mass * v * v
        row.mount_loss = y[MOUNT_LOSS]
    for side in range(2):
        c = C[side]
        row.heat_released[side] = y[N_STATE + HEAT_RELEASED + side]
        row.heat_lost[side] = y[N_STATE + HEAT_LOST + side]
        row.gas_work[side] = y[N_STATE + GAS_WORK + side]
        row.port_work[side] = y[N_STATE + PORT_WORK + side]
        row.peak_pressure[side] = peaks[PEAK_PRESSURE + side]
        row.peak_temperature[side] = peaks[PEAK_TEMPERATURE + side]
        row.peak_pressure_rise[side] = peaks[PEAK_PRESSURE_RISE + side]
        row.fresh_fuel_energy[side] = c.fresh_fuel_energy
        row.exhaust_energy[side] = c.exhaust_energy
        row.exhaust_fuel_energy[side] = c.exhaust_fuel_energy
        row.ignition_time[side] = c.ignition_time
        row.ignition_height[side] = c.ignition_height
        row.combustion_duration[side] = c.duration if c.ignition_time >= 0.0 else 0.0
        row.charge_mass[side] = c.mass
        row.internal_energy[side] = internal_energy(P, C, side, y)
        burning = c.mode == BURNING and not breathes(C, side)
        burnt = burnt_mass(P, C, side, E.t) if burning else 0.0
        row.fuel_energy[side] = (c.fuel - burnt) * c.lower_heating_value
        row.wall_temperature[side] = c.wall_temperature
        if CONTENTS_ARE_WANTED:
            write_passed(C, side, y, row)


@inline
def write_passed(C, side, y, row):
    """Write what has passed through a chamber that breathes into the row of a stroke."""
    c = C[side]
    if not breathes(C, side):
        return
    row.fresh_fuel_energy[side] += y[SUPPLIED_FUEL + side] * c.lower_heating_value
    row.exhaust_fuel_energy[side] += y[EXPELLED_FUEL + side] * c.lower_heating_value
    row.exhaust_energy[side] += y[ENTHALPY_OUT + side]
    row.fresh_mass[side] = c.fresh
    row.closing_mass[side] = c.p_closing * c.V_closing / (c.gas_constant * c.T_closing)
    row.closing_temperature[side] = c.T_closing
    if INJECTION_IS_WANTED and injects(C, side):
        row.closing_mass[side] = c.trapped_mass
        row.closing_temperature[side] = c.trapped_temperature
    if follows(C, side):  # nothing leaks out of it
        row.closing_mass[side] = c.mass
    row.supplied_mass[side] = y[SUPPLIED + side]
    row.expelled_mass[side] = y[EXPELLED + side]
    row.expelled_fresh[side] = y[EXPELLED_FRESH + side]
    row.crankcase_work[side] = y[CRANKCASE_WORK + side]


@inline
def supplied_energy(C, side, y):
    """Lower heating value of the fuel that has flowed into a chamber in this stroke [J]."""
    return y[SUPPLIED_FUEL + side] * C[side].lower_heating_value
