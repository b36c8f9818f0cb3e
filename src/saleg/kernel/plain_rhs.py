"""The equations in pressure, as they are printed: right-hand side of :mod:`saleg.reference`.

It shares the laws with the integrator and nothing else. `P` holds the laws, `E` what the engine
and `C` what each of its chambers keeps between two events (`EngineState` and `ChamberState` of
:mod:`saleg.reference.states`, or records of the same numbers), `side` is 0 for left, 1 for right.
"""

from math import nan, pi

from saleg.kernel.copies import motored_gas, with_pressure_rate
from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import (
    ALTERNATOR_IMPULSE,
    ALTERNATOR_WORK,
    BURNING,
    CLOSED,
    DISARMED,
    ELECTRICAL_ENERGY,
    ELECTRICAL_SQUARED,
    FRICTION_WORK,
    GAS_WORK,
    HEAT_LOST,
    HEAT_RELEASED,
    OPEN,
    PORT_WORK,
    SPEED_SQUARED,
)
from saleg.kernel.slots import (
    alternator_current_rate,
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

# Where each number stands: position [m], velocity [m/s]; per side pressure [Pa], ignition integral
# [-] and motored pressure [Pa]; the current in the alternator [A]; then the quadratures, in the
# order of the layout.
POSITION = 0
VELOCITY = 1
PRESSURE = 2
INTEGRAL = 4
MOTORED_PRESSURE = 6
ALTERNATOR_CURRENT = 8
QUADRATURES = 9


@inline
def gas_in(E, C, side, y):
    """Gas in a closed chamber, as the laws see it."""
    c = C[side]
    clearance = c.half_stroke + c.sign * y[POSITION]
    volume = c.area * clearance
    p = y[PRESSURE + side]
    return Gas(
        p=p,
        T=p * volume / (c.mass * c.gas_constant),
        V=volume,
        p_motored=y[MOTORED_PRESSURE + side] if E.motored == 1.0 else p,
        clearance=clearance,
        bore=c.bore,
        mean_piston_speed=E.mean_piston_speed,
        wall_temperature=c.wall_temperature,
        burning=1.0 if c.mode == BURNING else 0.0,
        clearance_rate=c.sign * y[VELOCITY],
        p_rate=0.0,
    )


@inline
def charge_in(E, C, side):
    """Charge since port closing, as the laws see it."""
    c = C[side]
    return Charge(
        mass=c.mass,
        fuel=c.fuel,
        air=c.air,
        burnt=c.burnt,
        equivalence_ratio=c.equivalence_ratio,
        p=c.p_closing,
        T=c.T_closing,
        V=c.V_closing,
        swept_volume=c.area * E.stroke,
    )


@inline
def heat_to_wall(P, side, gas, charge):
    """Heat flow to the wall [W]: Eq. 50."""
    surface = pi * gas.bore**2 / 2.0 + pi * gas.bore * gas.clearance
    h = heat_transfer_coefficient(P, side, gas, charge)
    return h * surface * (gas.T - gas.wall_temperature)


@inline
def heat_from_fuel(P, C, side, t):
    """Heat released by combustion [W]: Eq. 53."""
    c = C[side]
    if c.mode != BURNING:
        return 0.0
    u = min(max((t - c.t_ignition) / c.duration, c.first_phase), c.last_phase)
    return c.heat / c.duration * heat_release_burn_rate(P, side, u)


@inline
def pressure_rate(P, side, gas, volume_rate, heat_rate):
    """Rate of the pressure [Pa/s]: Eq. 48, signs corrected."""
    g = gas_properties_gamma(P, side, gas.T)
    return -g * gas.p / gas.V * volume_rate + (g - 1.0) / gas.V * heat_rate


@inline
def closed_chamber(P, E, C, side, t, y, dy):
    """Rates of the pressures, the ignition integral and the heats of a closed chamber."""
    gas, charge = gas_in(E, C, side, y), charge_in(E, C, side)
    volume_rate = C[side].sign * C[side].area * y[VELOCITY]
    lost, released = heat_to_wall(P, side, gas, charge), heat_from_fuel(P, C, side, t)
    dy[PRESSURE + side] = pressure_rate(P, side, gas, volume_rate, released - lost)
    dy[QUADRATURES + HEAT_LOST + side] = lost
    dy[QUADRATURES + HEAT_RELEASED + side] = released
    if C[side].armed > DISARMED and C[side].mode == CLOSED:
        rising = with_pressure_rate(gas, dy[PRESSURE + side])
        dy[INTEGRAL + side] = ignition_rate(P, side, rising, charge)
    if E.motored == 1.0:
        cold = motored_gas(gas, gas.T * gas.p_motored / gas.p)
        lost = heat_to_wall(P, side, cold, charge)
        dy[MOTORED_PRESSURE + side] = pressure_rate(P, side, cold, volume_rate, -lost)


@inline
def translator(P, E, C, t, y, dy):
    """Acceleration (Eq. 36) and the quadratures of alternator and friction."""
    x, v = y[POSITION], y[VELOCITY]
    motion = Motion(t, x, v, E.direction, y[ALTERNATOR_CURRENT])
    load = alternator_force(P, E.load_weight, motion)
    friction = friction_force(P, E.friction_held, motion)
    power = alternator_electrical_power(P, E.load_weight, motion)
    push = C[0].area * y[PRESSURE] - C[1].area * y[PRESSURE + 1]
    dy[POSITION] = v
    dy[VELOCITY] = (push + springs_force(P, motion) - load - friction) / E.mass
    dy[ALTERNATOR_CURRENT] = alternator_current_rate(P, E.load_weight, motion)
    dy[QUADRATURES + ALTERNATOR_WORK] = load * v
    dy[QUADRATURES + ELECTRICAL_ENERGY] = power
    dy[QUADRATURES + ELECTRICAL_SQUARED] = power**2
    dy[QUADRATURES + ALTERNATOR_IMPULSE] = abs(load)
    dy[QUADRATURES + FRICTION_WORK] = friction * v
    dy[QUADRATURES + SPEED_SQUARED] = v**2


@inline
def is_physical(C, y):
    """Whether all volumes and pressures are positive; a solver may try others."""
    for side in range(2):
        if not C[side].half_stroke + C[side].sign * y[POSITION] > 0.0:
            return False
        if not (y[PRESSURE + side] > 0.0 and y[MOTORED_PRESSURE + side] > 0.0):
            return False
    return True


@compiled
def rates(P, E, C, t, y, dy):
    """Write the rates of the state `y` and of all quadratures into `dy`."""
    physical = is_physical(C, y)
    for n in range(len(dy)):
        dy[n] = 0.0 if physical else nan
    if not physical:
        return
    translator(P, E, C, t, y, dy)
    for side in range(2):
        work = y[PRESSURE + side] * C[side].sign * C[side].area * y[VELOCITY]
        dy[QUADRATURES + GAS_WORK + side] = work
        if C[side].mode == OPEN:
            dy[QUADRATURES + PORT_WORK + side] = work
        else:
            closed_chamber(P, E, C, side, t, y, dy)


@cached
def rates_of_records(P1, E1, C, t, y, dy):
    """Do the same for arrays of records; called from Python."""
    rates(P1[0], E1[0], C, t, y, dy)
