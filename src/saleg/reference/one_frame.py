"""Engines that share one frame, through ``scipy.integrate.solve_ivp``: all of them at once."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.engine import Engine, engine_problems
from saleg.kernel import layout
from saleg.kernel.plain_rhs import VELOCITY
from saleg.laws import Frame
from saleg.quantities import Problem, problems
from saleg.reference.running_engine import RunningEngine
from saleg.reference.runs import checked_settings, run_of, setting_problems
from saleg.reference.segments import (
    Event,
    Rates,
    Solver,
    SolverFailure,
    Tally,
    breaks_in_combustion,
    jitted_rates,
    land,
    natural_speed,
    possible_events,
    scales,
    solve,
    watch,
)
from saleg.simulation.run import Run
from saleg.simulation.settings import refuse

if TYPE_CHECKING:
    import pandas as pd

#: Velocity, over the natural one, at which an engine turns together with another that does.
AT_REST = 1e-10
#: Least time from one dead centre to the next, over the natural one.
SHORTEST_STROKE = 1e-6
UNITS = {"t": "s", "x": "m", "v": "m/s", "force": "N"}


@dataclass(frozen=True)
class Together:
    """Engines that have run on one frame.

    Attributes
    ----------
    runs : tuple of Run
        One run per engine, without a history.
    frame : pandas.DataFrame
        Motion of the frame: time `t` [s], position `x` [m], velocity `v` [m/s] and `force` on what
        it stands on [N].
    """

    runs: tuple[Run, ...]
    frame: pd.DataFrame


def simulate_on_one_frame(
    engines: Sequence[Engine], frame: Frame, duration: float, *, rtol: float = 1e-9
) -> Together:
    """Simulate engines side by side on a frame that all of them push.

    Their translators move along one line. Engines that run in antiphase leave a frame at rest;
    in phase each moves its share of it.

    Parameters
    ----------
    engines : sequence of Engine
        Each with a fixed frame of its own; they begin as their start laws have it.
    frame : Frame
        The frame they share, at rest in the beginning.
    duration : float
        Time to simulate [s]; it ends as soon as one of them stalls or meets its head.
    rtol : float
        Relative tolerance of DOP853 [-].

    Returns
    -------
    Together

    Raises
    ------
    InvalidEngine, SettingsError
        Naming everything that is wrong; :class:`saleg.errors.WrongArguments` where engines and
        settings are.

    Examples
    --------
    >>> import saleg
    >>> from saleg.laws import MountedFrame
    >>> engine = saleg.machines.thesis_base()
    >>> opposite = engine.replace(**{"start.position": -engine.start.position})
    >>> pair = simulate_on_one_frame([engine, opposite], MountedFrame(mass=50.0), 0.05)
    >>> bool(pair.frame["x"].abs().max() < 1e-9)
    True
    """
    given = {"rtol": rtol, "duration": duration}
    refuse("simulate_on_one_frame", _problems(engines, frame), setting_problems(**given))
    rtol, duration = checked_settings(**given)
    group = _Group.of(engines, frame, rtol)
    code = layout.END_OF_TIME
    try:
        code = group.run_on(duration)
        trouble = ""
    except SolverFailure as failure:
        code, trouble = layout.STEP_FAILURE, f" ({failure})"
    settings = {"method": "DOP853", "rtol": rtol, "frame": repr(frame)}
    runs = tuple(run_of(running, code, trouble, group.tally, settings) for running in group.running)
    return Together(runs, group.table())


def _problems(engines: Any, frame: Any) -> list[Problem]:
    """What is wrong with engines and frame; none of them may have a moving one of its own."""
    wrong = engine_problems(engines)
    for n, engine in enumerate(engines if not wrong else ()):
        if "frame" in engine.frame.states:
            path = f"engines[{n}].frame"
            wrong.append(Problem(path, engine.frame, "-", "must be fixed: they share another"))
    if isinstance(frame, Frame):
        return wrong + problems(frame, "frame")
    return [*wrong, Problem("frame", frame, "-", "must be a Frame")]


@dataclass
class _Group:
    """Engines under way on one frame; `motion` is its position, velocity and heat in its mounts."""

    running: list[RunningEngine]
    frame: Frame
    solver: Solver
    rates: list[Any]
    speeds: list[float]
    motion: np.ndarray = field(default_factory=lambda: np.zeros(3))
    tally: Tally = field(default_factory=Tally)
    seen: list[np.ndarray] = field(default_factory=list)

    @classmethod
    def of(cls, engines: Sequence[Engine], frame: Frame, rtol: float) -> _Group:
        """Engines at time zero."""
        running = [RunningEngine.started(e, e.needs_motored_pressure) for e in engines]
        speeds = [natural_speed(one) for one in running]
        sizes = [scales(one, speed) for one, speed in zip(running, speeds, strict=True)]
        lengths = [0.5 * one.engine.maximum_stroke for one in running]
        energy = running[0].machine.mass * speeds[0] ** 2
        sizes.append(np.array([lengths[0], speeds[0], energy]))
        time = min(length / speed for length, speed in zip(lengths, speeds, strict=True))
        rates = [jitted_rates(one.engine) for one in running]
        solver = Solver("DOP853", rtol, rtol * np.concatenate(sizes), time, rates[0])
        return cls(running, frame, solver, rates, speeds)

    @property
    def slices(self) -> list[slice]:
        """Where each engine stands in the vector of all."""
        ends = np.cumsum([0, *(len(one.y) for one in self.running)])
        return [slice(int(a), int(b)) for a, b in itertools.pairwise(ends)]

    def run_on(self, duration: float) -> int:
        """Go from event to event; returns why it stopped, as a code of the layout."""
        for one in self.running:
            one.change_chambers()
        while self.running[0].t < duration:
            which, event = self.advance(duration)
            for one in self.running:
                one.machine.direction = one.machine.direction or float(np.sign(one.y[VELOCITY]))
                one.change_chambers()
            if event is None:
                continue
            if event.kind == "head":
                self.running[which].record(layout.EVENT_HEAD_CONTACT, event.side)
                return layout.HEAD_CONTACT
            for n, one in enumerate(self.running):
                if (n == which and event.kind == "dead centre") or self._turns(n):
                    one.y[VELOCITY] = 0.0
                    one.turn()
                    one.change_chambers()
                    if one.strokes and one.machine.stroke < 0.01 * one.engine.maximum_stroke:
                        return layout.STALLED
        return layout.END_OF_TIME

    def _turns(self, n: int) -> bool:
        """Whether an engine has come to rest at the very instant of another's event."""
        one = self.running[n]
        onward = one.machine.direction * one.y[VELOCITY]
        since = one.t - (one.t_dead_centre if math.isfinite(one.t_dead_centre) else 0.0)
        later = since > SHORTEST_STROKE * self.solver.natural_time
        return bool(later and onward <= AT_REST * self.speeds[n])

    def derivative(self) -> Rates:
        """Rates of all engines and of the frame, until the next event."""
        each = [rates(one) for rates, one in zip(self.rates, self.running, strict=True)]
        slices, masses = self.slices, [one.machine.mass for one in self.running]

        def of(t: float, y: np.ndarray) -> np.ndarray:
            dy = np.zeros(len(y))
            reaction = 0.0
            for place, rates, mass in zip(slices, each, masses, strict=True):
                dy[place] = rates(t, y[place])
                reaction -= mass * dy[place.start + VELOCITY]
            x, v = float(y[-3]), float(y[-2])
            acceleration = self.frame.acceleration(reaction, x, v)
            for place in slices:
                dy[place.start + VELOCITY] -= acceleration
            dy[-3:] = v, acceleration, self.frame.loss(v)
            return dy

        return of

    def advance(self, end: float) -> tuple[int, Event | None]:
        """Integrate to the next event of any engine, or to `end`; returns whose, and the event."""
        now, natural = self.running[0].t, self.solver.natural_time
        ends = [time for one in self.running for time in breaks_in_combustion(one)]
        if any(one.machine.direction == 0.0 for one in self.running):
            ends.append(now + max(now, 1e-3 * natural))
        end = min([end, *ends])
        if end - now <= 1e-14 * max(end, natural):
            self._put(end, self._vector())
            return 0, None
        owners, own, events = self._events()
        derivative = self.derivative()
        solution = solve(derivative, now, end, self._vector(), self.solver, self.tally, events)
        self._keep(solution, derivative)
        for one, place in zip(self.running, self.slices, strict=True):
            watch(one, solution, derivative, place)
        crossed = [n for n, times in enumerate(solution.t_events) if len(times)]
        if not crossed:
            self._put(end, solution.y[:, -1])
            return 0, None
        t, start, y = float(solution.t[-1]), solution.t[-2], solution.y[:, -2]
        self._put(t, solve(derivative, start, t, y, self.solver, self.tally).y[:, -1])
        which = owners[crossed[0]]
        event = own[crossed[0]]
        land(self.running[which], event)
        return which, event

    def _events(self) -> tuple[list[int], list[Event], list[Event]]:
        """Whose event each is that can come next, that event, and the same of the vector of all."""
        owners, own, joint = [], [], []
        for n, (one, place) in enumerate(zip(self.running, self.slices, strict=True)):
            for event in possible_events(one):
                owners.append(n)
                own.append(event)
                joint.append(_of_slice(event, place))
        return owners, own, joint

    def _vector(self) -> np.ndarray:
        return np.concatenate([*(one.y for one in self.running), self.motion])

    def _put(self, t: float, y: np.ndarray) -> None:
        """Hand each engine its part of the vector of all."""
        for one, place in zip(self.running, self.slices, strict=True):
            one.t, one.y = t, y[place].copy()
        self.motion = y[-3:].copy()

    def _keep(self, solution: Any, derivative: Rates) -> None:
        """Note the motion of the frame, and the force it hands on, at the steps of a segment."""
        for t, y in zip(solution.t, solution.y.T, strict=True):
            dy, x, v = derivative(t, y), float(y[-3]), float(y[-2])
            push = -sum(
                one.machine.mass * (dy[place.start + VELOCITY] + dy[-2])
                for one, place in zip(self.running, self.slices, strict=True)
            )
            self.seen.append(np.array([t, x, v, self.frame.transmitted(float(push), x, v)]))

    def table(self) -> pd.DataFrame:
        """Motion of the frame."""
        from saleg.simulation.shown_table import Table

        rows = np.array(self.seen).reshape(-1, len(UNITS)).T
        return Table.of(dict(zip(UNITS, rows, strict=True)), UNITS)


def _of_slice(event: Event, place: slice) -> Event:
    """An event of one engine as one of the vector of all."""
    return dataclasses.replace(event, value=lambda y: event.value(y[place]))
