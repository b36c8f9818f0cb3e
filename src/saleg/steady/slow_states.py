"""States that change slowly: how far they still have to go, and Newton's method to get there.

A small residual is no small distance: what decays by a factor m per return is a residual over
``1 - m`` away from where it will end. Memories of laws, temperatures of sealed chambers and the
charge's burnt gas may have an m next to one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.engine import BounceChamber, Chamber, Engine
from saleg.kernel import layout
from saleg.kernel.orbit import NEAR
from saleg.simulation.initial_state import State
from saleg.simulation.outcome import imbalance
from saleg.steady.entries import conserved_entries, is_adiabatic, unused_entries
from saleg.steady.return_map import NoReturn, ReturnMap, Search
from saleg.steady.sealed_gas import rise_of_theta
from saleg.steady.stability import FINE

#: Residual up to which what did not settle may only be slow.
SLOW = 0.1
#: Jumps of Newton's method, and those no shorter than the shortest before after which it gives up.
MAX_JUMPS = 30
MAX_VAIN_JUMPS = 3
#: Steps to one return that differences of the map may take; the base case takes four hundred.
FINE_STEPS = 10_000
#: Length of a Newton's step from which on the slow motion itself is followed instead, how far
#: at once, and what shares of that are tried.
NEARBY = 0.1
LONGEST = 0.25
SHARES = (1.0, 0.5, 0.25, 0.125)
#: Maps between two steps along the slow motion, and returns that one may stand for.
MAPS_ON_THE_WAY = 2
MAX_RETURNS = 1e9
#: Steps along the slow motion and jumps after them.
MAX_FOLLOWED = 16
#: Slowness of a map from which the error of its steps counts: it displaces the fixed point by as
#: many times itself.
SLOWEST = 30.0
#: Imbalance of a cycle's energy, over its largest term, from which its steps are too coarse.
COARSE = 1e-6
#: Residual that may be nothing but rounding, and says nothing of how far there is to go.
ROUNDING = 1e-13
#: Factor on the tolerance of an orbit that is found anew with finer steps, and the finest there is.
FINER = 1e-2
FINEST = 1e-9


def find_settled(
    return_map: ReturnMap,
    max_maps: int,
    tolerance: float,
    patient: bool = True,
    follow: bool = False,
) -> tuple[Search, int]:
    """Look for a fixed point that is near in all states, the slow ones included.

    Parameters
    ----------
    return_map : ReturnMap
    max_maps : int
        Maps between two jumps.
    tolerance : float
        Residual of the map.
    patient : bool
        Whether to go on from what has not settled but may only be slow.
    follow : bool
        Whether to follow the slow motion where the fixed point is far.

    Returns
    -------
    found : Search
        The last of all searches.
    strokes : int
        Strokes integrated in all, verifying cycles included.
    """
    strokes, slow = 0, has_slow_states(return_map.engine)
    begin, smallest = return_map.state.copy(), SLOW
    shortest, vain = np.inf, 0
    for _ in range(MAX_FOLLOWED if follow else MAX_JUMPS):
        found = return_map.find(max_maps, tolerance)
        settled = found.code == layout.END_OF_TIME
        strokes += int(found.maps * return_map.strokes_per_map) + (2 if settled else 0)
        if not settled:
            unsettled = found.code == layout.NOT_FOUND and found.maps > 0.0
            if not (patient and unsettled and found.residual < smallest):
                return found, strokes
            smallest = found.residual
        # What was slow once is known too badly from two residuals: there the next jump decides.
        if slow or not settled or not is_near(return_map, NEAR * tolerance):
            slow, jump = True, newton_step(return_map, follow)
            if jump is None:
                break
            length = float(np.abs(jump).max())
            if follow and length > NEARBY:
                smallest = SLOW  # on the way the residual may well grow
            else:
                vain += length >= shortest
                if vain >= MAX_VAIN_JUMPS:
                    break
                shortest = min(shortest, length)
            if not settled or length > NEAR * tolerance:
                if not follow:
                    return_map.jump(jump)
                elif not jump_to_return(return_map, jump):
                    break
                continue
        if not give_back_entropy(return_map, begin, NEAR * tolerance):
            return found, strokes
    return found._replace(code=layout.NOT_FOUND), strokes


def has_slow_states(engine: Engine) -> bool:
    """Whether a state may move by less than the tolerance in a cycle, far from rest."""
    return "frame" in engine.frame.states or any(map(may_be_slow, engine.chambers))


def may_be_slow(chamber: Chamber) -> bool:
    """Whether a state of a chamber may move by less than the tolerance in a cycle, far from rest.

    The wall of a great mass, or a gas spring behind tight rings: there Newton's method decides.
    """
    leaks = isinstance(chamber, BounceChamber) and not chamber.is_sealed
    return leaks or "wall_temperature" in chamber.states


def is_sharp(return_map: ReturnMap, found: Search, rtol: float) -> bool:
    """Whether the steps were fine enough for the orbit just found, or can be no finer."""
    off = imbalance(return_map.strokes[1], return_map.strokes[:2])
    return bool(are_sharp(found.slowness, off, rtol))


def are_sharp(slowness: Any, off: Any, rtol: float) -> Any:
    """The same of many orbits, by the slowness of their searches and their imbalance of energy."""
    return (rtol <= FINEST) | ((slowness <= SLOWEST) & (off <= max(COARSE, rtol)))


def finer(rtol: float) -> float:
    """Tolerance with which an orbit is found anew."""
    return max(FINER * rtol, FINEST)


def is_near(return_map: ReturnMap, distance: float) -> bool:
    """Whether the fixed point just found is as near, by what two residuals say of slow states.

    Entry by entry: from a residual a to a residual b that is m a, ``a b / (a - b)`` is left, by
    Aitken. The second residual is that of a whole cycle, for a map of half a cycle ``m (m + 1) a``:
    next to m = 1 that leaves ``3/2 a b / (2 a - b)``.
    """
    free = free_entries(return_map.engine)
    return bool(are_near(return_map.iterates, return_map.mirrored, free, distance))


def are_near(
    vectors: Any, mirrored: bool, free: list[int], distance: float, at_once: Any = False
) -> Any:
    """The same of many searches, each a row of `residual`, `image` and `point` in `vectors`.

    Where the first residual is that of the first half of the cycle itself, b is ``(m + 1) a``:
    that leaves ``a^2 / (2 a - b)``.
    """
    first, second = vectors.residual, vectors.image - vectors.point
    usual, share = (2.0, 1.5) if mirrored else (1.0, 1.0)
    product = first * np.where(np.expand_dims(at_once, -1), first, share * second)
    far = np.abs(product) > distance * np.abs(usual * first - second)
    far &= np.abs(second) > ROUNDING
    return ~far[..., free].any(axis=-1)


def free_entries(engine: Engine) -> list[int]:
    """Entries of the vector that an orbit decides about: all but entropies that nothing changes."""
    fixed = conserved_entries(engine) | unused_entries(engine)
    return sorted(set(range(layout.N_VECTOR)) - fixed)


def newton_step(return_map: ReturnMap, follow: bool = False) -> np.ndarray | None:
    """Way from the present state to the fixed point, as Newton's method has it; None if unknown.

    Where that is far and the slow motion is to be followed, a part of the way that takes.
    """
    state = return_map.state
    start = State(state.engine.copy(), state.chambers.copy(), state.y.copy(), np.zeros(0))
    fine = return_map.finer(FINE, FINE_STEPS)
    try:
        z = fine.vector(start)
        residual = fine.image(start, z) - z
        matrix = np.eye(len(z)) - fine.jacobian(start, z)
    except NoReturn:
        return None
    free = free_entries(return_map.engine)
    if not np.isfinite(matrix).all() or not np.isfinite(residual).all():
        return None
    jump = np.zeros(len(z))
    matrix, residual = matrix[np.ix_(free, free)], residual[free]
    jump[free] = np.linalg.lstsq(matrix, residual, rcond=None)[0]
    if follow and np.abs(jump).max() > NEARBY:
        jump[free] = slow_step(matrix, residual)
    return jump


def jump_to_return(return_map: ReturnMap, jump: np.ndarray) -> bool:
    """Take a jump, shortened until the state it leads to comes back near to itself; if it does."""
    begin = return_map.state.copy()
    for share in SHARES:
        return_map.reset(begin)
        return_map.jump(share * jump)
        there = return_map.state.copy()
        z = return_map.vector(there)
        try:
            missed = np.abs(return_map.image(there, z) - z).max()
        except NoReturn:
            continue
        if missed < SLOW:
            return_map.reset(there)
            return True
    return False


def slow_step(matrix: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """Step that stands for as many returns as move the state by no more than `LONGEST`.

    Far away Newton's method may lead to where no fixed point is: the leak of a gas spring that
    slows down as the spring fills seems to end at an infinite mass. The implicit step of Euler's
    method for n returns, ``(I / n + I - J) dz = residual``, goes where the motion itself goes, and
    is Newton's as n grows.

    Parameters
    ----------
    matrix : ndarray
        Identity less the derivative of the map.
    residual : ndarray
    """
    step, returns = residual, 1.0
    while returns < MAX_RETURNS:
        shift = np.eye(len(residual)) / returns
        longer = np.linalg.lstsq(matrix + shift, residual, rcond=None)[0]
        if not np.abs(longer).max() <= LONGEST:
            break
        step, returns = longer, 2.0 * returns
    return step


def give_back_entropy(return_map: ReturnMap, begin: State, tolerance: float) -> bool:
    """Give sealed adiabatic chambers the entropy they began with; whether that changed anything.

    Every entropy has an orbit of its own: extrapolation may not choose one.
    """
    changed = False
    for side, chamber in enumerate(return_map.engine.chambers):
        if not is_adiabatic(chamber):
            continue
        gas = chamber.gas_properties  # type: ignore[attr-defined]
        rise = rise_of_theta(gas, begin, return_map.state, side)
        if abs(rise) > tolerance:
            return_map.state.y[layout.THETA + side] -= rise
            changed = True
    return changed
