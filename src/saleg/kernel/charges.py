"""Charges of the chambers: composed, trapped, lit, burnt and blown down."""

from math import inf, log

from saleg.kernel.breathing import (
    breathes,
    by_flow,
    crankcase_of,
    energy_of,
    follows,
    gamma_of,
    has_crankcase,
    has_own_pressure,
    injects,
    mass_gas_of,
    mass_of,
    weighted,
)
from saleg.kernel.control import pressure_at_midpoint
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    AIR,
    ARMED,
    BURNING,
    BURNT,
    CLOSED,
    CRANKCASE_MASS,
    DISARMED,
    FAILING,
    FRESH,
    FUEL,
    G0,
    HEAT_RELEASED,
    IGNITION,
    MOTORED,
    N_STATE,
    OPEN,
    THETA,
    X,
)
from saleg.kernel.needs import INJECTION_IS_WANTED
from saleg.kernel.rhs import charge_of, gas_of
from saleg.kernel.slots import (
    completeness_share,
    gas_exchange_charge,
    gas_properties_internal_energy,
    heat_release_burnt_fraction,
    heat_release_duration,
    misfires_happens,
    scatter_delay_factor,
    scatter_duration_factor,
    scatter_fuel_factor,
)
from saleg.kernel.state import clearance_of
from saleg.laws.arguments import Parts

# Longest first step of a combustion, over its duration.
FIRST_OF_BURN = 0.1
# Rounds in which the mass of a charge whose gas depends on its composition is found to rounding.
MASS_ITERATIONS = 12


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
