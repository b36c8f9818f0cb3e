"""Additional argument of laws in reduced form (:mod:`saleg.compiler.strength_reduction`)."""

from typing import NamedTuple


class Logarithms(NamedTuple):
    """Logarithms of the state of the gas, and constants of a law.

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
