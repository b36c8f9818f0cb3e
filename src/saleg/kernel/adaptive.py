"""Step of the adaptive pair, in plain Python by the general method.

In a composed module :mod:`saleg.compiler.unrolled` stands in its place: the same, written out.
"""

from saleg.kernel.general import take_general_step
from saleg.kernel.jit import compiled, inline
from saleg.kernel.tableaus import ADAPTIVE


@compiled
def take_adaptive_step(P, E, C, t, h, y, k, y_new, motored):
    """Advance `y` by `h` into `y_new` with the adaptive pair."""
    take_general_step(P, E, C, ADAPTIVE, t, h, y, k, y_new, motored)


@inline
def defect(k, n):
    """Estimated error of an entry of the state over the length of the step."""
    return sum(weight * k[j, n] for j, weight in enumerate(ADAPTIVE.e))
