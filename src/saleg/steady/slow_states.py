"""States that change slowly: how far they still have to go, and Newton's method to get there.

A small residual is no small distance: what decays by a factor m per return is a residual over
``1 - m`` away from where it will end. Memories of laws, temperatures of sealed chambers and the
charge's burnt gas may have an m next to one.
"""

from __future__ import annotations

import math

import numpy as np

from saleg.kernel import layout
from saleg.simulation.initial_state import State
from saleg.steady.return_map import NoReturn, ReturnMap, conserved_entries
from saleg.steady.stability import FINE

#: Distance from the fixed point, in the numbers of order one a state is written in, within which a
#: state is steady, over the tolerance of the integrator.
NEAR = 100.0
#: Residual up to which what did not settle may only be slow.
SLOW = 1e-2
#: Jumps of Newton's method.
MOST_JUMPS = 30


def find_settled(chart: ReturnMap, most: int, tolerance: float) -> tuple[int, np.ndarray, int]:
    """Look for a fixed point that is near in all states, the slow ones included.

    Parameters
    ----------
    chart : ReturnMap
    most : int
        Maps between two jumps.
    tolerance : float
        Residual of the map.

    Returns
    -------
    code : int
        Why it ended, as a code of the layout.
    found : ndarray
        Maps taken in all, residual of the last one, residual of the whole cycle after it.
    strokes : int
        Strokes integrated in all, verifying cycles included.
    """
    maps, strokes = 0.0, 0
    for _ in range(MOST_JUMPS):
        code, found = chart.find(most, tolerance)
        maps += found[0]
        settled = code == layout.END_OF_TIME
        strokes += int(found[0] * chart.strokes_per_map) + (2 if settled else 0)
        found[0] = maps
        if settled and distance_to_go(chart) <= NEAR * tolerance:
            return code, found, strokes
        if not settled and not (code == layout.NOT_FOUND and maps and found[1] <= SLOW):
            return code, found, strokes
        jump = newton_step(chart)
        if settled and jump is not None and np.abs(jump).max() <= NEAR * tolerance:
            return code, found, strokes
        if jump is None:
            break
        chart.jump(jump)
    return layout.NOT_FOUND, found, strokes


def distance_to_go(chart: ReturnMap) -> float:
    """Distance of a fixed point just found from where its states are heading.

    Entry by entry, from the residuals of the last map and of the cycle after it: their ratio is m
    for a map of a whole cycle and m (m + 1) for one of half a cycle.
    """
    vectors = chart.vectors
    first, second = vectors[1].copy(), vectors[2] - vectors[0]
    first[list(conserved_entries(chart.engine))] = 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(first != 0.0, second / first, 0.0)
    if chart.mirrored:
        ratio = (0.5 * (np.sqrt(np.maximum(1.0 + 4.0 * ratio, 0.0)) - 1.0)) ** 2
    away = np.abs(1.0 - ratio)
    if away.min() == 0.0:
        return math.inf
    return float((np.abs(second) * (first != 0.0) / away).max())


def newton_step(chart: ReturnMap) -> np.ndarray | None:
    """Way from the present state to the fixed point, as Newton's method has it; None if unknown."""
    start = State(
        chart.state.engine.copy(), chart.state.chambers.copy(), chart.state.y.copy(), np.zeros(0)
    )
    fine = ReturnMap.of(chart.engine, chart.state.copy(), FINE, chart.mirrored)
    try:
        z = fine.vector(start)
        residual = fine.image(start, z) - z
        matrix = np.eye(len(z)) - fine.jacobian(start, z)
    except NoReturn:
        return None
    free = [n for n in range(len(z)) if n not in conserved_entries(chart.engine)]
    if not np.isfinite(matrix).all() or not np.isfinite(residual).all():
        return None
    jump = np.zeros(len(z))
    jump[free] = np.linalg.lstsq(matrix[np.ix_(free, free)], residual[free], rcond=None)[0]
    return jump
