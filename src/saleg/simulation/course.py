"""A run under way, and its last cycle simulated again."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.compiler.compiled_engine import compiled_engine
from saleg.engine import Engine
from saleg.kernel import layout, tableaus
from saleg.kernel.tuples import Integration, Snapshots
from saleg.laws.arguments import Commands
from saleg.simulation.initial_state import State
from saleg.simulation.kernel_arguments import arguments_of
from saleg.simulation.outcome import outcome_of
from saleg.simulation.progress import progress_bar
from saleg.simulation.records import Records
from saleg.simulation.run import Run
from saleg.simulation.settings import Detail, Settings
from saleg.status import Status

if TYPE_CHECKING:
    from saleg.engine.controller import Controller

#: Steps between two looks at the progress bar and the keyboard.
STEPS_PER_CALL = 200_000
#: Instants recorded within each step of the last cycle, so that curves through them are smooth.
ORBIT_POINTS = 7
BAR = "{l_bar}{bar}| {n:.3g}/{total:.3g} s simulated [{elapsed}<{remaining}]"
DEFAULT_DETAIL = Detail()
#: Status and message of a run, from its course and the code with which the kernel stopped.
Judge = Callable[["Course", int], tuple[Status, str]]


class Course:
    """A run under way: the engine's state, the compiled kernel, and what has been recorded.

    Parameters
    ----------
    engine : Engine
        A valid engine.
    state : State
        Where it stands; moves on.
    settings : Settings
    controller : Controller, optional
        Compiled with the engine, or whose actuators are.
    detail : Detail
    """

    def __init__(
        self,
        engine: Engine,
        state: State,
        settings: Settings,
        controller: Controller | None = None,
        detail: Detail = DEFAULT_DETAIL,
    ):
        if engine.needs_motored_pressure:
            settings = replace(settings, motored_pressure=True)
        self.engine, self.state, self.settings, self.detail = engine, state, settings, detail
        self.controller = controller
        asks = state.engine["controlled"][0] == layout.COMPILED
        compiled = compiled_engine(
            engine, controller, asks=asks, motored_pressure=settings.motored_pressure
        )
        self.kernel = compiled.kernel
        self.options = options_record(settings, state.time + settings.duration, detail)
        self.records = Records(bool(settings.history), settings.keep_cycles)
        method = tableaus.ADAPTIVE if settings.adaptive else tableaus.FIXED_STEP[settings.order]
        order = tableaus.ADAPTIVE_ORDER if settings.adaptive else float(settings.order)
        self._arguments = arguments_of(
            compiled,
            state,
            tableau=method,
            order=order,
            options=self.options,
            tables=self.records.tables,
        )
        #: Whether a charge failed to light in the latest call of the kernel.
        self.misfired = False
        #: What else a run says of how it came about.
        self.described: dict[str, Any] = {}

    @property
    def arguments(self) -> Integration:
        """Arguments of the integrator."""
        return self._arguments

    @property
    def snapshots(self) -> Snapshots:
        """States at the last two left dead centres."""
        return self._arguments.snapshots

    @property
    def commanded(self) -> Commands:
        """Latest commands of a controller in the kernel."""
        return Commands(*self._arguments.control.commands[0].tolist())

    @property
    def strokes(self) -> np.ndarray:
        """Rows of all strokes so far."""
        return self.records.kept_strokes.joined()

    def finish(self, outcome: Judge | None = None) -> Run:
        """Run to the end.

        Parameters
        ----------
        outcome : callable, optional
            Status and message from the course and why the kernel stopped; those of an engine left
            to itself unless given.

        Returns
        -------
        Run
        """
        code = self._integrate()
        return self.run(*(outcome or _outcome)(self, code), self.replay())

    def _integrate(self) -> int:
        """Call the kernel until it is done; returns why it stopped."""
        with progress_bar(self.settings.duration, bar_format=BAR) as bar:
            while True:
                before = self.state.time
                code = self.advance()
                if bar is not None:
                    bar.update(self.state.time - before)
                if code != layout.BUFFER_FULL:
                    return code
                if self.state.engine["steps"][0] >= self.detail.most_steps:
                    return layout.END_OF_TIME

    def advance(self) -> int:
        """Call the kernel once; returns why it stopped."""
        code = self.kernel.call("run_on", self._arguments)
        self.misfired = self.records.has(layout.EVENT_MISFIRE)
        self.records.make_room()
        return int(code)

    def replay(self) -> Replay | None:
        """Replay of the last full cycle; None without one."""
        if self.snapshots.engine["mass"][1] == 0.0 or self.detail.last_stroke < math.inf:
            return None
        return Replay(self.engine, self.snapshots, self.settings, self.controller)

    def run(self, status: Status, message: str, replay: Callable[[], Run] | None = None) -> Run:
        """Run of all that has been recorded."""
        return Run(
            engine=self.engine,
            status=status,
            message=message,
            duration=self.state.time,
            strokes=self.strokes,
            event_rows=self.records.kept_events.joined(),
            history_rows=self.records.finished_history(),
            evaluations=int(self.state.engine["evaluations"][0]),
            steps=int(self.state.engine["steps"][0]),
            settings={**self.settings.described(), **self.described},
            replay=replay,
        )


def _outcome(course: Course, code: int) -> tuple[Status, str]:
    """Status and message of an engine left to itself."""
    return outcome_of(course.engine, code, course.state, course.strokes)


def options_record(settings: Settings, t_end: float, detail: Detail = DEFAULT_DETAIL) -> np.ndarray:
    """Settings as the kernel reads them."""
    options = np.zeros(1, layout.OPTIONS_RECORD)
    options["adaptive"] = settings.adaptive
    options["motored"] = settings.motored_pressure
    options["peaks"] = detail.peaks
    options["history"] = settings.history or 0
    options["dense"] = detail.dense
    options["events"] = 1
    options["max_steps"] = STEPS_PER_CALL
    options["t_end"] = t_end
    options["step"] = settings.fixed_step
    options["tolerance"] = settings.rtol
    options["last_stroke"] = detail.last_stroke
    options["stall"] = settings.stall_stroke
    return options


@dataclass(frozen=True, eq=False)
class Replay:
    """Simulates the last full cycle again, with every instant recorded and every peak located."""

    engine: Engine
    snapshots: Snapshots
    settings: Settings
    controller: Controller | None = None

    def __call__(self) -> Run:
        """Run the cycle."""
        return self.course().finish()

    @property
    def start(self) -> State:
        """State at the dead centre the cycle begins at."""
        engine, chambers, y = (part[1].copy() for part in self.snapshots)
        return State(engine.reshape(1), chambers, y, np.zeros(layout.N_PEAKS))

    def course(self) -> Course:
        """The cycle about to begin."""
        state, times = self.start, self.snapshots.engine["t"]
        period = float(times[0] - times[1])
        asked = replace(self.settings, duration=1.5 * period, history=1, keep_cycles=None)
        last = float(state.engine["strokes"][0]) + 2.0
        detail = Detail(peaks=2, dense=ORBIT_POINTS, last_stroke=last)
        return Course(self.engine, state, asked, self.controller, detail)
