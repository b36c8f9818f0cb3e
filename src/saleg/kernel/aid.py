"""Logarithms and constants at hand as a law is evaluated: see the compiler's strength reduction."""

from typing import NamedTuple


class Aid(NamedTuple):
    """What the integrator knows beside the gas.

    Attributes
    ----------
    ln_p, ln_T, ln_V : float
        Natural logarithms of pressure [Pa], temperature [K] and volume [m^3].
    first, second, third : float
        Parts of the law's formula that stay the same between two events.
    """

    ln_p: float
    ln_T: float
    ln_V: float
    first: float
    second: float
    third: float
