"""Segments between two events, each one call of ``solve_ivp``."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.engine import Engine, OpenEnd
from saleg.kernel import layout
from saleg.kernel.plain_breathing import CRANKCASE_ENERGY, is_held_open, mass_times_constant
from saleg.kernel.plain_rhs import (
    ALTERNATOR_CURRENT,
    INTEGRAL,
    POSITION,
    PRESSURE,
    QUADRATURES,
    VELOCITY,
    gas_in,
    pressure_in,
    pressure_rate_in,
    rates,
)
from saleg.laws.arguments import Motion
from saleg.reference.running_engine import RunningEngine
from saleg.reference.states import ChamberState, EngineState
from saleg.simulation.initial_state import current_scale

Rates = Callable[[float, np.ndarray], np.ndarray]

#: Longest step over the natural time, which is half a stroke at natural speed: none skips a stroke.
LONGEST_STEP = 0.1
#: Share of the greatest value so far below which a sampled peak is not worth locating.
PROMISING = 0.9


class SolverFailure(Exception):
    """The solver gave up; says why."""


@dataclass(frozen=True)
class Solver:
    """Method and tolerances.

    Attributes
    ----------
    method : str or type
        Method of ``solve_ivp``.
    rtol : float
        Relative tolerance.
    atol : ndarray
        Absolute tolerance of every component.
    natural_time : float
        Half the maximum stroke over the natural speed [s].
    rates : callable
        Makes the right-hand side of a running engine, valid until its next event.
    """

    method: Any
    rtol: float
    atol: np.ndarray
    natural_time: float
    rates: Callable[[RunningEngine], Rates]


@dataclass
class Tally:
    """Right-hand sides evaluated and steps taken."""

    evaluations: int = 0
    steps: int = 0


def plain_rates(engine: Engine) -> Callable[[RunningEngine], Rates]:
    """Right-hand side in plain Python: the laws are ordinary methods of the engine."""

    def of(running: RunningEngine) -> Rates:
        def derivative(t: float, y: np.ndarray) -> np.ndarray:
            dy = [0.0] * len(y)
            rates(engine, running.machine, running.chambers, float(t), y.tolist(), dy)
            return np.array(dy)

        return derivative

    return of


def jitted_rates(engine: Engine) -> Callable[[RunningEngine], Rates]:
    """Compile the same right-hand side, with the laws of the engine put in."""
    from saleg.compiler.compiled_engine import compiled_engine
    from saleg.compiler.text import REFERENCE

    kernel, P, _ = compiled_engine(engine, modules=REFERENCE)

    def of(running: RunningEngine) -> Rates:
        E = _records(EngineState, [running.machine])
        C = _records(ChamberState, running.chambers)
        kernel.call("rates_of_records", P, E, C, 0.0, running.y, np.zeros_like(running.y))
        compiled = kernel.function("rates_of_records")

        def derivative(t: float, y: np.ndarray) -> np.ndarray:
            dy = np.empty_like(y)
            compiled(P, E, C, t, y, dy)
            return dy

        return derivative

    return of


def _records(kind: type, items: list[Any]) -> np.ndarray:
    """Numbers of some dataclasses as an array of records."""
    dtype = np.dtype([(item.name, np.float64) for item in dataclasses.fields(kind)])
    return np.array([dataclasses.astuple(item) for item in items], dtype)


def natural_speed(running: RunningEngine) -> float:
    """Speed of the moving mass with about the energy springs and gas can store [m/s]."""
    length = 0.5 * running.engine.maximum_stroke
    energy = running.engine.springs.energy(Motion(0.0, length, 0.0, 0.0))
    energy -= running.engine.springs.energy(Motion(0.0, 0.0, 0.0, 0.0))
    for c in running.chambers:
        energy += c.p_closing * c.area * c.half_stroke
    return math.sqrt(2.0 * energy / running.machine.mass)


def scales(running: RunningEngine, speed: float) -> np.ndarray:
    """Natural size of every component: absolute tolerances are the relative one times these."""
    length = 0.5 * running.engine.maximum_stroke
    time = length / speed
    energy = running.machine.mass * speed**2
    scale = np.full(len(running.y), energy)
    scale[POSITION], scale[VELOCITY] = length, speed
    scale[PRESSURE:QUADRATURES] = energy / (length * running.piston_area)
    scale[INTEGRAL : INTEGRAL + 2] = 1.0
    scale[ALTERNATOR_CURRENT] = current_scale(
        running.engine.alternator, running.machine.load_weight, speed
    )
    scale[QUADRATURES + layout.ELECTRICAL_SQUARED] = energy**2 / time
    scale[QUADRATURES + layout.ALTERNATOR_IMPULSE] = running.machine.mass * speed
    scale[QUADRATURES + layout.SPEED_SQUARED] = speed**2 * time
    if len(running.y) > layout.FUEL:
        for side, c in enumerate(running.chambers):
            _scale_states(scale, side, c, energy)
        scale[layout.FRAME_X], scale[layout.FRAME_V] = length, speed
        scale[layout.MOUNT_LOSS] = energy
    return scale


def _scale_states(scale: np.ndarray, side: int, c: ChamberState, energy: float) -> None:
    """Natural size of the states that the laws of a chamber ask for."""
    if c.breathes:
        scale[PRESSURE + side] = energy
    scale[layout.FUEL + side :: 2] = c.mass_trapped
    scale[layout.WALL + side] = c.wall_temperature
    for n in (CRANKCASE_ENERGY, layout.ENTHALPY_OUT, layout.CRANKCASE_WORK):
        scale[n + side] = energy


@dataclass(frozen=True)
class Event:
    """Something that ends a segment when it falls or rises through zero.

    The names are those ``solve_ivp`` looks for.

    Attributes
    ----------
    value : callable
        Number that passes through zero, from the state.
    direction : float
        -1 if it falls, 1 if it rises.
    kind : str
        "dead centre", "port", "corner", "injection", "ignition" or "head".
    side : int
    """

    value: Callable[[np.ndarray], float]
    direction: float
    kind: str
    side: int = 0
    terminal: bool = True

    def __call__(self, t: float, y: np.ndarray) -> float:
        """Value at the state `y`."""
        return float(self.value(y))


def possible_events(running: RunningEngine) -> list[Event]:
    """Events that can come next.

    Between two dead centres every height changes one way, so none of them is a crossing that has
    just happened: what a segment begins on is not looked for in it, but for the velocity, which
    leaves zero in the direction that is not looked for.
    """
    direction = running.machine.direction
    if direction == 0.0:
        return []
    events = [Event(lambda y: direction * y[VELOCITY], -1.0, "dead centre")]
    for side, (chamber, c) in enumerate(
        zip(running.engine.chambers, running.chambers, strict=True)
    ):
        port = getattr(chamber, "port_closing", None)
        is_open = c.mode == layout.OPEN
        if port is not None and is_open != running.is_expanding(side):
            events.append(Event(_beyond(c, port), -1.0 if is_open else 1.0, "port", side))
        corner = running.next_corner(side)
        if math.isfinite(corner):
            events.append(Event(_beyond(c, corner), direction * c.sign, "corner", side))
        if running.injection_comes(side):
            events.append(Event(_beyond(c, c.injection_place), -1.0, "injection", side))
        if c.armed > layout.DISARMED:
            events.append(Event(_unlit(side), 1.0, "ignition", side))
        closes = not isinstance(chamber, OpenEnd)
        if not (is_open and closes) and not running.is_expanding(side):
            events.append(Event(_beyond(c, chamber.head_gap), -1.0, "head", side))
    return events


def _beyond(c: ChamberState, height: float) -> Callable[[np.ndarray], float]:
    return lambda y: c.half_stroke + c.sign * y[POSITION] - height


def _unlit(side: int) -> Callable[[np.ndarray], float]:
    return lambda y: y[INTEGRAL + side] - 1.0


def advance(running: RunningEngine, end: float, solver: Solver, tally: Tally) -> Event | None:
    """Integrate to the next event, or to `end` if none comes; returns the event."""
    end = min([end, *breaks_in_combustion(running), _before_first_movement(running, end, solver)])
    if end - running.t <= 1e-14 * max(end, solver.natural_time):
        running.t = end
        return None
    events = possible_events(running)
    derivative = solver.rates(running)
    solution = solve(derivative, running.t, end, running.y, solver, tally, events)
    watch(running, solution, derivative)
    crossed = [event for event, times in zip(events, solution.t_events, strict=True) if len(times)]
    if not crossed:
        running.t, running.y = end, solution.y[:, -1].copy()
        return None
    # The interpolant gives the time of the event, a last step to it the state there: no rate need
    # be smooth beyond an event, nor the interpolant as good as the method.
    start, y, running.t = solution.t[-2], solution.y[:, -2], float(solution.t[-1])
    running.y = solve(derivative, start, running.t, y, solver, tally).y[:, -1].copy()
    land(running, crossed[0])
    return crossed[0]


def solve(
    derivative: Rates,
    start: float,
    end: float,
    y: np.ndarray,
    solver: Solver,
    tally: Tally,
    events: Sequence[Event] | None = None,
) -> Any:
    """Integrate; if events are given, up to one of them and with an interpolant."""
    from scipy.integrate import solve_ivp

    solution = solve_ivp(
        derivative,
        (start, end),
        y,
        method=solver.method,
        rtol=solver.rtol,
        atol=solver.atol,
        max_step=LONGEST_STEP * solver.natural_time,
        dense_output=events is not None,
        events=events,
    )
    tally.evaluations += solution.nfev
    tally.steps += len(solution.t) - 1
    if solution.status < 0 or not np.isfinite(solution.y[:, -1]).all():
        raise SolverFailure(solution.message)
    return solution


def breaks_in_combustion(running: RunningEngine) -> list[float]:
    """Times of the next breakpoints of burn rates, or of the ends of combustion [s]."""
    times = []
    for side, c in enumerate(running.chambers):
        if c.mode == layout.BURNING:
            running.bound_phase(side)
            times.append(c.t_ignition + c.last_phase * c.duration)
    return times


def _before_first_movement(running: RunningEngine, end: float, solver: Solver) -> float:
    """Time at which to look whether the translator has begun to move [s]."""
    if running.machine.direction != 0.0:
        return end
    return running.t + max(running.t, 1e-3 * solver.natural_time)


def land(running: RunningEngine, event: Event) -> None:
    """Put the state exactly on the event."""
    if event.kind == "dead centre":
        running.y[VELOCITY] = 0.0
    elif event.kind == "ignition":
        running.y[INTEGRAL + event.side] = 1.0
    elif event.kind == "port":
        running.y[POSITION] -= running.chambers[event.side].sign * running.beyond_port(event.side)
    elif event.kind in ("corner", "injection"):
        c = running.chambers[event.side]
        running.y[POSITION] -= c.sign * event.value(running.y)


def watch(
    running: RunningEngine, solution: Any, derivative: Rates, place: slice = slice(None)
) -> None:
    """Find the greatest values in a segment: sampled at the steps, located between them.

    The engine stands at `place` in the vector that is integrated.
    """

    def seen(t: float, y: np.ndarray) -> np.ndarray:
        return watched(running, y[place], derivative(t, y)[place])

    values = np.array([seen(t, y) for t, y in zip(solution.t, solution.y.T, strict=True)])
    last = len(values) - 1
    for peak, best in enumerate(np.argmax(values, axis=0)):
        sampled, ends = values[best, peak], (max(best - 1, 0), min(best + 1, last))
        levels = values[list(ends), peak]
        if sampled < PROMISING * running.peaks[peak] or (levels == sampled).all():
            running.peaks[peak] = max(running.peaks[peak], sampled)
            continue

        def falling(t: float, peak: int = peak) -> float:
            return -float(seen(t, solution.sol(t))[peak])

        located = _greatest(falling, solution.t[ends[0]], solution.t[ends[1]])
        running.peaks[peak] = max(running.peaks[peak], sampled, located)


def _greatest(falling: Callable[[float], float], low: float, high: float) -> float:
    """Greatest value between two times, given the function with its sign changed."""
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        falling, bounds=(low, high), method="bounded", options={"xatol": 1e-5 * (high - low)}
    )
    return -float(found.fun)


def watched(running: RunningEngine, y: np.ndarray, dy: np.ndarray) -> np.ndarray:
    """Quantities whose greatest values are kept, in the order of the layout."""
    values = np.zeros(layout.N_PEAKS)
    for side, c in enumerate(running.chambers):
        p = pressure_in(running.engine, running.chambers, side, y)
        gas = gas_in(running.machine, running.chambers, side, y, p)
        rise = pressure_rate_in(running.engine, running.chambers, side, gas, y, dy)
        volume = c.area * (c.half_stroke + c.sign * y[POSITION])
        T = p * volume / mass_times_constant(running.chambers, side, y)
        if is_held_open(running.chambers, side):
            T = running.temperature(side)
        values[layout.PEAK_PRESSURE + side] = p
        values[layout.PEAK_TEMPERATURE + side] = T
        values[layout.PEAK_PRESSURE_RISE + side] = rise
    values[layout.PEAK_VELOCITY] = math.fabs(y[VELOCITY])
    values[layout.PEAK_ACCELERATION] = math.fabs(dy[VELOCITY])
    return values
