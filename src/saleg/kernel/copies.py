"""Copies of a gas with some fields changed: numba has no ``_replace``."""

from saleg.kernel.jit import inline
from saleg.laws.arguments import Gas


@inline
def gas_in_state(gas, p, T, burning, p_rate):
    """The same gas at another pressure and temperature."""
    return Gas(
        p=p,
        T=T,
        V=gas.V,
        p_motored=gas.p_motored,
        clearance=gas.clearance,
        bore=gas.bore,
        mean_piston_speed=gas.mean_piston_speed,
        wall_temperature=gas.wall_temperature,
        burning=burning,
        clearance_rate=gas.clearance_rate,
        p_rate=p_rate,
    )


@inline
def with_pressure_rate(gas, p_rate):
    """The same gas with the rate of its pressure [Pa/s], as ignition laws are shown it."""
    return gas_in_state(gas, gas.p, gas.T, gas.burning, p_rate)


@inline
def motored_gas(gas, T):
    """The same charge at its motored pressure and the temperature `T` it has there [K]."""
    return gas_in_state(gas, gas.p_motored, T, 0.0, 0.0)
