"""Simulation of an engine over a stretch of time."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.compiler.compiled_engine import compiled_engine
from saleg.engine import Engine, check_engine, warn_of_unusual
from saleg.errors import SalegError
from saleg.kernel import layout, tableaus
from saleg.kernel.tuples import Snapshots
from saleg.laws.arguments import Commands
from saleg.quantities import as_float, is_whole
from saleg.simulation.initial_state import State, prepare
from saleg.simulation.kernel_arguments import arguments_of
from saleg.simulation.outcome import verdict
from saleg.simulation.records import Records
from saleg.simulation.run import Run
from saleg.status import Status

if TYPE_CHECKING:
    from saleg.engine.controller import Controller

#: Steps between two looks at the progress bar and the keyboard.
STEPS_PER_CALL = 200_000
DEFAULT_TOLERANCE = 1e-8
DEFAULT_STEP = 5e-6
#: Instants recorded within each step of the last cycle, so that curves through them are smooth.
ORBIT_POINTS = 7


class SettingsError(SalegError, ValueError):
    """A setting of :func:`simulate` that makes no sense."""


@dataclass(frozen=True)
class Settings:
    """How a run is integrated and what is kept of it; see :func:`simulate`."""

    duration: float
    adaptive: bool = True
    order: int = 4
    step: float = DEFAULT_STEP
    rtol: float = DEFAULT_TOLERANCE
    history: int = 0
    motored_pressure: bool = False
    stall_stroke: float = 0.01
    keep_cycles: int | None = None
    peaks: int = 1
    dense: int = 0
    last_stroke: float = math.inf


def simulate(
    engine: Engine,
    duration: float,
    *,
    method: str = "adaptive",
    order: int = 4,
    step: float | None = None,
    rtol: float = DEFAULT_TOLERANCE,
    history: int | None = None,
    motored_pressure: bool = False,
    stall_stroke: float = 0.01,
    keep_cycles: int | None = None,
) -> Run:
    """Simulate an engine for some time from its start.

    Parameters
    ----------
    engine : Engine
    duration : float
        Time to simulate [s].
    method : {"adaptive", "fixed"}
        Adaptive Dormand-Prince 5(4) pair, or a fixed step on a grid. Both end steps exactly on
        events.
    order : {1, 2, 3, 4, 5, 8}
        Order of the fixed-step method; the adaptive one has its own.
    step : float, optional
        Fixed step [s]; 5 microseconds unless given. Giving one asks for ``method="fixed"``.
    rtol : float
        Tolerance of the adaptive method, from 1e-14 to 1e-2, relative to stroke, natural speed
        and pressure; a fixed step has none.
    history : int, optional
        Keep every n-th step in :attr:`Run.history`, events always; nothing unless given.
    motored_pressure : bool
        Integrate the motored pressure as well.
    stall_stroke : float
        End the run as stalled when a stroke is shorter than this share of the maximum stroke;
        0 never does.
    keep_cycles : int, optional
        Keep the records of only about the last so many cycles, at least eleven; all unless given.

    Returns
    -------
    Run
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
    >>> run = saleg.simulate(saleg.machines.thesis_base(), 0.5)
    >>> round(run.performance.frequency, 1)
    47.0
    """
    settings = settings_of(
        duration,
        method=method,
        order=order,
        step=step,
        rtol=rtol,
        history=history,
        motored_pressure=motored_pressure,
        stall_stroke=stall_stroke,
        keep_cycles=keep_cycles,
    )
    check_engine(engine)
    warn_of_unusual(engine)
    return integrate(engine, prepare(engine), settings)


def settings_of(
    duration: float,
    *,
    method: str = "adaptive",
    order: int = 4,
    step: float | None = None,
    rtol: float = DEFAULT_TOLERANCE,
    history: int | None = None,
    motored_pressure: bool = False,
    stall_stroke: float = 0.01,
    keep_cycles: int | None = None,
) -> Settings:
    """Check the arguments of :func:`simulate`; all that is wrong is named together."""
    wrong = []
    if not isinstance(method, str) or method not in ("adaptive", "fixed"):
        wrong.append(f"method = {method!r}: must be 'adaptive' or 'fixed'")
    if as_float(order) not in tableaus.FIXED_STEP:
        orders = ", ".join(str(number) for number in tableaus.FIXED_STEP)
        wrong.append(f"order = {order!r}: must be one of {orders}")
    for name, value, low, high in (
        ("duration", duration, 0.0, math.inf),
        ("step", DEFAULT_STEP if step is None else step, 1e-12, 1.0),
        ("rtol", rtol, 9.9e-15, 1.01e-2),
    ):
        number = as_float(value)
        if number is None or not low < number < high:
            wrong.append(f"{name} = {value!r}: must be a number > {low:g} and < {high:g}")
    share = as_float(stall_stroke)
    if share is None or not 0.0 <= share < 1.0:
        wrong.append(f"stall_stroke = {stall_stroke!r}: must be a number >= 0 and < 1")
    for name, count in (("history", history), ("keep_cycles", keep_cycles)):
        if count is not None and not is_whole(count, 1, 2**31 - 1):
            wrong.append(f"{name} = {count!r}: must be a whole number >= 1, or None")
    if not isinstance(motored_pressure, (bool, np.bool_)):
        wrong.append(f"motored_pressure = {motored_pressure!r}: must be True or False")
    if wrong:
        raise SettingsError("cannot simulate:\n" + "\n".join(f"  {text}" for text in wrong))
    return Settings(
        duration=float(duration),
        adaptive=method == "adaptive" and step is None,
        order=int(order),
        step=DEFAULT_STEP if step is None else float(step),
        rtol=float(rtol),
        history=int(history or 0),
        motored_pressure=bool(motored_pressure),
        stall_stroke=float(stall_stroke),
        keep_cycles=None if keep_cycles is None else int(keep_cycles),
    )


def check_flag(name: str, value: Any) -> None:
    """Refuse what is neither True nor False.

    Raises
    ------
    SettingsError
    """
    if not isinstance(value, (bool, np.bool_)):
        raise SettingsError(f"{name} = {value!r}: must be True or False")


def integrate(engine: Engine, state: State, settings: Settings) -> Run:
    """Integrate from a state; the engine is taken to be valid."""
    course = Course(engine, state, settings)
    code = course.go_on()
    return course.run(*verdict(engine, code, state, course.strokes), course.replay())


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
    """

    def __init__(
        self,
        engine: Engine,
        state: State,
        settings: Settings,
        controller: Controller | None = None,
    ):
        if engine.needs_motored_pressure:
            settings = replace(settings, motored_pressure=True)
        self.engine, self.state, self.settings = engine, state, settings
        self.controller = controller
        asks = state.engine["controlled"][0] == layout.COMPILED
        compiled = compiled_engine(engine, controller, asks=asks)
        self.kernel = compiled.kernel
        self.options = options_record(settings, state.time + settings.duration)
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
        #: What else people want to know of how the run came about.
        self.described: dict[str, Any] = {}

    @property
    def snapshots(self) -> Snapshots:
        """States at the last two left dead centres."""
        return self._arguments.snapshots

    @property
    def commanded(self) -> Commands:
        """What a controller in the kernel has asked for last."""
        return Commands(*self._arguments.control.commands[0].tolist())

    @property
    def strokes(self) -> np.ndarray:
        """Rows of all strokes so far."""
        return self.records.kept_strokes.joined()

    def go_on(self) -> int:
        """Call the kernel until it is done; returns why it stopped."""
        with _progress(self.settings.duration) as bar:
            while True:
                before = self.state.time
                code = self.advance()
                if bar is not None:
                    bar.update(self.state.time - before)
                if code != layout.BUFFER_FULL:
                    return code

    def advance(self) -> int:
        """Call the kernel once; returns why it stopped."""
        code = self.kernel.call("run_on", self._arguments)
        self.records.make_room()
        return int(code)

    def replay(self) -> Replay | None:
        """How to see the last full cycle again; None without one."""
        if self.snapshots.engine["mass"][1] == 0.0 or self.settings.last_stroke < math.inf:
            return None
        return Replay(self.engine, self.snapshots, self.settings, self.controller)

    def run(self, status: Status, message: str, replay: Callable[[], Run] | None = None) -> Run:
        """What has been recorded, as a run."""
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
            settings={**_described(self.settings), **self.described},
            replay=replay,
        )


def options_record(settings: Settings, t_end: float) -> np.ndarray:
    """Settings as the kernel reads them."""
    options = np.zeros(1, layout.OPTIONS_RECORD)
    options["adaptive"] = settings.adaptive
    options["motored"] = settings.motored_pressure
    options["peaks"] = settings.peaks
    options["history"] = settings.history
    options["dense"] = settings.dense
    options["events"] = 1
    options["max_steps"] = STEPS_PER_CALL
    options["t_end"] = t_end
    options["step"] = settings.step
    options["tolerance"] = settings.rtol
    options["last_stroke"] = settings.last_stroke
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
        course = self.course()
        code = course.go_on()
        return course.run(*verdict(self.engine, code, course.state, course.strokes))

    @property
    def start(self) -> State:
        """State at the dead centre the cycle begins at."""
        engine, chambers, y = (part[1].copy() for part in self.snapshots)
        return State(engine.reshape(1), chambers, y, np.zeros(layout.N_PEAKS))

    def course(self) -> Course:
        """The cycle about to begin."""
        state, times = self.start, self.snapshots.engine["t"]
        period = float(times[0] - times[1])
        asked = replace(
            self.settings,
            duration=1.5 * period,
            last_stroke=float(state.engine["strokes"][0]) + 2.0,
            history=1,
            dense=ORBIT_POINTS,
            peaks=2,
            keep_cycles=None,
        )
        return Course(self.engine, state, asked, self.controller)


def _described(settings: Settings) -> dict[str, Any]:
    """What people want to know of how a run was integrated."""
    motored = {"motored_pressure": settings.motored_pressure}
    if settings.adaptive:
        return {"method": "adaptive", "rtol": settings.rtol, **motored}
    return {"method": "fixed", "order": settings.order, "step": settings.step, **motored}


@contextmanager
def _progress(duration: float) -> Iterator[Any]:
    """Progress bar for runs longer than a second of waiting, on a terminal only."""
    if not sys.stderr.isatty():
        yield None
        return
    from tqdm import tqdm

    form = "{l_bar}{bar}| {n:.3g}/{total:.3g} s simulated [{elapsed}<{remaining}]"
    with tqdm(total=duration, delay=1, leave=False, bar_format=form) as bar:
        yield bar
