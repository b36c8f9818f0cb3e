"""Steady states of many engines of one make: one search after the other in compiled code.

The orbits that the first start of :func:`saleg.steady_state` leads to are judged for all engines at
once. An engine it leads nowhere is left to that function, which tries all other ways.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from saleg.compiler import search
from saleg.compiler.compiled_engine import check_methods, numbers_of_rows
from saleg.engine import BounceChamber, Engine
from saleg.engine.columns import Rows, is_sound
from saleg.errors import SalegError
from saleg.kernel import layout
from saleg.kernel.orbit import NEAR, strokes_per_map
from saleg.kernel.orbits import Searches
from saleg.laws import NoHeatTransfer
from saleg.simulation.initial_rows import States, prepare_rows
from saleg.simulation.outcome import imbalance, is_dead, is_idling
from saleg.status import Status
from saleg.steady.lanes import find_each
from saleg.steady.return_map import (
    LONGEST,
    ReturnMap,
    has_laws_that_mirror,
    is_adiabatic,
    is_symmetric,
    repeats_itself,
)
from saleg.steady.sealed_gas import rise_of_theta
from saleg.steady.slow_states import are_near, are_sharp, free_entries
from saleg.steady.solver import (
    MAX_MAPS,
    MAX_MISSED,
    MIRROR_MISSED,
    QUICK_MAPS,
    QUICK_STEPS,
    RESIDUAL,
    THOROUGH_STEPS,
    Effort,
    fixed_point_message,
    kind_of,
    max_imbalance,
    starts,
)


class Limits(NamedTuple):
    """What a search may take, and how well an orbit must close.

    Attributes
    ----------
    max_maps : int
        Maps.
    most_steps : int
        Steps to one return.
    missed : float
        Most by which the verifying cycle may miss its start, over the tolerance [-].
    """

    max_maps: int
    most_steps: int
    missed: float


class Orbits(NamedTuple):
    """Orbits of engines of one make.

    Attributes
    ----------
    rows : Rows
        The engines.
    mirrored : bool
        Whether they are fixed points of the half-cycle map.
    strokes : ndarray of STROKE_RECORD, shape (n, 2)
        The cycle of each, from its left dead centre.
    mass : ndarray, shape (n,)
        Moving mass [kg].
    half_cycles : ndarray of int, shape (n,)
    evaluations, residual : ndarray, shape (n,)
        As in :class:`saleg.SteadyState`.
    """

    rows: Rows
    mirrored: bool
    strokes: np.ndarray
    mass: np.ndarray
    half_cycles: np.ndarray
    evaluations: np.ndarray
    residual: np.ndarray

    def some(self, chosen: np.ndarray) -> Orbits:
        """Some of them."""
        rest = (part[chosen] for part in self[2:])
        return Orbits(self.rows.some(chosen), self.mirrored, *rest)


def steady_rows(rows: Rows, rtol: float, effort: Effort, total: int = 1) -> list[Orbits]:
    """Orbits of those among some engines that have one where the first start leads.

    Parameters
    ----------
    rows : Rows
        Engines of one make, valid or not.
    rtol : float
        Tolerance of the integrator.
    effort : Effort
    total : int
        Number of engines in the batch they are a piece of.

    Returns
    -------
    list of Orbits
        Symmetric engines apart from those that are not.
    """
    quick = effort is Effort.QUICK
    taken = (QUICK_MAPS, QUICK_STEPS) if quick else (MAX_MAPS, THOROUGH_STEPS)
    limits = {True: Limits(*taken, MIRROR_MISSED), False: Limits(*taken, MAX_MISSED)}
    lots = lots_to_search(rows)
    found = (searched(lot, mirrored, rtol, limits[mirrored], total) for lot, mirrored in lots)
    return [orbits for orbits in found if orbits is not None]


def lots_to_search(rows: Rows) -> list[tuple[Rows, bool]]:
    """The valid engines that have a return map, and whether it is that of half a cycle."""
    rows = rows.some(is_sound(rows))
    if not rows.count or not search.stands_alone() or not _can_be_searched(rows.row(0)):
        return []
    symmetric = _are_symmetric(rows)
    lots = [(rows.some(symmetric == mirrored), mirrored) for mirrored in (True, False)]
    return [(lot, mirrored) for lot, mirrored in lots if lot.count]


def _can_be_searched(engine: Engine) -> bool:
    """Whether engines of this make have a return map and laws that can be compiled."""
    try:
        engine.validate()
        engine.check_laws()
        check_methods(engine.laws.values())
        return repeats_itself(engine)
    except SalegError:
        return False


def _are_symmetric(rows: Rows) -> np.ndarray:
    """Whether each engine is its own mirror image."""
    if not rows.engine.is_mirrored or has_laws_that_mirror(rows.engine):
        return np.full(rows.count, is_symmetric(rows.engine))
    return np.array([is_symmetric(rows.row(n)) for n in range(rows.count)])


def _from_first_start(engine: Engine) -> Engine:
    """The engine with the start its search begins with."""
    return replace(engine, start=next(starts(engine)))


def searched(
    rows: Rows,
    mirrored: bool,
    rtol: float,
    limits: Limits,
    total: int = 1,
    tell: Callable[[States, np.ndarray], None] | None = None,
) -> Orbits | None:
    """Search from the first start, and the orbits it has found, if any.

    Parameters
    ----------
    rows : Rows
        Valid engines.
    mirrored : bool
        Whether the map is that of half a cycle.
    rtol : float
        Tolerance of the integrator.
    limits : Limits
    total : int
        Number of engines in the batch they are a piece of.
    tell : callable, optional
        Writes into the states the search begins with, given whether each row has one.
    """
    begin, ready = prepare_rows(rows, _from_first_start)
    if not ready.any():
        return None
    rows, begin = rows.some(ready), begin.some(ready)
    if tell is not None:
        tell(begin, ready)
    states = begin.some(np.arange(rows.count))
    return_map = ReturnMap.of(rows.row(0), states.row(0), rtol, mirrored, limits.most_steps)
    room = _room(rows, states)
    find_each(return_map, limits.max_maps, RESIDUAL * rtol, room, total)
    strokes = room.strokes.reshape(-1, 2)
    good = room.codes == layout.END_OF_TIME
    good &= room.found["missed"] <= limits.missed * rtol
    good &= are_near(room, mirrored, free_entries(rows.row(0)), NEAR * RESIDUAL * rtol)
    good &= are_sharp(room.found["slowness"], imbalance(strokes[:, 1], strokes), rtol)
    _leave_out_changed_entropies(good, rows, begin, states, NEAR * RESIDUAL * rtol)
    if not good.any():
        return None
    half_cycles = (room.found["maps"] * strokes_per_map(mirrored)).astype(int) + 2
    mass, evaluations = states.engine["mass"], states.engine["evaluations"]
    residual = room.found["missed"]
    return Orbits(rows, mirrored, strokes, mass, half_cycles, evaluations, residual).some(good)


def verdicts(orbits: Orbits, rtol: float) -> tuple[np.ndarray, np.ndarray]:
    """Status and message of each orbit; most are steady states."""
    rows, strokes = orbits.rows, orbits.strokes
    pairs = zip(orbits.half_cycles.tolist(), orbits.residual.tolist(), strict=True)
    messages = [fixed_point_message(orbits.mirrored, *pair) for pair in pairs]
    statuses = [str(Status.STEADY)] * len(messages)
    off = imbalance(strokes[:, 1], strokes) > max_imbalance(rtol)
    odd = off | is_dead(rows.engine, strokes) | is_idling(rows.engine, strokes)
    for n in np.flatnonzero(odd).tolist():
        status, what = kind_of(rows.row(n), strokes[n], rtol)
        statuses[n], messages[n] = str(status), what + messages[n]
    return np.array(statuses, dtype=object), np.array(messages, dtype=object)


def _room(rows: Rows, states: States) -> Searches:
    """Engines and their states as the compiled search takes them, with room for what it finds."""
    n, E = rows.count, states.engine
    vectors = np.zeros((3, n, layout.N_VECTOR))
    return Searches(
        laws=numbers_of_rows(rows.engine, n),
        engine=E,
        chambers=states.chambers.reshape(2 * n),
        y=states.y,
        longest=LONGEST * E["length_scale"] / E["speed_scale"],
        codes=np.zeros(n, np.int64),
        found=np.zeros(n, layout.SEARCH_RECORD),
        spare=np.zeros(1, layout.SEARCH_RECORD),
        strokes=np.zeros(2 * n, layout.STROKE_RECORD),
        point=vectors[0],
        residual=vectors[1],
        image=vectors[2],
    )


def _leave_out_changed_entropies(
    good: np.ndarray, rows: Rows, begin: States, end: States, tolerance: float
) -> None:
    """Leave out engines whose sealed adiabatic chambers have another entropy than they began with.

    Which chambers are adiabatic may depend on the numbers of their law.
    """
    for side, chamber in enumerate(rows.engine.chambers):
        if not isinstance(chamber, BounceChamber):
            continue
        always = isinstance(chamber.heat_transfer, NoHeatTransfer)
        for n in np.flatnonzero(good).tolist():
            one: Any = rows.row(n).chambers[side]
            if always:
                rise = rise_of_theta(one.gas_properties, begin.row(n), end.row(n), side)
                good[n] = abs(rise) <= tolerance
            else:
                good[n] = not is_adiabatic(one)
