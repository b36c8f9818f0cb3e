"""Compressible flow through an orifice, ideal gas without losses up to the narrowest place.

``m' = A p / sqrt(R T) psi(r)`` with p, T upstream, r the pressure ratio, and
``psi^2 = 2 g / (g - 1) (r^(2/g) - r^((g+1)/g))``, constant below the critical ratio (Heywood,
Internal Combustion Engine Fundamentals, Appendix C).
"""

from math import exp, log, sqrt

from saleg.kernel.jit import inline
from saleg.laws.choice import any_of, where

# Relative pressure difference below which the flow follows a cubic in place of the square root,
# whose slope is infinite at rest: value and slope meet there.
NEARLY_EQUAL = 1e-3
# Above all critical ratios of gases.
NEVER_CHOKED = 0.65


@inline
def flow_function(ratio, g):
    """Dimensionless flow psi [-] at a pressure ratio of at most 1, `g` the ratio of heats."""
    r = min(ratio, 1.0 - NEARLY_EQUAL)
    may_choke = r < NEVER_CHOKED
    if any_of(may_choke):
        r = where(may_choke, max(r, exp(g / (g - 1.0) * log(2.0 / (g + 1.0)))), r)
    a = exp(log(r) / g)
    psi = sqrt(2.0 * g / (g - 1.0) * a * (a - r))
    rests = ratio > 1.0 - NEARLY_EQUAL
    if any_of(rests):
        s = (1.0 - ratio) / NEARLY_EQUAL
        psi *= where(rests, s * (1.25 - 0.25 * s * s), 1.0)
    return psi


@inline
def orifice_flow(area, p, T, p_beyond, g, R):
    """Mass flow [kg/s] through an effective area from `p`, `T` to the lower pressure beyond."""
    return area * p / sqrt(R * T) * flow_function(p_beyond / p, g)
