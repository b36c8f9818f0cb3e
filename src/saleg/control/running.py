"""A run under a controller, and many of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from saleg.batch.many import RUN_UNITS, batch_table, run_row
from saleg.batch.table import CHUNK, Row, rows_of
from saleg.checks import NUMBER, a, checked
from saleg.compiler.compiled_engine import compiled_engine
from saleg.control.outcome import controlled_outcome
from saleg.control.plant import InPython, Plant, commanded_by, course_of, give, plant_course
from saleg.control.sensors import Measurement, Sensors
from saleg.engine import Engine, warn_of_unusual
from saleg.engine.controller import Controller
from saleg.errors import ControllerError, nearest, shown
from saleg.kernel import layout
from saleg.laws.arguments import Commands, Signals
from saleg.laws.control.base import ActuatorLaw, ConverterLaw
from saleg.quantities import as_float, unusual
from saleg.simulation.indicators import beyond_ports
from saleg.simulation.run import Run
from saleg.simulation.settings import SettingsError
from saleg.simulation.signals import measured

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

#: Most samples of a run: fewer than a controller in Python gets through in an hour.
MAX_SAMPLES = 1e8
#: Columns of a table of runs under controllers.
CONTROL_UNITS = {
    **RUN_UNITS,
    "fired_at": "s",
    "motor_returns": "-",
    "strokes": "-",
    "motored_share": "-",
    "farthest": "m",
    "opened_ports": "-",
    "opens_ports": "-",
}


class Acts(Protocol):
    """Anything with a method that turns signals into commands."""

    def act(self, signals: Signals) -> Commands:
        """Commands from what is measured."""


def simulate(
    engine: Engine,
    controller: Controller | Acts,
    duration: float,
    *,
    compiled: bool | None = None,
    sensors: Sensors | None = None,
    sample_time: float | None = None,
    actuators: ActuatorLaw | None = None,
    converter: ConverterLaw | None = None,
    **settings: Any,
) -> Run:
    """Simulate an engine under a controller, which acts at every dead centre.

    With a ``force_control`` a :class:`saleg.Controller` acts within the stroke too, compiled in any
    case.

    Parameters
    ----------
    engine : Engine
        Begins as its start law has it; give it ``start=AtRest()`` to start it up.
    controller : Controller, or any object with a method ``act(signals)``
        Returns :class:`saleg.laws.Commands` from :class:`saleg.laws.Signals`.
    duration : float
        Time to simulate [s].
    compiled : bool, optional
        Whether a :class:`saleg.Controller` runs compiled with the engine or as Python; compiled
        unless sensors or a sample time are given, which only Python has.
    sensors : Sensors, optional
        Errors of measurement; none unless given.
    sample_time : float, optional
        Let the controller act at these intervals [s] instead of at dead centres.
    actuators : ActuatorLaw, optional
        Limits and lags for an object of your own; a :class:`saleg.Controller` has its own.
    converter : ConverterLaw, optional
        What comes of the force an object of your own commands; likewise.
    **settings
        Further settings of :func:`saleg.simulate`, of which ``stall_stroke`` is 0 here.

    Returns
    -------
    Run
        A controller that fails, returns what is no number or commands what the actuators cannot
        do ends it with :attr:`saleg.Status.CONTROLLER_FAULT`. ``run.dead_centres`` shows signals
        and commands.

    Raises
    ------
    InvalidEngine, InvalidController, SettingsError
        Naming what is wrong.

    Examples
    --------
    >>> import saleg
    >>> engine = saleg.machines.thesis_transient().replace(start=saleg.engine.start.AtRest())
    >>> run = saleg.control.simulate(engine, saleg.Controller(), 0.2)
    >>> bool(run.dead_centres.motoring.all())
    True
    """
    laws = isinstance(controller, Controller)
    in_python = sensors is not None or sample_time is not None
    if sensors is not None and not isinstance(sensors, Sensors):
        raise SettingsError(f"sensors = {shown(sensors)}: must be a saleg.control.Sensors")
    if compiled is not None and not isinstance(compiled, (bool, np.bool_)):
        raise SettingsError(f"compiled = {shown(compiled)}: must be True, False or None")
    if compiled is None:
        compiled = laws and not in_python
    if compiled and (in_python or not laws):
        raise SettingsError("compiled = True: only a Controller without sensors or sample_time is")
    for name, own in (("actuators", actuators), ("converter", converter)):
        if laws and own is not None:
            raise SettingsError(f"{name}: a Controller has its own; replace those")
    if compiled and isinstance(controller, Controller):
        run = _compiled(engine, controller, duration, settings)
        warn_of_unusual(engine, controller=controller)
        return run
    if sample_time is not None:
        sample_time = _checked_sample_time(sample_time, duration)
    acting: Acts
    if isinstance(controller, Controller):
        acting, before = InPython(controller), controller
    else:
        acting, before = controller, commanded_by(actuators, converter)
    if not callable(getattr(acting, "act", None)):
        raise SettingsError(f"{type(controller).__name__} has no method act(signals)")
    plant = Plant._again(plant_course(engine, duration, before, settings))
    measurement = Measurement(sensors or Sensors(), engine)
    warn_of_unusual(engine, controller=controller, actuators=actuators, sensors=sensors)
    return _in_python(plant, acting, measurement if sensors else None, sample_time)


def _checked_sample_time(sample_time: float, duration: float) -> float:
    """An interval as a float; refused if there were too many of them."""
    interval, lasts = as_float(sample_time), as_float(duration)
    least = (lasts or 0.0) / MAX_SAMPLES
    if interval is None or not interval >= least or not interval > 0.0:
        raise SettingsError(
            f"sample_time = {shown(sample_time)}: must be a number >= {least:g} [s]"
        )
    return interval


def _compiled(engine: Engine, controller: Controller, duration: float, settings: Any) -> Run:
    """Run with the controller in the kernel; its first commands are given here."""
    course = course_of(engine, controller, duration, layout.COMPILED, settings)
    course.described["controller"] = repr(controller)
    parts = InPython(controller)
    try:
        give(course, parts.act(measured(course.state)), first=True)
    except ControllerError as error:
        return course.run(*controlled_outcome(course, 0, str(error)))
    course.state.engine["memory"][0] = parts.memory.ravel()
    return course.finish(controlled_outcome)


def _in_python(
    plant: Plant, controller: Acts, measurement: Measurement | None, sample_time: float | None
) -> Run:
    """Run with the controller asked between calls of the kernel."""
    plant.describe(controller)
    name = "" if isinstance(controller, InPython) else f"{type(controller).__name__} "
    while plant.running:
        signals = plant.signals
        if measurement is not None:
            signals = measurement.of(signals)
        try:
            commands = controller.act(signals)
        except ControllerError as error:
            return plant.run(str(error))
        except Exception as error:  # whatever the user's code does, the run says so
            return plant.run(f"{name}raised {described(error)}")
        try:
            plant.command(commands)
        except ControllerError as error:
            return plant.run(f"{name}commands {error}")
        plant.advance(sample_time)
    return plant.run()


def described(error: Exception) -> str:
    """Kind and text of an error, whatever its text does."""
    try:
        return f"{type(error).__name__}: {error}"
    except Exception:
        return type(error).__name__


@checked(signals=a(Signals))
def generator(signals: Signals, **changes: float) -> Commands:
    """Commands for a generator at rated fuel and intake, loaded as its regulator asks.

    Parameters
    ----------
    signals : Signals
    **changes
        Commands to be other than that, by name.

    Returns
    -------
    Commands

    Raises
    ------
    ControllerError
        Naming the changes that are no commands.
    """
    known = Commands._fields
    unknown = [
        f"no command '{name}'{nearest(name, known)}" for name in changes if name not in known
    ]
    if unknown:
        raise ControllerError("\n".join([*unknown, f"there are {', '.join(known)}"]))
    plain = Commands(
        motoring=0.0,
        load_weight=signals.regulated_weight,
        amplitude=0.0,
        frequency=0.0,
        sweep=0.0,
        sets_phase=0.0,
        phase=0.0,
        equivalence_ratio=signals.rated_equivalence_ratio,
        intake_temperature=signals.rated_intake_temperature,
    )
    return plain._replace(**changes)


@checked(signals=a(Signals), amplitude=NUMBER, frequency=NUMBER)
def motor(signals: Signals, amplitude: float, frequency: float, **changes: float) -> Commands:
    """Commands for a motor without fuel; its angle goes on from where it is.

    Parameters
    ----------
    signals : Signals
    amplitude : float
        Amplitude of the force [N].
    frequency : float
        Frequency [Hz].
    **changes
        Commands to be other than that, by name.

    Returns
    -------
    Commands
    """
    drive = {"motoring": 1.0, "load_weight": 0.0, "equivalence_ratio": 0.0}
    return generator(
        signals, **{**drive, "amplitude": amplitude, "frequency": frequency, **changes}
    )


def simulate_many(
    pairs: Iterable[tuple[Engine, Controller]],
    duration: float,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int = CHUNK,
    **settings: Any,
) -> pd.DataFrame:
    """Simulate many engines, each under a compiled controller, and keep how they end.

    Parameters
    ----------
    pairs : iterable of (Engine, Controller)
        Taken as they are needed.
    duration : float
        Time to simulate [s].
    executor, workers, chunk
        As for :func:`saleg.steady_states`.
    **settings
        Further settings of :func:`saleg.simulate`.

    Returns
    -------
    DataFrame
        One row per pair, in order: status, message, figures of the last cycle, ``fired_at``, when
        the motor was first left [s], ``motor_returns``, how often it came back, ``strokes``, how
        many there were, ``motored_share``, the share of them that was motored, ``farthest``,
        the greatest distance of a dead centre from the midpoint [m], ``opened_ports`` and
        ``opens_ports``, whether any stroke and whether the last two went beyond the ports of a
        cylinder (1 or 0). Units in ``.attrs``.
    """
    if settings.get("keep_cycles") is not None:
        raise SettingsError("keep_cycles: the table looks back to the start; leave it out")
    row_of: Callable[[Any], Row] = partial(_control_row, duration=duration, settings=settings)
    return batch_table(
        partial(rows_of, row_of), pairs, CONTROL_UNITS, _kernel_of, executor, workers, chunk
    )


def _kernel_of(pair: tuple[Engine, Controller]) -> Any:
    compiled = compiled_engine(*pair)
    return compiled.kernel, compiled.control[0]


def _control_row(pair: tuple[Engine, Controller], duration: float, settings: Any) -> Row:
    """Row of a run under a controller."""
    run = _compiled(pair[0], pair[1], duration, settings)
    beyond = beyond_ports(run.engine, run.strokes)
    row = run_row(run)
    odd = [f"unusual: {problem}" for problem in unusual(pair[1], "controller")]
    return {
        **row,
        "message": "; ".join([str(row["message"]), *odd]),
        "fired_at": fired_at(run),
        "motor_returns": float(motor_returns(run)),
        "strokes": float(len(run.strokes)),
        "motored_share": motored_share(run),
        "farthest": float(np.abs(run.strokes["x_end"]).max(initial=0.0)),
        "opened_ports": float(beyond.any()),
        "opens_ports": float(beyond[-2:].any()),
    }


def motored_share(run: Run) -> float:
    """Share of the strokes in which the alternator was a motor [-]; NaN without strokes."""
    return float(np.mean(run.strokes["motoring"] > 0.0)) if len(run.strokes) else math.nan


@checked(run=a(Run))
def fired_at(run: Run) -> float:
    """When the motor was first left for fuel and load [s]; NaN if never, or no longer recorded.

    Parameters
    ----------
    run : Run

    Returns
    -------
    float
    """
    off = run.event_rows["t"][run.event_rows["kind"] == layout.EVENT_MOTOR_OFF]
    return float(off[0]) if len(off) else math.nan


@checked(run=a(Run))
def motor_returns(run: Run) -> int:
    """Number of times the motor came back after the engine had been fired.

    Parameters
    ----------
    run : Run

    Returns
    -------
    int
    """
    kinds = run.event_rows["kind"]
    off = np.flatnonzero(kinds == layout.EVENT_MOTOR_OFF)
    return int((kinds[off[0] :] == layout.EVENT_MOTOR_ON).sum()) if len(off) else 0
