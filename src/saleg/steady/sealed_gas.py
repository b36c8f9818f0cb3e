"""Gas of sealed chambers: what no cycle changes of it, as the engine is given it.

Mass and composition of a bounce chamber stay what they are, and its entropy too where no heat is
lost. Every amount of them has an orbit of its own; the one meant is that of the engine's start.
"""

from __future__ import annotations

import math

import numpy as np

from saleg.kernel import layout
from saleg.kernel.events import pressure_and_temperature
from saleg.kernel.orbit import Z_CHAMBERS, Z_LN_MOTORED, Z_LN_PRESSURE, read_vector
from saleg.laws.base import GasProperties
from saleg.simulation.initial_state import State
from saleg.steady.return_map import DIFFERENCE, ReturnMap, constant_entries, is_adiabatic


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
    ends = state_of_gas(before, side), state_of_gas(after, side)
    return (gas.gamma(ends[1][0]) - 1.0) * entropy_rise(gas, *ends)


def state_of_gas(state: State, side: int) -> tuple[float, float]:
    """Temperature [K] and volume [m^3] of the gas in a closed chamber."""
    _, C = state.records
    p, T = pressure_and_temperature(C, side, state.y)
    return float(T), float(C[side].mass * C[side].gas_constant * T / p)


def entropy_rise(
    gas: GasProperties, before: tuple[float, float], after: tuple[float, float]
) -> float:
    """Rise of the entropy of a charge from one temperature and volume to another, over m R [-]."""
    (cold, small), (hot, large) = before, after
    nodes, weights = np.polynomial.legendre.leggauss(16)
    middle, half = 0.5 * math.log(hot * cold), 0.5 * math.log(hot / cold)
    heat = sum(
        weight / (gas.gamma(math.exp(middle + half * node)) - 1.0)
        for node, weight in zip(nodes.tolist(), weights.tolist(), strict=True)
    )
    return half * heat + math.log(large / small)
