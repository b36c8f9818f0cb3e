"""One Runge-Kutta step with any explicit tableau, and its error."""

from math import inf, isfinite

from saleg.kernel.jit import compiled
from saleg.kernel.layout import CURRENT, IGNITION, MOTORED, N_ALL, N_STATE, THETA, V, X
from saleg.kernel.rhs import rhs


@compiled
def take_step(P, E, C, tableau, t, h, y, k, y_new, motored):
    """Advance `y` by `h` into `y_new`.

    On entry ``k[0]`` holds the rates at `t`; on return ``k[s]``, s the
    number of stages, holds those at `t + h`. Quadratures need no stage values, so they are summed
    only once, at the end.
    """
    A, b, c = tableau.A, tableau.b, tableau.c
    stages = b.shape[0]
    for i in range(1, stages):
        for n in range(N_STATE):
            y_new[n] = y[n]
        for j in range(i):
            weight = h * A[i, j]
            if weight != 0.0:
                for n in range(N_STATE):
                    y_new[n] += weight * k[j, n]
        rhs(P, E, C, t + c[i] * h, y_new, k[i], motored)
    for n in range(N_ALL):
        y_new[n] = y[n]
    for j in range(stages):
        weight = h * b[j]
        if weight != 0.0:
            for n in range(N_ALL):
                y_new[n] += weight * k[j, n]
    rhs(P, E, C, t + h, y_new, k[stages], motored)
    E.evaluations += stages


@compiled
def error_norm(E, tableau, h, y, y_new, k, tolerance):
    """Estimated error of a step over the tolerated one; below 1 the step is good.

    Position is measured by the stroke, velocity by the natural speed, theta (hence pressure)
    relatively, the ignition integral against the larger of itself and 1.
    """
    e = tableau.e
    worst = 0.0
    for n in range(N_STATE):
        error = 0.0
        for j in range(e.shape[0]):
            error += e[j] * k[j, n]
        scale = 1.0
        if n == X:
            scale = E.length_scale
        elif n == V:
            scale = E.speed_scale
        elif THETA <= n < IGNITION or MOTORED <= n < CURRENT:
            scale = 1.0
        elif n == CURRENT:
            scale = E.current_scale
        else:
            scale = max(1.0, abs(y[n]), abs(y_new[n]))
        error = abs(h * error) / (scale * tolerance)
        if not isfinite(error):
            return inf
        worst = max(worst, error)
    return worst
