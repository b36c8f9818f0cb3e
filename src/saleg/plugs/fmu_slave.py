"""What runs inside a functional mock-up unit, called by the library of pythonfmu."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pythonfmu import (
    Boolean,
    Fmi2Causality,
    Fmi2Initial,
    Fmi2Slave,
    Fmi2Variability,
    Real,
)
from pythonfmu.enums import Fmi2Status

from saleg.control.outcome import controlled_outcome
from saleg.control.plant import course_of, give
from saleg.control.running import generator
from saleg.engine import Engine
from saleg.engine.controller import Controller
from saleg.engine.paths import get, unit_of
from saleg.errors import SalegError
from saleg.kernel import layout
from saleg.plugs.fmu import ENGINE_FILE, SETTINGS_FILE
from saleg.simulation.course import Course
from saleg.simulation.initial_state import prepare
from saleg.simulation.signals import measured

#: Outputs at an instant: name, unit, column of the history and side of it, if it has two.
INSTANT = (
    ("x", "m", "x", None),
    ("v", "m/s", "v", None),
    ("a", "m/s^2", "a", None),
    ("p_left", "Pa", "p", 0),
    ("p_right", "Pa", "p", 1),
    ("T_left", "K", "T", 0),
    ("T_right", "K", "T", 1),
    ("alternator_force", "N", "alternator_force", None),
    ("electrical_power", "W", "electrical_power", None),
    ("current", "A", "current", None),
    ("actual_load_weight", "-", "load_weight", None),
)
#: Outputs of the latest stroke: signals and their units.
STROKE = (
    ("stroke", "m"),
    ("compression_ratio", "-"),
    ("frequency", "Hz"),
    ("power", "W"),
    ("x_left", "m"),
    ("x_right", "m"),
)
#: Settings as of a simulation left to itself, of which only the present is kept.
USUAL: dict[str, Any] = {"stall_stroke": 0.01}
KEPT: dict[str, Any] = {"history": 1, "keep_cycles": 11}
#: Time at which a run would end were it not for its host [s].
NEVER = 1e9

#: Names of the modules of units, see :func:`hold`.
_held: list[dict[str, Any]] = []


def hold(*_: object) -> None:
    """Keep the names of a unit's module, which calls this, alive; earlier units hand them over.

    For each instance the library of pythonfmu 0.7 runs the module and gives up one reference too
    many to its names: without one more they are gone before the second instance.
    """
    _held.append(sys._getframe(1).f_globals)


class EngineSlave(Fmi2Slave):  # type: ignore[misc]
    """An engine in co-simulation.

    Parameters
    ----------
    **given
        What pythonfmu hands over: a name, and the folder of the resources.
    """

    author = "saleg"
    description = "Free-piston linear engine generator"

    def __init__(self, **given: Any):
        super().__init__(**given)
        folder = Path(self.resources)
        kept = json.loads((folder / SETTINGS_FILE).read_text(encoding="utf-8"))
        self._given = Engine.from_toml(folder / ENGINE_FILE)
        self._settings = {**USUAL, **kept["settings"], **KEPT}
        self._changes: dict[str, float] = {}
        self._inputs: dict[str, float] = {}
        self._obeyed: dict[str, float] = {}
        self._regulated = True
        self._begun: Course | None = None
        self._runs = False
        self._start_time = 0.0
        for path in kept["parameters"]:
            self._add_parameter(path)
        for name, value in generator(measured(prepare(self._given)))._asdict().items():
            self._add_input(name, float(value))
        self._add_regulated()
        for name, unit, column, side in INSTANT:
            self._add_output(name, unit, self._at_instant(column, side))
        for name, unit in STROKE:
            self._add_output(f"signal.{name}", unit, self._of_stroke(name))

    def setup_experiment(
        self, start_time: float, stop_time: float | None, tolerance: float | None
    ) -> None:
        """Take over the time the host begins at; the tolerance is the unit's own."""
        self._start_time = start_time

    def exit_initialization_mode(self) -> None:
        """Begin with the parameters as they are now, if they make an engine."""
        self._told(lambda: self._course)
        self._runs = True

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Go on by a step of the host; false once the motion has ended."""
        self._told(self._obey)
        code = self._advance(current_time + step_size - self._start_time)
        if code == layout.END_OF_TIME:
            return True
        self.log(controlled_outcome(self._course, code)[1], Fmi2Status.discard)
        return False

    def _told(self, action: Callable[[], Any]) -> None:
        """Do something, and tell the host what is wrong if it fails."""
        try:
            action()
        except SalegError as error:
            self.log(str(error), Fmi2Status.error)
            raise

    @property
    def _course(self) -> Course:
        """The run, begun with the parameters as they are."""
        if self._begun is None:
            engine = self._given.replace(**self._changes) if self._changes else self._given
            given = (Controller(), NEVER, layout.UNCONTROLLED, self._settings)
            self._begun = course_of(engine, *given)
            self._advance(0.0)  # records what stands at the start
        return self._begun

    def _advance(self, until: float) -> int:
        """Integrate up to a time; returns why the integrator came back."""
        course = self._course
        course.options["t_end"] = until
        code = layout.BUFFER_FULL
        while code == layout.BUFFER_FULL:
            course.records.filled["history"] = 0
            code = course.advance()
        return code

    def _obey(self) -> None:
        """Pass inputs that have changed to the engine."""
        course, wanted = self._course, dict(self._inputs)
        course.state.engine["controlled"] = layout.IN_PYTHON
        if self._regulated:
            course.state.engine["controlled"] = layout.UNCONTROLLED
            wanted.pop("load_weight", None)
        if wanted != self._obeyed:
            commands = generator(measured(course.state))._replace(**wanted)
            give(course, commands, first=not self._obeyed)
            self._obeyed = wanted

    def _add_parameter(self, path: str) -> None:
        """Offer a number of the engine."""

        def set_number(value: float) -> None:
            self._changes[path], self._begun = value, None

        self.register_variable(
            Real(
                path,
                causality=Fmi2Causality.parameter,
                variability=Fmi2Variability.fixed,
                initial=Fmi2Initial.exact,
                description=f"[{unit_of(self._given, path)}]",
                getter=lambda: self._changes.get(path, float(get(self._given, path))),
                setter=set_number,
            ),
            nested=False,
        )

    def _add_input(self, name: str, start: float) -> None:
        """Offer a command."""
        self.register_variable(
            Real(
                f"command.{name}",
                causality=Fmi2Causality.input,
                variability=Fmi2Variability.discrete,
                description=f"Command of saleg.laws.Commands, {name}",
                getter=lambda: self._inputs.get(name, start),
                setter=lambda value: self._inputs.__setitem__(name, value),
            ),
            nested=False,
        )

    def _add_regulated(self) -> None:
        """Offer who sets the load weight."""
        self.register_variable(
            Boolean(
                "command.regulated",
                causality=Fmi2Causality.input,
                variability=Fmi2Variability.discrete,
                description="Whether the alternator's own regulator sets the load weight",
                getter=lambda: self._regulated,
                setter=lambda value: setattr(self, "_regulated", bool(value)),
            ),
            nested=False,
        )

    def _add_output(self, name: str, unit: str, getter: Callable[[], float]) -> None:
        """Offer an output."""
        self.register_variable(
            Real(
                name,
                causality=Fmi2Causality.output,
                variability=Fmi2Variability.continuous,
                description=f"[{unit}]",
                getter=getter,
            ),
            nested=False,
        )

    def _at_instant(self, column: str, side: int | None) -> Callable[[], float]:
        """Reader of a column of the latest instant."""

        def read() -> float:
            records = self._course.records
            row = records.history[int(records.filled[0]["history"]) - 1]
            return float(row[column] if side is None else row[column][side])

        return read

    def _of_stroke(self, name: str) -> Callable[[], float]:
        """Reader of a signal."""
        return lambda: float(getattr(measured(self._course.state), name))
