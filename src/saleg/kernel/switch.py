"""What is due at an event: chambers change, the translator turns, regulators act."""

from math import isfinite

from saleg.kernel.breathing import take_contents
from saleg.kernel.charges import (
    close_ports,
    end_combustion,
    fill_chamber,
    ignite,
    open_ports,
    renew_charge,
)
from saleg.kernel.control import ask, obey
from saleg.kernel.injection import inject, injection_is_due
from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import (
    ARMED,
    BURNING,
    CLOSED,
    COMPILED,
    CORNER,
    DEAD_CENTRE,
    DISARMED,
    ELECTRICAL_ENERGY,
    EVENT_CHARGE_RENEWAL,
    EVENT_DEAD_CENTRE,
    EVENT_END_OF_COMBUSTION,
    EVENT_HEAD_CONTACT,
    EVENT_IGNITION,
    EVENT_INJECTION,
    EVENT_MISFIRE,
    EVENT_MOTOR_OFF,
    EVENT_MOTOR_ON,
    EVENT_PORT_CLOSING,
    EVENT_PORT_OPENING,
    FAILING,
    HEAD,
    IGNITION,
    LATE,
    LEFT,
    N_STATE,
    OPEN,
    RIGHT,
    SPEED_SQUARED,
    UNCONTROLLED,
    X,
)
from saleg.kernel.needs import CONTENTS_ARE_WANTED, INJECTION_IS_WANTED
from saleg.kernel.rhs import charge_of, refresh
from saleg.kernel.rows import record_event, supplied_energy, write_stroke
from saleg.kernel.slots import (
    alternator_at_dead_centre,
    friction_at_dead_centre,
    ignition_lights_at_dead_centre,
)
from saleg.kernel.state import begin_stroke, clearance_of
from saleg.laws.arguments import Stroke
from saleg.laws.choice import where


@compiled
def regulate(P, E, C, y):
    """Hand the finished stroke to the laws that act at a dead centre."""
    fuel = C[LEFT].fresh_fuel_energy + C[RIGHT].fresh_fuel_energy
    if CONTENTS_ARE_WANTED:
        fuel += supplied_energy(C, LEFT, y) + supplied_energy(C, RIGHT, y)
    squared = y[N_STATE + SPEED_SQUARED]
    length = abs(y[X] - E.x_dead_centre)
    duration = E.t - E.t_dead_centre
    stroke = Stroke(
        length=length,
        duration=duration,
        maximum=E.maximum_stroke,
        half_maximum=0.5 * E.maximum_stroke,
        piston_area=0.5 * (C[LEFT].area + C[RIGHT].area),
        fuel_energy=fuel + E.last_fuel_energy,
        speed_squared=squared + E.last_speed_squared,
        x_left=min(y[X], E.x_dead_centre),
        x_right=max(y[X], E.x_dead_centre),
    )
    E.last_fuel_energy = fuel
    E.last_speed_squared = squared
    E.stroke = length
    E.mean_piston_speed = length / duration
    E.stroke_duration = duration
    E.power = y[N_STATE + ELECTRICAL_ENERGY] / duration
    E.regulated_weight = alternator_at_dead_centre(P, E.load_weight, stroke)
    if E.controlled == UNCONTROLLED:
        E.load_weight = E.regulated_weight
    E.friction_held = friction_at_dead_centre(P, E.friction_held, stroke)


@inline
def misfires(E, C, side):
    """Whether a chamber that begins to expand holds a charge that should have lit."""
    c = C[side]
    due = (c.armed == ARMED) | (c.armed == FAILING)
    return due & (c.mode == CLOSED) & (c.sign * E.direction > 0.0)


@inline
def ports_due(E, C, side, y):
    """Whether a chamber stands at its ports, about to pass them."""
    c = C[side]
    beyond = clearance_of(C, side, y[X]) - c.port
    slack = 1e-14 * E.length_scale
    outward = c.sign * E.direction
    opens, closes = (outward > 0.0) & (beyond >= -slack), (outward < 0.0) & (beyond <= slack)
    return where(c.mode == OPEN, closes, opens)


@inline
def is_due(E, C, side, t, y):
    """Whether any change of a chamber is due, or a breakpoint of its burn rate is reached."""
    c = C[side]
    breaks = (c.mode == BURNING) & (t >= c.t_breakpoint)
    changes = (c.renewal_due > 0.0) | misfires(E, C, side) | ports_due(E, C, side, y)
    lights = (c.mode == CLOSED) & (c.armed > DISARMED) & (y[IGNITION + side] >= 1.0)
    if INJECTION_IS_WANTED:
        changes = changes | injection_is_due(E, C, side, y)
    return breaks | changes | lights


@compiled
def change_due(P, E, C, side, y):
    """Kind of the event that is due in a chamber now; -1 if none is."""
    c = C[side]
    if c.mode == BURNING and E.t >= c.t_end:
        return EVENT_END_OF_COMBUSTION
    if c.renewal_due > 0.0:
        return EVENT_CHARGE_RENEWAL
    if misfires(E, C, side):
        lit = c.armed == ARMED
        if lit and ignition_lights_at_dead_centre(P, side, charge_of(E, C, side, y)) > 0.0:
            return EVENT_IGNITION
        return EVENT_MISFIRE
    if INJECTION_IS_WANTED and injection_is_due(E, C, side, y):
        return EVENT_INJECTION
    if c.mode == CLOSED and c.armed > DISARMED and y[IGNITION + side] >= 1.0:
        return EVENT_IGNITION
    if ports_due(E, C, side, y):
        return EVENT_PORT_CLOSING if c.mode == OPEN else EVENT_PORT_OPENING
    return -1


@compiled
def change_mode(P, E, C, O, side, y, kind):
    """Carry out the change of a chamber that is due."""
    if kind == EVENT_END_OF_COMBUSTION:
        end_combustion(P, E, C, side)
    elif kind == EVENT_MISFIRE:
        c = C[side]
        c.armed = LATE if c.armed == ARMED and c.late_ignition > 0.0 else DISARMED
        if c.armed == DISARMED:
            y[IGNITION + side] = 0.0
    elif kind == EVENT_IGNITION:
        ignite(P, E, C, side, y, O.motored)
    elif INJECTION_IS_WANTED and kind == EVENT_INJECTION:
        inject(P, E, C, side, y)
    elif kind == EVENT_CHARGE_RENEWAL and C[side].curve_exponent > 0.0:
        renew_charge(P, E, C, side, y)
    elif kind == EVENT_CHARGE_RENEWAL:
        fill_chamber(P, C, side, y)
    elif kind == EVENT_PORT_CLOSING:
        close_ports(P, E, C, side, y)
    else:
        open_ports(P, E, C, side, y)


@compiled
def turn(P, E, C, y, peaks, tables, control):
    """Dead centre: write the row of the stroke, let the regulators act, reverse the direction."""
    if isfinite(E.x_dead_centre) and E.t > E.t_dead_centre:
        filled = tables.filled[0]
        write_stroke(P, E, C, y, peaks, tables.strokes[filled.strokes])
        filled.strokes += 1
        regulate(P, E, C, y)
        E.strokes += 1.0
        E.steps_at_dead_centre = E.steps
    elif isfinite(E.x_dead_centre):
        E.strokes += 1.0
        E.stroke = 0.0  # two dead centres at one instant: the motion has died away
    E.direction = -E.direction
    begin_stroke(E, C, y, peaks)
    for side in range(2):
        c = C[side]
        c.renewal_due = 1.0 if c.curve_exponent > 0.0 > c.sign * E.direction else 0.0
    if E.controlled == COMPILED:
        obey(P, E, C, ask(E, C, y, control), E.t - E.t_command)


@compiled
def change_chambers(P, E, C, O, y, tables):
    """Carry out all changes of the chambers that are due; returns whether there were any.

    Every change takes away its own cause, so this ends; the bound is a safeguard.
    """
    changed = False
    for _ in range(12):
        quiet = True
        for side in range(2):
            kind = change_due(P, E, C, side, y)
            if kind >= 0:
                take_contents(C, y)
                record_event(E, C, O, y, kind, side, tables)
                change_mode(P, E, C, O, side, y, kind)
                quiet = False
                changed = True
        if quiet:
            break
    return changed


@compiled
def switch(P, E, C, O, y, landed, peaks, tables, control):
    """Do what is due at the present instant; returns whether anything was.

    Chambers change first, one after the other, then the translator turns. What is due in a chamber
    because it has turned belongs to the stroke that begins and waits for the next call.
    """
    if landed >= 0:
        take_contents(C, y)
    changed = change_chambers(P, E, C, O, y, tables) or landed == CORNER
    for side in range(2):
        if C[side].mode == BURNING and E.t >= C[side].t_breakpoint:
            changed = True
    was_motoring = E.motoring
    if landed == DEAD_CENTRE:
        turn(P, E, C, y, peaks, tables, control)
        side = LEFT if E.direction > 0.0 else RIGHT
        record_event(E, C, O, y, kind_of_turn(landed), side, tables)
        changed = True
    if E.motoring != was_motoring:
        kind = EVENT_MOTOR_ON if E.motoring > 0.0 else EVENT_MOTOR_OFF
        side = LEFT if E.direction > 0.0 else RIGHT
        record_event(E, C, O, y, kind, side, tables)
    if landed >= HEAD:
        record_event(E, C, O, y, kind_of_turn(landed), landed % 2, tables)
    if changed:
        refresh(P, E, C, y)
    return changed


@inline
def kind_of_turn(landed):
    """Kind of the event at which the translator itself was stopped."""
    return EVENT_HEAD_CONTACT if landed >= HEAD else EVENT_DEAD_CENTRE
