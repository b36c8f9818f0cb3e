"""Steady states, solved for instead of waited for.

The state at a dead centre settles all that follows, so a steady state is a fixed point of the map
from one dead centre to the next alike: half a cycle later, in the mirror, for a symmetric engine.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from saleg.compiler.compose import check_laws, needs_motored_pressure
from saleg.engine import Engine, check_engine, warn_of_unusual
from saleg.engine.start import CompressedCharge, Start
from saleg.kernel import layout
from saleg.quantities import as_float, is_whole
from saleg.simulation.initial_state import prepare
from saleg.simulation.integration import (
    Replay,
    Settings,
    SettingsError,
    integrate,
    settings_of,
)
from saleg.simulation.performance import EnergyBalance, Performance, remarks_on
from saleg.simulation.run import Run, read_only
from saleg.status import Status
from saleg.steady.return_map import ReturnMap, is_symmetric, repeats_itself
from saleg.steady.stability import Stability, stability

DEFAULT_TOLERANCE = 1e-6
#: Maps after which iteration gives up.
MOST_MAPS = 60
#: Residual of the map a steady state may have, over the tolerance of the integrator.
RESIDUAL = 1.0
#: Residual of the verifying cycle beyond which a fixed point does not count, over the tolerance:
#: an unstable one grows away from itself.
MOST_MISSED = 100.0
#: The same beyond which a mirrored orbit is looked for again without the mirror.
MIRROR_MISSED = 10.0
#: Factor on the tolerance with which an engine that seems unsteady is tried once more.
FINER = 1e-2
FINEST = 1e-9
#: Time simulated where no fixed point was found [s].
FALLBACK_DURATION = 4.0


@dataclass(eq=False)
class SteadyState:
    """A steady state of an engine, or what there is instead.

    Attributes
    ----------
    engine : Engine
    status : Status
        ``STEADY`` or ``IDLING`` for a fixed point; else why there is none.
    message : str
        What was found and how.
    half_cycles : int
        Strokes integrated to find it, the verifying cycle included, stability apart.
    evaluations : int
        Right-hand sides evaluated for that.
    residual : float
        How far the verifying cycle misses its start, in the numbers of order one a state is
        written in [-]; NaN without a fixed point.
    method : str
        "fixed point", "continuation" (a point of a branch) or "simulation".
    strokes : ndarray of STROKE_RECORD
        The two strokes of the cycle, read-only; empty without one.
    """

    engine: Engine
    status: Status
    message: str
    half_cycles: int
    evaluations: int
    residual: float
    method: str
    strokes: np.ndarray = field(repr=False)
    replay: Replay | None = field(default=None, repr=False)
    fallback: Run | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        """Show the strokes, but let nobody write to them."""
        self.strokes = read_only(self.strokes)

    @property
    def found(self) -> bool:
        """Whether there is a steady state, be it stable or not."""
        return self.status in (Status.STEADY, Status.IDLING)

    @cached_property
    def orbit(self) -> Run | None:
        """One cycle with its whole history and all peaks located; None without a steady state."""
        return self.replay() if self.replay is not None else None

    @cached_property
    def performance(self) -> Performance:
        """Figures of the cycle; zeros and NaN without one."""
        if not len(self.strokes):
            return Performance.of_nothing(self.engine)
        history = None if self.orbit is None else self.orbit.history_rows
        return Performance.of_cycle(self.engine, self.strokes, self.strokes, history)

    @property
    def quick_performance(self) -> Performance:
        """The same without what needs the history of the cycle: the adverse work is NaN."""
        if not len(self.strokes):
            return Performance.of_nothing(self.engine)
        return Performance.of_cycle(self.engine, self.strokes, self.strokes)

    @property
    def remarks(self) -> list[str]:
        """Figures of the cycle that no engine built comes near, as text; often none."""
        return remarks_on(self.quick_performance)

    @property
    def moving_mass(self) -> float:
        """Moving mass [kg]."""
        return float(self.engine.translator.mass)

    @cached_property
    def energy(self) -> EnergyBalance | None:
        """Energy balance of the cycle, which ends as it began; None without a steady state."""
        return EnergyBalance.between(self.strokes[-1], self.strokes) if self.found else None

    @cached_property
    def stability(self) -> Stability:
        """Multipliers of the cycle and what they mean, differentiated when first asked for."""
        if self.replay is None:
            raise ValueError(f"no steady state to differentiate: {self.message}")
        return stability(self.replay, float(self.strokes["duration"].sum()))

    @property
    def multipliers(self) -> np.ndarray:
        """Multipliers of a whole cycle, the largest first [-]."""
        return self.stability.multipliers

    @property
    def stable(self) -> bool:
        """Whether small disturbances of the cycle die away; False without a steady state."""
        return self.found and self.stability.stable

    def __str__(self) -> str:
        from saleg.simulation.report import describe_performance, describe_remarks

        known = vars(self).get("stability")
        stable = "stability not examined" if known is None else known.kind
        head = f"{self.engine.name}: {self.status} ({stable}) - {self.message}"
        head = head if self.found else head.replace(f" ({stable})", "")
        shown = describe_performance(self.performance)
        return "\n".join([head, shown, *describe_remarks(self.remarks)])


def steady_state(
    engine: Engine, *, rtol: float = DEFAULT_TOLERANCE, most: int = MOST_MAPS
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
        Tolerance of the integrator, and of the state after a return.
    most : int
        Maps to try before the other methods take over.

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
    if not is_whole(most, 0, 2**31 - 1):
        raise SettingsError(f"most = {most!r}: must be a whole number >= 0")
    check_engine(engine)
    warn_of_unusual(engine)
    return found_steady_state(engine, rtol, int(most))


def found_steady_state(engine: Engine, rtol: float, most: int = MOST_MAPS) -> SteadyState:
    """Steady state of an engine, without a warning of unusual numbers."""
    check_engine(engine)
    check_laws(engine)
    if not repeats_itself(engine):
        return waited_for(engine, rtol, 0, 0, "a law depends on time or counts charges")
    found = _solved(engine, rtol, most)
    if found.status is Status.UNSTEADY and rtol > FINEST:
        # Steps across a force or burn rate that jumps scatter: they may hide a steady state.
        again = _solved(engine, max(FINER * rtol, FINEST), most)
        return replace(
            again,
            half_cycles=again.half_cycles + found.half_cycles,
            evaluations=again.evaluations + found.evaluations,
        )
    return found


def check_tolerance(rtol: float) -> float:
    """A tolerance as a float; refused if nothing can be solved with it.

    Raises
    ------
    SettingsError
    """
    number = as_float(rtol)
    if number is None or not 1e-13 <= number <= 1e-3:
        raise SettingsError(f"rtol = {rtol!r}: must be a number from 1e-13 to 1e-3")
    return number


def _solved(engine: Engine, rtol: float, most: int) -> SteadyState:
    """Fixed point by iteration, from one start after the other; else simulation."""
    symmetric = is_symmetric(engine)
    spent = evaluations = 0
    for start, mirrored in itertools.product(starts(engine), (True, False)):
        if mirrored and not symmetric:
            continue
        state = prepare(replace(engine, start=start))
        chart = ReturnMap.of(engine, state, rtol, mirrored)
        code, found = chart.find(most, RESIDUAL * rtol)
        spent += int(found[0] * chart.strokes_per_map) + (2 if code == layout.END_OF_TIME else 0)
        evaluations += chart.evaluations
        if mirrored and code == layout.END_OF_TIME and found[2] > MIRROR_MISSED * rtol:
            continue  # unstable, or not as symmetric as it looks
        if converged(code, found, rtol):
            return result_of(chart, spent, evaluations, float(found[2]), "fixed point", rtol)
    return waited_for(engine, rtol, spent, evaluations, "the return map did not settle")


def starts(engine: Engine) -> Iterator[Start]:
    """Where to look from: near the target stroke, deeper and less deep, and the engine's own."""
    depth = float(getattr(engine.alternator, "target_stroke", 0.9))
    yield CompressedCharge(position=-min(max(depth, 0.5), 0.95), burning=1.0)
    if engine.start != CompressedCharge():
        yield engine.start
    yield CompressedCharge(position=-0.75, burning=1.0)


def converged(code: int, found: np.ndarray, tolerance: float) -> bool:
    """Whether a fixed point was found and a whole cycle from it comes back to it."""
    return code == layout.END_OF_TIME and found[2] <= MOST_MISSED * tolerance


def result_of(
    chart: ReturnMap, spent: int, evaluations: int, residual: float, method: str, rtol: float
) -> SteadyState:
    """What a converged map has found."""
    engine, strokes = chart.engine, chart.strokes[:2].copy()
    snapshot = tuple(part.copy() for part in chart.snapshot)
    settings = Settings(duration=0.0, rtol=rtol, motored_pressure=needs_motored_pressure(engine))
    status, what = _kind(engine, strokes)
    symmetry = "half-cycle map, mirrored" if chart.mirrored else "full-cycle map"
    message = (
        f"{what} a fixed point of the {symmetry}, found in {spent} half cycles; "
        f"a whole cycle misses its start by {residual:.1e}"
    )
    return SteadyState(
        engine=engine,
        status=status,
        message=message,
        half_cycles=spent,
        evaluations=evaluations,
        residual=residual,
        method=method,
        strokes=strokes,
        replay=Replay(engine, snapshot, settings),
    )


def _kind(engine: Engine, strokes: np.ndarray) -> tuple[Status, str]:
    """Status of a fixed point by what it delivers."""
    heat = float(strokes["heat_released"].sum())
    if engine.fires and not heat > 0.0:
        return Status.STALLED, "does not fire, it only swings:"
    if engine.fires and not float(strokes["electrical_energy"].sum()) > 1e-9 * heat:
        return Status.IDLING, "fires but delivers no power:"
    return Status.STEADY, "it is"


def waited_for(engine: Engine, rtol: float, spent: int, evaluations: int, why: str) -> SteadyState:
    """Simulate from the engine's own start and report how that ends."""
    run = integrate(engine, prepare(engine), settings_of(FALLBACK_DURATION, rtol=rtol))
    steady = run.status in (Status.STEADY, Status.IDLING)
    strokes = run.orbit.strokes if steady and run.orbit is not None else None
    unsettled = run.status is Status.COMPLETED
    return SteadyState(
        engine=engine,
        status=Status.UNSTEADY if unsettled else run.status,
        message=f"{why}; simulated instead: {run.message}",
        half_cycles=spent + len(run.strokes),
        evaluations=evaluations + run.evaluations,
        residual=math.nan,
        method="simulation",
        strokes=run.strokes[:0] if strokes is None else strokes.copy(),
        replay=run.replay if steady and isinstance(run.replay, Replay) else None,
        fallback=run,
    )
