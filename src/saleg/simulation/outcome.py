"""Outcome of a run: status and message."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.engine import Cylinder, Engine, OpenEnd
from saleg.kernel import layout
from saleg.simulation.faulty_law import fault_near
from saleg.simulation.indicators import beyond_ports, both, summed
from saleg.simulation.initial_state import State
from saleg.simulation.performance import EnergyBalance
from saleg.status import Status

#: Change of the dead centres per cycle, over the half stroke (Eq. 68), below which a run is steady.
STEADY = 1e-6
#: Distance from where dead centres, charges and what laws remember are heading, in half strokes or
#: relative, within which a run is steady.
NEAR = 1e-4
#: Heat released, over the greatest work of a gas, up to which a cycle has not fired: fuel of the
#: start leaves a trace in the residual gas for ever.
REMNANT = 1e-12
#: Imbalance of a cycle's energy beyond which it is no result (see :func:`imbalance`).
MAX_IMBALANCE = 0.05
#: Cycles over which it must stay below.
STEADY_CYCLES = 5
#: Natural periods without a dead centre after which a piston may stand still, and the share of the
#: maximum stroke that it would move in one more.
STILL_PERIODS = 10.0
STILL = 0.01


def outcome_of(
    engine: Engine, code: int, state: State, strokes: np.ndarray, conserves: bool = True
) -> tuple[Status, str]:
    """Status of a run and a message that says what happened, when, and what to try.

    A run whose last cycle does not conserve energy is no result; `conserves` False lets it pass.
    """
    E = state.engine[0]
    t, x = float(E["t"]), 1e3 * float(state.y[layout.X])
    hint = _stall_hint(engine, strokes)
    if code == layout.HEAD_CONTACT:
        side = "left" if x < 0.0 else "right"
        if isinstance(getattr(engine, side), OpenEnd):
            return Status.HEAD_CONTACT, (
                f"the translator came to the end of its room on the open {side} side at "
                f"t = {t:.6g} s (x = {x:.5g} mm): nothing pushed it back in time; try springs that "
                "push from there, stiffer or earlier"
            )
        return Status.HEAD_CONTACT, (
            f"the piston reached the {side} head at t = {t:.6g} s (x = {x:.5g} mm); "
            "try less fuel, a larger load or more half_stroke"
        )
    if code == layout.STEP_FAILURE:
        there = state.copy()
        fault = fault_near(engine, *there.records, there.y)
        why = f"{fault}; a law must give finite numbers" if fault else "try a looser rtol"
        return Status.STEP_FAILURE, (
            f"no step was small enough at t = {t:.6g} s (x = {x:.5g} mm); {why}"
        )
    if code == layout.TOO_MANY_STEPS:
        return Status.STEP_FAILURE, (
            f"over a million steps since the last dead centre at t = {t:.6g} s "
            f"(x = {x:.5g} mm): friction, load or springs are too stiff; try smaller coefficients"
        )
    if code == layout.STALLED:
        share = 100.0 * float(E["stroke"] / E["maximum_stroke"])
        return Status.STALLED, (
            f"the stroke fell to {share:.2g} % of the maximum at t = {t:.6g} s; {hint}"
        )
    if E["direction"] == 0.0:
        return Status.COMPLETED, f"never moved to t = {t:.6g} s: in equilibrium; try another start"
    if _stands_still(state):
        since = float(E["t_dead_centre"])
        return Status.STALLED, (
            f"the piston stands still at x = {x:.5g} mm, no dead centre since t = {since:.6g} s; "
            f"{hint}"
        )
    enough = conserves and len(strokes) > 2
    off = imbalance(strokes[-3], strokes[-2:]) if enough else 0.0
    if off > MAX_IMBALANCE:
        return Status.STEP_FAILURE, (
            f"the steps are too coarse: at t = {t:.6g} s the energy balance of the last cycle is "
            f"off by {100.0 * off:.2g} % of its largest term; try a smaller step or rtol"
        )
    return _at_end_of_time(engine, t, strokes)


def _stands_still(state: State) -> bool:
    """Whether an overdamped piston creeps towards its equilibrium, without another dead centre."""
    E = state.engine[0]
    period = 2.0 * math.pi * float(E["length_scale"] / E["speed_scale"])
    waited = float(E["t"] - E["t_dead_centre"])
    coming = abs(float(state.y[layout.V])) * period
    return waited > STILL_PERIODS * period and coming < STILL * float(E["maximum_stroke"])


def imbalance(before: Any, strokes: np.ndarray) -> Any:
    """Residual of an energy balance over its largest term, or over what moves to and fro.

    The latter is the work of the gas in a chamber in a stroke, or the energy in the springs: all
    terms of an engine without heat and friction are zero but for rounding.

    Parameters
    ----------
    before : row of STROKE_RECORD
        The stroke before.
    strokes : ndarray of STROKE_RECORD
        Consecutive strokes; of many runs each in a row, as :meth:`.EnergyBalance.between` has them.
    """
    balance = EnergyBalance.between(before, strokes)
    moved = np.abs(strokes["gas_work"]).max(axis=(-2, -1))
    held = np.abs(strokes["spring_energy"]).max(axis=-1)
    largest = np.maximum(balance.largest_term, np.maximum(moved, held))
    return abs(balance.residual) / np.maximum(largest, 1e-300)


NO_FRESH_GAS = "no fresh gas comes in; try wider intake ports or more intake.pressure"


def _stall_hint(engine: Engine, strokes: np.ndarray) -> str:
    if is_starved(engine, strokes):
        return NO_FRESH_GAS
    return "try a smaller load, more fuel, or another start"


def _at_end_of_time(engine: Engine, t: float, strokes: np.ndarray) -> tuple[Status, str]:
    """Outcome of a run whose time is up, by its last two strokes, whichever side they end on."""
    if len(strokes) < 2:
        return Status.COMPLETED, f"ran to t = {t:.6g} s, less than a cycle; try a longer run"
    cycle = strokes[-2:]
    steady, how = settled(engine, strokes)
    if is_dead(engine, cycle) and not (steady and delivers_power(cycle)):
        fired = np.flatnonzero(strokes["heat_released"].sum(axis=1) > 0.0)
        since = f"since t = {float(strokes['t'][fired[-1]]):.6g} s" if len(fired) else "at all"
        why = _stall_hint(engine, strokes)
        return Status.STALLED, f"ran to t = {t:.6g} s but has not fired {since}; {why}"
    if is_idling(engine, cycle):
        weight = float(cycle["load_weight"][-1])
        why = (
            "the alternator gives none; try a larger load or efficiency"
            if weight > 0.0
            else "the load weight is 0; try more fuel or a smaller alternator.target_stroke"
        )
        if is_starved(engine, strokes):
            why = NO_FRESH_GAS
        status = Status.IDLING if steady else Status.COMPLETED
        return status, f"fires at t = {t:.6g} s but delivers no power: {why}; {how}"
    if steady:
        return Status.STEADY, f"steady at t = {t:.6g} s: {how}"
    return Status.COMPLETED, f"ran to t = {t:.6g} s, {how}"


def is_dead(engine: Engine, cycle: np.ndarray) -> Any:
    """Whether an engine with cylinders neither fires in a cycle nor is motored; each of many."""
    all_of = summed(cycle)
    driven, heat = all_of["alternator_work"] < 0.0, both(all_of["heat_released"])
    work = np.abs(cycle["gas_work"]).max(axis=(-2, -1))
    return engine.has_combustion & ~driven & ~(heat > REMNANT * work)


def is_starved(engine: Engine, strokes: np.ndarray) -> bool:
    """Whether no gas came in through ports that the pistons did uncover, in all cylinders."""
    flows = [
        "contents" in chamber.gas_exchange.states
        for chamber in engine.chambers
        if isinstance(chamber, Cylinder)
    ]
    uncovered = bool(flows) and all(flows) and beyond_ports(engine, strokes).any()
    return bool(uncovered) and not (strokes["supplied_mass"] > 0.0).any()


def delivers_power(cycle: np.ndarray) -> bool:
    """Whether a cycle delivers power; one that repeats may live on the heat of its walls."""
    return float(cycle["electrical_energy"].sum()) > 1e-9 * float(np.abs(cycle["gas_work"]).max())


def is_idling(engine: Engine, cycle: np.ndarray) -> Any:
    """Whether an engine fires in a cycle but delivers no power; each of many."""
    all_of = summed(cycle)
    heat = both(all_of["heat_released"])
    return (heat > 0.0) & ~(all_of["electrical_energy"] > 1e-9 * heat)


def settled(engine: Engine, strokes: np.ndarray) -> tuple[bool, str]:
    """Whether a run has come to its steady state, and how near it is in words.

    A small change per cycle is not enough: what decays slowly changes little and has far to go.
    """
    change = change_per_cycle(engine, strokes)
    if change is None:
        return False, "too few cycles to call it steady"
    what = f"dead centres change by {change:.1e} half strokes per cycle"
    if change >= STEADY:
        return False, f"not steady yet: {what}"
    distance = distance_to_go(engine, strokes)
    if distance > NEAR:
        return False, f"not steady yet: {what}, but what changes slowly has {distance:.1e} to go"
    return True, what


def change_per_cycle(engine: Engine, strokes: np.ndarray) -> float | None:
    """Largest change of a dead centre from cycle to cycle over the last few, in half strokes."""
    ends = strokes["x_end"][-2 * STEADY_CYCLES - 2 :]
    if len(ends) < 2 * STEADY_CYCLES + 2:
        return None
    return float(np.abs(ends[2:] - ends[:-2]).max() / (0.5 * engine.maximum_stroke))


def distance_to_go(engine: Engine, strokes: np.ndarray) -> float:
    """Distance of the last cycle from where dead centres, charges and memories are heading [-].

    What shrinks by a factor m from one change to the next still has ``change m / (1 - m)`` to go:
    Aitken's estimate ``b^2 / |a - b|`` from two consecutive changes a and b. Of the last few the
    smallest counts, so that scatter of the integrator is not taken for a slow decay.

    Parameters
    ----------
    engine : Engine
    strokes : ndarray of STROKE_RECORD
        At least a dozen strokes.

    Returns
    -------
    float
        The largest of all, in half strokes or relative.
    """
    rows = strokes[-2 * STEADY_CYCLES - 2 :]
    names = ("load_weight", "friction_held")
    sides = ("internal_energy", "fuel_energy", "charge_mass")
    kept = [rows[name] for name in names] + [rows[name][:, n] for name in sides for n in (0, 1)]
    sizes = [float(np.abs(values).max()) for values in kept]
    series = np.array(
        [rows["x_end"] / (0.5 * engine.maximum_stroke)]
        + [values / size for values, size in zip(kept, sizes, strict=True) if size > 0.0]
    )
    changes = series[:, 2:] - series[:, :-2]  # each dead centre with the one a cycle before
    before, after = changes[:, :-2], changes[:, 2:]
    with np.errstate(divide="ignore", invalid="ignore"):
        left = np.where(after == 0.0, 0.0, after**2 / np.abs(before - after))
    each = np.maximum(left[:, ::2].min(axis=1), left[:, 1::2].min(axis=1))
    return float(each.max())
