"""Events of a step: which are crossed, and exactly where."""

from math import exp, inf, isfinite, log1p, sqrt

from saleg.kernel.breathing import breathes, dilution, has_own_pressure, mass_gas_of
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    BREAKPOINT,
    BURNING,
    CLOSED,
    CORNER,
    DEAD_CENTRE,
    DISARMED,
    G0,
    HEAD,
    IGNITION,
    LIGHT,
    N_EVENTS,
    N_STATE,
    OPEN,
    PORT,
    THETA,
    V,
    X,
)
from saleg.kernel.needs import N_WANTED
from saleg.kernel.rhs import ln_clearance_of, ln_temperature, rhs
from saleg.kernel.state import clearance_of
from saleg.kernel.step import take_step
from saleg.laws.choice import any_of, where

# Part of a step over which its end may be moved to an event it was aimed at, over the fourth root
# of the tolerance. The cubic through both ends is wrong by some h^4 / 24 times the fourth
# derivative and the square of this part: below a hundredth of the tolerance. And the most there is.
NEAR_AIM = 0.3
MOST_AIM = 0.01


@inline
def event_is_possible(E, C, event):
    """Whether an event can happen in the present mode and direction.

    Between two dead centres every clearance changes one way, so a port can be crossed once only.
    """
    if event == DEAD_CENTRE:
        return E.direction != 0.0
    if event == CORNER:
        return (E.direction != 0.0) & isfinite(E.x_breakpoint)
    side = event % 2
    c = C[side]
    outward = c.sign * E.direction
    if event < LIGHT:
        return where(c.mode == OPEN, outward < 0.0, outward > 0.0)
    if event < BREAKPOINT:
        return (c.mode == CLOSED) & (c.armed > DISARMED)
    if event < HEAD:
        return (c.mode != OPEN) & (c.ln_breakpoint > 0.0)
    return (outward < 0.0) & ((c.mode != OPEN) | (c.port < c.head_gap))


@inline
def event_value(E, C, event, y):
    """A number that is negative before the event and positive after it."""
    if event == DEAD_CENTRE:
        return -E.direction * y[V]
    if event == CORNER:
        return E.direction * (y[X] - E.x_breakpoint)
    side = event % 2
    c = C[side]
    if event < LIGHT:
        beyond = clearance_of(C, side, y[X]) - c.port
        return where(c.mode == OPEN, -beyond, beyond)
    if event < BREAKPOINT:
        return y[IGNITION + side] - 1.0
    if event < HEAD:
        return c.beyond_breakpoint * (c.ln_breakpoint - ln_temperature(C, side, y))
    return c.head_gap - clearance_of(C, side, y[X])


@inline
def event_rate(E, C, event, y, dy):
    """Time derivative of :func:`event_value`."""
    if event == DEAD_CENTRE:
        return -E.direction * dy[V]
    if event == CORNER:
        return E.direction * y[V]
    side = event % 2
    c = C[side]
    if event < LIGHT:
        return -c.sign * y[V] if c.mode == OPEN else c.sign * y[V]
    if event < BREAKPOINT:
        return dy[IGNITION + side]
    if event < HEAD:
        clearance = clearance_of(C, side, y[X])
        rate = dy[THETA + side] + (1.0 - G0) * c.sign * y[V] / clearance
        if breathes(C, side):
            rate -= dilution(C, side, y, dy)
        return -c.beyond_breakpoint * rate
    return -c.sign * y[V]


@inline
def place_of(E, C, event):
    """Position of a port, or of the next breakpoint of a force [m]."""
    if event == CORNER:
        return E.x_breakpoint
    c = C[event - PORT]
    return c.sign * (c.port - c.half_stroke)


@inline
def land(E, C, event, y):
    """Put the state exactly on the event it was located at."""
    if event == DEAD_CENTRE:
        y[V] = 0.0
    elif event == CORNER:
        y[X] = E.x_breakpoint
    elif event < LIGHT:
        y[X] = place_of(E, C, event)
    elif event < BREAKPOINT:
        y[IGNITION + event % 2] = 1.0
    elif event < HEAD:
        c = C[event % 2]
        c.beyond_breakpoint = -c.beyond_breakpoint


@inline
def cubic(g0, r0, g1, r1, h, s):
    """Cubic Hermite interpolation of a value with its rates at 0 and `h`, at `s`."""
    u = s / h
    w = 1.0 - u
    return w * w * ((1.0 + 2.0 * u) * g0 + s * r0) + u * u * ((3.0 - 2.0 * u) * g1 - w * h * r1)


@inline
def cubic_rate(g0, r0, g1, r1, h, s):
    """Derivative of :func:`cubic`."""
    u = s / h
    w = 1.0 - u
    return 6.0 * u * w * (g1 - g0) / h + w * (w - 2.0 * u) * r0 + u * (u - 2.0 * w) * r1


@inline
def cubic_root(g0, r0, g1, r1, h):
    """Where the cubic changes sign from g0 < 0 to g1 > 0: Newton's method within a bracket."""
    low, high = 0.0, h
    s = h * g0 / (g0 - g1)
    for _ in range(40):
        value = cubic(g0, r0, g1, r1, h, s)
        if value > 0.0:
            high = s
        else:
            low = s
        newton = s - value / cubic_rate(g0, r0, g1, r1, h, s)
        s_next = newton if low < newton < high else 0.5 * (low + high)
        if abs(s_next - s) <= 1e-9 * h:
            return s_next
        s = s_next
    return s


@inline
def guessed_time(E, C, event, h, y, y_new, dy, dy_new):
    """Time within a step at which an event that was crossed is expected, by interpolation."""
    g0, r0 = event_value(E, C, event, y), event_rate(E, C, event, y, dy)
    g1, r1 = event_value(E, C, event, y_new), event_rate(E, C, event, y_new, dy_new)
    if g0 >= 0.0 or h <= 0.0:
        return 0.0
    if LIGHT <= event < BREAKPOINT and g0 > -0.9:  # the integral grows about exponentially
        g0, r0, g1, r1 = log1p(g0), r0 / (1.0 + g0), log1p(g1), r1 / (1.0 + g1)
    return cubic_root(g0, r0, g1, r1, h)


@inline
def first_event(E, C, stages, h, y, y_new, k, landed):
    """Event crossed first between `y` and `y_new`, or -1, and when, both by interpolation.

    `landed` is the event the step already ends at; it is not looked at again.
    """
    first, earliest = -1, inf
    for event in range(N_EVENTS):
        if event == landed or not event_is_possible(E, C, event):
            continue
        if not event_value(E, C, event, y_new) > 0.0:
            continue
        guess = guessed_time(E, C, event, h, y, y_new, k[0], k[stages])
        if guess < earliest:
            first, earliest = event, guess
    return first, earliest


@inline
def nearness(O):
    """Part of a step over which a state may be carried to its event without another step."""
    return min(3.0 * sqrt(O.tolerance), 0.05) if O.adaptive == 1 else 1e-8


@compiled
def carry(P, E, C, O, stages, t, s, ds, y, k, y_new):
    """Move the end of a step of length `s` a little, along the cubic through both ends."""
    end = k[stages]
    u, w = 1.0 + ds / s, -ds / s
    # As an increment: what does not change stays as it is to the last bit.
    for n in range(N_WANTED):
        back = (1.0 + 2.0 * u) * (y[n] - y_new[n]) + u * s * k[0, n]
        y_new[n] += w * w * back - u * u * w * s * end[n]
    if O.peaks > 1 or O.history > 0:  # somebody looks at the rates there
        rhs(P, E, C, t + s + ds, y_new, end, O.motored)
        E.evaluations += 1.0


@compiled
def locate(P, E, C, O, tableau, t, h, guess, y, k, y_new, event):
    """Shorten a step so that it ends on an event; returns its length.

    Newton's method on the length of the step itself, kept within a bracket: the state at the event
    is that of one Runge-Kutta step to it, so the order of the method is kept. The last small
    correction is made along a cubic, whose error is then far below that of the step.
    """
    stages = tableau.b.shape[0]
    before = event_value(E, C, event, y)
    if before >= 0.0 and event_rate(E, C, event, y, k[0]) > 0.0:
        take_step(P, E, C, O, tableau, t, 0.0, y, k, y_new)
        return 0.0
    low, high = 0.0, h
    s = guess if before < 0.0 else 0.5 * h
    for _ in range(100):
        take_step(P, E, C, O, tableau, t, s, y, k, y_new)
        value = event_value(E, C, event, y_new)
        if value <= 0.0:
            low = s
        else:  # also where the step left the domain of the equations
            high = s
        ds = -value / event_rate(E, C, event, y_new, k[stages])
        if abs(ds) <= nearness(O) * s and 0.0 < s + ds <= h:
            if abs(ds) > 1e-15 * h:
                carry(P, E, C, O, stages, t, s, ds, y, k, y_new)
            return s + ds
        if high - low <= 1e-15 * h:
            break
        s = s + ds if low < s + ds < high else 0.5 * (low + high)
    return s


@inline
def expected_event(E, C, y, dy):
    """Next dead centre or place and the time to it, extrapolated; -1 if it is far or imminent.

    What cannot change by enough in the time looked ahead is not extrapolated: divisions take long.
    """
    first, earliest, least = -1, 2.0 * E.next_step, 1e-4 * E.next_step
    v, a, jerk = y[V], dy[V], E.jerk
    change = earliest * (abs(a) + 0.5 * earliest * abs(jerk))
    slows = (E.direction * v > 0.0) & (E.direction * a < 0.0) & (abs(v) <= change)
    if any_of(slows):
        s = -v / a
        s -= (v + s * (a + 0.5 * s * jerk)) / (a + s * jerk)
        sooner = slows & (least < s) & (s < earliest)
        first, earliest = where(sooner, DEAD_CENTRE, first), where(sooner, s, earliest)
    reach = earliest * (abs(v) + change)
    for event in (CORNER, PORT, PORT + 1):
        way = place_of(E, C, event) - y[X]
        possible = (v != 0.0) & (abs(way) <= reach) & event_is_possible(E, C, event)
        if any_of(possible):
            s = way / v
            for _ in range(2):
                rest = s * (v + s * (0.5 * a + s * jerk / 6.0)) - way
                s -= rest / (v + s * (a + 0.5 * s * jerk))
            sooner = possible & (least < s) & (s < earliest)
            first, earliest = where(sooner, event, first), where(sooner, s, earliest)
    return first, earliest


@compiled
def reached(P, E, C, O, stages, t, h, y, k, y_new, event):
    """Move the end of a step to an event it was aimed at and only just missed, if it did.

    Where the cubic through both ends meets it, for dead centres and places are linear in the state.
    Returns the length of the step, or -1.0 if the event is further away.
    """
    g0, r0 = event_value(E, C, event, y), event_rate(E, C, event, y, k[0])
    g1, r1 = event_value(E, C, event, y_new), event_rate(E, C, event, y_new, k[stages])
    room, s = h * min(NEAR_AIM * sqrt(sqrt(O.tolerance)), MOST_AIM), h - g1 / r1
    if not abs(s - h) <= room:
        return -1.0
    for _ in range(2):
        s -= cubic(g0, r0, g1, r1, h, s) / cubic_rate(g0, r0, g1, r1, h, s)
    if not abs(s - h) <= 2.0 * room:
        return -1.0
    carry(P, E, C, O, stages, t, h, s - h, y, k, y_new)
    return s


@inline
def is_sound(C, y):
    """Whether a state is finite and both pistons are short of their heads."""
    states, quadratures = 0.0, 0.0  # two sums, not finite if any of their terms is not
    for n in range(N_STATE):
        states += y[n]
    for n in range(N_STATE, N_WANTED):
        quadratures += y[n]
    sound = (clearance_of(C, 0, y[X]) > 0.0) & (clearance_of(C, 1, y[X]) > 0.0)
    return sound & isfinite(states + quadratures)


@inline
def next_time_event(C, t_end):
    """Earliest known time of an event: breakpoint or end of a combustion, or end of the run."""
    t = t_end
    for side in range(2):
        t = where(C[side].mode == BURNING, min(t, C[side].t_breakpoint), t)
    return t


@inline
def ln_pressure(C, side, x, theta):
    """Natural logarithm of the pressure in a closed chamber."""
    return theta - G0 * ln_clearance_of(C, side, x)


@inline
def pressure_and_temperature(C, side, y):
    """Pressure [Pa] and temperature [K] in a chamber, open or closed."""
    c = C[side]
    p, T, own = c.intake_pressure, c.intake_temperature, has_own_pressure(C, side)
    if any_of(own):
        p = where(own, exp(ln_pressure(C, side, y[X], y[THETA + side])), p)
        pV = p * c.area * clearance_of(C, side, y[X])
        T = where(own, pV / mass_gas_of(C, side, y), T)
    return p, T
