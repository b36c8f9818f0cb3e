"""What became of a run: status and message."""

from __future__ import annotations

import numpy as np

from saleg.engine import Engine
from saleg.kernel import layout
from saleg.simulation.initial_state import State
from saleg.simulation.performance import EnergyBalance
from saleg.simulation.run import last_cycle_start
from saleg.status import Status

#: Change of the dead centres per cycle, over the half stroke (Eq. 68), below which a run is steady.
STEADY = 1e-6
#: Residual of a cycle's energy balance, over the heat released, beyond which it is no result.
MOST_IMBALANCE = 0.05
#: Cycles over which it must stay below.
STEADY_CYCLES = 5


def verdict(
    engine: Engine, code: int, state: State, strokes: np.ndarray, conserves: bool = True
) -> tuple[Status, str]:
    """Status of a run and a message that says what happened, when, and what to try.

    A run whose last cycle does not conserve energy is no result; `conserves` False lets it pass.
    """
    E = state.engine[0]
    t, x = float(E["t"]), 1e3 * float(state.y[layout.X])
    if code == layout.HEAD_CONTACT:
        side = "left" if x < 0.0 else "right"
        return Status.HEAD_CONTACT, (
            f"the piston reached the {side} head at t = {t:.6g} s (x = {x:.5g} mm); "
            "try less fuel, a larger load or more half_stroke"
        )
    if code == layout.STEP_FAILURE:
        return Status.STEP_FAILURE, (
            f"no step was small enough at t = {t:.6g} s (x = {x:.5g} mm); "
            "try a looser rtol, or check the laws for values that are not finite"
        )
    if code == layout.TOO_MANY_STEPS:
        return Status.STEP_FAILURE, (
            f"over a million steps since the last dead centre at t = {t:.6g} s "
            f"(x = {x:.5g} mm): friction, load or springs are too stiff; try smaller coefficients"
        )
    if code == layout.STALLED:
        share = 100.0 * float(E["stroke"] / E["maximum_stroke"])
        return Status.STALLED, (
            f"the stroke fell to {share:.2g} % of the maximum at t = {t:.6g} s; {_STALL_HINT}"
        )
    if E["direction"] == 0.0:
        return Status.COMPLETED, f"never moved to t = {t:.6g} s: in equilibrium; try another start"
    off = _imbalance(strokes) if conserves else 0.0
    if off > MOST_IMBALANCE:
        return Status.STEP_FAILURE, (
            f"the steps are too coarse: at t = {t:.6g} s the energy balance of the last cycle is "
            f"off by {100.0 * off:.2g} % of the heat released; try a smaller step or rtol"
        )
    return _at_end_of_time(engine, t, strokes)


def _imbalance(strokes: np.ndarray) -> float:
    """Residual of the energy balance of the last cycle over the heat released."""
    start = last_cycle_start(strokes)
    if start is None or start == 0:
        return 0.0
    balance = EnergyBalance.between(strokes[start - 1], strokes[start : start + 2])
    return abs(balance.residual) / balance.released if balance.released > 0.0 else 0.0


PER_CYCLE = "dead centres change by {:.1e} half strokes per cycle"
_STALL_HINT = "try a smaller load, more fuel, or another start"


def _at_end_of_time(engine: Engine, t: float, strokes: np.ndarray) -> tuple[Status, str]:
    start = last_cycle_start(strokes)
    if start is None:
        return Status.COMPLETED, f"ran to t = {t:.6g} s, less than a cycle; try a longer run"
    cycle = strokes[start : start + 2]
    if engine.has_combustion and not cycle["heat_released"].sum() > 0.0:
        fired = np.flatnonzero(strokes["heat_released"].sum(axis=1) > 0.0)
        since = f"since t = {float(strokes['t'][fired[-1]]):.6g} s" if len(fired) else "at all"
        return Status.STALLED, f"ran to t = {t:.6g} s but has not fired {since}; {_STALL_HINT}"
    if (
        engine.has_combustion
        and not cycle["electrical_energy"].sum() > 1e-9 * cycle["heat_released"].sum()
    ):
        weight = float(cycle["load_weight"][-1])
        why = (
            "the alternator gives none; try a larger load or efficiency"
            if weight > 0.0
            else "the load weight is 0; try more fuel or a smaller alternator.target_stroke"
        )
        return Status.IDLING, f"fires at t = {t:.6g} s but delivers no power: {why}"
    change = change_per_cycle(engine, strokes[: start + 2])
    if change is not None and change < STEADY:
        return Status.STEADY, f"steady at t = {t:.6g} s: {PER_CYCLE.format(change)}"
    if change is None:
        return Status.COMPLETED, f"ran to t = {t:.6g} s, too few cycles to call it steady"
    return Status.COMPLETED, f"ran to t = {t:.6g} s, not steady yet: {PER_CYCLE.format(change)}"


def change_per_cycle(engine: Engine, strokes: np.ndarray) -> float | None:
    """Largest change of a dead centre from cycle to cycle over the last few, in half strokes."""
    ends = strokes["x_end"][-2 * STEADY_CYCLES - 2 :]
    if len(ends) < 2 * STEADY_CYCLES + 2:
        return None
    return float(np.abs(ends[2:] - ends[:-2]).max() / (0.5 * engine.maximum_stroke))
