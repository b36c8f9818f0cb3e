"""Steps of engines side by side: all lanes at once, each its own.

The text of right-hand side, step, error and step control is that of one engine
(:mod:`saleg.kernel.rhs`, :mod:`saleg.kernel.step`, :mod:`saleg.kernel.integrate`), compiled for
numbers of lanes. A step in which something happens is ended by the integrator of one engine, with
the lane's own records; the others meanwhile wait.

Arguments shared by functions here: `P`, `E`, `C`, `y`, `y_new` and `k` as everywhere in the kernel,
but of all lanes; `S` what is remembered of a step; `O` the options, alike for all lanes.
"""

from saleg.compiler.lanes.storage import numbers_of, records_of, rows_of, tables_of
from saleg.compiler.lanes.values import lane_bits
from saleg.compiler.lanes.width import WIDTH
from saleg.kernel.adaptive import take_adaptive_step
from saleg.kernel.events import event_is_possible, event_value, is_sound, next_time_event
from saleg.kernel.integrate import control_step, proposal, shrunk, smallest_step
from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.lanes.group import N_CHANGING, UNWATCHED, put, run_of, take
from saleg.kernel.layout import (
    BUFFER_FULL,
    END_OF_STEP,
    END_OF_TIME,
    GOES_ON,
    LEFT,
    MAX_STEPS,
    N_EVENTS,
    N_PEAKS,
    RIGHT,
    STEP_FAILURE,
    TOO_MANY_STEPS,
    V,
)
from saleg.kernel.needs import N_WANTED
from saleg.kernel.peaks import is_costly, is_passed, may_peak, watched
from saleg.kernel.run_plainly import run_at
from saleg.kernel.step import error_norm
from saleg.kernel.switch import is_due
from saleg.laws.choice import any_of, where

# Stages of the adaptive pair, and the order of its error estimate plus one.
STAGES = 6
N_RATES = STAGES + 1
ORDER = 5.0


@inline
def propose(E, C, O, S, y, dy):
    """Length, end and aim of the next step of the lanes that have moved."""
    moved, t_event = S.moved > 0.0, next_time_event(C, S.t_end)
    end, aim = proposal(E, C, O, t_event, y, dy)
    S.end, S.aim = where(moved, end, S.end), where(moved, aim, S.aim)
    S.h, S.rejected = where(moved, end - E.t, S.h), where(moved, 0.0, S.rejected)


@inline
def something_happens(E, C, S, t, y, y_new):
    """Whether an event is crossed, aimed at or due at the end of a step."""
    happens = (E.direction == 0.0) | (S.aim >= 0.0)
    happens = happens | is_due(E, C, LEFT, t, y_new) | is_due(E, C, RIGHT, t, y_new)
    for event in range(N_EVENTS):
        possible = event_is_possible(E, C, event)
        if any_of(possible):
            happens = happens | (possible & (event_value(E, C, event, y_new) > 0.0))
    return happens


@inline
def something_peaks(C, S, y, y_new, k):
    """Whether a watched quantity may have its peak in a step."""
    dy, dy_new = k[0], k[STAGES]
    peaks = S.watched < 0.0
    for peak in range(N_PEAKS):
        if is_costly(peak):
            peaks = peaks | may_peak(C, peak, S.h, y, dy, y_new, dy_new, S.peaks, S.trail)
        else:
            peaks = peaks | is_passed(C, peak, y, dy, y_new, dy_new)
    return peaks & (S.watched > 0.0)


@inline
def leave_trail(C, S, plain, y, dy):
    """Remember the watched quantities without a known rate at the begin of a step: they count."""
    for peak in range(N_PEAKS):
        if is_costly(peak):
            value = watched(C, peak, y, dy)
            S.trail[peak] = where(plain, value, S.trail[peak])
            S.peaks[peak] = where(plain, max(S.peaks[peak], value), S.peaks[peak])
    S.trail[N_PEAKS] = where(plain, S.h, S.trail[N_PEAKS])


@inline
def move(E, S, plain, t, y, y_new, k):
    """Make the ends of steps in which nothing happens the present state."""
    h, dy, dy_new = S.h, k[0], k[STAGES]
    E.jerk = where(plain, where(h > 0.0, (dy_new[V] - dy[V]) / h, 0.0), E.jerk)
    E.t = where(plain, t, E.t)
    for n in range(N_WANTED):
        y[n] = where(plain, y_new[n], y[n])
        dy[n] = where(plain, dy_new[n], dy[n])
    S.moved = where(plain, 1.0, 0.0)


@compiled
def judge(E, C, O, S, y, y_new, k):
    """Accept or reject the steps just taken, where nothing happens in them.

    Returns the lanes, as bits, in which something happens, then those that cannot go on.
    """
    h, busy, rejected = S.h, S.busy > 0.0, S.rejected > 0.0
    error = error_norm(E, C, h, y, y_new, k, O.tolerance)
    sound = is_sound(C, y_new)
    good = busy & sound & (error <= 1.0) & (h >= 0.0)
    E.steps += where(busy, 1.0, 0.0)
    step, ln_error = control_step(E, C, ORDER, h, error, rejected, y, y_new)
    E.next_step = where(good, step, E.next_step)
    E.ln_last_error = where(good, ln_error, E.ln_last_error)
    t = where(rejected, E.t + h, S.end)
    happens = good & something_happens(E, C, S, t, y, y_new)
    if any_of(good & (S.watched > 0.0)):
        happens = happens | (good & something_peaks(C, S, y, y_new, k))
        leave_trail(C, S, where(happens, False, good), y, k[0])
    move(E, S, where(happens, False, good), t, y, y_new, k)
    over = busy & (E.steps >= S.last_step)
    over = over | (busy & (E.steps - E.steps_at_dead_centre > MAX_STEPS))
    over = where(happens, False, over | (busy & (E.t >= S.t_end)))
    bad = where(good, False, busy)
    if any_of(bad):
        shorter = where(sound, shrunk(h, ORDER, error), 0.5 * h)
        E.next_step = where(bad & sound, shorter, E.next_step)
        E.rejected += where(bad, 1.0, 0.0)
        S.h, S.rejected = where(bad, shorter, h), where(bad, 1.0, S.rejected)
        S.aim = where(bad, -1.0, S.aim)
        over = over | where(shorter > smallest_step(E), False, bad)
    return lane_bits(happens), lane_bits(over)


@inline
def put_in(group, lane):
    """Copy a lane into the rows, its next step due."""
    rows, flat, runs = group.rows, group.flat, group.runs
    step, peaks, trail = group.step[lane, 0], runs.peaks[lane], runs.scratch.spare.trail[lane]
    if group.fresh[lane] > 0:
        O = runs.options[lane, 0]
        step.t_end, step.watched = O.t_end, 1.0 if O.peaks > 1 else 0.0
        step.last_step = runs.engine[lane, 0].steps + O.max_steps
        put(rows.laws, lane, WIDTH, flat.laws[lane])
        put(rows.engine, lane, WIDTH, flat.engine[lane])
        group.fresh[lane] = 0
    step.busy, step.moved = 1.0, 1.0
    if step.watched > 0.0:
        for peak in range(N_PEAKS):
            step.peaks[peak], step.trail[peak] = peaks[peak], trail[peak]
        step.trail[N_PEAKS] = trail[N_PEAKS]
        put(rows.step, lane, WIDTH, flat.step[lane])
    else:
        put(rows.step, lane, WIDTH, flat.step[lane, :UNWATCHED])
    put(rows.engine, lane, WIDTH, flat.engine[lane, :N_CHANGING])
    put(rows.chambers, lane, WIDTH, flat.chambers[lane])
    put(rows.y, lane, WIDTH, runs.y[lane, :N_WANTED])
    put(rows.rates, lane, WIDTH, runs.scratch.rates[lane, 0, :N_WANTED])


@inline
def take_out(group, lane):
    """Copy a lane out of the rows."""
    rows, flat, runs = group.rows, group.flat, group.runs
    step, peaks, trail = group.step[lane, 0], runs.peaks[lane], runs.scratch.spare.trail[lane]
    take(rows.step, lane, WIDTH, flat.step[lane, :UNWATCHED])
    take(rows.engine, lane, WIDTH, flat.engine[lane, :N_CHANGING])
    take(rows.y, lane, WIDTH, runs.y[lane, :N_WANTED])
    take(rows.y_new, lane, WIDTH, runs.scratch.y_new[lane, :N_WANTED])
    rates = runs.scratch.rates[lane, :, :N_WANTED]
    take(rows.rates, lane, WIDTH, rates[0])
    take(rows.rates[STAGES * N_WANTED * WIDTH :], lane, WIDTH, rates[STAGES])
    if step.watched > 0.0:
        take(rows.step, lane, WIDTH, flat.step[lane])
        for n in range(N_PEAKS + 1):
            trail[n] = step.trail[n]
        for peak in range(N_PEAKS):
            peaks[peak] = step.peaks[peak]


@inline
def end_step(group, lane):
    """End a step in which something happens, as for one engine; why the integrator came back."""
    take_out(group, lane)
    run, step = run_of(group.runs, lane), group.step[lane, 0]
    E, O = run.engine[0], run.options[0]
    O.part = END_OF_STEP
    O.length, O.aim = step.h, int(step.aim)
    O.end = step.end if step.rejected == 0.0 else E.t + step.h
    return run_at(group.address, run)


@inline
def reason_of(group, lane):
    """Why a lane cannot go on."""
    take_out(group, lane)
    E, step = group.runs.engine[lane, 0], group.step[lane, 0]
    if E.t >= step.t_end:
        return END_OF_TIME
    if E.steps >= step.last_step:
        return BUFFER_FULL
    if E.steps - E.steps_at_dead_centre > MAX_STEPS:
        return TOO_MANY_STEPS
    return STEP_FAILURE


@inline
def leave(group, lane, code):
    """Let a lane rest: there is nothing to step until another engine is in it."""
    group.codes[lane] = code
    group.step[lane, 0].busy, group.step[lane, 0].h = 0.0, 0.0
    put(group.rows.step, lane, WIDTH, group.flat.step[lane, :UNWATCHED])


@inline
def see_to(group, happens, over):
    """Do by each lane what cannot be done by all; how many of them have come back."""
    count = 0
    for lane in range(WIDTH):
        code = GOES_ON
        if (happens >> lane) & 1:
            code = end_step(group, lane)
            if code == GOES_ON:
                put_in(group, lane)
        elif (over >> lane) & 1:
            code = reason_of(group, lane)
        if code != GOES_ON:
            leave(group, lane, code)
            count += 1
    return count


@cached
def advance(group):
    """Step all lanes until they have returned, or cannot go on.

    Takes a :class:`~saleg.kernel.lanes.group.Group`, whose `codes` say which of them.
    """
    runs, rows = group.runs, group.rows
    P, E = records_of(rows.laws, group.law, WIDTH), records_of(rows.engine, runs.engine, WIDTH)
    C, S = rows_of(rows.chambers, runs.chambers, 2, WIDTH), records_of(rows.step, group.step, WIDTH)
    y, y_new = numbers_of(rows.y, N_WANTED, WIDTH), numbers_of(rows.y_new, N_WANTED, WIDTH)
    k = tables_of(rows.rates, N_RATES, N_WANTED, WIDTH)
    O = runs.options[0, 0]
    busy = 0
    for lane in range(WIDTH):
        if group.fresh[lane] > 0:
            put_in(group, lane)
        busy += group.codes[lane] == GOES_ON
    while busy > 0:
        propose(E, C, O, S, y, k[0])
        take_adaptive_step(P, E, C, E.t, S.h, y, k, y_new, O.motored)
        happens, over = judge(E, C, O, S, y, y_new, k)
        if (happens | over) != 0:
            busy -= see_to(group, happens, over)
    return 0
