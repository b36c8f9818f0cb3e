"""Steady states of many engines of one make: one search after the other in compiled code.

The orbits that the first start of :func:`saleg.steady_state` leads to are judged for all engines at
once. An engine it leads nowhere is left to that function, which tries all other ways.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from saleg.compiler import search
from saleg.compiler.compiled_engine import check_methods, numbers_of_rows
from saleg.engine import Engine
from saleg.engine.columns import Rows, is_sound
from saleg.errors import SalegError
from saleg.kernel import layout
from saleg.kernel.orbit import NEAR, strokes_per_map
from saleg.kernel.orbits import Searches
from saleg.kernel.tuples import Snapshots
from saleg.laws import NoHeatTransfer
from saleg.simulation.initial_rows import States, prepare_rows
from saleg.simulation.law_ranges import check_flows
from saleg.simulation.outcome import imbalance, is_dead, is_idling
from saleg.status import Status
from saleg.steady.entries import is_adiabatic
from saleg.steady.lanes import BY_ITSELF, UNKNOWN, find_each
from saleg.steady.lines import Lines, lines_among, no_lines
from saleg.steady.return_map import ReturnMap, longest_return, map_tolerance, step_tolerance
from saleg.steady.sealed_gas import rises_of_theta
from saleg.steady.slow_states import are_near, are_sharp, free_entries, has_slow_states
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
from saleg.steady.symmetry import has_laws_that_mirror, is_symmetric, repeats_itself

#: What of searches is one row for each engine.
ROW_BY_ROW = (
    "engine",
    "y",
    "codes",
    "found",
    "followed",
    "at_once",
    "point",
    "residual",
    "image",
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
    starts : States
        At the left dead centres at which the cycles begin.
    """

    rows: Rows
    mirrored: bool
    strokes: np.ndarray
    mass: np.ndarray
    half_cycles: np.ndarray
    evaluations: np.ndarray
    residual: np.ndarray
    starts: States

    def some(self, chosen: np.ndarray) -> Orbits:
        """Some of them."""
        if chosen.dtype == bool and chosen.all():
            return self
        strokes, mass, half_cycles, evaluations, residual = (p[chosen] for p in self[2:-1])
        return Orbits(
            rows=self.rows.some(chosen),
            mirrored=self.mirrored,
            strokes=strokes,
            mass=mass,
            half_cycles=half_cycles,
            evaluations=evaluations,
            residual=residual,
            starts=self.starts.some(chosen),
        )


def steady_rows(rows: Rows, rtol: float, effort: Effort, total: int = UNKNOWN) -> list[Orbits]:
    """Orbits of those among some engines that have one where the first start leads.

    Parameters
    ----------
    rows : Rows
        Engines of one make, valid or not.
    rtol : float
        Tolerance of the integrator.
    effort : Effort
    total : int
        Number of engines in the batch they are a piece of, as in :mod:`saleg.steady.lanes`.

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
    if not rows.count or not search.stands_alone() or not _can_be_searched(rows.first):
        return []
    symmetric = _are_symmetric(rows)
    lots = [(rows.some(symmetric == mirrored), mirrored) for mirrored in (True, False)]
    return [(lot, mirrored) for lot, mirrored in lots if lot.count]


def _can_be_searched(engine: Engine) -> bool:
    """Whether engines of this make have a return map, laws to compile and no slow states."""
    try:
        engine.validate()
        engine.check_laws()
        check_methods(engine.laws.values())
        check_flows(engine)
        return repeats_itself(engine) and not has_slow_states(engine)
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
    total: int = UNKNOWN,
    tell: Callable[[States, np.ndarray], None] | None = None,
    numbers: np.ndarray | None = None,
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
        Number of engines in the batch they are a piece of, as in :mod:`saleg.steady.lanes`.
    tell : callable, optional
        Writes into the states the search begins with, given whether each row has one.
    numbers : ndarray, shape (n, k), optional
        What the engines are made from, by which lines among them are found; their own numbers
        unless given.
    """
    begin, ready = prepare_rows(rows, _from_first_start)
    if not ready.any():
        return None
    rows, begin = rows.some(ready), begin.some(ready)
    if tell is not None:
        tell(begin, ready)
    numbers = rows.numbers() if numbers is None else numbers[ready]
    follows = total != BY_ITSELF and _may_follow(rows.engine)
    lines = lines_among(numbers) if follows else no_lines(rows.count)
    search = _Search(rows, begin, mirrored, rtol, limits, total)
    room, good = search.found(lines)
    search.check(lines, room, good)
    if not good.any():
        return None
    begun = room.starts
    chambers = begun.chambers.view(layout.CHAMBER_RECORD).reshape(-1, 2)
    return Orbits(
        rows=rows,
        mirrored=mirrored,
        strokes=room.strokes.reshape(-1, 2),
        mass=room.engine["mass"],
        half_cycles=(room.found["maps"] * strokes_per_map(mirrored)).astype(int) + 2,
        evaluations=room.engine["evaluations"],
        residual=room.found["missed"],
        starts=States(begun.engine, chambers, begun.y),
    ).some(good)


def _may_follow(engine: Engine) -> bool:
    """Whether engines may follow each other along a line.

    What a bounce chamber holds is given, its entropy too: no neighbour may say it.
    """
    return not any(chamber.is_sealed for chamber in engine.chambers)


class _Search(NamedTuple):
    """Search for the orbits of some engines.

    Attributes
    ----------
    rows : Rows
    begin : States
        Where each begins.
    mirrored, rtol, limits, total
        As for :func:`searched`.
    """

    rows: Rows
    begin: States
    mirrored: bool
    rtol: float
    limits: Limits
    total: int

    def found(self, lines: Lines) -> tuple[Searches, np.ndarray]:
        """What was found, and whether it is an orbit."""
        rows, mirrored, limits = self.rows, self.mirrored, self.limits
        rtol, one = self.tolerance, rows.first
        states = self.begin.copy()
        steps = step_tolerance(one, self.rtol)
        return_map = ReturnMap.of(one, states.row(0), steps, mirrored, limits.most_steps)
        room = _room(rows, states, lines)
        find_each(return_map, limits.max_maps, RESIDUAL * rtol, room, self.total)
        strokes = room.strokes.reshape(-1, 2)
        good = room.codes == layout.END_OF_TIME
        good &= room.found["missed"] <= limits.missed * rtol
        good &= are_near(room, mirrored, free_entries(one), NEAR * RESIDUAL * rtol, room.at_once)
        good &= are_sharp(room.found["slowness"], imbalance(strokes[:, 1], strokes), rtol)
        _leave_out_changed_entropies(good, rows, self.begin, states, NEAR * RESIDUAL * rtol)
        return room, good

    @property
    def tolerance(self) -> float:
        """Tolerance to which a return can be told."""
        return map_tolerance(self.rows.engine, self.rtol)

    def some(self, chosen: np.ndarray) -> _Search:
        """The search for some of them."""
        rest = self[2:]
        return _Search(self.rows.some(chosen), self.begin.some(chosen), *rest)

    def check(self, lines: Lines, room: Searches, good: np.ndarray) -> None:
        """Replace what lines have led to and engines would not have come to from their starts.

        Where a line has led to no orbit, and that is no chance, all rows of its stretch are
        searched for from their own starts.
        """
        doubtful = room.followed & ~good
        differs = self._take_from_starts(np.flatnonzero(doubtful), room, good)
        again = lines.around(differs) & room.followed
        self._take_from_starts(np.flatnonzero(again), room, good)

    def _take_from_starts(self, chosen: np.ndarray, room: Searches, good: np.ndarray) -> np.ndarray:
        """Put what rows come to from their own starts in place; which that moves elsewhere."""
        if not len(chosen):
            return chosen
        own, own_good = self.some(chosen).found(no_lines(len(chosen)))
        apart = np.abs(own.image - room.image[chosen]).max(axis=1)
        apart_modes = own.chambers["mode"] != room.chambers["mode"].reshape(-1, 2)[chosen].ravel()
        same = apart <= NEAR * RESIDUAL * self.tolerance
        same &= ~apart_modes.reshape(-1, 2).any(axis=1)
        for name in ROW_BY_ROW:
            getattr(room, name)[chosen] = getattr(own, name)
        for name in ("chambers", "strokes"):
            pairs = getattr(room, name).reshape(-1, 2)
            pairs[chosen] = getattr(own, name).reshape(-1, 2)
        for begun, own_begun in zip(room.starts, own.starts, strict=True):
            each = begun.reshape(len(good), -1)
            each[chosen] = own_begun.reshape(len(chosen), -1)
        good[chosen] = own_good
        return chosen[~(same & own_good)]


def verdicts(orbits: Orbits, rtol: float) -> tuple[np.ndarray, np.ndarray]:
    """Status and message of each orbit; most are steady states."""
    rows, strokes = orbits.rows, orbits.strokes
    rtol = step_tolerance(rows.engine, rtol)
    pairs = zip(orbits.half_cycles.tolist(), orbits.residual.tolist(), strict=True)
    messages = [fixed_point_message(orbits.mirrored, *pair) for pair in pairs]
    statuses = [str(Status.STEADY)] * len(messages)
    off = imbalance(strokes[:, 1], strokes) > max_imbalance(rtol)
    odd = off | is_dead(rows.engine, strokes) | is_idling(rows.engine, strokes)
    for n in np.flatnonzero(odd).tolist():
        status, what = kind_of(rows.row(n), strokes[n], rtol)
        statuses[n], messages[n] = str(status), what + messages[n]
    return np.array(statuses, dtype=object), np.array(messages, dtype=object)


def _room(rows: Rows, states: States, lines: Lines) -> Searches:
    """Engines and their states as the compiled search takes them, with room for what it finds."""
    n = rows.count
    words = layout.CHAMBER_RECORD.itemsize // 8
    vectors = np.zeros((3, n, layout.N_VECTOR))
    return Searches(
        laws=numbers_of_rows(rows.engine, n),
        engine=states.engine,
        chambers=states.chambers.reshape(2 * n),
        y=states.y,
        longest=longest_return(states.engine),
        order=lines.order,
        before=lines.before,
        ahead=lines.ahead,
        followed=np.full(n, False),
        at_once=np.full(n, False),
        codes=np.full(n, layout.GOES_ON, np.int64),
        found=np.zeros(n, layout.SEARCH_RECORD),
        spare=np.zeros(1, layout.SEARCH_RECORD),
        strokes=np.zeros(2 * n, layout.STROKE_RECORD),
        point=vectors[0],
        residual=vectors[1],
        image=vectors[2],
        starts=Snapshots(
            engine=np.zeros(n, layout.ENGINE_RECORD),
            chambers=np.zeros((2 * n, words), np.int64),
            y=np.zeros((n, layout.N_ALL)),
        ),
    )


def _leave_out_changed_entropies(
    good: np.ndarray, rows: Rows, begin: States, end: States, tolerance: float
) -> None:
    """Leave out engines whose sealed adiabatic chambers have another entropy than they began with.

    Which chambers are adiabatic may depend on the numbers of their law.
    """
    for side, chamber in enumerate(rows.engine.chambers):
        if not chamber.is_sealed:
            continue
        if isinstance(chamber.laws["heat_transfer"], NoHeatTransfer):
            rises = rises_of_theta(rows, begin, end, side, np.flatnonzero(good))
            good &= np.abs(rises) <= tolerance
        else:
            for n in np.flatnonzero(good).tolist():
                good[n] = not is_adiabatic(rows.row(n).chambers[side])
