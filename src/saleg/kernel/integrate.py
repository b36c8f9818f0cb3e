"""The integrator: steps, events, restarts.

One loop serves fixed steps on a grid and the adaptive pair. A step that crosses an event is
shortened to end on it; there modes change and the next step starts afresh.

Arguments shared by functions here: `P` the laws, `E` the engine's record, `C` the two chambers'
records, `O` the options of the run (all in :mod:`saleg.kernel.layout`), `y` the state, `k` the
rates of a step's stages.
"""

from math import copysign, exp, log

from saleg.kernel.control import take_sample
from saleg.kernel.events import (
    expected_event,
    first_event,
    is_sound,
    land,
    locate,
    next_time_event,
    reached,
)
from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import (
    BEGIN,
    BUFFER_FULL,
    CONTROLLER_FAULT,
    DEAD_CENTRE,
    END_OF_STEP,
    END_OF_TIME,
    GOES_ON,
    HEAD,
    HEAD_CONTACT,
    LEFT,
    MAX_STEPS,
    N_PEAKS,
    PEAK_PRESSURE,
    RIGHT,
    STALLED,
    STEP_FAILURE,
    TOO_MANY_STEPS,
    WHOLE,
    V,
    X,
)
from saleg.kernel.needs import N_WANTED
from saleg.kernel.observe import observe
from saleg.kernel.peaks import forget_slopes, watch_point, watch_step
from saleg.kernel.rhs import refresh, rhs
from saleg.kernel.rows import has_room
from saleg.kernel.state import clearance_of, keep_snapshot
from saleg.kernel.step import error_norm, take_step
from saleg.kernel.switch import is_due, switch
from saleg.laws.choice import where

# Logarithm of the least error the controller remembers of a step.
MIN_LN_ERROR = -9.21


@inline
def proposed_end(E, O, t_event):
    """Time at which the next step should end: grid point or controller's wish, or known event."""
    if O.adaptive == 0:
        return min((E.grid + 1.0) * O.step, t_event)
    wish = E.t + E.next_step
    half = 0.5 * (E.t + t_event)  # two equal steps rather than one and a splinter
    divides = E.t + 2.0 * E.next_step > t_event
    return where(wish >= t_event, t_event, where(divides, half, wish))


@inline
def compression(C, y, y_new):
    """Clearance on the side that is compressed at the end of a step over that at its begin."""
    leftward = y_new[V] < 0.0
    before = where(leftward, clearance_of(C, LEFT, y[X]), clearance_of(C, RIGHT, y[X]))
    after = where(leftward, clearance_of(C, LEFT, y_new[X]), clearance_of(C, RIGHT, y_new[X]))
    return min(after / before, 1.0)


@inline
def control_step(E, C, order, h, error, was_rejected, y, y_new):
    """Next step from the error of an accepted one (PI control, Hairer and Wanner), and its log.

    On the way to a head all happens the faster the nearer it is: the step shrinks with the
    clearance before an error says so. One cut short by a known event keeps the wish at least.
    """
    beta = 0.08
    exponent = 1.0 / order - 0.75 * beta
    ln_error = log(max(error, 1e-10))
    factor = 0.9 * exp(beta * E.ln_last_error - exponent * ln_error)
    factor = min(max(factor, 0.2), where(was_rejected, 1.0, 6.0))
    step, wish = h * factor * compression(C, y, y_new), E.next_step
    step = where(was_rejected, step, where(h < wish, max(step, wish), step))
    return step, max(ln_error, MIN_LN_ERROR)


@inline
def shrunk(h, order, error):
    """Step to try after one with too great an error."""
    return h * max(0.2, 0.9 * error ** (-1.0 / order))


@inline
def proposal(E, C, O, t_event, y, dy):
    """Time at which the next step should end, and the event it is aimed at; -1 for none."""
    aim, t_aim = -1, t_event
    if O.adaptive == 1:
        aim, wait = expected_event(E, C, y, dy)
        comes = (aim >= 0) & (E.t + wait < t_event)
        aim, t_aim = where(comes, aim, -1), where(comes, E.t + wait, t_event)
    end = proposed_end(E, O, t_aim)
    return end, where(end < t_aim, -1, aim)


@inline
def smallest_step(E):
    """Step that hardly changes the time [s]."""
    return 4e-16 * max(E.t, E.length_scale / E.speed_scale)


@inline
def good_step(P, E, C, O, tableau, order, t_event, y, k, y_new):
    """Take one step the error control, or the fixed grid, is content with.

    Returns its length, the time it ends at, exactly, and the event it was aimed at, if it still
    is; a length of -1.0 if no step is small enough.
    """
    t = E.t
    end, aim = proposal(E, C, O, t_event, y, k[0])
    h = end - t
    smallest = smallest_step(E)
    rejected = False
    while h > smallest or (h >= 0.0 and not rejected):
        take_step(P, E, C, O, tableau, t, h, y, k, y_new)
        E.steps += 1.0
        if not is_sound(C, y_new):
            h *= 0.5
            rejected = True
            E.rejected += 1.0
            continue
        if O.adaptive == 0:
            return h, t + h if rejected else end, -1
        error = error_norm(E, C, h, y, y_new, k, O.tolerance)
        if error <= 1.0:
            step = control_step(E, C, order, h, error, rejected, y, y_new)
            E.next_step, E.ln_last_error = step
            return h, t + h if rejected else end, -1 if rejected else aim
        E.rejected += 1.0
        rejected = True
        h = shrunk(h, order, error)
        E.next_step = h
    return -1.0, t, -1


@inline
def advance_to_event(P, E, C, O, tableau, h, aim, y, k, y_new):
    """End the step just taken on the first event in it; returns its length and the event."""
    stages = tableau.b.shape[0]
    landed = -1
    if aim >= 0:
        length = reached(P, E, C, O, stages, E.t, h, y, k, y_new, aim)
        if length > 0.0:
            h, landed = length, aim
    for _ in range(16):
        event, guess = first_event(E, C, stages, h, y, y_new, k, landed)
        if event < 0:
            break
        h = locate(P, E, C, O, tableau, E.t, h, guess, y, k, y_new, event)
        landed = event
    if landed >= 0:
        land(E, C, landed, y_new)
    return h, landed


@inline
def accept(E, O, h, full, end, y, y_new, k, stages):
    """Make the end of a step the present state."""
    E.t = end if h == full else E.t + h
    E.jerk = (k[stages, V] - k[0, V]) / h if h > 0.0 else 0.0
    if O.adaptive == 0 and E.t >= (E.grid + 1.0) * O.step:
        E.grid += 1.0
    for n in range(N_WANTED):
        y[n] = y_new[n]
        k[0, n] = k[stages, n]


@inline
def observe_now(P, E, C, O, y, dy, tables):
    """Record the instant of a state."""
    filled = tables.filled[0]
    observe(P, E, C, y, dy, O.motored, tables.history[filled.history])
    filled.history += 1


@compiled
def observe_within(P, E, C, O, tableau, h, y, k, spare, tables):
    """Record instants within a step, each reached by a shorter step of the same method."""
    stages = tableau.b.shape[0]
    t = E.t
    for i in range(1, O.dense + 1):
        part = h * i / (O.dense + 1.0)
        for n in range(N_WANTED):
            spare.rates[0, n] = k[0, n]
        take_step(P, E, C, O, tableau, t, part, y, spare.rates, spare.y_new)
        E.t = t + part
        observe_now(P, E, C, O, spare.y_new, spare.rates[stages], tables)
    E.t = t


@compiled
def begin_anew(P, E, C, O, y, dy, tables):
    """Rates after an event, recorded."""
    rhs(P, E, C, E.t, y, dy, O.motored)
    E.evaluations += 1.0
    if O.history > 0:
        observe_now(P, E, C, O, y, dy, tables)


@inline
def reason_to_stop(E, O, landed):
    """Code of what ends the run at an event; -1 if it goes on."""
    if landed >= HEAD:
        return HEAD_CONTACT
    if landed != DEAD_CENTRE:
        return CONTROLLER_FAULT if E.fault != 0.0 else -1
    if E.strokes > 0.0 and E.stroke < O.stall * E.maximum_stroke:
        return STALLED
    if E.fault != 0.0:
        return CONTROLLER_FAULT
    return END_OF_TIME if E.strokes >= O.last_stroke else -1


@cached
def run_on(run):
    """Integrate until the end, a table is full, or nothing more can be done.

    Takes an :class:`~saleg.kernel.tuples.Integration` and returns one of the codes of
    :mod:`saleg.kernel.layout`. All state is in the arguments, so a call continues where the one
    before stopped. Whoever takes the steps himself (kernel/lanes) asks for the begin, or for the
    end of a step, alone.
    """
    P, E, C, y, O = run.laws[0], run.engine[0], run.chambers, run.y, run.options[0]
    peaks, tables, tableau, control = run.peaks, run.tables, run.tableau, run.control
    k, y_new, spare = run.scratch.rates, run.scratch.y_new, run.scratch.spare
    stages = tableau.b.shape[0]
    last_step = E.steps + O.max_steps
    if O.part != END_OF_STEP:
        spare.trail[N_PEAKS] = 0.0
        forget_slopes(spare.slopes)
        refresh(P, E, C, y)
        rhs(P, E, C, E.t, y, k[0], O.motored)
        E.evaluations += 1.0
        if O.history > 0 and tables.filled[0].history == 0:
            observe_now(P, E, C, O, y, k[0], tables)
        # What is due at the start.
        changed = switch(P, E, C, O, y, -1, peaks, tables, control)
        if E.t >= E.t_sample:
            take_sample(E, y, control.sampling)
            changed = True
        if changed:
            begin_anew(P, E, C, O, y, k[0], tables)
        if O.peaks > 0 and peaks[PEAK_PRESSURE] == 0.0:  # nothing has been watched of this stroke
            watch_point(C, y, k[0], peaks)
    if O.part == BEGIN:
        return GOES_ON
    while E.t < O.t_end:
        if E.steps >= last_step or not has_room(O, tables):
            return BUFFER_FULL
        if O.adaptive == 1 and E.steps - E.steps_at_dead_centre > MAX_STEPS:
            return TOO_MANY_STEPS
        full, end, aim = O.length, O.end, O.aim
        if O.part == WHOLE:
            t_event = next_time_event(C, min(O.t_end, E.t_sample))
            full, end, aim = good_step(P, E, C, O, tableau, run.order, t_event, y, k, y_new)
        if full < 0.0:
            return STEP_FAILURE
        if E.direction == 0.0:
            E.direction = copysign(1.0, y_new[V]) if y_new[V] != 0.0 else 0.0
        h, landed = advance_to_event(P, E, C, O, tableau, full, aim, y, k, y_new)
        if O.peaks > 0:
            watch_step(P, E, C, O, tableau, h, y, k, y_new, peaks, spare)
        if O.dense > 0:
            observe_within(P, E, C, O, tableau, h, y, k, spare, tables)
        accept(E, O, h, full, end, y, y_new, k, stages)
        if O.peaks > 0 and landed >= 0:
            watch_point(C, y, k[0], peaks)
        if O.history > 0 and (landed >= 0 or E.steps % O.history < 1.0):
            observe_now(P, E, C, O, y, k[0], tables)
        changed = False
        if landed >= 0 or is_due(E, C, LEFT, E.t, y) or is_due(E, C, RIGHT, E.t, y):
            changed = switch(P, E, C, O, y, landed, peaks, tables, control)
        if E.t >= E.t_sample:
            take_sample(E, y, control.sampling)
            changed = True
        code = reason_to_stop(E, O, landed)
        if landed == DEAD_CENTRE:
            if E.direction > 0.0:
                keep_snapshot(run.words, y, run.snapshots.y)
            if code != END_OF_TIME:  # else what is due now is left to the call that goes on
                switch(P, E, C, O, y, -1, peaks, tables, control)
        changed = changed or landed >= 0  # rates at an event are those before it, and of close by
        if changed:
            spare.trail[N_PEAKS] = 0.0
            begin_anew(P, E, C, O, y, k[0], tables)
        if code >= 0:
            return code
        if O.peaks > 0 and changed:
            watch_point(C, y, k[0], peaks)
        if O.part == END_OF_STEP:
            return GOES_ON
    return END_OF_TIME
