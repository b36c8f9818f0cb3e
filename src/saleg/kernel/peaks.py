"""Greatest values within a stroke, located between the ends of steps.

A quantity whose rate changes from rising to falling within a step has its peak inside it. It is
approached by shorter steps to where a cubic has its maximum, until the cubic is right about the
value there, and read off a last cubic between there and the nearer end. What the ends of steps show
counts in any case.
"""

from math import sqrt

from saleg.kernel.breathing import breathes, dilution, has_own_pressure
from saleg.kernel.events import cubic, pressure_and_temperature
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    FUEL,
    G0,
    N_PEAKS,
    N_STATE,
    PEAK_ACCELERATION,
    PEAK_PRESSURE_RISE,
    PEAK_TEMPERATURE,
    PEAK_VELOCITY,
    SUPPLIED,
    THETA,
    V,
    X,
)
from saleg.kernel.needs import N_WANTED
from saleg.kernel.rhs import rhs
from saleg.kernel.state import clearance_of
from saleg.kernel.step import take_step
from saleg.laws.choice import where

# Share of the greatest value so far below which both ends of a step promise no greater one within.
PROMISING = 0.7
# Share of the slope of the step before from which a rise goes on beyond the end of a step: with a
# peak within, it is at most half of it for a parabola.
GOES_ON_RISING = 0.8
# How near a cubic must come to the value at its maximum, relatively: so many times the tolerance of
# the steps, and this at least. And how often it is tried.
CLOSE = 100.0
LEAST_CLOSE = 1e-4
LOOKS = 5


@inline
def pressure_rate(C, side, y, dy):
    """Relative rate of the pressure [1/s]."""
    c = C[side]
    rate = dy[THETA + side] - G0 * c.sign * y[V] / clearance_of(C, side, y[X])
    return where(has_own_pressure(C, side), rate, 0.0)


@inline
def watched(C, peak, y, dy):
    """Value of a watched quantity."""
    if peak == PEAK_ACCELERATION:
        return abs(dy[V])
    if peak == PEAK_VELOCITY:
        return abs(y[V])
    side = peak % 2
    p, T = pressure_and_temperature(C, side, y)
    if peak >= PEAK_PRESSURE_RISE:
        return p * pressure_rate(C, side, y, dy)
    return T if peak >= PEAK_TEMPERATURE else p


@inline
def known_rate(C, peak, y, dy):
    """Time derivative of a watched quantity the state gives; relative for all but velocity."""
    if peak == PEAK_VELOCITY:
        return where(y[V] > 0.0, dy[V], -dy[V])
    side = peak % 2
    rate = pressure_rate(C, side, y, dy)
    if peak < PEAK_TEMPERATURE:
        return rate
    if breathes(C, side):
        rate -= dilution(C, side, y, dy)
    rate += C[side].sign * y[V] / clearance_of(C, side, y[X])
    return where(has_own_pressure(C, side), rate, 0.0)


@compiled
def find_slopes(P, E, C, t, way, h, y, dy, spare, slopes, motored):
    """Time derivatives of acceleration and pressure rises, by a difference along the solution.

    Exact ones would need the derivative of every law. `way` is 1 for a difference with what
    follows, -1 for one with what was before: at either end of a step of `h` it stays within.
    """
    dt = way * min(1e-6 * E.length_scale / E.speed_scale, h)
    for n in range(N_STATE):
        spare.y[n] = y[n] + dt * dy[n]
    for n in range(FUEL, min(SUPPLIED, N_WANTED)):
        spare.y[n] = y[n] + dt * dy[n]
    rhs(P, E, C, t + dt, spare.y, spare.dy, motored)
    E.evaluations += 1.0
    for peak in range(N_PEAKS):
        if is_costly(peak):
            later, now = watched(C, peak, spare.y, spare.dy), watched(C, peak, y, dy)
            slopes[peak] = (later - now) / dt


@inline
def top_of_cubic(q0, r0, q1, r1, h):
    """Where a cubic that rises at 0 and falls at `h` is greatest."""
    slope = (q1 - q0) / h
    a = 3.0 * (r0 + r1 - 2.0 * slope)
    b = 2.0 * (3.0 * slope - 2.0 * r0 - r1)
    root = sqrt(max(b * b - 4.0 * a * r0, 0.0))
    # Roots of a u^2 + b u + r0; the falling one, in a form that does not cancel.
    u = 2.0 * r0 / (root - b) if b <= 0.0 else -(b + root) / (2.0 * a)
    return h * min(max(u, 0.0), 1.0)


@compiled
def watch_point(C, y, dy, peaks):
    """Take the present values into account."""
    for peak in range(N_PEAKS):
        peaks[peak] = max(peaks[peak], watched(C, peak, y, dy))


@inline
def is_costly(peak):
    """Whether the rate of a watched quantity needs an evaluation of its own."""
    return peak == PEAK_ACCELERATION or PEAK_PRESSURE_RISE <= peak < PEAK_VELOCITY


@inline
def rises(C, peak, y, dy):
    """Whether a watched quantity with a known rate rises: the sign of that rate, undivided."""
    if peak == PEAK_VELOCITY:
        return known_rate(C, peak, y, dy) > 0.0
    side = peak % 2
    c = C[side]
    share = G0 if peak < PEAK_TEMPERATURE else G0 - 1.0
    closer = dy[THETA + side] * clearance_of(C, side, y[X]) - share * c.sign * y[V]
    if peak >= PEAK_TEMPERATURE and breathes(C, side):
        closer -= dilution(C, side, y, dy) * clearance_of(C, side, y[X])
    return has_own_pressure(C, side) & (closer > 0.0)


@inline
def is_passed(C, peak, y, dy, y_new, dy_new):
    """Whether a quantity with a known rate rises at the begin of a step and falls at its end."""
    return where(rises(C, peak, y_new, dy_new), False, rises(C, peak, y, dy))


@inline
def watch_step(P, E, C, O, tableau, h, y, k, y_new, peaks, spare):
    """Take the peaks within a step from `y` to `y_new` into account.

    Only if the options ask for all (`peaks` = 2) are those of acceleration and pressure rise
    located and the others approached by further steps: that costs evaluations. Maxima at events
    are left to :func:`watch_point`.
    """
    if h <= 0.0:
        return
    dy, dy_new = k[0], k[tableau.b.shape[0]]
    if O.peaks > 1:
        keep_slopes(E, spare)
    for peak in range(N_PEAKS):
        if is_costly(peak):
            if O.peaks > 1:
                expected = may_peak(C, peak, h, y, dy, y_new, dy_new, peaks, spare.trail)
                q0, q1 = watched(C, peak, y, dy), watched(C, peak, y_new, dy_new)
                spare.trail[peak] = q0
                peaks[peak] = max(peaks[peak], q0, q1)
                if expected:
                    approach_peak(P, E, C, O, tableau, h, y, k, y_new, peaks, spare, peak)
        elif rises(C, peak, y, dy) and not rises(C, peak, y_new, dy_new):
            if O.peaks > 1:
                approach_peak(P, E, C, O, tableau, h, y, k, y_new, peaks, spare, peak)
            else:
                q0, r0 = known_value_and_rate(C, peak, y, dy)
                q1, r1 = known_value_and_rate(C, peak, y_new, dy_new)
                top = cubic(q0, r0, q1, r1, h, top_of_cubic(q0, r0, q1, r1, h))
                peaks[peak] = max(peaks[peak], q0, q1, top)
    spare.trail[N_PEAKS] = h


@inline
def may_peak(C, peak, h, y, dy, y_new, dy_new, peaks, trail):
    """Whether a quantity without a known rate may have a new peak within a step.

    Its values here and at the begin of the step before (in `trail`, whose last entry is the length
    of that step) rule most steps out; it costs no evaluation. Within the first step after an event,
    for which that length is 0, all may have begun and ended.
    """
    before, h_before = trail[peak], trail[N_PEAKS]
    q0, q1 = watched(C, peak, y, dy), watched(C, peak, y_new, dy_new)
    begins = h_before <= 0.0
    slope, slope_before = (q1 - q0) / h, (q0 - before) / where(begins, h, h_before)
    reach = q0 + h * max(slope_before, 0.0)
    high = (q0 > PROMISING * peaks[peak]) | (q1 > PROMISING * peaks[peak]) | (reach > peaks[peak])
    slows = where(slope_before > 0.0, slope < GOES_ON_RISING * slope_before, slope > 0.0)
    return begins | (high & slows)


@inline
def forget_slopes(slopes):
    """Nothing is known of the slopes at either end of a step."""
    slopes[0, N_PEAKS] = slopes[1, N_PEAKS] = -1.0


@inline
def keep_slopes(E, spare):
    """Take the slopes at the end of the step before, if they were found, for those at the begin."""
    slopes = spare.slopes
    if slopes[1, N_PEAKS] == E.steps - 1.0 and spare.trail[N_PEAKS] > 0.0:
        for peak in range(N_PEAKS):
            slopes[0, peak] = slopes[1, peak]
        slopes[0, N_PEAKS] = E.steps


@inline
def known_value_and_rate(C, peak, y, dy):
    """A watched quantity and its time derivative where the state gives both."""
    value, rate = watched(C, peak, y, dy), known_rate(C, peak, y, dy)
    return value, rate if peak == PEAK_VELOCITY else rate * value


@inline
def look_at(P, E, C, t, way, h, y, dy, spare, slopes, motored):
    """Find the slopes at one end of the present step, unless they are known."""
    if slopes[N_PEAKS] != E.steps:
        find_slopes(P, E, C, t, way, h, y, dy, spare, slopes, motored)
        slopes[N_PEAKS] = E.steps


@compiled
def value_and_rate(P, E, C, peak, t, way, h, y, dy, spare, slopes, motored):
    """A watched quantity and its time derivative, on the later or the earlier side of a time."""
    if is_costly(peak):
        look_at(P, E, C, t, way, h, y, dy, spare, slopes, motored)
        return watched(C, peak, y, dy), slopes[peak]
    return known_value_and_rate(C, peak, y, dy)


@compiled
def approach_peak(P, E, C, O, tableau, h, y, k, y_new, peaks, spare, peak):
    """Locate a peak within a step by shorter steps of the same method, and a cubic from there."""
    t, motored, close = E.t, O.motored, min(CLOSE * O.tolerance, LEAST_CLOSE)
    last = tableau.b.shape[0]
    end, dy = k[last], spare.rates[last]
    slopes, inner = spare.slopes, spare.y_new
    low, high = 0.0, h
    q0, r0 = value_and_rate(P, E, C, peak, t, 1.0, h, y, k[0], spare, slopes[0], motored)
    if r0 <= 0.0:
        return
    q1, r1 = value_and_rate(P, E, C, peak, t + h, -1.0, h, y_new, end, spare, slopes[1], motored)
    peaks[peak] = max(peaks[peak], q0, q1)
    for _ in range(LOOKS):
        if r0 <= 0.0 or r1 > 0.0:
            return
        way = top_of_cubic(q0, r0, q1, r1, high - low)
        top, s = cubic(q0, r0, q1, r1, high - low, way), low + way
        if top < PROMISING * peaks[peak] or not low < s < high:
            return
        for n in range(N_WANTED):
            spare.rates[0, n] = k[0, n]
        take_step(P, E, C, O, tableau, t, s, y, spare.rates, inner)
        slopes[2, N_PEAKS] = -1.0  # those of another place than before
        q, r = value_and_rate(
            P, E, C, peak, t + s, 1.0, h - s, inner, dy, spare, slopes[2], motored
        )
        peaks[peak] = max(peaks[peak], q)
        if r > 0.0:
            low, q0, r0 = s, q, r
        else:
            high, q1, r1 = s, q, r
        if abs(top - q) <= close * q:
            rest = top_of_cubic(q0, r0, q1, r1, high - low)
            peaks[peak] = max(peaks[peak], cubic(q0, r0, q1, r1, high - low, rest))
            return
