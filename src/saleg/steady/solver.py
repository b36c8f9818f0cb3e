"""Steady states, solved for instead of waited for.

The state at a dead centre settles all that follows, so a steady state is a fixed point of the map
from one dead centre to the next alike: half a cycle later, in the mirror, for a symmetric engine.
"""

from __future__ import annotations

import enum
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from saleg.compiler.compiled_engine import check_methods
from saleg.engine import Chamber, CombustionChamber, Engine, check_engine, warn_of_unusual
from saleg.engine.start import CompressedCharge, Start, standard_charge
from saleg.errors import shown
from saleg.kernel import layout
from saleg.kernel.tuples import Snapshots
from saleg.laws import NoScatter
from saleg.quantities import as_float, is_whole
from saleg.simulation.course import Course, Replay
from saleg.simulation.initial_state import State, natural_period, prepare
from saleg.simulation.outcome import MAX_IMBALANCE, delivers_power, imbalance, is_dead, is_idling
from saleg.simulation.run import Run
from saleg.simulation.settings import Detail, Settings, SettingsError
from saleg.status import Status
from saleg.steady.earlier_names import renamed_keywords
from saleg.steady.return_map import ReturnMap, Search, map_tolerance, step_tolerance
from saleg.steady.slow_states import FINEST, MAPS_ON_THE_WAY, find_settled, finer, is_sharp
from saleg.steady.state import SteadyState
from saleg.steady.symmetry import is_symmetric, repeats_itself

DEFAULT_TOLERANCE = 1e-6
#: Maps after which iteration gives up.
MAX_MAPS = 60
#: Residual of the map a steady state may have, over the tolerance of the integrator.
RESIDUAL = 1.0
#: Residual of the verifying cycle beyond which a fixed point does not count, over the tolerance:
#: an unstable one grows away from itself.
MAX_MISSED = 100.0
#: The same beyond which a mirrored orbit is looked for again without the mirror.
MIRROR_MISSED = 10.0
#: Imbalance of the energy of a cycle beyond which a fixed point does not count, over the tolerance
#: of the integrator, but not below what a force with corners of its own may leave.
ENERGY = 1e3
MIN_IMBALANCE = 1e-4
#: Natural periods simulated where no fixed point was found; 4 s for the base case.
FALLBACK_PERIODS = 108.0
#: Steps it may take in all, a few seconds; the base case takes a hundredth of them.
FALLBACK_STEPS = 1.5e6
#: What a quick search may take: maps from one start, and steps to one return.
QUICK_MAPS = 40
QUICK_STEPS = 1000
#: Steps to one return in a thorough search; the base case takes seventy.
THOROUGH_STEPS = 20_000


class Effort(enum.Enum):
    """Work that a search for a steady state may be.

    Attributes
    ----------
    QUICK
        The standard starts, and no more: a few milliseconds, found or not.
    THOROUGH
        All ways to a fixed point; where none leads to one the engine is simulated.
    """

    QUICK = "quick"
    THOROUGH = "thorough"


@renamed_keywords(most="max_maps")
def steady_state(
    engine: Engine,
    *,
    rtol: float = DEFAULT_TOLERANCE,
    max_maps: int = MAX_MAPS,
    effort: Effort = Effort.THOROUGH,
) -> SteadyState:
    """Steady state of an engine: the fixed point of its return map.

    Iterates the map from a compressed charge near the target stroke, extrapolates (Anderson's
    method over the last four points) and verifies with one whole cycle. If that settles from none
    of a few starts, the engine is simulated from its own start and the end of that is reported;
    an engine that then seems unsteady is tried once more with a finer tolerance.

    Parameters
    ----------
    engine : Engine
    rtol : float
        Tolerance of the integrator, and of the state after a return [-].
    max_maps : int
        Maps to try before the other methods take over.
    effort : Effort
        ``Effort.QUICK`` ends with "not found" where the standard starts lead to no orbit.

    Returns
    -------
    SteadyState
        Always with a status and a message.

    Raises
    ------
    InvalidEngine
        Naming every wrong field of the engine.
    SettingsError
        If a setting makes no sense.

    Examples
    --------
    >>> import saleg
    >>> found = saleg.steady_state(saleg.machines.thesis_base())
    >>> found.found, round(found.performance.frequency, 2), found.half_cycles < 20
    (True, 46.97, True)
    """
    rtol = check_tolerance(rtol)
    if not is_whole(max_maps, 0, 2**31 - 1):
        raise SettingsError(f"max_maps = {shown(max_maps)}: must be a whole number >= 0")
    check_effort(effort)
    check_engine(engine)
    warn_of_unusual(engine, frames=2)  # this one and what accepts earlier keywords
    return _found(engine, rtol, int(max_maps), effort)


def found_steady_state(
    engine: Engine, rtol: float, max_maps: int = MAX_MAPS, effort: Effort = Effort.THOROUGH
) -> SteadyState:
    """Steady state of an engine, without a warning of unusual numbers."""
    check_engine(engine)
    return _found(engine, rtol, max_maps, effort)


def _found(engine: Engine, rtol: float, max_maps: int, effort: Effort) -> SteadyState:
    """Steady state of an engine whose numbers have been checked."""
    engine.check_laws()
    check_methods(engine.laws.values())
    quick = effort is Effort.QUICK
    if not repeats_itself(engine):
        why = "a law depends on time or counts charges"
        if not isinstance(engine.scatter, NoScatter):
            why = "charges scatter; the mean engine's state is that with NoScatter()"
        return not_found(engine, 0, 0, why) if quick else waited_for(engine, rtol, 0, 0, why)
    if quick:
        return _solved(engine, rtol, min(max_maps, QUICK_MAPS), quick)
    found = _solved(engine, rtol, max_maps, quick)
    if found.status is not Status.UNSTEADY or _is_given_up(found.fallback):
        return found
    followed = _followed(engine, rtol, found)
    if followed is not None:
        return followed
    if rtol <= FINEST:
        return found
    # Steps across a force or burn rate that jumps scatter: they may hide a steady state.
    again = _solved(engine, finer(rtol), max_maps, quick)
    return replace(
        again,
        half_cycles=again.half_cycles + found.half_cycles,
        evaluations=again.evaluations + found.evaluations,
    )


def check_tolerance(rtol: float) -> float:
    """A tolerance as a float; refused if nothing can be solved with it.

    Raises
    ------
    SettingsError
    """
    number = as_float(rtol)
    if number is None or not 1e-13 <= number <= 1e-3:
        raise SettingsError(f"rtol = {shown(rtol)}: must be a number from 1e-13 to 1e-3")
    return number


def check_effort(effort: Effort) -> None:
    """Refuse what is no effort.

    Raises
    ------
    SettingsError
    """
    if not isinstance(effort, Effort):
        names = " or ".join(f"saleg.Effort.{item.name}" for item in Effort)
        raise SettingsError(f"effort = {shown(effort)}: must be {names}")


def _solved(engine: Engine, rtol: float, max_maps: int, quick: bool) -> SteadyState:
    """Fixed point by iteration, from one start after the other; else simulation, unless quick."""
    symmetric = is_symmetric(engine)
    spent = Spent()
    ways = (False,) if not symmetric else (True,) if quick else (True, False)
    for start, mirrored in itertools.product(starts(engine), ways):
        state = prepare(replace(engine, start=start))
        found = _from_state(engine, state, mirrored, rtol, max_maps, spent, quick=quick)
        if found is not None:
            return found
    if quick:
        why = "no orbit from the standard starts"
        return not_found(engine, spent.half_cycles, spent.evaluations, why)
    why = "the return map did not settle"
    return waited_for(engine, rtol, spent.half_cycles, spent.evaluations, why)


def _followed(engine: Engine, rtol: float, waited: SteadyState) -> SteadyState | None:
    """Fixed point to which the slow motion leads on from the end of a simulation, if it does."""
    if waited.fallback is None or not isinstance(waited.fallback.replay, Replay):
        return None
    late = waited.fallback.replay.start
    spent = Spent(waited.half_cycles, waited.evaluations)
    return _from_state(engine, late, False, rtol, MAPS_ON_THE_WAY, spent, follow=True)


@dataclass
class Spent:
    """Half cycles and right-hand sides that a search has taken so far."""

    half_cycles: int = 0
    evaluations: int = 0


def _from_state(
    engine: Engine,
    state: State,
    mirrored: bool,
    rtol: float,
    max_maps: int,
    spent: Spent,
    *,
    quick: bool = False,
    follow: bool = False,
) -> SteadyState | None:
    """Fixed point by iteration from one state, counted in `spent`; None if it leads to none."""
    most_steps = QUICK_STEPS if quick else THOROUGH_STEPS
    rtol, steps = map_tolerance(engine, rtol), step_tolerance(engine, rtol)
    return_map = ReturnMap.of(engine, state, steps, mirrored, most_steps)
    before = return_map.evaluations
    found, strokes = find_settled(return_map, max_maps, RESIDUAL * rtol, not quick, follow)
    cycled = found.code == layout.END_OF_TIME
    spent.half_cycles += strokes
    spent.evaluations += return_map.evaluations - before
    if mirrored and cycled and found.missed > MIRROR_MISSED * rtol:
        return None  # unstable, or not as symmetric as it looks
    if not converged(found, rtol):
        return None
    return_map.begin_on_the_left()
    if not is_sharp(return_map, found, rtol):
        steps = step_tolerance(engine, finer(rtol))
        sharper = return_map.finer(steps)
        again, strokes = find_settled(sharper, max_maps, RESIDUAL * finer(rtol), not quick)
        spent.half_cycles += strokes
        spent.evaluations += sharper.evaluations - return_map.evaluations
        if not converged(again, finer(rtol)):
            return None
        return_map, found = sharper, again
    counts = spent.half_cycles, spent.evaluations
    return result_of(return_map, *counts, found.missed, "fixed point", steps)


def starts(engine: Engine) -> Iterator[Start]:
    """Starts of the search: near the target stroke, deeper and less deep, and the engine's own.

    They begin on the side with more fuel, whichever that is.
    """
    left_first = engine.is_mirrored or fuel_energy(engine.left) >= fuel_energy(engine.right)
    side = -1.0 if left_first else 1.0
    depth = getattr(engine.alternator, "target_stroke", 0.9)
    yield CompressedCharge(position=side * min(max(depth, 0.5), 0.95), burning=1.0)
    usual = CompressedCharge()
    if engine.start not in (usual, replace(usual, position=-usual.position)):
        yield engine.start
    yield CompressedCharge(position=side * 0.75, burning=1.0)


def fuel_energy(chamber: Chamber) -> float:
    """Lower heating value of the fuel in a charge [J]; 0 for a chamber without fuel."""
    if not isinstance(chamber, CombustionChamber):
        return 0.0
    return standard_charge(chamber)[1] * chamber.fuel.lower_heating_value


def converged(found: Search, tolerance: float) -> bool:
    """Whether a fixed point was found and a whole cycle from it comes back to it."""
    return found.code == layout.END_OF_TIME and found.missed <= MAX_MISSED * tolerance


def result_of(
    return_map: ReturnMap, spent: int, evaluations: int, residual: float, method: str, rtol: float
) -> SteadyState:
    """Steady state a converged map has found."""
    return_map.begin_on_the_left()
    engine, strokes = return_map.engine, return_map.strokes[:2].copy()
    snapshots = Snapshots(*(part.copy() for part in return_map.snapshots))
    settings = Settings(duration=0.0, rtol=rtol, motored_pressure=engine.needs_motored_pressure)
    status, what = kind_of(engine, strokes, rtol)
    message = what + fixed_point_message(return_map.mirrored, spent, residual)
    return SteadyState(
        engine=engine,
        status=status,
        message=message,
        half_cycles=spent,
        evaluations=evaluations,
        residual=residual,
        method=method,
        strokes=strokes,
        mirrored=return_map.mirrored,
        replay=Replay(engine, snapshots, settings),
    )


def fixed_point_message(mirrored: bool, spent: int, residual: float) -> str:
    """How a fixed point was found."""
    cycle = "half-cycle" if mirrored else "full-cycle"
    return (
        f"fixed point of the {cycle} map, found in {spent} half cycles; "
        f"a whole cycle misses its start by {residual:.1e}"
    )


def max_imbalance(rtol: float) -> float:
    """Imbalance of a cycle's energy beyond which a fixed point does not count."""
    return min(max(ENERGY * rtol, MIN_IMBALANCE), MAX_IMBALANCE)


def kind_of(engine: Engine, strokes: np.ndarray, rtol: float) -> tuple[Status, str]:
    """Status of a fixed point by what it delivers, and that as the beginning of a message."""
    off = imbalance(strokes[-1], strokes)
    if off > max_imbalance(rtol):
        return Status.STEP_FAILURE, (
            f"the energy balance is off by {100.0 * off:.2g} % of its largest term; try a smaller "
            "rtol, or check that the energies of the laws belong to their forces: "
        )
    if is_dead(engine, strokes):
        if delivers_power(strokes):
            return Status.STEADY, "delivers power without firing: "
        return Status.STALLED, "swings without firing: "
    if is_idling(engine, strokes):
        return Status.IDLING, "fires but delivers no power: "
    return Status.STEADY, ""


def not_found(engine: Engine, spent: int, evaluations: int, why: str) -> SteadyState:
    """Result of a quick search that has found nothing."""
    return SteadyState(
        engine=engine,
        status=Status.NOT_FOUND,
        message=f"{why}; Effort.THOROUGH tries other ways and simulates",
        half_cycles=spent,
        evaluations=evaluations,
        residual=math.nan,
        method="none",
        strokes=np.zeros(0, layout.STROKE_RECORD),
    )


def _is_given_up(run: Run | None) -> bool:
    """Whether a simulation ended because of the number of its steps."""
    return run is not None and run.steps >= FALLBACK_STEPS


def waited_for(engine: Engine, rtol: float, spent: int, evaluations: int, why: str) -> SteadyState:
    """Simulate from the engine's own start and report how that ends."""
    start = prepare(engine)  # names a law that fails
    settings = Settings(FALLBACK_PERIODS * natural_period(engine), rtol=rtol)
    course = Course(engine, start, settings, detail=Detail(most_steps=FALLBACK_STEPS))
    run = course.finish()
    given_up = f" (given up after {run.steps} steps)" if _is_given_up(run) else ""
    steady = run.status in (Status.STEADY, Status.IDLING)
    strokes = run.orbit.strokes if steady and run.orbit is not None else None
    unsettled = run.status is Status.COMPLETED
    return SteadyState(
        engine=engine,
        status=Status.UNSTEADY if unsettled else run.status,
        message=f"{why}; simulated instead{given_up}: {run.message}",
        half_cycles=spent + len(run.strokes),
        evaluations=evaluations + run.evaluations,
        residual=math.nan,
        method="simulation",
        strokes=run.strokes[:0] if strokes is None else strokes.copy(),
        replay=run.replay if steady and isinstance(run.replay, Replay) else None,
        fallback=run,
    )
