"""The return map of an engine: from one dead centre to the next alike."""

from __future__ import annotations

import dis
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any, NamedTuple

import numpy as np

from saleg.compiler import search
from saleg.compiler.compiled_engine import compiled_engine
from saleg.compiler.kernel import Kernel
from saleg.engine import BounceChamber, Chamber, Engine, OpenEnd
from saleg.kernel import layout, tableaus
from saleg.kernel.differences import Differences
from saleg.kernel.extrapolation import DEPTH
from saleg.kernel.orbit import CYCLE, FIND, IMAGE, strokes_per_map
from saleg.kernel.orbits import Searches
from saleg.kernel.tuples import Iterates, ReturnMapping, Snapshots, Tables
from saleg.kernel.vector import (
    Z_AMPERES,
    Z_BURN_PHASE,
    Z_CHAMBERS,
    Z_CRANKCASE_BURNT,
    Z_CRANKCASE_MASS,
    Z_FRAME_V,
    Z_FRAME_X,
    Z_FRESH,
    Z_INTEGRAL,
    Z_LN_CLOSING_PRESSURE,
    Z_LN_CLOSING_TEMPERATURE,
    Z_LN_CRANKCASE,
    Z_LN_DURATION,
    Z_LN_LIT,
    Z_LN_MASS_MOVING,
    Z_LN_MOTORED,
    Z_LN_PRESSURE,
    Z_RATIO,
    Z_TO_BURN,
    Z_WALL,
    mirror,
    read_vector,
    write_vector,
)
from saleg.laws import NoHeatTransfer, NoMisfires, NoScatter
from saleg.laws.arguments import Charge, Gas, Motion, Stroke
from saleg.laws.base import Alternator, Law
from saleg.simulation.course import STEPS_PER_CALL, options_record
from saleg.simulation.initial_rows import States
from saleg.simulation.initial_state import State
from saleg.simulation.kernel_arguments import arguments_of
from saleg.simulation.settings import Detail, Settings

#: Longest time to the next return, over the natural time of half a stroke.
LONGEST = 200.0
#: Positions, velocities and currents, over their natural sizes, at which the laws of motion are
#: compared with their mirror images.
PROBES = tuple(
    (position, speed, 0.7 * speed)
    for position, speed in zip(
        (0.03, 0.11, 0.23, 0.31, 0.42, 0.53, 0.61, 0.72, 0.80, 0.86, 0.90, 0.94, 0.97, 0.99),
        (0.97, -0.9, 0.85, -0.8, 0.7, -0.6, 0.5, -0.45, 0.4, -0.3, 0.25, -0.2, 0.1, -0.05),
        strict=True,
    )
)
#: Hot gas in motion and its charge, to which every wall that takes heat has a coefficient.
PROBE_GAS = Gas(30e5, 900.0, 1e-4, 20e5, 0.03, 0.06, 8.0, 450.0, 0.0, -5.0)
PROBE_CHARGE = Charge(1e-4, 0.0, 1e-4, 0.0, 0.0, 1e5, 300.0, 4e-4, 3e-4)
#: Methods of laws of motion that are shown no motion, but a stroke or a position.
SHOWN_NO_MOTION = ("at_dead_centre", "next_breakpoint")
#: How Python takes a field by name, and the fields of a motion that are not the time.
TAKE = "LOAD_ATTR"
TIMELESS = frozenset(Motion._fields) - {"t"}
#: Longest way of a jump at once, over the entry of the vector or one.
FARTHEST = 0.5
#: Difference of a central difference, over the numbers of order one in a vector.
DIFFERENCE = 1e-5
#: Entries of the vector, per side, for the states that laws ask for; masses have entries anyway.
ENTRIES_OF_STATES = {
    "contents": (Z_FRESH, Z_LN_LIT, Z_LN_CLOSING_PRESSURE, Z_LN_CLOSING_TEMPERATURE),
    "wall_temperature": (Z_WALL,),
    "crankcase": (Z_LN_CRANKCASE, Z_CRANKCASE_MASS, Z_CRANKCASE_BURNT),
}
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


def constant_entries(engine: Engine) -> set[int]:
    """Entries of the vector that nothing can change: a current that is not, a sealed charge."""
    kept = set()
    if type(engine.alternator).current_rate is Alternator.current_rate:
        kept.add(Z_AMPERES)
    if "frame" not in engine.frame.states:
        kept |= {Z_FRAME_X, Z_FRAME_V}
    for side, chamber in enumerate(engine.chambers):
        first = Z_CHAMBERS + layout.VECTOR_PER_SIDE * side
        if isinstance(chamber, OpenEnd):
            kept |= {first + n for n in range(layout.VECTOR_PER_SIDE)}
        elif chamber.is_sealed:
            kept |= {first + n for n in range(layout.VECTOR_PER_SIDE)}
            kept -= {first + Z_LN_PRESSURE, first + Z_LN_MOTORED, first + Z_WALL}
        elif isinstance(chamber, BounceChamber):  # gas flows, but no charge is composed
            kept |= {first + Z_INTEGRAL, first + Z_RATIO, first + Z_LN_LIT}
            kept |= {first + Z_LN_CLOSING_PRESSURE, first + Z_LN_CLOSING_TEMPERATURE}
        if not engine.needs_motored_pressure:
            kept.add(first + Z_LN_MOTORED)
    return kept | unused_entries(engine)


def unused_entries(engine: Engine) -> set[int]:
    """Entries of the vector for states of the chambers that none of their laws asks for."""
    return {
        Z_CHAMBERS + layout.VECTOR_PER_SIDE * side + n
        for side, chamber in enumerate(engine.chambers)
        for name, entries in ENTRIES_OF_STATES.items()
        if name not in chamber.states
        for n in entries
    }


def conserved_entries(engine: Engine) -> set[int]:
    """Entries of the vector that hold the entropy of sealed chambers without heat transfer."""
    return sealed_entries(engine, [is_adiabatic(chamber) for chamber in engine.chambers])


def sealed_entries(engine: Engine, wanted: Sequence[bool] = (True, True)) -> set[int]:
    """Entries of the vector for the pressures in those chambers that never open."""
    entries = [Z_LN_PRESSURE] + [Z_LN_MOTORED] * engine.needs_motored_pressure
    return {
        Z_CHAMBERS + layout.VECTOR_PER_SIDE * side + n
        for side, chamber in enumerate(engine.chambers)
        if wanted[side] and chamber.is_sealed
        for n in entries
    }


def is_adiabatic(chamber: Chamber) -> bool:
    """Whether a chamber is sealed and without heat transfer, so that it keeps its entropy."""
    if not chamber.is_sealed:
        return False
    law = chamber.heat_transfer  # type: ignore[attr-defined]
    return isinstance(law, NoHeatTransfer) or law.coefficient(PROBE_GAS, PROBE_CHARGE) == 0.0


def repeats_itself(engine: Engine) -> bool:
    """Whether nothing in an engine depends on the time or on the number of the charge."""
    if not isinstance(engine.scatter, NoScatter):
        return False
    for chamber in engine.chambers:
        if not isinstance(getattr(chamber, "misfires", NoMisfires()), NoMisfires):
            return False
    kinds: list[Any] = [type(law) for law in _laws_of_motion(engine)]
    return not any(_asks_for_time(kind) for kind in kinds)


@lru_cache(maxsize=256)
def _asks_for_time(law: Any) -> bool:
    """Whether a method of a law may look at the time in the motion it is shown.

    It does not if all it takes from the motion is fields by name, and none of them the time.
    Whoever unpacks the motion, takes a field by number or hands the motion on may well look.
    """
    return any(
        not isinstance(method, FunctionType) or _looks_at_time(method.__code__)
        for method in (getattr(law, name) for name in law.compiled if name not in SHOWN_NO_MOTION)
    )


def _looks_at_time(code: CodeType) -> bool:
    """Whether code does anything with its last argument but take fields other than the time."""
    motion = code.co_varnames[code.co_argcount - 1]
    steps = [step for step in dis.get_instructions(code) if step.opname not in ("CACHE", "NOP")]
    for step, following in itertools.zip_longest(steps, steps[1:]):
        names = step.argval if isinstance(step.argval, tuple) else (step.argval,)
        if motion not in names or step.opname == "LOAD_CONST":
            continue
        taken = following.argval if following is not None and following.opname == TAKE else None
        loaded_last = "LOAD_FAST" in step.opname and names[-1] == motion
        if not loaded_last or motion in names[:-1] or taken not in TIMELESS:
            return True
    return False


def is_symmetric(engine: Engine) -> bool:
    """Whether an engine is its own mirror image, laws of motion included."""
    if not engine.is_mirrored:
        return False
    if has_laws_that_mirror(engine):
        return True
    for x, v, direction, current in _probes(engine):
        try:
            there = _forces(engine, Motion(0.0, x, v, direction, current))
            mirrored = _forces(engine, Motion(0.0, -x, -v, -direction, -current))
            signs = (-1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
            for sign, a, b in zip(signs, there, mirrored, strict=True):
                if abs(sign * a - b) > 1e-12 * abs(a):
                    return False
        except Exception:  # a law that fails is named where the engine starts
            return False
    return True


def has_laws_that_mirror(engine: Engine) -> bool:
    """Whether all laws of motion are the same in the mirror whatever their numbers."""
    # A class says so for itself, not for those derived from it.
    laws = *_laws_of_motion(engine), engine.frame
    return all(vars(type(law)).get("mirrors") for law in laws)


def _laws_of_motion(engine: Engine) -> tuple[Law, ...]:
    return engine.springs, engine.friction, engine.alternator


def _probes(engine: Engine) -> list[tuple[float, float, float, float]]:
    """Positions, velocities, directions and currents at which forces are compared."""
    length = 0.5 * engine.maximum_stroke
    speed = 100.0 * length
    return [(a * length, b * speed, math.copysign(1.0, b), c) for a, b, c in PROBES]


def _forces(engine: Engine, motion: Motion) -> list[float]:
    """Forces and the rate of the current, then energies and what is held: odd, then even."""
    stroke = _stroke_at(engine, motion)
    return [
        engine.springs.force(motion),
        engine.friction.force(1.0, motion),
        engine.alternator.force(1.0, motion),
        engine.alternator.current_rate(1.0, motion),
        engine.frame.acceleration(motion.x, motion.x, motion.v),
        engine.frame.energy(motion.x, motion.v),
        engine.frame.loss(motion.v),
        engine.springs.energy(motion),
        engine.alternator.electrical_power(1.0, motion),
        engine.alternator.at_dead_centre(1.0, stroke),
        engine.friction.at_dead_centre(1.0, stroke),
    ]


def _stroke_at(engine: Engine, motion: Motion) -> Stroke:
    """A stroke that ends at different distances from the midpoint."""
    half, speed = 0.5 * engine.maximum_stroke, abs(motion.v)
    ends = sorted((motion.x, -0.9 * motion.x))
    length = ends[1] - ends[0]
    area = 0.5 * sum(chamber.area for chamber in engine.chambers)
    return Stroke(length, length / speed, 2.0 * half, half, area, 1.0, speed, *ends)
