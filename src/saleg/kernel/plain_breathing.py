"""Gas that flows in and out of chambers, as :mod:`saleg.reference` has it.

First law and balance of mass of an open system, for each chamber that breathes and its crankcase::

    U' = Q - p V' + sum(h m'),    U = m u(T),    h = u + R T,    p V = m R T

with the internal energy U as the state, in the place of the pressure. Written from these equations
and from Heywood, Appendix C; the integrator's own form stands in :mod:`saleg.kernel.breathing`.
Names of the arguments are those of :mod:`saleg.kernel.plain_rhs`.
"""

from math import sqrt
from typing import NamedTuple

from saleg.kernel.flow import NEARLY_EQUAL
from saleg.kernel.jit import inline
from saleg.kernel.layout import (
    AIR,
    BURNT,
    CRANKCASE_BURNT,
    CRANKCASE_MASS,
    CRANKCASE_THETA,
    CRANKCASE_WORK,
    ENTHALPY_OUT,
    EXPELLED,
    EXPELLED_FRESH,
    EXPELLED_FUEL,
    FRESH,
    FUEL,
    OPEN,
    SUPPLIED,
    SUPPLIED_FUEL,
    THETA,
    WALL,
    V,
    X,
)
from saleg.kernel.needs import (
    COMPOSITION_IS_WANTED,
    CONTENTS_ARE_WANTED,
    CRANKCASE_IS_WANTED,
    WALL_TEMPERATURE_IS_WANTED,
)
from saleg.kernel.slots import (
    gas_exchange_areas,
    gas_exchange_exhaust,
    gas_exchange_fresh_share,
    gas_properties_energy_of,
    gas_properties_gamma,
    gas_properties_heat_capacity_of,
    gas_properties_internal_energy,
    leak_area,
    leak_beyond,
    supply_inlet_area,
    supply_piston_area,
    supply_volume,
    wall_temperature_rate,
)
from saleg.laws.arguments import Parts

# Internal energies of a chamber that breathes and of its crankcase [J] stand where the integrator
# has logarithms of their pressures, all other states where it has them too.
ENERGY = THETA
CRANKCASE_ENERGY = CRANKCASE_THETA
# Temperature below which none is looked for [K].
COLDEST = 1e-3


class Shares(NamedTuple):
    """Shares of fuel, burnt gas and fresh gas, by mass [-]; what is not fuel or burnt is air."""

    fuel: float
    burnt: float
    fresh: float


class Space(NamedTuple):
    """Gas in a space: pressure [Pa], temperature [K], specific enthalpy [J/kg]."""

    p: float
    T: float
    h: float


@inline
def is_open_system(C, side):
    """Whether energy and masses of a chamber are the states."""
    return CONTENTS_ARE_WANTED and C[side].breathes > 0.0


@inline
def is_held_open(C, side):
    """Whether open ports hold a chamber at the state of its intake."""
    by_flow = CONTENTS_ARE_WANTED and C[side].by_flow > 0.0
    return C[side].mode == OPEN and not by_flow


@inline
def has_crankcase(C, side):
    """Whether a crankcase stands before the intake ports."""
    return CRANKCASE_IS_WANTED and C[side].crankcase > 0.0


@inline
def mass_in(C, side, y):
    """Mass of the gas in a chamber [kg]."""
    if is_open_system(C, side):
        return y[FUEL + side] + y[AIR + side] + y[BURNT + side]
    return C[side].mass


@inline
def follows_composition(C, side):
    """Whether the gas of a chamber is the sum of what stands in it."""
    return COMPOSITION_IS_WANTED and C[side].follows > 0.0


@inline
def parts_in(y, side):
    """Fuel, air and burnt gas in a chamber, or their rates."""
    return Parts(y[FUEL + side], y[AIR + side], y[BURNT + side])


@inline
def mass_times_constant(C, side, y):
    """Mass of the gas in a chamber times its gas constant [J/K]."""
    if not follows_composition(C, side):
        return mass_in(C, side, y) * C[side].gas_constant
    parts, c = parts_in(y, side), C[side]
    burnt = parts.burnt * c.burnt_constant
    return parts.fuel * c.fuel_constant + parts.air * c.air_constant + burnt


@inline
def ratio_of_heats(P, C, side, y, T):
    """Ratio of specific heats of the gas in a chamber."""
    if not follows_composition(C, side):
        return gas_properties_gamma(P, side, T)
    heat_capacity = gas_properties_heat_capacity_of(P, side, T, parts_in(y, side))
    return 1.0 + mass_times_constant(C, side, y) / heat_capacity


@inline
def temperature_in(P, C, side, y):
    """Temperature in a chamber, of its energy and its contents [K]; 0 for none that a gas has."""
    if not follows_composition(C, side):
        u = y[ENERGY + side] / mass_in(C, side, y)
        return temperature_at(P, side, u, C[side].gas_constant)
    parts, T = parts_in(y, side), 1000.0
    for _ in range(50):
        lacking = y[ENERGY + side] - gas_properties_energy_of(P, side, T, parts)
        change = lacking / gas_properties_heat_capacity_of(P, side, T, parts)
        T = max(T + change, 0.1 * T)
        if abs(change) <= 1e-14 * T:
            return T
        if T < COLDEST:
            return 0.0
    return T


@inline
def wall_temperature_of(C, side, y):
    """Temperature of the wall [K]."""
    if WALL_TEMPERATURE_IS_WANTED and C[side].wall_follows > 0.0:
        return y[WALL + side]
    return C[side].wall_temperature


@inline
def temperature_at(P, side, u, R):
    """Temperature at which the gas has a specific internal energy [K], by Newton's method.

    0 for an energy that no gas has, though a solver may try it.
    """
    T = 1000.0
    for _ in range(50):
        heat_capacity = R / (gas_properties_gamma(P, side, T) - 1.0)
        change = (u - gas_properties_internal_energy(P, side, T)) / heat_capacity
        T = max(T + change, 0.1 * T)
        if abs(change) <= 1e-14 * T:
            return T
        if T < COLDEST:
            return 0.0
    return T


@inline
def space_at(P, side, p, T, R):
    """Gas of given pressure and temperature."""
    return Space(p, T, gas_properties_internal_energy(P, side, T) + R * T)


@inline
def textbook_flow(area, p0, T0, p, g, R):
    """Mass flow from `p0`, `T0` to the lower pressure `p` [kg/s]: Heywood, Eq. C.8 and C.9.

    Between nearly equal pressures a cubic takes the place of the root, with its value and, but for
    higher terms, its slope where they meet.
    """
    ratio = p / p0
    near, weight = min(ratio, 1.0 - NEARLY_EQUAL), 1.0
    if ratio > near:
        s = (1.0 - ratio) / NEARLY_EQUAL
        weight = s * (5.0 - s**2) / 4.0
    if near <= (2.0 / (g + 1.0)) ** (g / (g - 1.0)):
        psi = sqrt(g) * (2.0 / (g + 1.0)) ** ((g + 1.0) / (2.0 * (g - 1.0)))
    else:
        psi = near ** (1.0 / g) * sqrt(2.0 * g / (g - 1.0) * (1.0 - near ** ((g - 1.0) / g)))
    return area * p0 / sqrt(R * T0) * psi * weight


@inline
def net_flow(P, side, area, outside, inside, R):
    """Mass flow in through an opening [kg/s], negative if it goes out."""
    if area <= 0.0 or outside.p == inside.p:
        return 0.0
    if outside.p > inside.p:
        g = gas_properties_gamma(P, side, outside.T)
        return textbook_flow(area, outside.p, outside.T, inside.p, g, R)
    g = gas_properties_gamma(P, side, inside.T)
    return -textbook_flow(area, inside.p, inside.T, outside.p, g, R)


@inline
def pass_through(side, flow, outside, inside, comes, goes, dy):
    """Let gas through an opening of a chamber: energy, contents and what is counted of them.

    `comes` and `goes` are the shares in what comes in and in what goes out.
    """
    shares, h = (comes, outside.h) if flow > 0.0 else (goes, inside.h)
    dy[ENERGY + side] += flow * h
    dy[FUEL + side] += flow * shares.fuel
    dy[BURNT + side] += flow * shares.burnt
    dy[AIR + side] += flow * (1.0 - shares.fuel - shares.burnt)
    dy[FRESH + side] += flow * shares.fresh
    dy[ENTHALPY_OUT + side] -= flow * h
    if flow < 0.0:
        dy[EXPELLED_FUEL + side] -= flow * shares.fuel
        dy[EXPELLED_FRESH + side] -= flow * shares.fresh


@inline
def leaving(P, side, present, supplied):
    """Shares in what leaves through the ports, given those in the cylinder and in fresh gas."""
    x = gas_exchange_fresh_share(P, side, present.fresh)
    older = (1.0 - x) / max(1.0 - present.fresh, 1e-9)
    return Shares(
        fuel=x * supplied.fuel + older * (present.fuel - present.fresh * supplied.fuel),
        burnt=x * supplied.burnt + older * (present.burnt - present.fresh * supplied.burnt),
        fresh=x,
    )


@inline
def volume_of_crankcase(P, C, side, x):
    """Volume of a crankcase [m^3]."""
    return supply_volume(P, side, C[side].sign * x)


@inline
def gas_in_crankcase(P, C, side, y):
    """Gas in a crankcase."""
    R, mass = C[side].gas_constant, y[CRANKCASE_MASS + side]
    T = temperature_at(P, side, y[CRANKCASE_ENERGY + side] / mass, R)
    return space_at(P, side, mass * R * T / volume_of_crankcase(P, C, side, y[X]), T, R)


@inline
def has_real_crankcase(P, C, side, y):
    """Whether mass and energy of a crankcase, if there is one, are those of a gas."""
    if not has_crankcase(C, side):
        return True
    return y[CRANKCASE_MASS + side] > 0.0 and gas_in_crankcase(P, C, side, y).T > 0.0


@inline
def gas_before_ports(P, C, side, y):
    """Gas before the intake ports, and the share of burnt gas in it."""
    c = C[side]
    if has_crankcase(C, side):
        share = y[CRANKCASE_BURNT + side] / y[CRANKCASE_MASS + side]
        return gas_in_crankcase(P, C, side, y), share
    return space_at(P, side, c.intake_pressure, c.intake_temperature, c.gas_constant), 0.0


@inline
def exchange_gas(P, C, side, gas, y, dy):
    """Let gas through all openings of a chamber, and of the crankcase before it."""
    c = C[side]
    R, mass = c.gas_constant, mass_in(C, side, y)
    inside = space_at(P, side, gas.p, gas.T, R)
    present = Shares(y[FUEL + side] / mass, y[BURNT + side] / mass, y[FRESH + side] / mass)
    p, T = leak_beyond(P, side)
    beyond = space_at(P, side, p, T, R)
    leak = net_flow(P, side, leak_area(P, side, gas), beyond, inside, R)
    pass_through(side, leak, beyond, inside, Shares(0.0, 0.0, 0.0), present, dy)
    dy[EXPELLED + side] -= leak
    if c.by_flow > 0.0:
        supply, burnt = gas_before_ports(P, C, side, y)
        intake, exchanged, metered = 0.0, Shares(0.0, 0.0, 0.0), 0.0
        if c.mode == OPEN:
            intake, exchanged, metered = flow_through_ports(
                P, C, side, gas, inside, present, supply, burnt, dy
            )
        if has_crankcase(C, side):
            h = supply.h if intake > 0.0 else inside.h
            change_crankcase(P, C, side, supply, intake, exchanged, metered, h, y, dy)


@inline
def flow_through_ports(P, C, side, gas, inside, present, supply, burnt, dy):
    """Let gas through both ports; flow in through the intake, shares in it, that of metered fuel.

    Fuel is added to what comes from the supply until it stands at the ratio wanted to the air.
    """
    c = C[side]
    R = c.gas_constant
    intake_area, exhaust_area = gas_exchange_areas(P, side, gas.clearance - c.port)
    mixes = c.injection_place == 0.0  # else no fuel comes through the ports
    wanted = c.fuel_factor * c.equivalence_ratio_wanted if mixes else 0.0
    per_supplied = wanted / c.air_fuel_ratio * (1.0 - burnt)
    fuel = per_supplied / (1.0 + per_supplied)
    fresh = Shares(fuel, (1.0 - fuel) * burnt, 1.0)
    goes = leaving(P, side, present, fresh)
    p, T = gas_exchange_exhaust(P, side)
    exhaust = space_at(P, side, p, T, R)
    out = net_flow(P, side, exhaust_area, exhaust, inside, R)
    pass_through(side, out, exhaust, inside, Shares(0.0, 1.0, 0.0), goes, dy)
    intake = net_flow(P, side, intake_area, supply, inside, R)
    pass_through(side, intake, supply, inside, fresh, goes, dy)
    # Fresh gas that is blown back comes again, with its fuel: it counts as not delivered.
    blown_back = min(intake, 0.0) * goes.fresh
    delivered = max(intake, 0.0) + blown_back
    dy[EXPELLED + side] -= out + min(intake, 0.0) - blown_back
    dy[EXPELLED_FRESH + side] += blown_back
    dy[EXPELLED_FUEL + side] += blown_back * fuel
    dy[SUPPLIED + side] += delivered
    dy[SUPPLIED_FUEL + side] += delivered * fuel
    if intake > 0.0:
        return intake, fresh, fuel
    return intake, goes, goes.fresh * fuel


@inline
def change_crankcase(P, C, side, case, intake, exchanged, metered, h, y, dy):
    """Energy, mass and burnt gas of a crankcase.

    Fuel is added only beyond it, and stays beyond it when fresh gas is blown back. Of all else that
    the cylinder blows back, fuel counts as air there.
    """
    c = C[side]
    drawn = intake * (1.0 - metered)
    manifold = space_at(P, side, c.intake_pressure, c.intake_temperature, c.gas_constant)
    area = supply_inlet_area(P, side, manifold.p - case.p)
    inlet = net_flow(P, side, area, manifold, case, c.gas_constant)
    h_inlet = manifold.h if inlet > 0.0 else case.h
    share = y[CRANKCASE_BURNT + side] / y[CRANKCASE_MASS + side]
    growth = -supply_piston_area(P, side) * c.sign * y[V]
    dy[CRANKCASE_ENERGY + side] = inlet * h_inlet - drawn * h - case.p * growth
    dy[CRANKCASE_MASS + side] = inlet - drawn
    dy[CRANKCASE_BURNT + side] = min(inlet, 0.0) * share - intake * exchanged.burnt
    dy[CRANKCASE_WORK + side] = (case.p - manifold.p) * growth
    # Out of cylinder and crankcase together, work on the surroundings included.
    dy[ENTHALPY_OUT + side] += drawn * h - inlet * h_inlet + manifold.p * growth


@inline
def push_of_crankcase(P, C, side, y):
    """Force of a crankcase on the translator, over the intake's pressure [N]; right is positive."""
    c = C[side]
    if not has_crankcase(C, side):
        return 0.0
    over = gas_in_crankcase(P, C, side, y).p - c.intake_pressure
    return -c.sign * supply_piston_area(P, side) * over


@inline
def burn(C, side, released, dy):
    """Turn fuel and its air into burnt gas as their heat is released."""
    c = C[side]
    if released > 0.0:
        fuel = released / c.lower_heating_value
        dy[FUEL + side] -= fuel
        dy[AIR + side] -= c.air_fuel_ratio * fuel
        dy[BURNT + side] += (1.0 + c.air_fuel_ratio) * fuel


@inline
def warm_wall(P, C, side, heat, y, dy):
    """Rate of the temperature of a wall, given the heat from the gas [W]."""
    if WALL_TEMPERATURE_IS_WANTED and C[side].wall_follows > 0.0:
        dy[WALL + side] = wall_temperature_rate(P, side, y[WALL + side], heat)
