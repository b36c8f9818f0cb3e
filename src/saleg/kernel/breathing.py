"""Gas that flows in and out of a chamber: through ports, past rings, out of a crankcase.

Masses of fuel, air and burnt gas, and of fresh gas among them, are states of a chamber whose laws
ask for them. It has one temperature; what flows in mixes with it at once.
"""

from math import exp, log
from typing import NamedTuple

from saleg.kernel.flow import orifice_flow
from saleg.kernel.jit import compiled, inline
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
    G0,
    OPEN,
    SUPPLIED,
    SUPPLIED_FUEL,
    WALL,
    V,
    X,
)
from saleg.kernel.needs import (
    COMPOSITION_IS_WANTED,
    CONTENTS_ARE_WANTED,
    CRANKCASE_IS_WANTED,
    INJECTION_IS_WANTED,
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
    injection_fuel_state,
    leak_area,
    leak_beyond,
    supply_inlet_area,
    supply_piston_area,
    supply_volume,
    wall_temperature_rate,
)
from saleg.laws.arguments import Parts
from saleg.laws.choice import any_of, where

# The laws decide about these three: of engines side by side, one answer holds for all.


@inline
def breathes(C, side):
    """Whether the masses in a chamber are integrated."""
    return CONTENTS_ARE_WANTED and any_of(C[side].breathes > 0.0)


@inline
def by_flow(C, side):
    """Whether gas flows through the ports of a chamber while they are open."""
    return CONTENTS_ARE_WANTED and any_of(C[side].by_flow > 0.0)


@inline
def has_crankcase(y, side):
    """Whether a crankcase stands before the ports of a chamber."""
    return CRANKCASE_IS_WANTED and any_of(y[CRANKCASE_MASS + side] > 0.0)


@inline
def has_own_pressure(C, side):
    """Whether the state of a chamber is its own; open ports may hold it at that of its intake."""
    return (C[side].mode != OPEN) | by_flow(C, side)


@inline
def mass_of(C, side, y):
    """Mass of the gas in a chamber [kg]."""
    if breathes(C, side):
        return y[FUEL + side] + y[AIR + side] + y[BURNT + side]
    return C[side].mass


@inline
def follows(C, side):
    """Whether the gas of a chamber changes with its composition."""
    return COMPOSITION_IS_WANTED and C[side].follows > 0.0


@inline
def parts_of(y, side):
    """What a chamber that breathes holds."""
    return Parts(y[FUEL + side], y[AIR + side], y[BURNT + side])


@inline
def weighted(C, side, parts):
    """Sum of the specific gas constants of parts of a gas, each times its mass [J/K]."""
    c = C[side]
    fuel, air = parts.fuel * c.fuel_constant, parts.air * c.air_constant
    return fuel + air + parts.burnt * c.burnt_constant


@inline
def mass_gas_of(C, side, y):
    """Mass of the gas in a chamber times its gas constant [J/K]."""
    if follows(C, side):
        return weighted(C, side, parts_of(y, side))
    return mass_of(C, side, y) * C[side].gas_constant


@inline
def gamma_of(P, C, side, y, T):
    """Ratio of specific heats of the gas in a chamber."""
    if follows(C, side):
        parts = parts_of(y, side)
        heat_capacity = gas_properties_heat_capacity_of(P, side, T, parts)
        return 1.0 + weighted(C, side, parts) / heat_capacity
    return gas_properties_gamma(P, side, T)


@inline
def energy_of(P, C, side, y, T):
    """Internal energy of the gas in a chamber [J]."""
    if follows(C, side):
        return gas_properties_energy_of(P, side, T, parts_of(y, side))
    return mass_of(C, side, y) * gas_properties_internal_energy(P, side, T)


@inline
def injects(C, side):
    """Whether fuel is injected into a chamber once its ports are closed."""
    return C[side].injection_place > 0.0


@inline
def enthalpy_of_fuel(P, C, side, fuel):
    """Enthalpy that fuel brings along as it is injected [J]."""
    c = C[side]
    T, latent_heat = injection_fuel_state(P, side)
    if follows(C, side):
        vapour = gas_properties_energy_of(P, side, T, Parts(fuel, 0.0, 0.0))
        return vapour + fuel * (c.fuel_constant * T - latent_heat)
    return fuel * (enthalpy_at(P, side, T, c.gas_constant) - latent_heat)


@inline
def burning_parts(C, side, released):
    """Rates at which parts of a gas change as they release some heat [kg/s]."""
    c = C[side]
    fuel = released / c.lower_heating_value
    return Parts(-fuel, -c.air_fuel_ratio * fuel, (1.0 + c.air_fuel_ratio) * fuel)


@inline
def rate_by_composition(P, C, side, y, gas, g, released):
    """Part in the rate of the logarithm of the pressure that comes from the composition [1/s].

    The number of moles changes, and so does the energy the gas has at its temperature.
    """
    change = burning_parts(C, side, released)
    moles = weighted(C, side, change) / mass_gas_of(C, side, y)
    return moles - (g - 1.0) * gas_properties_energy_of(P, side, gas.T, change) / (gas.p * gas.V)


@inline
def dilution(C, side, y, dy):
    """Relative rate of the mass in a chamber that breathes times its gas constant [1/s]."""
    if follows(C, side):
        return weighted(C, side, parts_of(dy, side)) / mass_gas_of(C, side, y)
    return (dy[FUEL + side] + dy[AIR + side] + dy[BURNT + side]) / mass_of(C, side, y)


@inline
def wall_of(C, side, y):
    """Temperature of the wall [K]."""
    if WALL_TEMPERATURE_IS_WANTED:
        return y[WALL + side]
    return C[side].wall_temperature


@compiled
def take_contents(C, y):
    """Bring what the records say of the chambers up to date with the state."""
    for side in range(2):
        c = C[side]
        if breathes(C, side):
            c.fuel, c.air, c.burnt = y[FUEL + side], y[AIR + side], y[BURNT + side]
            c.mass = mass_of(C, side, y)
        if WALL_TEMPERATURE_IS_WANTED:
            c.wall_temperature = y[WALL + side]


class Crankcase(NamedTuple):
    """Gas in a crankcase: pressure [Pa] and temperature [K]."""

    p: float
    T: float


class Flows(NamedTuple):
    """Flows of gas into a chamber and out of it.

    Attributes
    ----------
    ln_p : float
        Their part in the rate of the logarithm of the pressure [1/s].
    fuel, air, burnt, fresh : float
        Rates of the contents, combustion left out [kg/s].
    supplied, supplied_fuel, expelled, expelled_fuel, expelled_fresh : float
        In through the intake, less the fresh gas blown back there; out otherwise, less what comes
        back [kg/s].
    enthalpy : float
        Out, less in [W].
    drawn, drawn_burnt, drawn_enthalpy : float
        Out of the supply: gas and burnt gas among it [kg/s], enthalpy [W].
    """

    ln_p: float
    fuel: float
    air: float
    burnt: float
    fresh: float
    supplied: float
    supplied_fuel: float
    expelled: float
    expelled_fuel: float
    expelled_fresh: float
    enthalpy: float
    drawn: float
    drawn_burnt: float
    drawn_enthalpy: float


@inline
def no_flows(C, side):
    """Flows of a tight chamber."""
    o = where(C[side].breathes > 0.0, 0.0, 0.0)  # as many zeros as there are engines
    return Flows(o, o, o, o, o, o, o, o, o, o, o, o, o, o)


@inline
def enthalpy_at(P, side, T, R):
    """Specific enthalpy [J/kg]."""
    return gas_properties_internal_energy(P, side, T) + R * T


@inline
def flow_in(P, side, area, gas, g, R, p_beyond, T_beyond):
    """Mass flow into a chamber through an opening, negative out of it [kg/s]."""
    flow, passes = 0.0, where(area <= 0.0, False, True)
    if any_of(passes):
        inward = p_beyond > gas.p
        p, T, p_down, g_up = gas.p, gas.T, p_beyond, g
        if any_of(inward):
            g_beyond = gas_properties_gamma(P, side, T_beyond)
            p, T = where(inward, p_beyond, gas.p), where(inward, T_beyond, gas.T)
            p_down, g_up = where(inward, gas.p, p_beyond), where(inward, g_beyond, g)
        through = orifice_flow(area, p, T, p_down, g_up, R)
        flow = where(passes, where(inward, through, -through), 0.0)
    return flow


@inline
def supply_of(P, C, side, y):
    """Gas before the intake ports."""
    c = C[side]
    p, T, burnt = c.intake_pressure, c.intake_temperature, 0.0
    if has_crankcase(y, side):
        p, T = crankcase_of(P, C, side, y)
        burnt = y[CRANKCASE_BURNT + side] / y[CRANKCASE_MASS + side]
    return p, T, burnt


@inline
def shares_leaving(P, C, side, y, mass, fuel_share, burnt_share):
    """Shares of fuel, burnt gas and fresh gas in what leaves a cylinder through its ports.

    Fresh gas is what its supply gives; the rest is what was there before.
    """
    fresh = y[FRESH + side]
    x = gas_exchange_fresh_share(P, side, fresh / mass)
    rest = (1.0 - x) / max(mass - fresh, 1e-9 * mass)
    fuel = x * fuel_share + rest * (y[FUEL + side] - fresh * fuel_share)
    burnt = x * burnt_share + rest * (y[BURNT + side] - fresh * burnt_share)
    return fuel, burnt, x


@compiled
def chamber_flows(P, C, side, y, gas):
    """All flows of a chamber at one instant."""
    c = C[side]
    R, mass = c.gas_constant, mass_of(C, side, y)
    g = gas_properties_gamma(P, side, gas.T)
    area_in, area_out, p_exhaust, T_exhaust = 0.0, 0.0, gas.p, gas.T
    p_supply, T_supply, burnt_supply = c.intake_pressure, c.intake_temperature, 0.0
    is_open = c.mode == OPEN
    if any_of(is_open):
        in_now, out_now = gas_exchange_areas(P, side, gas.clearance - c.port)
        area_in, area_out = where(is_open, in_now, 0.0), where(is_open, out_now, 0.0)
        p_exhaust, T_exhaust = gas_exchange_exhaust(P, side)
        p_supply, T_supply, burnt_supply = supply_of(P, C, side, y)
    p_leak, T_leak = leak_beyond(P, side)
    intake = flow_in(P, side, area_in, gas, g, R, p_supply, T_supply)
    exhaust = flow_in(P, side, area_out, gas, g, R, p_exhaust, T_exhaust)
    gap = where(has_own_pressure(C, side), leak_area(P, side, gas), 0.0)
    leak = flow_in(P, side, gap, gas, g, R, p_leak, T_leak)
    # Compositions: of the supply with fuel metered to its air at the ports, of what leaves, of the
    # gas.
    metered = c.fuel_factor * c.equivalence_ratio_wanted * (1.0 - burnt_supply)
    if INJECTION_IS_WANTED:
        metered = where(injects(C, side), 0.0, metered)
    fuel_share = metered / (metered + c.air_fuel_ratio)
    burnt_share = (1.0 - fuel_share) * burnt_supply
    fuel_out, burnt_out, fresh_out = 0.0, 0.0, 0.0
    if any_of(is_open):
        fuel_now, burnt_now, fresh_now = shares_leaving(
            P, C, side, y, mass, fuel_share, burnt_share
        )
        fuel_out, burnt_out = where(is_open, fuel_now, 0.0), where(is_open, burnt_now, 0.0)
        fresh_out = where(is_open, fresh_now, 0.0)
    fuel_here, burnt_here = y[FUEL + side] / mass, y[BURNT + side] / mass
    fresh_here = y[FRESH + side] / mass
    fed, drawn_back = max(intake, 0.0), max(-intake, 0.0)
    back, gone = max(exhaust, 0.0), max(-exhaust, 0.0)
    seeped, leaked = max(leak, 0.0), max(-leak, 0.0)
    leaves = drawn_back + gone
    blown_back, returned = drawn_back * fresh_out, drawn_back * fresh_out * fuel_share
    net = intake + exhaust + leak
    fuel = fed * fuel_share - leaves * fuel_out - leaked * fuel_here
    burnt = fed * burnt_share + back - leaves * burnt_out - leaked * burnt_here
    fresh = fed - leaves * fresh_out - leaked * fresh_here
    h, u = enthalpy_at(P, side, gas.T, R), gas_properties_internal_energy(P, side, gas.T)
    h_supply = enthalpy_at(P, side, T_supply, R)
    h_in = fed * h_supply
    h_in += back * enthalpy_at(P, side, T_exhaust, R) + seeped * enthalpy_at(P, side, T_leak, R)
    out = leaves + leaked
    heat = h_in - (fed + back + seeped) * u - out * R * gas.T
    from_supply = 1.0 - fuel_share
    return Flows(
        ln_p=net / mass + (g - 1.0) * heat / (gas.p * gas.V),
        fuel=fuel,
        air=net - fuel - burnt,
        burnt=burnt,
        fresh=fresh,
        supplied=fed - blown_back,
        supplied_fuel=fed * fuel_share - returned,
        expelled=out - back - seeped - blown_back,
        expelled_fuel=leaves * fuel_out + leaked * fuel_here - returned,
        expelled_fresh=gone * fresh_out + leaked * fresh_here,
        enthalpy=out * h - h_in,
        drawn=fed * from_supply - drawn_back + returned,
        drawn_burnt=fed * burnt_share - drawn_back * burnt_out,
        drawn_enthalpy=fed * from_supply * h_supply - (drawn_back - returned) * h,
    )


@inline
def write_contents(P, C, side, y, rates, dy):
    """Write the rates of the states a chamber's laws ask for."""
    if CONTENTS_ARE_WANTED:
        c, flows = C[side], rates.flows
        burning, burns = 0.0, rates.released > 0.0
        if breathes(C, side) and any_of(burns):
            burning = where(burns, rates.released / c.lower_heating_value, 0.0)
        dy[FUEL + side] = flows.fuel - burning
        dy[AIR + side] = flows.air - c.air_fuel_ratio * burning
        dy[BURNT + side] = flows.burnt + (1.0 + c.air_fuel_ratio) * burning
        dy[FRESH + side] = flows.fresh
        dy[SUPPLIED + side] = flows.supplied
        dy[SUPPLIED_FUEL + side] = flows.supplied_fuel
        dy[EXPELLED + side] = flows.expelled
        dy[EXPELLED_FUEL + side] = flows.expelled_fuel
        dy[EXPELLED_FRESH + side] = flows.expelled_fresh
        dy[ENTHALPY_OUT + side] = flows.enthalpy
    if WALL_TEMPERATURE_IS_WANTED:
        dy[WALL + side] = wall_temperature_rate(P, side, y[WALL + side], rates.lost)
    if CRANKCASE_IS_WANTED:
        write_crankcase(P, C, side, y, rates.flows, dy)


@inline
def displacement_of(C, side, x):
    """Way of a piston from its midpoint, away from its head [m]."""
    return C[side].sign * x


@inline
def crankcase_of(P, C, side, y):
    """Pressure [Pa] and temperature [K] in a crankcase."""
    volume = supply_volume(P, side, displacement_of(C, side, y[X]))
    squeeze = volume / supply_volume(P, side, 0.0)
    p = exp(y[CRANKCASE_THETA + side] - G0 * log(squeeze))
    return Crankcase(p, p * volume / (y[CRANKCASE_MASS + side] * C[side].gas_constant))


@inline
def crankcase_force(P, C, side, y):
    """Force of a crankcase on its piston, over the intake's pressure [N]; right is positive."""
    force = 0.0
    if has_crankcase(y, side):
        rise = crankcase_of(P, C, side, y).p - C[side].intake_pressure
        force = -C[side].sign * supply_piston_area(P, side) * rise
    return force


@compiled
def write_crankcase(P, C, side, y, flows, dy):
    """Write the rates of a crankcase that draws from the intake and feeds the ports."""
    if not has_crankcase(y, side):
        return
    c = C[side]
    R, mass = c.gas_constant, y[CRANKCASE_MASS + side]
    gas = crankcase_of(P, C, side, y)
    p, T = gas.p, gas.T
    volume = supply_volume(P, side, displacement_of(C, side, y[X]))
    growth = -supply_piston_area(P, side) * c.sign * y[V]
    g, u = gas_properties_gamma(P, side, T), gas_properties_internal_energy(P, side, T)
    area = supply_inlet_area(P, side, c.intake_pressure - p)
    inlet = flow_in(P, side, area, gas, g, R, c.intake_pressure, c.intake_temperature)
    h, draws = u + R * T, inlet > 0.0
    if any_of(draws):
        h = where(draws, enthalpy_at(P, side, c.intake_temperature, R), h)
    net = inlet - flows.drawn
    heat = inlet * h - flows.drawn_enthalpy - u * net - p * growth
    # Of the rate of ln p the part G0 dV/V belongs to theta.
    rate = net / mass + (g - 1.0) * heat / (p * volume) - growth / volume
    dy[CRANKCASE_THETA + side] = rate + G0 * growth / volume
    dy[CRANKCASE_MASS + side] = net
    share = y[CRANKCASE_BURNT + side] / mass
    dy[CRANKCASE_BURNT + side] = min(inlet, 0.0) * share - flows.drawn_burnt
    dy[CRANKCASE_WORK + side] = (p - c.intake_pressure) * growth
    # Across the boundary of both: what the ports drew from the crankcase stays within.
    dy[ENTHALPY_OUT + side] += flows.drawn_enthalpy - inlet * h + c.intake_pressure * growth
