"""The return map of an engine: from one dead centre to the next alike."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from saleg.compiler import search
from saleg.compiler.compiled_engine import compiled_engine
from saleg.compiler.kernel import Kernel
from saleg.engine import Engine
from saleg.kernel import layout, tableaus
from saleg.kernel.differences import Differences
from saleg.kernel.extrapolation import DEPTH
from saleg.kernel.orbit import CYCLE, FIND, IMAGE, strokes_per_map
from saleg.kernel.orbits import Searches
from saleg.kernel.tuples import Iterates, ReturnMapping, Snapshots, Tables
from saleg.kernel.vector import (
    Z_BURN_PHASE,
    Z_CHAMBERS,
    Z_FRAME_V,
    Z_FRAME_X,
    Z_INTEGRAL,
    Z_LN_CLOSING_PRESSURE,
    Z_LN_CLOSING_TEMPERATURE,
    Z_LN_DURATION,
    Z_LN_LIT,
    Z_LN_MASS_MOVING,
    Z_LN_MOTORED,
    Z_LN_PRESSURE,
    Z_TO_BURN,
    mirror,
    read_vector,
    write_vector,
)
from saleg.simulation.course import STEPS_PER_CALL, options_record
from saleg.simulation.initial_rows import States
from saleg.simulation.initial_state import State
from saleg.simulation.kernel_arguments import arguments_of
from saleg.simulation.settings import Detail, Settings
from saleg.steady.entries import constant_entries

#: Longest time to the next return, over the natural time of half a stroke.
LONGEST = 200.0
#: Longest way of a jump at once, over the entry of the vector or one.
FARTHEST = 0.5
#: Difference of a central difference, over the numbers of order one in a vector.
DIFFERENCE = 1e-5
#: Tolerance of the steps of an engine that breathes, over that of the map, and the least there is.
FINER_WITH_CORNERS = 1e-3
FINEST_WITH_CORNERS = 1e-12
#: Scatter of the image of such an engine over the tolerance of the steps, at the most.
SCATTER = 1e4


class NoReturn(Exception):
    """The map has no image: the engine stalls, meets its head, or its step fails.

    Attributes
    ----------
    code : int
        Why the integrator came back.
    """

    def __init__(self, code: int):
        super().__init__(code)
        self.code = code


class Search(NamedTuple):
    """End of a search for a fixed point, or of a cycle from a given state.

    Attributes
    ----------
    code : int
        Why the integrator came back, as a code of :mod:`saleg.kernel.layout`.
    maps : float
        Maps taken.
    residual : float
        How far the last image is from its point [-].
    slowness : float
        How many residuals the fixed point may be away, by the points of the search [-].
    missed : float
        How far the whole cycle after it misses its start [-].
    """

    code: int
    maps: float
    residual: float
    slowness: float
    missed: float


@dataclass
class ReturnMap:
    """Return map of an engine, with the records it works on.

    Attributes
    ----------
    engine : Engine
    kernel : Kernel
        Of the search for fixed points.
    state : State
        The present state; every call moves it.
    mirrored : bool
        Whether the map is that of half a cycle, seen in the mirror.
    strokes : ndarray of STROKE_RECORD
        Rows of the latest map.
    mapping : ReturnMapping
        Arguments of the compiled map.
    iterates : Iterates
        Vectors of the latest search (see the kernel's find_orbit).
    """

    engine: Engine
    kernel: Kernel
    state: State
    mirrored: bool
    strokes: np.ndarray
    mapping: ReturnMapping
    iterates: Iterates

    @classmethod
    def of(
        cls,
        engine: Engine,
        state: State,
        rtol: float,
        mirrored: bool,
        most_steps: int = STEPS_PER_CALL,
    ) -> ReturnMap:
        """Return map that begins at a state; a return may take so many steps."""
        settings = Settings(
            duration=math.inf,
            rtol=rtol,
            motored_pressure=engine.needs_motored_pressure,
        )
        options = options_record(settings, math.inf, Detail(peaks=0))
        options["events"] = 0
        options["max_steps"] = most_steps
        options["longest"] = longest_return(state.engine)
        strokes = np.zeros(4, layout.STROKE_RECORD)
        tables = Tables(
            strokes=strokes,
            events=np.zeros(0, layout.EVENT_RECORD),
            history=np.zeros(0, layout.HISTORY_RECORD),
            filled=np.zeros(1, layout.FILLED_RECORD),
        )
        compiled = compiled_engine(engine, modules=search.modules())
        arguments = arguments_of(
            compiled,
            state,
            tableau=tableaus.ADAPTIVE,
            order=tableaus.ADAPTIVE_ORDER,
            options=options,
            tables=tables,
        )
        searched = search.compiled_search(compiled.kernel, arguments)
        mapping = ReturnMapping(
            integration=searched.integration,
            address=searched.address,
            mirrored=mirrored,
        )
        return cls(engine, searched.kernel, state, mirrored, strokes, mapping, iterates_from())

    def finer(self, rtol: float, most_steps: int | None = None) -> ReturnMap:
        """The same map with another tolerance, from a copy of the present state."""
        if most_steps is None:
            most_steps = int(self.mapping.integration.options["max_steps"][0])
        return ReturnMap.of(self.engine, self.state.copy(), rtol, self.mirrored, most_steps)

    @property
    def snapshots(self) -> Snapshots:
        """States at the last two left dead centres."""
        return self.mapping.integration.snapshots

    @property
    def strokes_per_map(self) -> float:
        """Strokes from one return to the next."""
        return strokes_per_map(self.mirrored)

    @property
    def evaluations(self) -> int:
        """Right-hand sides evaluated so far."""
        return int(self.state.engine["evaluations"][0])

    def find(self, max_maps: int, tolerance: float) -> Search:
        """Look for a fixed point by iteration and extrapolation (see the kernel's find_orbit)."""
        self.iterates = iterates_from()
        return self._do(FIND, self.iterates, max_maps, tolerance)

    def find_each(self, max_maps: int, tolerance: float, searches: Searches) -> None:
        """Look for the fixed points of many engines of the same laws, one after the other."""
        self.kernel.call(
            "find_orbits", self.mapping, max_maps, tolerance, iterates_from(), searches
        )

    def _do(
        self, task: int, iterates: Iterates, max_maps: int = 0, tolerance: float = 0.0
    ) -> Search:
        """Call the compiled entry point."""
        found = np.zeros(1, layout.SEARCH_RECORD)
        code = self.kernel.call(
            "do_orbit", task, self.mapping, max_maps, tolerance, iterates, found
        )
        return Search(int(code), *found[0].tolist())

    def jump(self, change: np.ndarray) -> None:
        """Move the present state by a change of its vector; a long one is shortened."""
        z = self.vector(self.state)
        room = (FARTHEST * np.maximum(np.abs(z), 1.0) / np.maximum(np.abs(change), 1e-300)).min()
        read_vector(*self.state.records, self.state.y, z + min(room, 1.0) * change)

    def begin_on_the_left(self) -> None:
        """Take the cycle just recorded from its left dead centre, if it began on the right."""
        if self.state.engine["direction"][0] > 0.0:
            return
        words = self.mapping.integration.words.chambers
        self.mapping, asked = self.mapping._replace(mirrored=True), self.mapping
        self._do(IMAGE, iterates_from(self.vector(self.state)))
        mirror(*self.state.records, self.state.y, words)  # half a cycle on, seen without the mirror
        self.mapping = asked
        self._do(CYCLE, iterates_from(self.vector(self.state)))

    def cycle(self, start: State, z: np.ndarray) -> Search:
        """Whole cycle from a vector, recorded."""
        self.reset(start)
        return self._do(CYCLE, iterates_from(z))

    def reset(self, state: State) -> None:
        """Go to a copy of a state."""
        self.state.engine[:] = state.engine
        self.state.peaks[:] = 0.0
        self.state.chambers[:] = state.chambers
        self.state.y[:] = state.y

    def image(self, start: State, z: np.ndarray) -> np.ndarray:
        """Image of a vector, the rest of the state as in `start`.

        Raises
        ------
        NoReturn
            If there is none.
        """
        self.reset(start)
        iterates = iterates_from(z)
        code = self._do(IMAGE, iterates).code
        if code != layout.END_OF_TIME:
            raise NoReturn(code)
        image: np.ndarray = iterates.image
        return image

    def vector(self, state: State) -> np.ndarray:
        """A state as a vector."""
        z = np.empty(layout.N_VECTOR)
        write_vector(*state.records, state.y, z)
        return z

    def jacobian(self, start: State, z: np.ndarray, by: float = DIFFERENCE) -> np.ndarray:
        """Derivative of the map at a vector, by central differences, the rest as in `start`.

        Raises
        ------
        NoReturn
            If a vector near by has no image.
        """
        differences = differences_at(self.engine, States.of(start), by)
        differences.points[0] = z
        code = self.kernel.call("find_jacobian", self.mapping, iterates_from(), differences)
        if code != layout.END_OF_TIME:
            raise NoReturn(int(code))
        matrix: np.ndarray = differences.matrices[0]
        return matrix

    def moved_entries(self, start: State) -> np.ndarray:
        """Entries of the vector that can make a difference at a state."""
        return np.flatnonzero(_moved_entries(self.engine, States.of(start))[0])

    def jacobians(self, laws: np.ndarray, differences: Differences) -> None:
        """Differentiate the maps of many engines, whose laws have these numbers."""
        self.kernel.call("find_jacobians", self.mapping, iterates_from(), laws, differences)


def differences_at(engine: Engine, starts: States, by: float) -> Differences:
    """Room for the derivatives of return maps at some states.

    Parameters
    ----------
    engine : Engine
        One of them; all have the same laws.
    starts : States
    by : float
        Difference on either side.
    """
    count = len(starts.y)
    points = np.zeros((count, layout.N_VECTOR))
    E, C = starts.engine.view(np.recarray), starts.chambers.view(np.recarray)
    for n in range(count):
        write_vector(E[n], C[n], starts.y[n], points[n])
    return Differences(
        engine=starts.engine,
        chambers=starts.chambers.reshape(2 * count),
        y=starts.y,
        longest=longest_return(starts.engine),
        points=points,
        moved=_moved_entries(engine, starts),
        by=by,
        matrices=np.zeros((count, layout.N_VECTOR, layout.N_VECTOR)),
        codes=np.zeros(count, np.int64),
    )


def step_tolerance(engine: Engine, rtol: float) -> float:
    """Tolerance of the steps of a return map.

    Valves that lift and flows that turn are corners at which no step ends: the image scatters by
    some hundred times the tolerance where an engine breathes.
    """
    return max(FINER_WITH_CORNERS * rtol, FINEST_WITH_CORNERS) if has_states(engine) else rtol


def map_tolerance(engine: Engine, rtol: float) -> float:
    """Tolerance to which a return can be told: above the scatter of the finest steps."""
    return max(rtol, SCATTER * FINEST_WITH_CORNERS) if has_states(engine) else rtol


def has_states(engine: Engine) -> bool:
    """Whether chambers own states, beside pressure, that change as gas flows or walls warm up."""
    return any(chamber.states for chamber in engine.chambers)


def longest_return(engines: np.ndarray) -> np.ndarray:
    """Longest time to the next return of each engine [s]."""
    longest: np.ndarray = LONGEST * engines["length_scale"] / engines["speed_scale"]
    return longest


def _moved_entries(engine: Engine, starts: States) -> np.ndarray:
    """Whether each entry of the vector can make a difference; those of an open chamber do not."""
    moved = np.full((len(starts.y), layout.N_VECTOR), True)
    moved[:, sorted(constant_entries(engine))] = False
    moved[:, Z_FRAME_X] &= starts.engine["frame_is_held"] > 0.0
    moved[:, Z_FRAME_V] &= starts.engine["frame_is_slowed"] > 0.0
    moved[:, Z_LN_MASS_MOVING] &= starts.engine["mass_fixed"] > 0.0
    for side, mode in enumerate(starts.chambers["mode"].T):
        first = Z_CHAMBERS + layout.VECTOR_PER_SIDE * side
        by_flow = starts.chambers["by_flow"][:, side] > 0.0
        for entry in (Z_LN_PRESSURE, Z_INTEGRAL, Z_LN_MOTORED):
            moved[:, first + entry] &= (mode != layout.OPEN) | by_flow
        for entry in (Z_BURN_PHASE, Z_LN_DURATION, Z_TO_BURN, Z_LN_LIT):
            moved[:, first + entry] &= mode == layout.BURNING
        for entry in (Z_LN_CLOSING_PRESSURE, Z_LN_CLOSING_TEMPERATURE):
            moved[:, first + entry] &= (mode != layout.OPEN) & by_flow
    return moved


def iterates_from(point: np.ndarray | None = None) -> Iterates:
    """Room for points, residuals and images; begins at a point."""
    n = layout.N_VECTOR
    return Iterates(
        point=np.zeros(n) if point is None else point.copy(),
        residual=np.zeros(n),
        image=np.zeros(n),
        points=np.zeros((DEPTH, n)),
        residuals=np.zeros((DEPTH, n)),
        gram=np.zeros((DEPTH, DEPTH + 2)),
        modes=np.zeros(2, np.int64),
        counts=np.zeros(2, np.int64),
    )
