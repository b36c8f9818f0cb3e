"""Emulation of a block diagram whose cylinder blocks lag behind: for study, not for use.

A fixed step of Heun's method on a grid, as block-diagram simulators take it: modes change only at
grid points, after the fact, and the translator feels the gas force of some steps ago.
"""

from math import copysign

from saleg.kernel.events import is_sound
from saleg.kernel.jit import cached, compiled
from saleg.kernel.layout import (
    BUFFER_FULL,
    DEAD_CENTRE,
    END_OF_TIME,
    LEFT,
    N_ALL,
    RIGHT,
    STALLED,
    STEP_FAILURE,
    V,
)
from saleg.kernel.peaks import watch_point
from saleg.kernel.rhs import chamber_rates, gas_force, rates_of_motion, refresh, write_chamber
from saleg.kernel.rows import has_room
from saleg.kernel.switch import switch


@compiled
def lagging_rhs(P, E, C, t, y, dy, delay, late_force, motored):
    """Rates with a late gas force, or that of now if nothing lags; returns the one of now."""
    left = chamber_rates(P, E, C, LEFT, t, y, motored)
    right = chamber_rates(P, E, C, RIGHT, t, y, motored)
    force = gas_force(C, left, right)
    rates_of_motion(P, E, t, y, dy, late_force if delay > 0 else force)
    write_chamber(C, LEFT, y[V], left, dy)
    write_chamber(C, RIGHT, y[V], right, dy)
    return force


@cached
def run_delayed(P1, E1, C, y, peaks, delay, forces, O1, tables, work, control):
    """Run to the end with the gas force `delay` steps late.

    `forces` is a ring of the last gas forces, longer than the delay, filled with the first one.
    """
    P, E, O = P1[0], E1[0], O1[0]
    k0, k1, y_new = work
    size = forces.shape[0]
    refresh(P, E, C, y)
    while E.t < O.t_end:
        if not has_room(O, tables):
            return BUFFER_FULL
        now = int(E.grid) % size
        late = forces[(now - delay) % size]
        forces[now] = lagging_rhs(P, E, C, E.t, y, k0, delay, late, O.motored)
        if delay == 0:
            late = forces[now]
        for n in range(N_ALL):
            y_new[n] = y[n] + O.step * k0[n]
        if not is_sound(C, y_new):
            return STEP_FAILURE
        lagging_rhs(P, E, C, E.t + O.step, y_new, k1, delay, late, O.motored)
        for n in range(N_ALL):
            y[n] += 0.5 * O.step * (k0[n] + k1[n])
        if not is_sound(C, y):
            return STEP_FAILURE
        E.grid += 1.0
        E.steps += 1.0
        E.evaluations += 2.0
        E.t = E.grid * O.step
        if E.direction == 0.0 and y[V] != 0.0:
            E.direction = copysign(1.0, y[V])
        watch_point(C, y, k1, peaks)
        landed = DEAD_CENTRE if E.direction * y[V] < 0.0 else -1
        switch(P, E, C, O, y, landed, peaks, tables, control)
        if landed == DEAD_CENTRE:
            switch(P, E, C, O, y, -1, peaks, tables, control)
        short = E.strokes > 0.0 and E.stroke < O.stall * E.maximum_stroke
        if landed == DEAD_CENTRE and short:
            return STALLED
    return END_OF_TIME
