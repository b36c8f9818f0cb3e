"""The equations in pressure, as they are printed: right-hand side of :mod:`saleg.reference`.

A chamber that breathes has its internal energy in the place of its pressure, and states more behind
the quadratures (:mod:`saleg.kernel.plain_breathing`).

It shares the laws with the integrator and nothing else. `P` holds the laws, `E` what the engine
and `C` what each of its chambers keeps between two events (`EngineState` and `ChamberState` of
:mod:`saleg.reference.states`, or records of the same numbers), `side` is 0 for left, 1 for right.
"""

from math import nan, pi

from saleg.kernel.copies import motored_gas, with_pressure_rate
from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import (
    AIR,
    ALTERNATOR_IMPULSE,
    ALTERNATOR_WORK,
    BURNING,
    BURNT,
    CLOSED,
    DISARMED,
    ELECTRICAL_ENERGY,
    ELECTRICAL_SQUARED,
    FRAME_V,
    FRAME_X,
    FRICTION_WORK,
    FUEL,
    GAS_WORK,
    HEAT_LOST,
    HEAT_RELEASED,
    MOUNT_LOSS,
    OPEN,
    PORT_WORK,
    SPEED_SQUARED,
)
from saleg.kernel.needs import FRAME_IS_WANTED
from saleg.kernel.plain_breathing import (
    ENERGY,
    burn,
    exchange_gas,
    follows_composition,
    has_crankcase,
    has_real_crankcase,
    is_held_open,
    is_open_system,
    mass_in,
    mass_times_constant,
    parts_in,
    push_of_crankcase,
    ratio_of_heats,
    temperature_in,
    wall_temperature_of,
    warm_wall,
)
from saleg.kernel.slots import (
    alternator_current_rate,
    alternator_electrical_power,
    alternator_force,
    frame_acceleration,
    frame_loss,
    friction_force,
    gas_properties_energy_of,
    gas_properties_gamma,
    gas_properties_heat_capacity_of,
    gas_properties_internal_energy,
    heat_release_burn_rate,
    heat_transfer_coefficient,
    ignition_rate,
    springs_force,
)
from saleg.laws.arguments import Charge, Gas, Motion

# Where each number stands: position [m], velocity [m/s]; per side pressure [Pa], ignition integral
# [-] and motored pressure [Pa]; the current in the alternator [A]; then the quadratures, in the
# order of the layout. Behind them, in engines that have them, the states of chambers where the
# layout has them.
POSITION = 0
VELOCITY = 1
PRESSURE = 2
INTEGRAL = 4
MOTORED_PRESSURE = 6
ALTERNATOR_CURRENT = 8
QUADRATURES = 9


@inline
def pressure_in(P, C, side, y):
    """Pressure in a chamber [Pa]."""
    c = C[side]
    if not is_open_system(C, side):
        return y[PRESSURE + side]
    if is_held_open(C, side):
        return c.intake_pressure
    volume = c.area * (c.half_stroke + c.sign * y[POSITION])
    return mass_times_constant(C, side, y) * temperature_in(P, C, side, y) / volume


@inline
def gas_in(E, C, side, y, p):
    """Gas in a chamber at its pressure, as the laws see it."""
    c = C[side]
    clearance = c.half_stroke + c.sign * y[POSITION]
    volume = c.area * clearance
    has_motored = E.motored == 1.0 and c.mode != OPEN
    return Gas(
        p=p,
        T=p * volume / mass_times_constant(C, side, y),
        V=volume,
        p_motored=y[MOTORED_PRESSURE + side] if has_motored else p,
        clearance=clearance,
        bore=c.bore,
        mean_piston_speed=E.mean_piston_speed,
        wall_temperature=wall_temperature_of(C, side, y),
        burning=1.0 if c.mode == BURNING else 0.0,
        clearance_rate=c.sign * y[VELOCITY],
        p_rate=0.0,
    )


@inline
def charge_in(E, C, side, y):
    """Charge since port closing, as the laws see it: what there is of it now."""
    c = C[side]
    follows = is_open_system(C, side)
    return Charge(
        mass=mass_in(C, side, y),
        fuel=y[FUEL + side] if follows else c.fuel,
        air=y[AIR + side] if follows else c.air,
        burnt=y[BURNT + side] if follows else c.burnt,
        equivalence_ratio=c.equivalence_ratio,
        p=c.p_closing,
        T=c.T_closing,
        V=c.V_closing,
        swept_volume=c.area * E.stroke,
        spark_advance=0.0,  # nobody commands
        time_to_dead_centre=c.time_to_dead_centre,
    )


@inline
def heat_to_wall(P, side, gas, charge):
    """Heat flow to the wall [W]: Eq. 50."""
    surface = pi * gas.bore**2 / 2.0 + pi * gas.bore * gas.clearance
    h = heat_transfer_coefficient(P, side, gas, charge)
    return h * surface * (gas.T - gas.wall_temperature)


@inline
def heat_from_fuel(P, C, side, t, y):
    """Heat released by combustion [W]: Eq. 53; gas that leaks takes its share of it along."""
    c = C[side]
    if c.mode != BURNING:
        return 0.0
    u = min(max((t - c.t_ignition) / c.duration, c.first_phase), c.last_phase)
    rate = c.heat / c.duration * heat_release_burn_rate(P, side, u)
    if is_open_system(C, side):
        rate *= mass_in(C, side, y) / c.mass_lit
    return rate


@inline
def pressure_rate(g, gas, volume_rate, heat_rate):
    """Rate of the pressure [Pa/s]: Eq. 48, signs corrected."""
    return -g * gas.p / gas.V * volume_rate + (g - 1.0) / gas.V * heat_rate


@inline
def pressure_rate_in(P, C, side, gas, y, dy):
    """Rate of the pressure [Pa/s]; of an open system by the gas law, from energy and mass."""
    if not is_open_system(C, side):
        return dy[PRESSURE + side]
    if is_held_open(C, side):
        return 0.0
    if follows_composition(C, side):
        heat_capacity = gas_properties_heat_capacity_of(P, side, gas.T, parts_in(y, side))
        own = gas_properties_energy_of(P, side, gas.T, parts_in(dy, side))
        warming = (dy[ENERGY + side] - own) / heat_capacity
        moles = mass_times_constant(C, side, dy) / mass_times_constant(C, side, y)
        return gas.p * (moles + warming / gas.T - gas.clearance_rate / gas.clearance)
    c = C[side]
    mass = mass_in(C, side, y)
    gain = dy[FUEL + side] + dy[AIR + side] + dy[BURNT + side]
    heat_capacity = c.gas_constant / (gas_properties_gamma(P, side, gas.T) - 1.0)
    energy = gas_properties_internal_energy(P, side, gas.T)
    warming = (dy[ENERGY + side] - energy * gain) / (mass * heat_capacity)
    return gas.p * (gain / mass + warming / gas.T - gas.clearance_rate / gas.clearance)


@inline
def work_on_gas(P, E, C, side, t, y, p, dy):
    """Rates of a chamber that is closed, or whose open ports let gas flow."""
    gas, charge = gas_in(E, C, side, y, p), charge_in(E, C, side, y)
    volume_rate = C[side].sign * C[side].area * y[VELOCITY]
    lost, released = heat_to_wall(P, side, gas, charge), heat_from_fuel(P, C, side, t, y)
    if is_open_system(C, side):
        dy[ENERGY + side] = released - lost - p * volume_rate
        exchange_gas(P, C, side, gas, y, dy)
        burn(C, side, released, dy)
    else:
        g = ratio_of_heats(P, C, side, y, gas.T)
        dy[PRESSURE + side] = pressure_rate(g, gas, volume_rate, released - lost)
    warm_wall(P, C, side, lost, y, dy)
    dy[QUADRATURES + HEAT_LOST + side] = lost
    dy[QUADRATURES + HEAT_RELEASED + side] = released
    if C[side].armed > DISARMED and C[side].mode == CLOSED:
        rising = with_pressure_rate(gas, pressure_rate_in(P, C, side, gas, y, dy))
        dy[INTEGRAL + side] = ignition_rate(P, side, rising, charge)
    if E.motored == 1.0 and C[side].mode != OPEN:
        cold = motored_gas(gas, gas.T * gas.p_motored / gas.p)
        lost = heat_to_wall(P, side, cold, charge)
        g = ratio_of_heats(P, C, side, y, cold.T)
        dy[MOTORED_PRESSURE + side] = pressure_rate(g, cold, volume_rate, -lost)


@inline
def translator(P, E, C, t, y, p_left, p_right, dy):
    """Acceleration (Eq. 36) and the quadratures of alternator and friction."""
    x, v = y[POSITION], y[VELOCITY]
    motion = Motion(t, x, v, E.direction, y[ALTERNATOR_CURRENT])
    load = alternator_force(P, E.load_weight, motion)
    friction = friction_force(P, E.friction_held, motion)
    power = alternator_electrical_power(P, E.load_weight, motion)
    push = C[0].area * p_left - C[1].area * p_right + E.back_force
    if has_crankcase(C, 0) or has_crankcase(C, 1):
        push += push_of_crankcase(P, C, 0, y) + push_of_crankcase(P, C, 1, y)
    dy[POSITION] = v
    on_translator = push + springs_force(P, motion) - load - friction
    dy[VELOCITY] = on_translator / E.mass
    if FRAME_IS_WANTED and E.frame_moves > 0.0:
        frame = frame_acceleration(P, -on_translator, y[FRAME_X], y[FRAME_V])
        dy[FRAME_X], dy[FRAME_V] = y[FRAME_V], frame
        dy[MOUNT_LOSS] = frame_loss(P, y[FRAME_V])
        dy[VELOCITY] -= frame
    dy[ALTERNATOR_CURRENT] = alternator_current_rate(P, E.load_weight, motion)
    dy[QUADRATURES + ALTERNATOR_WORK] = load * v
    dy[QUADRATURES + ELECTRICAL_ENERGY] = power
    dy[QUADRATURES + ELECTRICAL_SQUARED] = power**2
    dy[QUADRATURES + ALTERNATOR_IMPULSE] = abs(load)
    dy[QUADRATURES + FRICTION_WORK] = friction * v
    dy[QUADRATURES + SPEED_SQUARED] = v**2


@inline
def is_physical(P, C, y):
    """Whether all volumes, masses and pressures are positive; a solver may try others."""
    for side in range(2):
        if not C[side].half_stroke + C[side].sign * y[POSITION] > 0.0:
            return False
        if not (mass_in(C, side, y) > 0.0 and y[MOTORED_PRESSURE + side] > 0.0):
            return False
        if not (pressure_in(P, C, side, y) > 0.0 and has_real_crankcase(P, C, side, y)):
            return False
    return True


@compiled
def rates(P, E, C, t, y, dy):
    """Write the rates of the state `y` and of all quadratures into `dy`."""
    physical = is_physical(P, C, y)
    for n in range(len(dy)):
        dy[n] = 0.0 if physical else nan
    if not physical:
        return
    p_left, p_right = pressure_in(P, C, 0, y), pressure_in(P, C, 1, y)
    translator(P, E, C, t, y, p_left, p_right, dy)
    for side in range(2):
        p = p_left if side == 0 else p_right
        work = p * C[side].sign * C[side].area * y[VELOCITY]
        dy[QUADRATURES + GAS_WORK + side] = work
        if is_held_open(C, side):
            dy[QUADRATURES + PORT_WORK + side] = work
            warm_wall(P, C, side, 0.0, y, dy)
        else:
            work_on_gas(P, E, C, side, t, y, p, dy)


@cached
def rates_of_records(P1, E1, C, t, y, dy):
    """Do the same for arrays of records; called from Python."""
    rates(P1[0], E1[0], C, t, y, dy)
