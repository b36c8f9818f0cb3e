"""Many engines under commands, a stroke each, one after the other.

All of one choice of laws and actuators. What the integrator works on belongs to one engine at a
time: its numbers are copied there and, a stroke later, back.
"""

from math import inf
from typing import Any, NamedTuple

from saleg.kernel.control import commands_of, obey, write_signals
from saleg.kernel.jit import cached, compiled, inline
from saleg.kernel.layout import BUFFER_FULL, CONTROLLER_FAULT, EVENT_MISFIRE, N_ALL
from saleg.kernel.run_plainly import run_at
from saleg.kernel.slots import actuators_refused
from saleg.kernel.state import copy_row


class Fleet(NamedTuple):
    """Engines under commands; a row per engine.

    Attributes
    ----------
    laws : ndarray, shape (n,)
        Records of the numbers of the laws.
    engine : ndarray of ENGINE_RECORD, shape (n,)
    chambers : ndarray of CHAMBER_RECORD, shape (2 n,)
    y : ndarray, shape (n, N_ALL)
    commands : ndarray of COMMANDS_RECORD, shape (n,)
        Of the coming stroke.
    signals : ndarray of SIGNALS_RECORD, shape (n,)
        Of the stroke just ended.
    begins : ndarray of bool, shape (n,)
        Whether the coming commands are the first.
    codes : ndarray of int, shape (n,)
        Why the integrator came back.
    misfired : ndarray of bool, shape (n,)
        Whether a charge failed to light in the stroke just ended.
    """

    laws: Any
    engine: Any
    chambers: Any
    y: Any
    commands: Any
    signals: Any
    begins: Any
    codes: Any
    misfired: Any


@inline
def bring(fleet, row, run):
    """Copy an engine to where the integrator works."""
    copy_row(run.laws, 0, fleet.laws, row)
    copy_row(run.engine, 0, fleet.engine, row)
    for side in range(2):
        copy_row(run.chambers, side, fleet.chambers, 2 * row + side)
    for n in range(N_ALL):
        run.y[n] = fleet.y[row, n]


@inline
def take_back(fleet, row, run):
    """Copy what has become of an engine back."""
    copy_row(fleet.engine, row, run.engine, 0)
    for side in range(2):
        copy_row(fleet.chambers, 2 * row + side, run.chambers, side)
    for n in range(N_ALL):
        fleet.y[row, n] = run.y[n]


@compiled
def has_misfired(tables):
    """Whether a misfire is among the events recorded."""
    found = False
    for n in range(tables.filled[0].events):
        found = found or tables.events[n].kind == EVENT_MISFIRE
    return found


@compiled
def next_stroke(fleet, row, run, address):
    """Integrate to the next dead centre; returns why the integrator came back."""
    filled = run.tables.filled[0]
    run.options[0].last_stroke = run.engine[0].strokes + 1.0
    fleet.misfired[row] = False
    code = BUFFER_FULL
    while code == BUFFER_FULL:
        filled.strokes, filled.events = 0, 0
        code = run_at(address, run)
        fleet.misfired[row] = fleet.misfired[row] or has_misfired(run.tables)
    return code


@compiled
def first_refused(fleet, rows, run):
    """First row whose commands its actuators refuse; -1 if there is none."""
    for at in range(rows.shape[0]):
        copy_row(run.laws, 0, fleet.laws, rows[at])
        if actuators_refused(run.laws[0], commands_of(fleet.commands[rows[at]])) != 0.0:
            return rows[at]
    return -1


@cached
def advance_fleet(fleet, rows, run, address):
    """Entry point: command some engines and integrate each to its next dead centre.

    Returns the first row whose commands are refused, and nothing has moved then; else -1.
    """
    refused = first_refused(fleet, rows, run)
    if refused >= 0:
        return refused
    for at in range(rows.shape[0]):
        row = rows[at]
        bring(fleet, row, run)
        E, C = run.engine[0], run.chambers
        elapsed = inf if fleet.begins[row] else E.t - E.t_command
        obey(run.laws[0], E, C, commands_of(fleet.commands[row]), elapsed)
        fleet.begins[row] = False
        code = CONTROLLER_FAULT if E.fault != 0.0 else next_stroke(fleet, row, run, address)
        fleet.codes[row] = code
        write_signals(E, C, run.y, fleet.signals[row])
        take_back(fleet, row, run)
    return -1
