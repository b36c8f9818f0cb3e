"""Changes at an event: modes switch, charges are composed, regulators act."""

from math import inf, isfinite, log

from saleg.kernel.breathing import (
    breathes,
    by_flow,
    crankcase_of,
    energy_of,
    enthalpy_of_fuel,
    follows,
    gamma_of,
    has_crankcase,
    has_own_pressure,
    injects,
    mass_gas_of,
    mass_of,
    take_contents,
    weighted,
)
from saleg.kernel.control import ask, obey, pressure_at_midpoint
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    AIR,
    ALTERNATOR_IMPULSE,
    ALTERNATOR_WORK,
    ARMED,
    BURNING,
    BURNT,
    CLOSED,
    COMPILED,
    CORNER,
    CRANKCASE_MASS,
    CRANKCASE_WORK,
    CURRENT,
    DEAD_CENTRE,
    DISARMED,
    ELECTRICAL_ENERGY,
    ELECTRICAL_SQUARED,
    ENTHALPY_OUT,
    EVENT_CHARGE_RENEWAL,
    EVENT_DEAD_CENTRE,
    EVENT_END_OF_COMBUSTION,
    EVENT_HEAD_CONTACT,
    EVENT_IGNITION,
    EVENT_INJECTION,
    EVENT_MISFIRE,
    EVENT_MOTOR_OFF,
    EVENT_MOTOR_ON,
    EVENT_PORT_CLOSING,
    EVENT_PORT_OPENING,
    EXPELLED,
    EXPELLED_FRESH,
    EXPELLED_FUEL,
    FAILING,
    FRAME_V,
    FRAME_X,
    FRESH,
    FRICTION_WORK,
    FUEL,
    G0,
    GAS_WORK,
    HEAD,
    HEAT_LOST,
    HEAT_RELEASED,
    IGNITION,
    LATE,
    LEFT,
    MOTORED,
    MOUNT_LOSS,
    N_STATE,
    OPEN,
    PEAK_ACCELERATION,
    PEAK_PRESSURE,
    PEAK_PRESSURE_RISE,
    PEAK_TEMPERATURE,
    PEAK_VELOCITY,
    PORT_WORK,
    RIGHT,
    SPEED_SQUARED,
    SUPPLIED,
    SUPPLIED_FUEL,
    THETA,
    UNCONTROLLED,
    V,
    X,
)
from saleg.kernel.needs import CONTENTS_ARE_WANTED, FRAME_IS_WANTED, INJECTION_IS_WANTED
from saleg.kernel.rhs import AT_BREAKPOINT, charge_of, gas_of, refresh
from saleg.kernel.slots import (
    alternator_at_dead_centre,
    completeness_share,
    frame_energy,
    friction_at_dead_centre,
    gas_exchange_charge,
    gas_properties_internal_energy,
    heat_release_burnt_fraction,
    heat_release_duration,
    ignition_lights_at_dead_centre,
    misfires_happens,
    scatter_delay_factor,
    scatter_duration_factor,
    scatter_fuel_factor,
    springs_energy,
)
from saleg.kernel.state import begin_stroke, clearance_of
from saleg.laws.arguments import Motion, Parts, Stroke
from saleg.laws.choice import where

# Longest first step of a combustion, over its duration.
FIRST_OF_BURN = 0.1
# Rounds in which the mass of a charge whose gas depends on its composition is found to rounding.
MASS_ITERATIONS = 12


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


@inline
def burnt_mass(P, C, side, t):
    """Fuel burnt since the start of combustion [kg]."""
    c = C[side]
    u = min(max((t - c.t_ignition) / c.duration, 0.0), 1.0) if c.duration > 0.0 else 1.0
    return c.fuel_to_burn * heat_release_burnt_fraction(P, side, u)


@compiled
def internal_energy(P, C, side, y):
    """Internal energy of the charge [J]; while the ports are open that of the fresh one."""
    c = C[side]
    T = c.T_closing
    if has_own_pressure(C, side):
        _, T = pressure_and_temperature(C, side, y)
    energy = energy_of(P, C, side, y, T)
    if has_crankcase(y, side):
        T = crankcase_of(P, C, side, y).T
        energy += y[CRANKCASE_MASS + side] * gas_properties_internal_energy(P, side, T)
    return energy


@compiled
def ignite(P, E, C, side, y, motored):
    """Start of combustion: the charge burns as far as fuel and air allow (Eq. 53)."""
    c = C[side]
    gas = gas_of(E, C, side, y, motored)
    charge = charge_of(E, C, side, y)
    c.duration = heat_release_duration(P, side, gas, charge)
    c.duration *= scatter_duration_factor(P, c.charge_number, 1.0 * side)
    c.mode = BURNING
    c.armed = DISARMED
    c.t_ignition = E.t
    c.t_end = E.t + c.duration
    if c.duration > 0.0:
        E.next_step = min(E.next_step, FIRST_OF_BURN * c.duration)
    share = c.combustion_efficiency * completeness_share(P, side, gas, charge)
    c.fuel_to_burn = share * min(c.fuel, c.air / c.air_fuel_ratio)
    c.mass_lit = mass_of(C, side, y)
    c.ignition_time = E.t
    c.ignition_height = gas.clearance
    if c.duration <= 0.0:
        burn_at_once(P, E, C, side, y, gas.T)
        c.mode = CLOSED


@compiled
def burn_at_once(P, E, C, side, y, T):
    """Release all heat at constant volume: internal energy and temperature (by Newton) jump."""
    c = C[side]
    heat = c.fuel_to_burn * c.lower_heating_value * heat_release_burnt_fraction(P, side, 1.0)
    wanted, cold = energy_of(P, C, side, y, T) + heat, mass_gas_of(C, side, y) * T
    burn_contents(P, E, C, side)
    put_contents(C, side, y)
    y[THETA + side] += log(mass_gas_with(P, C, side, y, wanted, T) / cold)
    y[N_STATE + HEAT_RELEASED + side] += heat


@inline
def mass_gas_with(P, C, side, y, energy, T):
    """Mass times gas constant and temperature [J] with an internal energy; near T [K] at first."""
    hot, mass_gas = T, mass_gas_of(C, side, y)
    for _ in range(50):
        excess = energy_of(P, C, side, y, hot) - energy
        change = excess * (gamma_of(P, C, side, y, hot) - 1.0) / mass_gas
        hot -= change
        if abs(change) <= 1e-15 * hot:
            break
    return hot * mass_gas


@inline
def burn_contents(P, E, C, side):
    """Turn the fuel burnt, and its air, into burnt gas."""
    c = C[side]
    fuel = burnt_mass(P, C, side, E.t)
    c.fuel -= fuel
    c.air -= c.air_fuel_ratio * fuel
    c.burnt += (1.0 + c.air_fuel_ratio) * fuel


@compiled
def end_combustion(P, E, C, side):
    """End a combustion; the masses of a chamber that breathes have followed it all along."""
    if not breathes(C, side):
        burn_contents(P, E, C, side)
    C[side].mode = CLOSED


@inline
def put_contents(C, side, y):
    """Bring the state up to date with what the record says of a chamber."""
    if breathes(C, side):
        c = C[side]
        y[FUEL + side], y[AIR + side], y[BURNT + side] = c.fuel, c.air, c.burnt


@compiled
def open_ports(P, E, C, side, y):
    """Blow down: pressure and temperature become those of the intake."""
    if C[side].mode == BURNING:
        end_combustion(P, E, C, side)
    c = C[side]
    if by_flow(C, side):
        c.fuel_factor = scatter_fuel_factor(P, c.charge_number + 1.0, 1.0 * side)
        c.mode = OPEN
        c.armed = DISARMED
        c.injection_due = 0.0
        y[IGNITION + side] = 0.0
        y[FRESH + side] = 0.0
        return
    before = internal_energy(P, C, side, y)
    c.mode = OPEN
    c.armed = DISARMED
    c.injection_due = 0.0
    c.T_closing = c.intake_temperature
    y[IGNITION + side] = 0.0
    c.exhaust_energy += before - internal_energy(P, C, side, y)


@compiled
def close_ports(P, E, C, side, y):
    """Compose the fresh charge and begin to compress it."""
    if by_flow(C, side):
        trap_charge(P, E, C, side, y)
        return
    before = internal_energy(P, C, side, y)
    c = C[side]
    compose_charge(P, E, C, side, y, c.intake_pressure, c.intake_temperature)
    c.exhaust_energy += before - internal_energy(P, C, side, y)


@compiled
def fill_chamber(P, C, side, y):
    """Bring a bounce chamber to the pressure commanded, by gas of its own temperature."""
    c = C[side]
    before = internal_energy(P, C, side, y)
    ratio = c.wanted_pressure / pressure_at_midpoint(c)
    y[THETA + side] += log(ratio)
    y[MOTORED + side] += log(ratio)
    c.mass, c.fuel, c.air, c.burnt = ratio * c.mass, ratio * c.fuel, ratio * c.air, ratio * c.burnt
    put_contents(C, side, y)
    c.renewal_due = 0.0
    c.exhaust_energy += before - internal_energy(P, C, side, y)


@compiled
def renew_charge(P, E, C, side, y):
    """Reject heat at bottom dead centre, down to the curve through the midpoint state (2.3)."""
    if C[side].mode == BURNING:
        end_combustion(P, E, C, side)
    before = internal_energy(P, C, side, y)
    c = C[side]
    volume_ratio = c.half_stroke / clearance_of(C, side, y[X])
    p = c.intake_pressure * volume_ratio**c.curve_exponent
    T = c.intake_temperature * volume_ratio ** (c.curve_exponent - 1.0)
    compose_charge(P, E, C, side, y, p, T)
    c.renewal_due = 0.0
    c.exhaust_energy += before - internal_energy(P, C, side, y)


@compiled
def compose_charge(P, E, C, side, y, p, T):
    """Compose a fresh charge at a pressure and a temperature from the contents of the chamber."""
    c = C[side]
    clearance = clearance_of(C, side, y[X])
    volume = c.area * clearance
    mass = p * volume / (c.gas_constant * T)
    wanted = c.equivalence_ratio_wanted
    wanted *= scatter_fuel_factor(P, c.charge_number + 1.0, 1.0 * side)
    if INJECTION_IS_WANTED and injects(C, side):
        wanted = 0.0
    fuel, air, burnt, fresh = metered(P, C, side, mass, wanted)
    if follows(C, side):  # what a volume holds depends on what it is
        for _ in range(MASS_ITERATIONS):
            mass *= p * volume / (T * weighted(C, side, Parts(fuel, air, burnt)))
            fuel, air, burnt, fresh = metered(P, C, side, mass, wanted)
    c.fresh_fuel_energy += fresh * c.lower_heating_value
    c.exhaust_fuel_energy += (c.fuel + fresh - fuel) * c.lower_heating_value
    c.mass, c.fuel, c.air, c.burnt = mass, fuel, air, burnt
    close_charge(P, E, C, side, y, p, T, volume)
    put_contents(C, side, y)
    y[THETA + side] = log(p) + G0 * log(clearance / c.half_stroke)
    y[MOTORED + side] = y[THETA + side]


@inline
def metered(P, C, side, mass, wanted):
    """Charge of a mass from what a chamber holds: fuel, air, burnt gas, fresh fuel [kg]."""
    c = C[side]
    return gas_exchange_charge(P, side, mass, c.fuel, c.air, c.burnt, wanted, c.air_fuel_ratio)


@inline
def trap_charge(P, E, C, side, y):
    """Close the ports on what has flowed in and what is left."""
    c = C[side]
    p, T = pressure_and_temperature(C, side, y)
    c.fresh = y[FRESH + side]
    close_charge(P, E, C, side, y, p, T, c.area * clearance_of(C, side, y[X]))
    y[MOTORED + side] = y[THETA + side]


@inline
def close_charge(P, E, C, side, y, p, T, volume):
    """Take a charge for the one now trapped at a pressure, a temperature and a volume."""
    c = C[side]
    c.mode = CLOSED
    c.spark_advance = c.next_spark_advance
    c.charge_number += 1.0
    if INJECTION_IS_WANTED and injects(C, side):
        note_charge(E, C, side, p, T, volume)
        c.trapped_mass, c.trapped_temperature = p * volume / (c.gas_constant * T), T
        c.injection_due, c.armed, y[IGNITION + side] = 1.0, DISARMED, 0.0
    else:
        arm_charge(P, E, C, side, y, p, T, volume)


@compiled
def inject(P, E, C, side, y):
    """Inject the fuel that the air in a chamber is to have: it evaporates and mixes at once."""
    c = C[side]
    _, T = pressure_and_temperature(C, side, y)
    wanted, cold = energy_of(P, C, side, y, T), mass_gas_of(C, side, y) * T
    ratio = c.equivalence_ratio_wanted * scatter_fuel_factor(P, c.charge_number, 1.0 * side)
    fuel = max(ratio * c.air / c.air_fuel_ratio - c.fuel, 0.0)
    brought = enthalpy_of_fuel(P, C, side, fuel)
    c.injection_due = 0.0
    c.fuel += fuel
    c.mass += fuel
    put_contents(C, side, y)
    y[THETA + side] += log(mass_gas_with(P, C, side, y, wanted + brought, T) / cold)
    y[MOTORED + side] = y[THETA + side]
    c.fresh_fuel_energy += fuel * c.lower_heating_value
    c.exhaust_energy -= brought
    p, T = pressure_and_temperature(C, side, y)
    arm_charge(P, E, C, side, y, p, T, c.area * clearance_of(C, side, y[X]))


@inline
def note_charge(E, C, side, p, T, volume):
    """Note the state a charge has as its ports close, or as its fuel is injected."""
    c = C[side]
    c.equivalence_ratio = c.fuel * c.air_fuel_ratio / max(c.air, 1e-300)
    c.p_closing, c.T_closing, c.V_closing = p, T, volume
    c.time_to_dead_centre = E.t_dead_centre + last_duration(E) - E.t


@inline
def arm_charge(P, E, C, side, y, p, T, volume):
    """Let a charge light from now on."""
    note_charge(E, C, side, p, T, volume)
    c = C[side]
    c.armed = ARMED if c.fuel > 0.0 else DISARMED
    if c.armed == ARMED and misfires_happens(P, side, c.charge_number) > 0.0:
        c.armed = FAILING
    y[IGNITION + side] = 1.0 - scatter_delay_factor(P, c.charge_number, 1.0 * side)


@inline
def last_duration(E):
    """Duration of the stroke before the present one [s]; infinite if there was none."""
    return E.stroke / E.mean_piston_speed if E.mean_piston_speed > 0.0 else inf


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


@compiled
def regulate(P, E, C, y):
    """Hand the finished stroke to the laws that act at a dead centre."""
    fuel = C[LEFT].fresh_fuel_energy + C[RIGHT].fresh_fuel_energy
    if CONTENTS_ARE_WANTED:
        fuel += supplied_energy(C, LEFT, y) + supplied_energy(C, RIGHT, y)
    squared = y[N_STATE + SPEED_SQUARED]
    length = abs(y[X] - E.x_dead_centre)
    duration = E.t - E.t_dead_centre
    stroke = Stroke(
        length=length,
        duration=duration,
        maximum=E.maximum_stroke,
        half_maximum=0.5 * E.maximum_stroke,
        piston_area=0.5 * (C[LEFT].area + C[RIGHT].area),
        fuel_energy=fuel + E.last_fuel_energy,
        speed_squared=squared + E.last_speed_squared,
        x_left=min(y[X], E.x_dead_centre),
        x_right=max(y[X], E.x_dead_centre),
    )
    E.last_fuel_energy = fuel
    E.last_speed_squared = squared
    E.stroke = length
    E.mean_piston_speed = length / duration
    E.stroke_duration = duration
    E.power = y[N_STATE + ELECTRICAL_ENERGY] / duration
    E.regulated_weight = alternator_at_dead_centre(P, E.load_weight, stroke)
    if E.controlled == UNCONTROLLED:
        E.load_weight = E.regulated_weight
    E.friction_held = friction_at_dead_centre(P, E.friction_held, stroke)


@inline
def misfires(E, C, side):
    """Whether a chamber that begins to expand holds a charge that should have lit."""
    c = C[side]
    due = (c.armed == ARMED) | (c.armed == FAILING)
    return due & (c.mode == CLOSED) & (c.sign * E.direction > 0.0)


@inline
def ports_due(E, C, side, y):
    """Whether a chamber stands at its ports, about to pass them."""
    c = C[side]
    beyond = clearance_of(C, side, y[X]) - c.port
    slack = 1e-14 * E.length_scale
    outward = c.sign * E.direction
    opens, closes = (outward > 0.0) & (beyond >= -slack), (outward < 0.0) & (beyond <= slack)
    return where(c.mode == OPEN, closes, opens)


@inline
def is_due(E, C, side, t, y):
    """Whether any change of a chamber is due, or a breakpoint of its burn rate is reached."""
    c = C[side]
    breaks = (c.mode == BURNING) & (t >= c.t_breakpoint)
    changes = (c.renewal_due > 0.0) | misfires(E, C, side) | ports_due(E, C, side, y)
    lights = (c.mode == CLOSED) & (c.armed > DISARMED) & (y[IGNITION + side] >= 1.0)
    if INJECTION_IS_WANTED:
        changes = changes | injection_is_due(E, C, side, y)
    return breaks | changes | lights


@inline
def injection_is_due(E, C, side, y):
    """Whether a piston on its way in stands where fuel is to be injected."""
    c = C[side]
    inward = c.sign * E.direction < 0.0
    beyond = clearance_of(C, side, y[X]) - c.injection_place
    reached = beyond <= AT_BREAKPOINT * E.length_scale
    return (c.injection_due > 0.0) & (c.mode == CLOSED) & inward & reached


@compiled
def change_due(P, E, C, side, y):
    """Kind of the event that is due in a chamber now; -1 if none is."""
    c = C[side]
    if c.mode == BURNING and E.t >= c.t_end:
        return EVENT_END_OF_COMBUSTION
    if c.renewal_due > 0.0:
        return EVENT_CHARGE_RENEWAL
    if misfires(E, C, side):
        lit = c.armed == ARMED
        if lit and ignition_lights_at_dead_centre(P, side, charge_of(E, C, side, y)) > 0.0:
            return EVENT_IGNITION
        return EVENT_MISFIRE
    if INJECTION_IS_WANTED and injection_is_due(E, C, side, y):
        return EVENT_INJECTION
    if c.mode == CLOSED and c.armed > DISARMED and y[IGNITION + side] >= 1.0:
        return EVENT_IGNITION
    if ports_due(E, C, side, y):
        return EVENT_PORT_CLOSING if c.mode == OPEN else EVENT_PORT_OPENING
    return -1


@compiled
def change_mode(P, E, C, O, side, y, kind):
    """Carry out the change of a chamber that is due."""
    if kind == EVENT_END_OF_COMBUSTION:
        end_combustion(P, E, C, side)
    elif kind == EVENT_MISFIRE:
        c = C[side]
        c.armed = LATE if c.armed == ARMED and c.late_ignition > 0.0 else DISARMED
        if c.armed == DISARMED:
            y[IGNITION + side] = 0.0
    elif kind == EVENT_IGNITION:
        ignite(P, E, C, side, y, O.motored)
    elif INJECTION_IS_WANTED and kind == EVENT_INJECTION:
        inject(P, E, C, side, y)
    elif kind == EVENT_CHARGE_RENEWAL and C[side].curve_exponent > 0.0:
        renew_charge(P, E, C, side, y)
    elif kind == EVENT_CHARGE_RENEWAL:
        fill_chamber(P, C, side, y)
    elif kind == EVENT_PORT_CLOSING:
        close_ports(P, E, C, side, y)
    else:
        open_ports(P, E, C, side, y)


@compiled
def turn(P, E, C, y, peaks, tables, control):
    """Dead centre: write the row of the stroke, let the regulators act, reverse the direction."""
    if isfinite(E.x_dead_centre) and E.t > E.t_dead_centre:
        filled = tables.filled[0]
        write_stroke(P, E, C, y, peaks, tables.strokes[filled.strokes])
        filled.strokes += 1
        regulate(P, E, C, y)
        E.strokes += 1.0
        E.steps_at_dead_centre = E.steps
    elif isfinite(E.x_dead_centre):
        E.strokes += 1.0
        E.stroke = 0.0  # two dead centres at one instant: the motion has died away
    E.direction = -E.direction
    begin_stroke(E, C, y, peaks)
    for side in range(2):
        c = C[side]
        c.renewal_due = 1.0 if c.curve_exponent > 0.0 > c.sign * E.direction else 0.0
    if E.controlled == COMPILED:
        obey(P, E, C, ask(E, C, y, control), E.t - E.t_command)


@compiled
def change_chambers(P, E, C, O, y, tables):
    """Carry out all changes of the chambers that are due; returns whether there were any.

    Every change takes away its own cause, so this ends; the bound is a safeguard.
    """
    changed = False
    for _ in range(12):
        quiet = True
        for side in range(2):
            kind = change_due(P, E, C, side, y)
            if kind >= 0:
                take_contents(C, y)
                record_event(E, C, O, y, kind, side, tables)
                change_mode(P, E, C, O, side, y, kind)
                quiet = False
                changed = True
        if quiet:
            break
    return changed


@compiled
def switch(P, E, C, O, y, landed, peaks, tables, control):
    """Do what is due at the present instant; returns whether anything was.

    Chambers change first, one after the other, then the translator turns. What is due in a chamber
    because it has turned belongs to the stroke that begins and waits for the next call.
    """
    if landed >= 0:
        take_contents(C, y)
    changed = change_chambers(P, E, C, O, y, tables) or landed == CORNER
    for side in range(2):
        if C[side].mode == BURNING and E.t >= C[side].t_breakpoint:
            changed = True
    was_motoring = E.motoring
    if landed == DEAD_CENTRE:
        turn(P, E, C, y, peaks, tables, control)
        side = LEFT if E.direction > 0.0 else RIGHT
        record_event(E, C, O, y, kind_of_turn(landed), side, tables)
        changed = True
    if E.motoring != was_motoring:
        kind = EVENT_MOTOR_ON if E.motoring > 0.0 else EVENT_MOTOR_OFF
        side = LEFT if E.direction > 0.0 else RIGHT
        record_event(E, C, O, y, kind, side, tables)
    if landed >= HEAD:
        record_event(E, C, O, y, kind_of_turn(landed), landed % 2, tables)
    if changed:
        refresh(P, E, C, y)
    return changed


@inline
def kind_of_turn(landed):
    """Kind of the event at which the translator itself was stopped."""
    return EVENT_HEAD_CONTACT if landed >= HEAD else EVENT_DEAD_CENTRE
