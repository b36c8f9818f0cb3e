"""Linear model of a steady state: how small changes at a dead centre go on to the next one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from saleg.engine import Engine
from saleg.errors import SalegError, WrongFields, shown
from saleg.kernel import layout
from saleg.laws.arguments import Signals
from saleg.simulation.course import Replay
from saleg.simulation.initial_state import State
from saleg.simulation.run import read_only
from saleg.simulation.signals import measured
from saleg.steady.entry_names import ENTRY_NAMES
from saleg.steady.linear_inputs import Input, NoLinearModel, difference_of, place_of
from saleg.steady.return_map import NoReturn, ReturnMap, step_tolerance
from saleg.steady.stability import DIFFERENCE, TOLERANCE, split_multipliers

if TYPE_CHECKING:
    import control

#: What a model shows unless asked otherwise.
OUTPUTS = ("dead_centre", "stroke", "compression_ratio", "frequency", "power")
#: Signals that are no measurement of a stroke.
NO_OUTPUT = {
    "t",
    "direction",
    "motoring",
    "was_motoring",
    "maximum_stroke",
    "rated_equivalence_ratio",
    "rated_intake_temperature",
}
SIGNALS = tuple(name for name in Signals._fields if name not in NO_OUTPUT)


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Linear model of a steady state in discrete time, from one dead centre to the next.

    ``x[k+1] = A x[k] + B u[k]``, ``y[k] = C x[k] + D u[k]``, all of them changes against the steady
    state: u[k] is commanded at dead centre k and held until k + 1, y[k] is measured at dead centre
    k, before u[k] is commanded, so that D is zero. A step is half a cycle of a mirrored engine,
    seen in the mirror at every other one, so that ``left`` is always the side just compressed;
    of other engines it is a whole cycle, from one left dead centre to the next.

    The first states are those numbers of the engine at a dead centre that its future depends on,
    scaled as the return map has them [-]; the last are the outputs, in their units, for a
    controller is shown what the stroke before has measured.

    Attributes
    ----------
    A, B, C, D : ndarray
        The matrices, shapes (n, n), (n, m), (p, n), (p, m); read-only.
    states, inputs, outputs : tuple of str
        Names of x, u and y.
    input_values, output_values : ndarray
        Inputs and outputs of the steady state [in their SI units]; read-only. That of the load
        weight is what the regulator sets there.
    conserved : ndarray of complex
        Eigenvalues of A that are no multipliers: one for each number that sealed chambers keep
        for ever; read-only.
    mirrored : bool
        Whether a step is half a cycle.
    step : float
        Duration of a step at the steady state [s].
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    input_values: np.ndarray
    output_values: np.ndarray
    conserved: np.ndarray
    mirrored: bool
    step: float

    def __post_init__(self) -> None:
        """Show the numbers, but let nobody write to them."""
        for name in ("A", "B", "C", "D", "input_values", "output_values", "conserved"):
            object.__setattr__(self, name, read_only(getattr(self, name)))

    @property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """A, B, C and D, as ``control.ss(*model.matrices, dt=True)`` takes them."""
        return self.A, self.B, self.C, self.D

    def response(self, changes: np.ndarray) -> np.ndarray:
        """Outputs that follow from small changes of the inputs.

        Parameters
        ----------
        changes : ndarray, shape (steps, inputs)
            Changes commanded at one dead centre after the other [in the SI units of the inputs].

        Returns
        -------
        ndarray, shape (steps + 1, outputs)
            Changes measured, at the first of these dead centres and the end of each step.
        """
        given = np.asarray(changes, dtype=float).reshape(-1, len(self.inputs))
        x, seen = np.zeros(len(self.states)), []
        for u in given:
            seen.append(self.C @ x + self.D @ u)
            x = self.A @ x + self.B @ u
        return np.array([*seen, self.C @ x])

    def to_control(self) -> control.StateSpace:
        """The model for python-control, with names; its time counts the steps (``dt=True``).

        Returns
        -------
        control.StateSpace

        Raises
        ------
        ImportError
            Without the extra ``control``.
        """
        import control

        names = {"states": self.states, "inputs": self.inputs, "outputs": self.outputs}
        lists = {name: list(values) for name, values in names.items()}
        return control.ss(*self.matrices, dt=True, **lists)

    def __repr__(self) -> str:
        step = "half a cycle" if self.mirrored else "a cycle"
        return (
            f"<{type(self).__name__}: {len(self.states)} states, {len(self.inputs)} inputs, "
            f"{len(self.outputs)} outputs, a step is {step} ({1e3 * self.step:.4g} ms)>"
        )


def linear_model(
    replay: Replay, mirrored: bool, period: float, inputs: Sequence[str], outputs: Sequence[str]
) -> LinearModel:
    """Linear model of a steady state, by central differences of its return map.

    Parameters
    ----------
    replay : Replay
        The cycle of the steady state.
    mirrored : bool
        Whether its second half is the mirror image of its first.
    period : float
        How long it takes [s].
    inputs, outputs : sequence of str
        Their names, see :meth:`saleg.steady.SteadyState.linear`.

    Returns
    -------
    LinearModel

    Raises
    ------
    NoLinearModel
        If an output is not known, an input changes the geometry, or the least change stalls the
        engine or drives it into a head.
    """
    inputs, outputs = tuple(inputs), tuple(outputs)
    engine, start = replay.engine, replay.start
    given = _checked(engine, start, inputs, outputs)
    mirrored = mirrored and all(item.keeps_mirror for item in given)
    image = _Image(start, mirrored, outputs)
    try:
        rest = image.of(engine, start)
        entries, columns = image.by_state(engine)
        moved = [_derivative(image, item) for item in given]
    except NoReturn:
        raise NoLinearModel("no return: the least change stalls it or ends in a head") from None
    jacobian = np.zeros((layout.N_VECTOR, layout.N_VECTOR))
    jacobian[:, entries] = columns[: layout.N_VECTOR]
    matters = entries[jacobian[:, entries].any(axis=0)]
    rows = [*matters, *range(layout.N_VECTOR, layout.N_VECTOR + len(outputs))]
    by_state = np.zeros((len(rows), len(rows)))
    by_state[:, : len(matters)] = columns[np.ix_(rows, np.isin(entries, matters))]
    shows = np.zeros((len(outputs), len(rows)))
    shows[:, len(matters) :] = np.eye(len(outputs))
    return LinearModel(
        A=by_state,
        B=np.array(moved).reshape(len(inputs), -1).T[rows] if inputs else np.zeros((len(rows), 0)),
        C=shows,
        D=np.zeros((len(outputs), len(inputs))),
        states=(*(ENTRY_NAMES[n] for n in matters), *(f"measured.{name}" for name in outputs)),
        inputs=inputs,
        outputs=outputs,
        input_values=np.array([item.value for item in given]),
        output_values=rest[layout.N_VECTOR :],
        conserved=split_multipliers(engine, jacobian)[1],
        mirrored=mirrored,
        step=0.5 * period if mirrored else period,
    )


@dataclass(frozen=True)
class _Image:
    """Where states go in one step: vector and outputs at its end, as one array."""

    start: State
    mirrored: bool
    outputs: tuple[str, ...]

    def of(self, engine: Engine, start: State, z: np.ndarray | None = None) -> np.ndarray:
        """Image of a state, or of another vector with the rest as in it."""
        return self._image(self._map(engine, start), start, z)

    def by_state(self, engine: Engine) -> tuple[np.ndarray, np.ndarray]:
        """Entries of the vector that can make a difference, and the derivative by them."""
        return_map = self._map(engine, self.start)
        z = return_map.vector(self.start)
        entries = return_map.moved_entries(self.start)
        columns = []
        for change in DIFFERENCE * np.eye(len(z))[entries]:
            ahead = self._image(return_map, self.start, z + change)
            behind = self._image(return_map, self.start, z - change)
            columns.append((ahead - behind) / (2.0 * DIFFERENCE))
        return entries, np.array(columns).T

    def _map(self, engine: Engine, start: State) -> ReturnMap:
        """Return map at the tolerance of multipliers."""
        steps = step_tolerance(engine, TOLERANCE)
        return ReturnMap.of(engine, start.copy(), steps, self.mirrored)

    def _image(self, return_map: ReturnMap, start: State, z: np.ndarray | None) -> np.ndarray:
        vector = return_map.image(start, return_map.vector(start) if z is None else z)
        signals = measured(return_map.state)
        shown = [output_of(signals, name) for name in self.outputs]
        return np.concatenate([vector, shown])


def _derivative(image: _Image, given: Input) -> np.ndarray:
    """Derivative of the image by an input."""
    by = difference_of(given.value)
    ahead, behind = (image.of(*given.changed(given.value + sign * by)) for sign in (1.0, -1.0))
    return (ahead - behind) / (2.0 * by)


def _checked(
    engine: Engine, start: State, inputs: Sequence[str], outputs: Sequence[str]
) -> list[Input]:
    """The inputs, if they and all outputs can be had; else one error names those that cannot.

    Two names of one number are one input: twins would share its effect.
    """
    found: dict[object, Input] = {}
    wrong: list[SalegError] = []
    for name in inputs:
        try:
            given = Input.of(engine, start, name)
            place = place_of(engine, name)
            if place in found:
                raise NoLinearModel(f"input '{name}': is named twice")
            found[place] = given
        except SalegError as error:
            wrong.append(error)
    known = ("dead_centre", *SIGNALS)
    for n, name in enumerate(outputs):
        if name not in known:
            text = f"output {shown(name)}: must be one of {', '.join(known)}"
            wrong.append(NoLinearModel(text))
        elif name in outputs[:n]:
            wrong.append(NoLinearModel(f"output '{name}': is named twice"))
    if len({type(error) for error in wrong}) == 1 and not isinstance(wrong[0], WrongFields):
        raise type(wrong[0])("\n".join(map(str, wrong)))
    if wrong:
        raise wrong[0] if len(wrong) == 1 else NoLinearModel("\n".join(map(str, wrong)))
    return list(found.values())


def output_of(signals: Signals, name: str) -> float:
    """An output as it is measured at a dead centre."""
    return float(
        -signals.direction * signals.x if name == "dead_centre" else getattr(signals, name)
    )
