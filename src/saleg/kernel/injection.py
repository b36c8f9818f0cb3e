"""Fuel injected into the closed chamber: when, and what becomes of the charge."""

from math import log

from saleg.kernel.breathing import energy_of, enthalpy_of_fuel, mass_gas_of
from saleg.kernel.charges import arm_charge, mass_gas_with, put_contents
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import CLOSED, MOTORED, THETA, X
from saleg.kernel.rhs import AT_BREAKPOINT
from saleg.kernel.slots import scatter_fuel_factor
from saleg.kernel.state import clearance_of


@inline
def injection_is_due(E, C, side, y):
    """Whether a piston on its way in stands where fuel is to be injected."""
    c = C[side]
    inward = c.sign * E.direction < 0.0
    beyond = clearance_of(C, side, y[X]) - c.injection_place
    reached = beyond <= AT_BREAKPOINT * E.length_scale
    return (c.injection_due > 0.0) & (c.mode == CLOSED) & inward & reached


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
