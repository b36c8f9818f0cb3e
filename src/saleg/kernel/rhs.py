"""Right-hand side: the translator (Eq. 36) and the gas in its two chambers (Eq. 48).

Arguments shared by all functions here: `P` the laws, `E` the engine's record, `C` the two
chambers' records (see :mod:`saleg.kernel.layout`), `side` 0 for left and 1 for right.
"""

from math import exp, inf, log, pi, sin
from typing import NamedTuple

from saleg.kernel.breathing import (
    Flows,
    breathes,
    by_flow,
    chamber_flows,
    crankcase_force,
    follows,
    gamma_of,
    has_own_pressure,
    mass_gas_of,
    mass_of,
    no_flows,
    rate_by_composition,
    wall_of,
    write_contents,
)
from saleg.kernel.copies import motored_gas, with_pressure_rate
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    AIR,
    ALTERNATOR_IMPULSE,
    ALTERNATOR_WORK,
    BURNING,
    BURNT,
    CLOSED,
    CURRENT,
    DISARMED,
    ELECTRICAL_ENERGY,
    ELECTRICAL_SQUARED,
    FRAME_V,
    FRAME_X,
    FRICTION_WORK,
    FUEL,
    G0,
    GAS_WORK,
    HEAT_LOST,
    HEAT_RELEASED,
    IGNITION,
    LEFT,
    MOTORED,
    MOUNT_LOSS,
    N_STATE,
    OPEN,
    PORT_WORK,
    RIGHT,
    SPEED_SQUARED,
    THETA,
    V,
    X,
)
from saleg.kernel.logarithms import Logarithms
from saleg.kernel.needs import (
    COMPOSITION_IS_WANTED,
    CONTENTS_ARE_WANTED,
    CRANKCASE_IS_WANTED,
    CURRENT_IS_WANTED,
    FRAME_IS_WANTED,
    INJECTION_IS_WANTED,
    MOTORED_PRESSURE_IS_WANTED,
    MOTORING_IS_POSSIBLE,
    WALL_TEMPERATURE_IS_WANTED,
)
from saleg.kernel.slots import (
    actuators_motor_power,
    alternator_current_rate,
    alternator_electrical_power,
    alternator_force,
    alternator_next_breakpoint,
    converter_force,
    converter_power,
    frame_acceleration,
    frame_loss,
    friction_force,
    gas_exchange_next_breakpoint,
    gas_properties_breakpoint,
    heat_release_burn_rate,
    heat_release_next_breakpoint,
    heat_transfer_coefficient,
    heat_transfer_coefficient_constants,
    ignition_rate,
    ignition_rate_constants,
    springs_force,
    springs_next_breakpoint,
)
from saleg.kernel.state import clearance_of
from saleg.laws.arguments import Charge, Gas, Motion
from saleg.laws.choice import any_of, where

# How near a breakpoint counts as reached, over the half stroke or the duration of the combustion,
# and how far beside it is beyond it.
AT_BREAKPOINT = 1e-9
ONE_SIDE = 1e-15


@inline
def ln_clearance_of(C, side, x):
    """Natural logarithm of the clearance over that at the midpoint."""
    return log(clearance_of(C, side, x) * C[side].per_half_stroke)


@inline
def ln_mass_gas_of(C, side, y):
    """Natural logarithm of mass times gas constant [J/K]."""
    if breathes(C, side):
        return log(mass_gas_of(C, side, y))
    return C[side].ln_mass_gas


@inline
def per_mass_gas_of(C, side, y):
    """One over mass times gas constant [K/J]."""
    if breathes(C, side):
        return 1.0 / mass_gas_of(C, side, y)
    return C[side].per_mass_gas


@inline
def ln_temperature(C, side, y):
    """Natural logarithm of the temperature in a closed chamber [K]."""
    c = C[side]
    ln_clearance = ln_clearance_of(C, side, y[X])
    return y[THETA + side] + (1.0 - G0) * ln_clearance + c.ln_volume - ln_mass_gas_of(C, side, y)


@inline
def gas_at(E, C, side, y, x, v, p, p_motored):
    """Gas in a closed chamber with the contents and the wall of `y`, as the laws see it."""
    c = C[side]
    clearance = clearance_of(C, side, x)
    volume = c.area * clearance
    return Gas(
        p=p,
        T=p * volume * per_mass_gas_of(C, side, y),
        V=volume,
        p_motored=p_motored,
        clearance=clearance,
        bore=c.bore,
        mean_piston_speed=E.mean_piston_speed,
        wall_temperature=wall_of(C, side, y),
        burning=where(c.mode == BURNING, 1.0, 0.0),
        clearance_rate=c.sign * v,
        p_rate=0.0,
    )


@inline
def gas_of(E, C, side, y, motored):
    """Gas in a closed chamber from a state vector."""
    shift = G0 * ln_clearance_of(C, side, y[X])
    p = exp(y[THETA + side] - shift)
    p_motored = exp(y[MOTORED + side] - shift) if motored else p
    return gas_at(E, C, side, y, y[X], y[V], p, p_motored)


@inline
def logarithms_of(C, side, ln_clearance, ln_p, ln_mass_gas, constants):
    """Logarithms of the state of the gas, with the constants of a law."""
    ln_V = ln_clearance + C[side].ln_volume
    ln_T = ln_p + ln_V - ln_mass_gas
    return Logarithms(ln_p, ln_T, ln_V, constants[0], constants[1], constants[2])


@inline
def charge_of(E, C, side, y):
    """Charge since port closing, as the laws see it; in a chamber that breathes, what is left."""
    c = C[side]
    fuel, air, burnt = c.fuel, c.air, c.burnt
    if breathes(C, side):
        fuel, air, burnt = y[FUEL + side], y[AIR + side], y[BURNT + side]
    return Charge(
        mass=mass_of(C, side, y),
        fuel=fuel,
        air=air,
        burnt=burnt,
        equivalence_ratio=c.equivalence_ratio,
        p=c.p_closing,
        T=c.T_closing,
        V=c.V_closing,
        swept_volume=c.area * E.stroke,
        spark_advance=c.spark_advance,
        time_to_dead_centre=c.time_to_dead_centre,
    )


@inline
def heat_loss(P, C, side, gas, charge, logarithms):
    """Heat flow to the wall [W], Eq. 50."""
    surface = 2.0 * C[side].area + pi * gas.bore * gas.clearance
    coefficient = heat_transfer_coefficient(P, side, gas, charge, logarithms)
    return coefficient * surface * (gas.T - gas.wall_temperature)


@inline
def heat_release(P, C, side, t, y):
    """Heat released by combustion [W], Eq. 53; what leaks meanwhile takes its share along."""
    c = C[side]
    released, burning = 0.0, c.mode == BURNING
    if any_of(burning):
        u = min(max((t - c.t_ignition) / c.duration, c.first_phase), c.last_phase)
        energy = c.fuel_to_burn * c.lower_heating_value
        if breathes(C, side):
            energy *= mass_of(C, side, y) / c.mass_lit
        flow = energy / c.duration * heat_release_burn_rate(P, side, u)
        released = where(burning, flow, 0.0)
    return released


@inline
def theta_rate(g, gas, clearance_rate, heat):
    """Rate of theta [1/s]: Eq. 48, signs corrected."""
    per_pV = 1.0 / (gas.p * gas.V)  # before heat and g are known: a division takes its time
    growth = clearance_rate / gas.clearance
    return (G0 - g) * growth + (g - 1.0) * (heat * per_pV)


class ChamberRates(NamedTuple):
    """Pressure in a chamber [Pa] and what else of it the right-hand side needs.

    Attributes
    ----------
    p : float
        Pressure [Pa].
    theta, ignition, motored : float
        Rates of theta, of the ignition integral and of theta of the motored pressure [1/s].
    released, lost : float
        Heat released by combustion and lost to the wall [W].
    flows : Flows
        Gas that flows in and out.
    """

    p: float
    theta: float
    ignition: float
    motored: float
    released: float
    lost: float
    flows: Flows


@inline
def chamber_rates(P, E, C, side, t, y, motored):
    """Pressure, rates and heat flows of one chamber."""
    c = C[side]
    p, own = c.intake_pressure, has_own_pressure(C, side)
    rate, ignition, motored_rate, released, lost = 0.0, 0.0, 0.0, 0.0, 0.0
    flows = no_flows(C, side)
    if any_of(own):
        clearance_rate = c.sign * y[V]
        ln_clearance = ln_clearance_of(C, side, y[X])
        ln_p = y[THETA + side] - G0 * ln_clearance
        p_own = p_motored = exp(ln_p)
        if MOTORED_PRESSURE_IS_WANTED and motored:
            ln_p_motored = y[MOTORED + side] - G0 * ln_clearance
            p_motored = where(c.mode == OPEN, p_own, exp(ln_p_motored))
        gas = gas_at(E, C, side, y, y[X], y[V], p_own, p_motored)
        charge = charge_of(E, C, side, y)
        heat_released = heat_release(P, C, side, t, y)
        heat_constants = (c.heat_first, c.heat_second, c.heat_third)
        if CONTENTS_ARE_WANTED or WALL_TEMPERATURE_IS_WANTED:  # charge and wall change all the time
            heat_constants = heat_transfer_coefficient_constants(P, side, gas, charge)
        ln_mass_gas = ln_mass_gas_of(C, side, y)
        logarithms = logarithms_of(C, side, ln_clearance, ln_p, ln_mass_gas, heat_constants)
        heat_lost = heat_loss(P, C, side, gas, charge, logarithms)
        g = gamma_of(P, C, side, y, gas.T)
        rate_own = theta_rate(g, gas, clearance_rate, heat_released - heat_lost)
        if COMPOSITION_IS_WANTED and follows(C, side) and heat_released > 0.0:
            rate_own += rate_by_composition(P, C, side, y, gas, g, heat_released)
        if CONTENTS_ARE_WANTED and breathes(C, side):
            flows = chamber_flows(P, C, side, y, gas)
            rate_own += flows.ln_p
        lights = (c.armed > DISARMED) & (c.mode == CLOSED)
        if any_of(lights):
            relative_rate = rate_own - G0 * clearance_rate / gas.clearance
            rising = with_pressure_rate(gas, gas.p * relative_rate)
            constants = (c.ignition_first, c.ignition_second, c.ignition_third)
            if CONTENTS_ARE_WANTED or WALL_TEMPERATURE_IS_WANTED:
                constants = ignition_rate_constants(P, side, gas, charge)
            logarithms = logarithms_of(C, side, ln_clearance, ln_p, ln_mass_gas, constants)
            ignition = where(lights, ignition_rate(P, side, rising, charge, logarithms), 0.0)
        if MOTORED_PRESSURE_IS_WANTED and motored:
            cold = motored_gas(gas, gas.p_motored * gas.V * per_mass_gas_of(C, side, y))
            logarithms = logarithms_of(
                C, side, ln_clearance, ln_p_motored, ln_mass_gas, heat_constants
            )
            cooled = heat_loss(P, C, side, cold, charge, logarithms)
            g = gamma_of(P, C, side, y, cold.T)
            cold_rate = theta_rate(g, cold, clearance_rate, -cooled)
            motored_rate = where(c.mode == OPEN, 0.0, cold_rate)
        p, rate = where(own, p_own, p), where(own, rate_own, 0.0)
        released, lost = where(own, heat_released, 0.0), where(own, heat_lost, 0.0)
    return ChamberRates(p, rate, ignition, motored_rate, released, lost, flows)


@inline
def write_chamber(C, side, v, rates, dy):
    """Write the rates of a chamber and its quadratures into `dy`."""
    c = C[side]
    power = rates.p * c.area * c.sign * v
    dy[THETA + side] = rates.theta
    dy[IGNITION + side] = rates.ignition
    if MOTORED_PRESSURE_IS_WANTED:
        dy[MOTORED + side] = rates.motored
    dy[N_STATE + HEAT_RELEASED + side] = rates.released
    dy[N_STATE + HEAT_LOST + side] = rates.lost
    dy[N_STATE + GAS_WORK + side] = power
    dy[N_STATE + PORT_WORK + side] = where(has_own_pressure(C, side), 0.0, power)


@inline
def gas_force(C, left, right):
    """Force of the gas on the translator [N]."""
    return C[LEFT].sign * C[LEFT].area * left.p + C[RIGHT].sign * C[RIGHT].area * right.p


@inline
def motor_angle(E, t):
    """Angle of the motor's force [rad]."""
    since = t - E.t_command
    return E.motor_phase + 2.0 * pi * (E.motor_frequency + 0.5 * E.motor_sweep * since) * since


@inline
def alternator_action(P, E, t, motion):
    """Force of the alternator against positive velocity [N] and the power it delivers [W]."""
    if MOTORING_IS_POSSIBLE and E.is_driven > 0.0:
        return driven_action(P, E, t, motion.v)
    force = alternator_force(P, E.load_weight, motion)
    return force, alternator_electrical_power(P, E.load_weight, motion)


@inline
def driven_action(P, E, t, v):
    """The same of an alternator whose force is commanded, or that is a motor."""
    if E.sets_force > 0.0:
        force = converter_force(P, E.force, v)
        return -force, converter_power(P, force, v)
    force = -E.motor_amplitude * sin(motor_angle(E, t))
    return force, actuators_motor_power(P, force * v)


@inline
def rates_of_motion(P, E, t, y, dy, force):
    """Newton's law (Eq. 36), seen from the frame, and the quadratures of the translator."""
    motion = Motion(t, y[X], y[V], E.direction, y[CURRENT])
    generator, power = alternator_action(P, E, t, motion)
    friction = friction_force(P, E.friction_held, motion)
    total = force + springs_force(P, motion) - generator - friction
    v, acceleration = motion.v, total * E.per_mass
    if FRAME_IS_WANTED:
        frame = frame_acceleration(P, -total, y[FRAME_X], y[FRAME_V])
        acceleration -= frame
        dy[FRAME_X], dy[FRAME_V] = y[FRAME_V], frame
        dy[MOUNT_LOSS] = frame_loss(P, y[FRAME_V])
    dy[X], dy[V] = v, acceleration
    if CURRENT_IS_WANTED:
        dy[CURRENT] = alternator_current_rate(P, E.load_weight, motion)
    dy[N_STATE + ALTERNATOR_WORK] = generator * v
    dy[N_STATE + ELECTRICAL_ENERGY] = power
    dy[N_STATE + ELECTRICAL_SQUARED] = power * power
    dy[N_STATE + ALTERNATOR_IMPULSE] = abs(generator)
    dy[N_STATE + FRICTION_WORK] = friction * v
    dy[N_STATE + SPEED_SQUARED] = v * v


@compiled
def rhs(P, E, C, t, y, dy, motored):
    """Write the rates of the state `y` and of all quadratures into `dy`."""
    write_rates(P, E, C, t, y, dy, motored)


@inline
def write_rates(P, E, C, t, y, dy, motored):
    """The same, folded into the caller."""
    left = chamber_rates(P, E, C, LEFT, t, y, motored)
    right = chamber_rates(P, E, C, RIGHT, t, y, motored)
    force = gas_force(C, left, right) + E.back_force
    if CRANKCASE_IS_WANTED:
        force += crankcase_force(P, C, LEFT, y) + crankcase_force(P, C, RIGHT, y)
    rates_of_motion(P, E, t, y, dy, force)
    write_chamber(C, LEFT, y[V], left, dy)
    write_chamber(C, RIGHT, y[V], right, dy)
    if CONTENTS_ARE_WANTED or WALL_TEMPERATURE_IS_WANTED:
        write_contents(P, C, LEFT, y, left, dy)
        write_contents(P, C, RIGHT, y, right, dy)


@inline
def bound_phase(P, E, C, side):
    """Find the breakpoints of the burn rate that the present phase of a combustion lies between.

    Steps see the rate on their side of either; a breakpoint within rounding has been reached.
    """
    c = C[side]
    u = (E.t - c.t_ignition) / c.duration
    slack = AT_BREAKPOINT + 1e-15 * abs(E.t) / c.duration
    reached = heat_release_next_breakpoint(P, side, u - slack)
    ahead = heat_release_next_breakpoint(P, side, u + slack)
    c.first_phase = reached + ONE_SIDE if reached <= u + slack else 0.0
    c.last_phase = ahead - ONE_SIDE if u + slack < ahead < 1.0 else 1.0
    c.t_breakpoint = c.t_ignition + ahead * c.duration if c.last_phase < 1.0 else c.t_end


@inline
def find_position(P, E, C, x):
    """Find the next position at which a force on the translator, or a port, has a corner."""
    slack = AT_BREAKPOINT * E.length_scale
    E.x_breakpoint = inf
    if E.direction == 0.0:
        return
    beyond = x + E.direction * slack
    spring = springs_next_breakpoint(P, beyond, E.direction)
    alternator = alternator_next_breakpoint(P, beyond, E.direction)
    nearest = inf
    left, right = port_breakpoint(P, E, C, LEFT, beyond), port_breakpoint(P, E, C, RIGHT, beyond)
    if INJECTION_IS_WANTED:
        left = E.direction * min(E.direction * left, way_to_injection(E, C, LEFT))
        right = E.direction * min(E.direction * right, way_to_injection(E, C, RIGHT))
    for place in (spring, alternator, left, right):
        way = E.direction * (place - x)
        if slack < way < nearest:
            nearest = way
            E.x_breakpoint = place


@inline
def way_to_injection(E, C, side):
    """Position of the injection to come, in the direction of motion [m]; infinite for none."""
    c = C[side]
    inward = c.sign * E.direction < 0.0
    if inward and c.mode == CLOSED and c.injection_due > 0.0:
        return E.direction * c.sign * (c.injection_place - c.half_stroke)
    return inf


@inline
def port_breakpoint(P, E, C, side, x):
    """Next position at which the area of a port is not smooth [m]; infinite if there is none."""
    c = C[side]
    if not by_flow(C, side):
        return E.direction * inf
    outward = c.sign * E.direction
    opening = clearance_of(C, side, x) - c.port
    place = gas_exchange_next_breakpoint(P, side, opening, outward)
    return c.sign * (place + c.port - c.half_stroke)


@compiled
def refresh(P, E, C, y):
    """Compute the numbers that stay the same until the next event."""
    find_position(P, E, C, y[X])
    E.per_mass = 1.0 / E.mass
    for side in range(2):
        c = C[side]
        c.per_half_stroke = 1.0 / c.half_stroke
        if not has_own_pressure(C, side):
            continue
        c.ln_volume = log(c.area * c.half_stroke)
        c.ln_mass_gas = log(c.mass * c.gas_constant)
        c.per_mass_gas = 1.0 / (c.mass * c.gas_constant)
        breakpoint = gas_properties_breakpoint(P, side)
        c.ln_breakpoint = log(breakpoint) if breakpoint > 0.0 else 0.0
        c.beyond_breakpoint = 1.0 if ln_temperature(C, side, y) > c.ln_breakpoint else -1.0
        gas = gas_at(E, C, side, y, 0.0, 0.0, 1.0, 1.0)  # of which only what stays the same is used
        charge = charge_of(E, C, side, y)
        heat = heat_transfer_coefficient_constants(P, side, gas, charge)
        c.heat_first, c.heat_second, c.heat_third = heat
        ignition = ignition_rate_constants(P, side, gas, charge)
        c.ignition_first, c.ignition_second, c.ignition_third = ignition
        if c.mode == BURNING:
            bound_phase(P, E, C, side)
