"""The engine as a controller meets it: it advances, shows signals and takes commands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.control.outcome import blamed, controlled_outcome, fault_message, is_plain, refusal
from saleg.engine import Engine, check_controller, check_engine, warn_of_unusual
from saleg.engine.controller import Controller
from saleg.errors import ControllerError
from saleg.kernel import layout
from saleg.kernel.control import asked, obey
from saleg.kernel.decide import decide
from saleg.laws.arguments import Commands, Signals
from saleg.laws.control.actuators import Actuators
from saleg.laws.control.base import ActuatorLaw, ConverterLaw
from saleg.laws.control.converter import Converter
from saleg.quantities import is_number
from saleg.simulation.course import Course, Replay
from saleg.simulation.initial_state import State, prepare
from saleg.simulation.run import Run
from saleg.simulation.settings import Settings, SettingsError
from saleg.simulation.signals import measured

#: Strokes whose commands are remembered: the last full cycle is among them.
LOGGED = 8


class Plant:
    """An engine under commands, from dead centre to dead centre.

    Parameters
    ----------
    engine : Engine
        Begins as its start law has it.
    duration : float
        Time at which it ends [s].
    actuators : ActuatorLaw, optional
        Limits and lags; :class:`saleg.laws.Actuators` unless given.
    converter : ConverterLaw, optional
        What comes of a commanded force; :class:`saleg.laws.Converter` unless given.
    **settings
        Further settings of :func:`saleg.simulate`, of which ``stall_stroke`` is 0 here.

    Raises
    ------
    InvalidEngine, InvalidController, SettingsError
        Naming what is wrong.

    Examples
    --------
    >>> import saleg
    >>> from saleg.control import Plant, generator
    >>> plant = Plant(saleg.machines.thesis_transient(), 0.5)
    >>> while plant.running:
    ...     plant.command(generator(plant.signals))
    ...     plant.advance()
    >>> round(plant.run().performance.frequency)
    45
    """

    def __init__(
        self,
        engine: Engine,
        duration: float,
        *,
        actuators: ActuatorLaw | None = None,
        converter: ConverterLaw | None = None,
        **settings: Any,
    ):
        before = commanded_by(actuators, converter)
        self._begin(plant_course(engine, duration, before, settings))
        warn_of_unusual(engine, actuators=actuators)

    @classmethod
    def _again(cls, course: Course) -> Plant:
        """A plant that goes on with a course."""
        plant = cls.__new__(cls)
        plant._begin(course)
        return plant

    def _begin(self, course: Course) -> None:
        self._course = course
        self._end = float(course.options["t_end"][0])
        self._code = layout.BUFFER_FULL
        self._misfired = False
        self._commanded = False
        self._latest: Commands | None = None
        self._at_dead_centres = True
        self._log: dict[int, Commands] = {}

    def describe(self, controller: object) -> None:
        """Say in the settings of the run what controls it: the laws with their numbers, or a name.

        Parameters
        ----------
        controller : object
            What gives the commands.
        """
        laws = isinstance(controller, InPython)
        text = repr(controller.controller) if laws else type(controller).__name__  # type: ignore[attr-defined]
        self._course.described["controller"] = text

    @property
    def engine(self) -> Engine:
        """The engine."""
        return self._course.engine

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self._course.state.time

    @property
    def running(self) -> bool:
        """Whether there is time left and nothing has ended the motion."""
        return self._code == layout.BUFFER_FULL

    @property
    def time_is_up(self) -> bool:
        """Whether it has come to the end of its time."""
        return self._code == layout.END_OF_TIME

    @property
    def misfired(self) -> bool:
        """Whether a charge failed to light in the latest advance."""
        return self._misfired

    @property
    def signals(self) -> Signals:
        """Signals now; those of the stroke are of the latest dead centre."""
        return measured(self._course.state)

    def command(self, commands: Commands) -> None:
        """Command the engine from now on.

        Parameters
        ----------
        commands : Commands
            See :func:`generator` and :func:`motor`.

        Raises
        ------
        ControllerError
            If a command is not finite or beyond the limits of its actuator; the engine then goes
            on as before.
        """
        if not isinstance(commands, Commands):
            raise ControllerError(f"must be Commands, not {type(commands).__name__}")
        if not all(map(is_plain, commands)):
            raise ControllerError(refusal(commands, self._course.controller or Controller()))
        commands = Commands(*(float(value) for value in commands))
        give(self._course, commands, first=not self._commanded)
        self._commanded, self._latest = True, commands
        stroke = int(self._course.state.engine["strokes"][0])
        self._log[stroke] = commands
        self._log.pop(stroke - LOGGED, None)

    def advance(self, duration: float | None = None) -> None:
        """Go on to the next dead centre, or for some time.

        Parameters
        ----------
        duration : float, optional
            Time to go on [s]; to the next dead centre unless given.

        Raises
        ------
        SettingsError
            If the duration makes no sense, or the run is over.
        """
        if not self.running:
            raise SettingsError("the run is over: there is nothing to advance to")
        self._hold()
        end = self._end
        E, O = self._course.state.engine, self._course.options
        O["last_stroke"], O["t_end"] = E["strokes"] + 1.0, end
        if duration is not None:
            if not is_number(duration) or not 0.0 < duration < math.inf:
                raise SettingsError(f"duration = {duration!r}: must be a number > 0 [s]")
            if self.time + duration <= self.time:
                raise SettingsError(f"duration = {duration!r}: too short to move the time on [s]")
            self._at_dead_centres = False
            O["last_stroke"], O["t_end"] = math.inf, min(end, self.time + duration)
        code, self._misfired = layout.BUFFER_FULL, False
        while code == layout.BUFFER_FULL:
            code = self._course.advance()
            self._misfired |= self._course.misfired
        if code != layout.END_OF_TIME or self.time >= end:
            self._code = code

    def _hold(self) -> None:
        """Move the actuators on where no command has been given since the last advance."""
        if self._commanded and self._latest is None:
            give(self._course, standing_orders(self._course.state), first=False)
        self._latest = None

    def run(self, fault: str = "") -> Run:
        """Run of all that has been recorded so far.

        Parameters
        ----------
        fault : str
            What the controller did wrong, if that ended the run.

        Returns
        -------
        Run
        """
        code = layout.END_OF_TIME if self.running else self._code
        status, message = controlled_outcome(self._course, code, fault)
        return self._course.run(status, message, self._replay())

    def _replay(self) -> ReplayOfCommands | None:
        """Replay of the last cycle; it needs commands given at dead centres."""
        plain = self._course.replay()
        if plain is None or not self._at_dead_centres:
            return None
        return ReplayOfCommands(
            plain.engine, plain.snapshots, plain.settings, plain.controller, self._log
        )


@dataclass(frozen=True, eq=False)
class ReplayOfCommands(Replay):
    """The last cycle again, with the commands that were given in it."""

    log: dict[int, Commands] | None = None

    def __call__(self) -> Run:
        """Run the cycle."""
        plant, log = Plant._again(self.course()), self.log or {}
        plant._commanded = True
        course = plant._course
        last = float(course.options["last_stroke"][0])
        while plant.running and course.state.engine["strokes"][0] < last:
            stroke = int(course.state.engine["strokes"][0])
            if stroke in log:
                plant.command(log[stroke])
            plant.advance()
        return plant.run()


def commanded_by(actuators: ActuatorLaw | None, converter: ConverterLaw | None) -> Controller:
    """A controller of which what stands before the engine matters alone."""
    return Controller(actuators=actuators or Actuators(), converter=converter or Converter())


def plant_course(engine: Engine, duration: float, controller: Controller, settings: Any) -> Course:
    """Start a run that is commanded from Python, through actuators and converter."""
    return course_of(engine, controller, duration, layout.IN_PYTHON, settings)


def course_of(
    engine: Engine, controller: Controller, duration: float, controlled: int, settings: Any
) -> Course:
    """A run about to begin, under a controller."""
    known = Settings.of(duration, {"stall_stroke": 0.0, **settings})
    check_engine(engine)
    check_controller(controller)
    engine.check_laws()
    controller.check_laws()
    state = prepare(engine)
    state.engine["controlled"] = controlled
    if controller.force_control is not None:
        state.engine["sample_time"] = controller.sample_time
        state.engine["t_sample"] = 0.0
    return Course(engine, state, known, controller)


def give(course: Course, commands: Commands, first: bool) -> None:
    """Pass commands to the actuators; on a change of the motor, note the event."""
    E, C = course.state.records
    was = float(E.motoring)
    elapsed = math.inf if first else float(E.t - E.t_command)
    obey(course.controller, E, C, commands, elapsed)
    if E.fault != 0.0:
        fault, E.fault = float(E.fault), 0.0
        raise ControllerError(fault_message(fault, commands, course.controller or Controller()))
    if E.motoring != was:
        note_motor(course)


def standing_orders(state: State) -> Commands:
    """Commands that change nothing of what was commanded last, the motor's frequency gone on."""
    E, _ = state.records
    frequency = E.motor_frequency + E.motor_sweep * float(E.t - E.t_command)
    return Commands(*map(float, asked(E)._replace(frequency=frequency)))


def note_motor(course: Course) -> None:
    """Put a change of the motor into the table of events."""
    row = np.zeros(1, layout.EVENT_RECORD)
    E, y = course.state.engine[0], course.state.y
    on = E["motoring"] > 0.0
    row["t"], row["x"], row["v"] = E["t"], y[layout.X], y[layout.V]
    row["kind"] = layout.EVENT_MOTOR_ON if on else layout.EVENT_MOTOR_OFF
    row["side"] = layout.LEFT if E["direction"] > 0.0 else layout.RIGHT
    row["p"], row["T"] = state_of_gas(course, int(row["side"][0]))
    course.records.kept_events.add(row)


def state_of_gas(course: Course, side: int) -> tuple[float, float]:
    """Pressure [Pa] and temperature [K] in a chamber."""
    from saleg.kernel.events import pressure_and_temperature

    _, C = course.state.records
    p, T = pressure_and_temperature(C, side, course.state.y)
    return float(p), float(T)


class InPython:
    """A controller made of laws, run as Python.

    Parameters
    ----------
    controller : Controller
    """

    def __init__(self, controller: Controller):
        self.controller = controller
        self.memory = np.zeros((layout.CONTROL_PARTS, layout.MEMORY))

    def act(self, signals: Signals) -> Commands:
        """Commands at a dead centre.

        Raises
        ------
        ControllerError
            Naming the part that failed.
        """
        before = self.memory.copy()
        try:
            commands = decide(self.controller, self.memory, signals)
        except Exception as error:  # whatever a part does, the run says so
            raise ControllerError(blamed(self.controller, before, signals)) from error
        return Commands(*(float(value) for value in commands))
