"""Right-hand side: the translator (Eq. 36) and the gas in its two chambers (Eq. 48).

Arguments shared by all functions here: `P` the laws, `E` the engine's record, `C` the two
chambers' records (see :mod:`saleg.kernel.layout`), `side` 0 for left and 1 for right.
"""

from math import exp, log, pi

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    ALTERNATOR_IMPULSE,
    ALTERNATOR_WORK,
    BURNING,
    CLOSED,
    ELECTRICAL_ENERGY,
    ELECTRICAL_SQUARED,
    FRICTION_WORK,
    G0,
    GAS_WORK,
    HEAT_LOST,
    HEAT_RELEASED,
    IGNITION,
    MOTORED,
    N_STATE,
    OPEN,
    PORT_WORK,
    SPEED_SQUARED,
    THETA,
    V,
    X,
)
from saleg.kernel.slots import (
    alternator_electrical_power,
    alternator_force,
    friction_force,
    gas_properties_gamma,
    heat_release_burn_rate,
    heat_transfer_coefficient,
    ignition_rate,
    springs_force,
)
from saleg.laws.arguments import Charge, Gas, Motion


@inline
def height_of(C, side, x):
    """Clearance between crown and head [m]."""
    return C[side].half_stroke + C[side].sign * x


@inline
def gas_of(E, C, side, x, theta, theta_motored):
    """What the laws are shown of the gas in a closed chamber."""
    c = C[side]
    height = c.half_stroke + c.sign * x
    shift = G0 * log(height / c.half_stroke)
    p = exp(theta - shift)
    volume = c.area * height
    return Gas(
        p,
        p * volume / (c.mass * c.gas_constant),
        volume,
        exp(theta_motored - shift),
        height,
        c.bore,
        E.mean_piston_speed,
        c.wall_temperature,
        1.0 if c.mode == BURNING else 0.0,
    )


@inline
def charge_of(E, C, side):
    """What the laws are shown of the charge since port closing."""
    c = C[side]
    return Charge(
        c.mass,
        c.fuel,
        c.air,
        c.burnt,
        c.equivalence_ratio,
        c.p_closing,
        c.T_closing,
        c.V_closing,
        c.area * E.stroke,
    )


@inline
def heat_loss(P, C, side, gas, charge):
    """Heat flow to the wall [W], Eq. 50."""
    surface = 2.0 * C[side].area + pi * gas.bore * gas.height
    return (
        heat_transfer_coefficient(P, side, gas, charge) * surface * (gas.T - gas.wall_temperature)
    )


@inline
def heat_release(P, C, side, t):
    """Heat released by combustion [W], Eq. 53."""
    c = C[side]
    if c.mode != BURNING:
        return 0.0
    u = min(max((t - c.t_ignition) / c.duration, 0.0), 1.0)
    energy = c.fuel_to_burn * c.lower_heating_value
    return energy / c.duration * heat_release_burn_rate(P, side, u)


@inline
def theta_rate(P, side, gas, growth, heat):
    """Rate of theta [1/s]: Eq. 48, signs corrected, with Eq. 49."""
    g = gas_properties_gamma(P, side, gas.T)
    return (G0 - g) * growth / gas.height + (g - 1.0) * heat / (gas.p * gas.V)


@inline
def chamber_rates(P, E, C, side, t, y, dy, motored):
    """Rates of one chamber into `dy`; returns its pressure [Pa]."""
    c = C[side]
    growth = c.sign * y[V]
    dy[THETA + side] = 0.0
    dy[IGNITION + side] = 0.0
    dy[MOTORED + side] = 0.0
    dy[N_STATE + HEAT_RELEASED + side] = 0.0
    dy[N_STATE + HEAT_LOST + side] = 0.0
    if c.mode == OPEN:
        dy[N_STATE + GAS_WORK + side] = c.intake_pressure * c.area * growth
        dy[N_STATE + PORT_WORK + side] = c.intake_pressure * c.area * growth
        return c.intake_pressure
    theta = y[THETA + side]
    gas = gas_of(E, C, side, y[X], theta, y[MOTORED + side] if motored else theta)
    charge = charge_of(E, C, side)
    released = heat_release(P, C, side, t)
    lost = heat_loss(P, C, side, gas, charge)
    dy[THETA + side] = theta_rate(P, side, gas, growth, released - lost)
    dy[N_STATE + HEAT_RELEASED + side] = released
    dy[N_STATE + HEAT_LOST + side] = lost
    dy[N_STATE + GAS_WORK + side] = gas.p * c.area * growth
    dy[N_STATE + PORT_WORK + side] = 0.0
    if c.armed and c.mode == CLOSED:
        dy[IGNITION + side] = ignition_rate(P, side, gas, charge)
    if motored:
        cold = motored_gas(C, side, gas)
        lost = heat_loss(P, C, side, cold, charge)
        dy[MOTORED + side] = theta_rate(P, side, cold, growth, -lost)
    return gas.p


@inline
def motored_gas(C, side, gas):
    """The same charge at its motored pressure."""
    c = C[side]
    return Gas(
        gas.p_motored,
        gas.p_motored * gas.V / (c.mass * c.gas_constant),
        gas.V,
        gas.p_motored,
        gas.height,
        gas.bore,
        gas.mean_piston_speed,
        gas.wall_temperature,
        0.0,
    )


@inline
def rates_of_motion(P, E, t, y, dy, gas_force):
    """Newton's law (Eq. 36) and the quadratures of the translator."""
    motion = Motion(t, y[X], y[V], E.direction)
    generator = alternator_force(P, E.load_weight, motion)
    friction = friction_force(P, E.friction_held, motion)
    power = alternator_electrical_power(P, E.load_weight, motion)
    dy[X] = y[V]
    dy[V] = (gas_force + springs_force(P, motion) - generator - friction) / E.mass
    dy[N_STATE + ALTERNATOR_WORK] = generator * y[V]
    dy[N_STATE + ELECTRICAL_ENERGY] = power
    dy[N_STATE + ELECTRICAL_SQUARED] = power * power
    dy[N_STATE + ALTERNATOR_IMPULSE] = abs(generator)
    dy[N_STATE + FRICTION_WORK] = friction * y[V]
    dy[N_STATE + SPEED_SQUARED] = y[V] * y[V]


@compiled
def rhs(P, E, C, t, y, dy, motored):
    """Write the rates of the state `y` and of all quadratures into `dy`."""
    gas_force = 0.0
    for side in range(2):
        pressure = chamber_rates(P, E, C, side, t, y, dy, motored)
        gas_force += C[side].sign * C[side].area * pressure
    rates_of_motion(P, E, t, y, dy, gas_force)
