"""Gas of sealed chambers: what no cycle changes of it, as the engine is given it.

Mass and composition of a bounce chamber stay what they are, and its entropy too where no heat is
lost. Every amount of them has an orbit of its own; the one meant is that of the engine's start.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from saleg.columns import by_branch, column, exp, log
from saleg.compiler.plain import on_columns
from saleg.engine.columns import Rows
from saleg.kernel import layout
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.vector import Z_CHAMBERS, Z_LN_MOTORED, Z_LN_PRESSURE, read_vector
from saleg.laws.base import GasProperties
from saleg.simulation.initial_rows import States
from saleg.simulation.initial_state import State
from saleg.steady.entries import constant_entries, is_adiabatic
from saleg.steady.return_map import DIFFERENCE, ReturnMap


def with_sealed_charges(return_map: ReturnMap, given: State, z: np.ndarray) -> np.ndarray:
    """A vector with the masses and compositions of the sealed charges from a state.

    Parameters
    ----------
    return_map : ReturnMap
    given : State
    z : ndarray

    Returns
    -------
    ndarray
    """
    filled, known = z.copy(), return_map.vector(given)
    for side, chamber in enumerate(return_map.engine.chambers):
        if chamber.is_sealed:
            first = Z_CHAMBERS + layout.VECTOR_PER_SIDE * side
            sealed = {first + n for n in range(layout.VECTOR_PER_SIDE)}
            entries = sorted(sealed - {first + Z_LN_PRESSURE, first + Z_LN_MOTORED})
            filled[entries] = known[entries]
    return filled


def missing_entropy(return_map: ReturnMap, given: State, z: np.ndarray) -> dict[int, float]:
    """What a vector lacks to have the entropies of a state, by the entries that hold them.

    Parameters
    ----------
    return_map : ReturnMap
    given : State
    z : ndarray

    Returns
    -------
    dict of int to float
        Nothing unless a chamber is sealed and adiabatic.
    """
    present = given.copy()
    read_vector(*present.records, present.y, z)
    found = {}
    for side, chamber in enumerate(return_map.engine.chambers):
        if not is_adiabatic(chamber):
            continue
        first = Z_CHAMBERS + layout.VECTOR_PER_SIDE * side
        gas = chamber.gas_properties  # type: ignore[attr-defined]
        found[first + Z_LN_PRESSURE] = -rise_of_theta(gas, given, present, side)
        if return_map.engine.needs_motored_pressure:  # nothing burns: it is the pressure itself
            found[first + Z_LN_MOTORED] = float(z[first + Z_LN_PRESSURE] - z[first + Z_LN_MOTORED])
    return found


def missing_entropy_rates(
    return_map: ReturnMap, given: State, z: np.ndarray
) -> dict[int, np.ndarray]:
    """Derivatives of :func:`missing_entropy` by the entries of the vector."""
    rates = {n: np.zeros(len(z)) for n in missing_entropy(return_map, given, z)}
    moved = sorted(set(range(len(z))) - constant_entries(return_map.engine)) if rates else []
    for m in moved:
        step = np.zeros(len(z))
        step[m] = DIFFERENCE
        ahead, behind = (missing_entropy(return_map, given, z + way * step) for way in (1, -1))
        for n, row in rates.items():
            row[m] = (ahead[n] - behind[n]) / (2.0 * DIFFERENCE)
    return rates


def rise_of_theta(gas: GasProperties, before: State, after: State, side: int) -> float:
    """Rise of theta in a sealed chamber from one state to another that is due to entropy [-]."""
    ends = [
        _gas_in(state.records[1], side, state.y, pressure_and_temperature)
        for state in (before, after)
    ]
    return float(_rise(gas, *ends))


def rises_of_theta(
    rows: Rows, before: States, after: States, side: int, chosen: np.ndarray
) -> np.ndarray:
    """The same of some rows of many engines; NaN for the others."""
    rises = np.full(rows.count, math.nan)
    of_one: Any = rows.engine.chambers[side]
    if type(of_one.gas_properties).__module__.startswith("saleg."):  # it calculates with columns
        inside = on_columns().pressure_and_temperature

        def rise(lot: np.ndarray) -> Any:
            chamber: Any = rows.some(lot).engine.chambers[side]
            ends = [_gas_in(*_columns(states, lot, side), inside) for states in (before, after)]
            return _rise(chamber.gas_properties, *ends)

        for lot, values in by_branch(rise, chosen):
            rises[lot] = math.nan if values is None else values
    for n in chosen[np.isnan(rises[chosen])].tolist():
        one: Any = rows.row(n).chambers[side]
        rises[n] = rise_of_theta(one.gas_properties, before.row(n), after.row(n), side)
    return rises


def _columns(states: States, lot: np.ndarray, side: int) -> tuple[Any, int, Any]:
    """Chambers, side and state vector of some rows, their numbers columns."""
    chambers = states.chambers[lot, side]
    names = [name for name in chambers.dtype.names or () if name != "mode"]
    c = SimpleNamespace(**{name: column(chambers[name]) for name in names})
    c.mode = layout.CLOSED  # no sealed chamber is open
    return {side: c}, side, [column(values) for values in states.y[lot].T]


def _gas_in(C: Any, side: int, y: Any, inside: Callable[..., Any]) -> tuple[Any, Any]:
    """Temperature [K] and volume [m^3] of the gas in a closed chamber."""
    p, T = inside(C, side, y)
    return T, C[side].mass * C[side].gas_constant * T / p


def _rise(gas: GasProperties, before: tuple[Any, Any], after: tuple[Any, Any]) -> Any:
    return (gas.gamma(after[0]) - 1.0) * entropy_rise(gas, before, after)


def entropy_rise(gas: GasProperties, before: tuple[Any, Any], after: tuple[Any, Any]) -> Any:
    """Rise of the entropy of a charge from one temperature and volume to another, over m R [-]."""
    (cold, small), (hot, large) = before, after
    nodes, weights = np.polynomial.legendre.leggauss(16)
    middle, half = 0.5 * log(hot * cold), 0.5 * log(hot / cold)
    heat = sum(
        weight / (gas.gamma(exp(middle + half * node)) - 1.0)
        for node, weight in zip(nodes.tolist(), weights.tolist(), strict=True)
    )
    return half * heat + log(large / small)
