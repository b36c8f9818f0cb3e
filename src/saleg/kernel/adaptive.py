"""Step of the adaptive pair, in plain Python by the general method.

In a composed module :mod:`saleg.compiler.unrolled` stands in its place: the same, written out.
"""

from saleg.kernel.general import take_general_step
from saleg.kernel.jit import compiled, inline
from saleg.kernel.tableaus import ADAPTIVE

# Growth of a rate within a step from which its estimated error is not believed.
MANIFOLD = 9.0


@compiled
def take_adaptive_step(P, E, C, t, h, y, k, y_new, motored):
    """Advance `y` by `h` into `y_new` with the adaptive pair."""
    take_general_step(P, E, C, ADAPTIVE, t, h, y, k, y_new, motored)


@inline
def defect(k, n):
    """Estimated error of an entry of the state over the length of the step."""
    return sum(weight * k[j, n] for j, weight in enumerate(ADAPTIVE.e))


@inline
def late_defect(k, n):
    """The same with the rate at the end of the step in the place of that of its last stage."""
    *before, stage, end = ADAPTIVE.e
    return sum(weight * k[j, n] for j, weight in enumerate((*before, 0.0, stage + end)))


@inline
def grows_manifold(k, n):
    """Whether the rate of an entry at the end of the step is many times that at its begin."""
    return k[len(ADAPTIVE.b), n] > MANIFOLD * k[0, n]
