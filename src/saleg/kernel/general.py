"""One Runge-Kutta step with any explicit tableau."""

from saleg.kernel.jit import compiled
from saleg.kernel.layout import FUEL, N_STATE, SUPPLIED
from saleg.kernel.needs import N_WANTED
from saleg.kernel.rhs import rhs


@compiled
def take_general_step(P, E, C, tableau, t, h, y, k, y_new, motored):
    """Advance `y` by `h` into `y_new`, as :func:`saleg.kernel.step.take_step`."""
    A, b, c = tableau.A, tableau.b, tableau.c
    stages = b.shape[0]
    for i in range(1, stages):
        for n in range(N_STATE):
            y_new[n] = y[n]
        for n in range(FUEL, min(SUPPLIED, N_WANTED)):
            y_new[n] = y[n]
        for j in range(i):
            weight = h * A[i, j]
            if weight != 0.0:
                for n in range(N_STATE):
                    y_new[n] += weight * k[j, n]
                for n in range(FUEL, min(SUPPLIED, N_WANTED)):
                    y_new[n] += weight * k[j, n]
        rhs(P, E, C, t + c[i] * h, y_new, k[i], motored)
    for n in range(N_WANTED):
        y_new[n] = y[n]
    for j in range(stages):
        weight = h * b[j]
        if weight != 0.0:
            for n in range(N_WANTED):
                y_new[n] += weight * k[j, n]
    rhs(P, E, C, t + h, y_new, k[stages], motored)
    E.evaluations += stages
