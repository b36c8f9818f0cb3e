"""Events of a step: which are crossed, and exactly where."""

from math import exp, inf, isfinite, log

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    BURNING,
    CLOSED,
    DEAD_CENTRE,
    G0,
    HEAD,
    IGNITION,
    LIGHT,
    N_ALL,
    N_EVENTS,
    OPEN,
    THETA,
    V,
    X,
)
from saleg.kernel.rhs import height_of
from saleg.kernel.step import take_step


@inline
def event_is_possible(E, C, event):
    """Whether an event can happen in the present mode and direction.

    Between two dead centres every height changes one way, so a port can be crossed once only.
    """
    if event == DEAD_CENTRE:
        return E.direction != 0.0
    side = (event - 1) % 2
    c = C[side]
    outward = c.sign * E.direction
    if event < LIGHT:
        return outward < 0.0 if c.mode == OPEN else outward > 0.0
    if event < HEAD:
        return c.mode == CLOSED and c.armed == 1
    return outward < 0.0 and c.mode != OPEN


@inline
def event_value(E, C, event, y):
    """A number that is negative before the event and positive after it."""
    if event == DEAD_CENTRE:
        return -E.direction * y[V]
    side = (event - 1) % 2
    c = C[side]
    if event < LIGHT:
        beyond = height_of(C, side, y[X]) - c.port
        return -beyond if c.mode == OPEN else beyond
    if event < HEAD:
        return y[IGNITION + side] - 1.0
    return c.head_gap - height_of(C, side, y[X])


@inline
def event_rate(E, C, event, y, dy):
    """Time derivative of :func:`event_value`."""
    if event == DEAD_CENTRE:
        return -E.direction * dy[V]
    side = (event - 1) % 2
    c = C[side]
    if event < LIGHT:
        return -c.sign * y[V] if c.mode == OPEN else c.sign * y[V]
    if event < HEAD:
        return dy[IGNITION + side]
    return -c.sign * y[V]


@inline
def land(C, event, y):
    """Put the state exactly on the event it was located at."""
    if event == DEAD_CENTRE:
        y[V] = 0.0
    elif event < LIGHT:
        c = C[(event - 1) % 2]
        y[X] = c.sign * (c.port - c.half_stroke)
    elif event < HEAD:
        y[IGNITION + (event - 1) % 2] = 1.0


@inline
def cubic(g0, r0, g1, r1, h, s):
    """Cubic Hermite interpolation of a value with its rates at 0 and `h`, at `s`."""
    u = s / h
    w = 1.0 - u
    return w * w * ((1.0 + 2.0 * u) * g0 + s * r0) + u * u * ((3.0 - 2.0 * u) * g1 - w * h * r1)


@inline
def cubic_root(g0, r0, g1, r1, h):
    """Where the cubic changes sign between 0 and `h`."""
    low, high = 0.0, h
    for _ in range(30):
        middle = 0.5 * (low + high)
        if cubic(g0, r0, g1, r1, h, middle) > 0.0:
            high = middle
        else:
            low = middle
    return high


@compiled
def first_event(E, C, stages, h, y, y_new, k, landed):
    """Event crossed first between `y` and `y_new` by interpolation, or -1.

    `landed` is the event the step already ends at; it is not looked at again.
    """
    first, earliest = -1, inf
    for event in range(N_EVENTS):
        if event == landed or not event_is_possible(E, C, event):
            continue
        after = event_value(E, C, event, y_new)
        if not after > 0.0:
            continue
        before = event_value(E, C, event, y)
        guess = 0.0
        if before < 0.0 and h > 0.0:
            r0 = event_rate(E, C, event, y, k[0])
            r1 = event_rate(E, C, event, y_new, k[stages])
            guess = cubic_root(before, r0, after, r1, h)
        if guess < earliest:
            first, earliest = event, guess
    return first


@compiled
def locate(P, E, C, tableau, t, h, y, k, y_new, event, motored):
    """Shorten a step so that it ends on an event; returns its length.

    Newton's method on the length of the step itself, kept within a bracket: the state at the event
    is that of one Runge-Kutta step to it, so the order of the method is kept.
    """
    stages = tableau[1].shape[0]
    before = event_value(E, C, event, y)
    if before >= 0.0 and event_rate(E, C, event, y, k[0]) > 0.0:
        take_step(P, E, C, tableau, t, 0.0, y, k, y_new, motored)
        return 0.0
    low, high = 0.0, h
    s = 0.5 * h
    if before < 0.0:
        after = event_value(E, C, event, y_new)
        r0 = event_rate(E, C, event, y, k[0])
        r1 = event_rate(E, C, event, y_new, k[stages])
        s = cubic_root(before, r0, after, r1, h)
    for _ in range(100):
        take_step(P, E, C, tableau, t, s, y, k, y_new, motored)
        value = event_value(E, C, event, y_new)
        if value <= 0.0:
            low = s
        else:  # also where the step left the domain of the equations
            high = s
        newton = s - value / event_rate(E, C, event, y_new, k[stages])
        if abs(newton - s) <= 1e-13 * h or high - low <= 1e-15 * h:
            break
        s = newton if low < newton < high else 0.5 * (low + high)
    return s


@compiled
def is_sound(C, y):
    """Whether a state is finite and both pistons are short of their heads."""
    for n in range(N_ALL):
        if not isfinite(y[n]):
            return False
    return height_of(C, 0, y[X]) > 0.0 and height_of(C, 1, y[X]) > 0.0


@compiled
def next_time_event(C, t_end):
    """Earliest known time at which something happens: end of combustion, or of the run."""
    t = t_end
    for side in range(2):
        if C[side].mode == BURNING:
            t = min(t, C[side].t_end)
    return t


@inline
def ln_pressure(C, side, x, theta):
    """Natural logarithm of the pressure in a closed chamber."""
    return theta - G0 * log(height_of(C, side, x) / C[side].half_stroke)


@inline
def pressure_and_temperature(C, side, y):
    """Pressure [Pa] and temperature [K] in a chamber, open or closed."""
    c = C[side]
    if c.mode == OPEN:
        return c.intake_pressure, c.intake_temperature
    p = exp(ln_pressure(C, side, y[X], y[THETA + side]))
    return p, p * c.area * height_of(C, side, y[X]) / (c.mass * c.gas_constant)
