"""One Runge-Kutta step, of the adaptive pair or with any explicit tableau, and its error."""

from math import inf, isfinite

from saleg.kernel.adaptive import defect, grows_manifold, late_defect, take_adaptive_step
from saleg.kernel.breathing import mass_of
from saleg.kernel.general import take_general_step
from saleg.kernel.jit import inline
from saleg.kernel.layout import (
    AIR,
    CRANKCASE_MASS,
    CRANKCASE_THETA,
    CURRENT,
    FRAME_V,
    FRAME_X,
    FUEL,
    IGNITION,
    MOTORED,
    THETA,
    WALL,
    V,
    X,
)
from saleg.kernel.needs import (
    CONTENTS_ARE_WANTED,
    CRANKCASE_IS_WANTED,
    CURRENT_IS_WANTED,
    FRAME_IS_WANTED,
    MOTORED_PRESSURE_IS_WANTED,
    WALL_TEMPERATURE_IS_WANTED,
)
from saleg.laws.choice import any_of, where

# Share of fuel in a charge below which its error counts as if there were so much.
FUEL_SHARE = 0.02


@inline
def take_step(P, E, C, O, tableau, t, h, y, k, y_new):
    """Advance `y` by `h` into `y_new`.

    On entry ``k[0]`` holds the rates at `t`; on return ``k[s]``, s the
    number of stages, holds those at `t + h`. Quadratures need no stage values, so they are summed
    only once, at the end.
    """
    if O.adaptive == 1:
        take_adaptive_step(P, E, C, t, h, y, k, y_new, O.motored)
    else:
        take_general_step(P, E, C, tableau, t, h, y, k, y_new, O.motored)


@inline
def error_norm(E, C, h, y, y_new, k, tolerance):
    """Estimated error of a step of the adaptive pair over the tolerated one; below 1 it is good.

    Position is measured by the stroke, velocity by the natural speed, theta (hence pressure)
    relatively, the ignition integral against the larger of itself and 1, masses in a chamber by
    all of its gas. Where the rate of the ignition integral grows manifold in a step its estimated
    error may pass through zero, so there it is estimated in another way too.
    """
    worst, speed = abs(defect(k, X)) / E.length_scale, abs(defect(k, V)) / E.speed_scale
    worst, total = max(worst, speed), worst + speed  # the total is not finite if any of them is not
    for n in range(THETA, IGNITION):
        error = abs(defect(k, n))
        worst, total = max(worst, error), total + error
    for n in range(IGNITION, MOTORED):
        error = abs(defect(k, n))
        manifold = grows_manifold(k, n)
        if any_of(manifold):
            error = where(manifold, max(error, abs(late_defect(k, n))), error)
        error /= max(1.0, abs(y[n]), abs(y_new[n]))
        worst, total = max(worst, error), total + error
    if MOTORED_PRESSURE_IS_WANTED:
        for n in range(MOTORED, CURRENT):
            error = abs(defect(k, n))
            worst, total = max(worst, error), total + error
    if CURRENT_IS_WANTED:
        error = abs(defect(k, CURRENT)) / E.current_scale
        worst, total = max(worst, error), total + error
    if CONTENTS_ARE_WANTED:
        for n in range(FUEL, WALL):
            scale = mass_of(C, (n - FUEL) % 2, y_new)
            if n < AIR:
                scale = max(y_new[n], FUEL_SHARE * scale)
            error = abs(defect(k, n)) / scale
            worst, total = max(worst, error), total + error
    if WALL_TEMPERATURE_IS_WANTED:
        for n in range(WALL, CRANKCASE_THETA):
            error = abs(defect(k, n)) / y[n]
            worst, total = max(worst, error), total + error
    if CRANKCASE_IS_WANTED:
        for n in range(CRANKCASE_THETA, CRANKCASE_MASS):
            error = abs(defect(k, n))
            worst, total = max(worst, error), total + error
        for n in range(CRANKCASE_MASS, FRAME_X):
            error = abs(defect(k, n)) / max(y[CRANKCASE_MASS + (n - FUEL) % 2], 1e-300)
            worst, total = max(worst, error), total + error
    if FRAME_IS_WANTED:
        error = abs(defect(k, FRAME_X)) / E.length_scale
        worst, total = max(worst, error), total + error
        error = abs(defect(k, FRAME_V)) / E.speed_scale
        worst, total = max(worst, error), total + error
    return where(isfinite(total), h * worst / tolerance, inf)
