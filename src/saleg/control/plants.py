"""Many engines as controllers meet them: they advance together, in one compiled loop."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from saleg.checks import as_array
from saleg.compiler import plain, search
from saleg.compiler.compiled_engine import compiled_engine
from saleg.compiler.text import INTEGRATOR_WITH_PLANTS, PLANTS
from saleg.control.outcome import fault_message, is_plain, refusal
from saleg.control.plant import course_of
from saleg.engine import Engine, engine_problems
from saleg.engine.controller import Controller
from saleg.errors import ControllerError, shown
from saleg.kernel import layout
from saleg.kernel.plants import Fleet
from saleg.laws.arguments import Commands, Signals
from saleg.laws.control.actuators import Actuators
from saleg.laws.control.base import ActuatorLaw
from saleg.simulation.course import Course
from saleg.simulation.settings import Settings, SettingsError, refuse
from saleg.simulation.signals import measured

#: Engines whose refused commands are named one by one.
SHOWN = 5


class Plants:
    """Many engines under commands, from dead centre to dead centre.

    Each does what a :class:`Plant` would, without a record of its strokes: only the signals of the
    latest are kept.

    Parameters
    ----------
    engines : sequence of Engine
        Of the same laws; their numbers may differ.
    duration : float
        Time at which each ends [s].
    actuators : ActuatorLaw, optional
        Limits and lags; :class:`saleg.laws.Actuators` unless given.
    **settings
        Further settings of :func:`saleg.simulate`, of which ``stall_stroke`` is 0 here.

    Raises
    ------
    InvalidEngine, InvalidController, SettingsError
        Naming what is wrong.

    Examples
    --------
    >>> import saleg
    >>> from saleg.control import Plants, generator
    >>> engine = saleg.machines.thesis_transient()
    >>> plants = Plants([engine, engine.replace(moving_mass=4.0)], 1.0)
    >>> for _ in range(30):
    ...     plants.advance(generator(plants.signals))
    >>> plants.signals.frequency.round()
    array([45., 50.])
    """

    def __init__(
        self,
        engines: Sequence[Engine],
        duration: float,
        *,
        actuators: ActuatorLaw | None = None,
        **settings: Any,
    ):
        if plain.is_wanted():
            raise SettingsError("Plants are compiled code only: take a Plant for each engine")
        wrong = Settings.wrong(duration, {"stall_stroke": 0.0, **settings})
        refuse("Plants", engine_problems(engines), wrong)
        engines = list(engines)
        self._controller = Controller(actuators=actuators or Actuators())
        self._duration, self._settings = duration, settings
        begun = {id(engine): self._begin(engine) for engine in engines}
        self._course = begun[id(engines[0])]
        for detail in ("peaks", "history"):
            self._course.options[detail] = 0
        alone = search.stands_alone()
        self._kernel = compiled_engine(
            engines[0],
            self._controller,
            asks=False,
            modules=PLANTS if alone else INTEGRATOR_WITH_PLANTS,
            motored_pressure=self._course.settings.motored_pressure,
        ).kernel
        work = self._course.arguments
        self._address = self._course.kernel.address("run_on", (work,)) if alone else 0
        self._fleet = _fleet(len(engines), self._course)
        for row, engine in enumerate(engines):
            self._put(row, begun[id(engine)])

    def _begin(self, engine: Engine) -> Course:
        """An engine at its start."""
        given = (self._controller, self._duration, layout.IN_PYTHON, self._settings)
        return course_of(engine, *given)

    def _put(self, row: int, course: Course) -> None:
        """Put an engine at its start into a row."""
        numbers, known = course.arguments.laws, self._course.arguments.laws
        if course.kernel is not self._course.kernel or numbers.dtype != known.dtype:
            raise SettingsError(f"engines[{row}] has other laws than engines[0]")
        fleet, state = self._fleet, course.state
        fleet.laws[row], fleet.engine[row], fleet.y[row] = numbers[0], state.engine[0], state.y
        fleet.chambers[2 * row : 2 * row + 2] = state.chambers
        fleet.signals[row] = tuple(measured(state))
        fleet.begins[row], fleet.misfired[row] = True, False
        fleet.codes[row] = layout.BUFFER_FULL

    def __len__(self) -> int:
        """How many engines there are."""
        return len(self._fleet.codes)

    @property
    def time(self) -> np.ndarray:
        """Time each has reached [s], shape (n,)."""
        return self._fleet.engine["t"].copy()

    @property
    def running(self) -> np.ndarray:
        """Whether each has time left and nothing has ended its motion, shape (n,)."""
        at_dead_centre = self._fleet.codes == layout.END_OF_TIME
        goes_on = at_dead_centre & (self._fleet.engine["t"] < self._duration)
        return goes_on | (self._fleet.codes == layout.BUFFER_FULL)

    @property
    def time_is_up(self) -> np.ndarray:
        """Whether each has come to the end of its time, shape (n,)."""
        return (self._fleet.codes == layout.END_OF_TIME) & ~self.running

    @property
    def misfired(self) -> np.ndarray:
        """Whether a charge of each failed to light in its latest stroke, shape (n,)."""
        return self._fleet.misfired.copy()

    @property
    def signals(self) -> Signals:
        """Signals of each, as :class:`saleg.laws.Signals` of arrays of shape (n,)."""
        return Signals(*(self._fleet.signals[name].copy() for name in Signals._fields))

    def advance(self, commands: Commands, rows: np.ndarray | None = None) -> None:
        """Command engines and go on to the next dead centre of each.

        Parameters
        ----------
        commands : Commands
            Of numbers, or of arrays with a value for each engine, shape (n,).
        rows : ndarray of bool, shape (n,), optional
            Which engines go on; all that run unless given.

        Raises
        ------
        ControllerError
            If commands are no numbers, one for each engine, or beyond the limits of their
            actuators, naming all of them and the engines; all then stay where they are.
        SettingsError
            If an engine that is to go on is over.
        """
        running = self.running
        chosen = running if rows is None else np.asarray(rows, bool)
        if chosen.shape != running.shape:
            raise SettingsError(f"rows: must be of shape {running.shape}, not {chosen.shape}")
        if not chosen.any() or (chosen & ~running).any():
            raise SettingsError("a run is over: there is nothing to advance to")
        self._check(commands)
        for name, values in commands._asdict().items():
            self._fleet.commands[name] = values
        wanted = np.flatnonzero(chosen)
        work = self._course.arguments
        refused = self._kernel.call("advance_fleet", self._fleet, wanted, work, self._address)
        if refused >= 0:
            raise ControllerError(self._refusal(int(refused), wanted))

    def _check(self, commands: Commands) -> None:
        """Refuse what is no numbers, one or one for each engine."""
        if not isinstance(commands, Commands):
            raise ControllerError(f"must be Commands, not {type(commands).__name__}")
        fits = ((), (len(self),))
        wrong = []
        for name, value in commands._asdict().items():
            if not is_plain(value) and getattr(as_array(value), "shape", None) not in fits:
                wrong.append(f"{name} = {shown(value)}")
        if wrong:
            wanted = f"must be numbers, or arrays of shape ({len(self)},)"
            raise ControllerError(f"{', '.join(wrong)}: {wanted}")

    def _refusal(self, first: int, rows: np.ndarray) -> str:
        """Why the commands of some engines are refused."""
        refused = {}
        for row in rows.tolist():
            commands = Commands(*self._fleet.commands[row].tolist())
            text = refusal(commands, self._controller)
            if text:
                refused[row] = text
        if first not in refused:
            commands = Commands(*self._fleet.commands[first].tolist())
            fault = float(self._controller.actuators.refused(commands))
            refused[first] = fault_message(fault, commands, self._controller)
        lines = [f"engine {row}: {text}" for row, text in itertools.islice(refused.items(), SHOWN)]
        more = len(refused) - len(lines)
        return "\n".join([*lines, *([f"and {more} more engines"] if more else [])])

    def restart(self, row: int, engine: Engine) -> None:
        """Put an engine at its start in the place of another.

        Parameters
        ----------
        row : int
            Whose place it takes.
        engine : Engine
            Of the same laws.
        """
        self._put(row, self._begin(engine))


def _fleet(count: int, course: Course) -> Fleet:
    """Room for engines of the laws of one."""
    return Fleet(
        laws=np.zeros(count, course.arguments.laws.dtype),
        engine=np.zeros(count, layout.ENGINE_RECORD),
        chambers=np.zeros(2 * count, layout.CHAMBER_RECORD),
        y=np.zeros((count, layout.N_ALL)),
        commands=np.zeros(count, layout.COMMANDS_RECORD),
        signals=np.zeros(count, layout.SIGNALS_RECORD),
        begins=np.ones(count, bool),
        codes=np.zeros(count, np.int64),
        misfired=np.zeros(count, bool),
    )
