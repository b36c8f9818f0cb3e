"""Dead-centre control: state feedback on the linear model of a steady state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from saleg.checks import POSITIVE, a, checked
from saleg.control.running import generator
from saleg.laws.arguments import Commands, Signals
from saleg.steady.linear import LinearModel, output_of
from saleg.steady.solver import SteadyState

#: What is measured, and the standard deviation of its error: position [m] and frequency [Hz].
NOISE: Mapping[str, float] = MappingProxyType({"dead_centre": 1e-5, "frequency": 0.01})


@dataclass(frozen=True, eq=False)
class Gains:
    """Gains of a state feedback, its observer and the model both go by.

    The load that the engine seems to bear beside the one commanded, d, is a state of its own: it
    stays as it is, ``d[k+1] = d[k]``, and the feedback takes it away again (disturbance observer,
    which is the integral part).

    Attributes
    ----------
    A, B, C : ndarray
        Model of the observer, d as its last state, with the load weight itself as input.
    feedback : ndarray, shape (n,)
        ``u = -feedback x``.
    observer : ndarray, shape (n, p)
        What a deviation of the measurements adds to the estimate.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    feedback: np.ndarray
    observer: np.ndarray


def gains_of(
    model: LinearModel, noise: Mapping[str, float], tolerance: float, scatter: float, drift: float
) -> Gains:
    """Gains by two Riccati equations: linear-quadratic regulator and Kalman filter.

    Parameters
    ----------
    model : LinearModel
        With ``load_weight`` and ``equivalence_ratio`` as inputs and ``dead_centre`` among its
        outputs.
    noise : mapping of str to float
        Outputs that are measured, with the standard deviation of their errors [in their units].
    tolerance : float
        Deviation of the dead centre that costs as much as a load weight of one [m].
    scatter : float
        Standard deviation of the equivalence ratio of a charge [-].
    drift : float
        Change of the unknown load from one dead centre to the next [-].

    Returns
    -------
    Gains
    """
    from scipy.linalg import solve_discrete_are

    A = model.A.copy()
    n = len(A)
    # The controller sets the load weight itself: what the regulator asks for acts on nothing.
    A[:, model.states.index("load_weight")] = 0.0
    B = model.B[:, [model.inputs.index("load_weight")]]
    fuel = model.B[:, [model.inputs.index("equivalence_ratio")]] * scatter
    goal = model.C[[model.outputs.index("dead_centre")]] / tolerance
    shown = model.C[[model.outputs.index(name) for name in noise]]
    cost = solve_discrete_are(A, B, goal.T @ goal, np.eye(1))
    feedback = np.linalg.solve(np.eye(1) + B.T @ cost @ B, B.T @ cost @ A)
    with_load = np.block([[A, B], [np.zeros((1, n)), np.eye(1)]])
    by_load = np.vstack([B, np.zeros((1, 1))])
    seen = np.hstack([shown, np.zeros((len(shown), 1))])
    disturbed = np.zeros((n + 1, n + 1))
    disturbed[:n, :n] = fuel @ fuel.T
    disturbed[n, n] = drift**2
    errors = np.diag(np.square(list(noise.values())))
    spread = solve_discrete_are(with_load.T, seen.T, disturbed, errors)
    observer = np.linalg.solve(seen @ spread @ seen.T + errors, seen @ spread).T
    return Gains(with_load, by_load[:, 0], seen, np.append(feedback[0], 1.0), observer)


class DeadCentreControl:
    """Dead centre held by the load: feed-forward, state feedback and disturbance observer.

    The load weight of the steady state is the feed-forward. What is measured at a dead centre
    corrects an estimate of the state of its linear model (Kalman filter); the load weight is then
    that of a linear-quadratic regulator on the dead centre, less the load the engine seems to bear
    beside it. The regulator of the alternator is left out. Of an engine with unlike sides the left
    dead centre is held and the load stays as it is at right ones.

    Parameters
    ----------
    steady : SteadyState
        The steady state to hold.
    noise : mapping of str to float
        Outputs of :meth:`saleg.steady.SteadyState.linear` that are measured, with the standard
        deviation of their errors [in their units].
    tolerance : float
        Deviation of the dead centre that costs as much as a load weight of one [m].
    scatter : float
        Standard deviation of the equivalence ratio to expect [-].
    drift : float
        Change of the unknown load to expect from one dead centre to the next [-].
    maximum_weight : float
        Largest load weight [-].

    Raises
    ------
    NoSteadyState, NoLinearModel
        If there is nothing to hold.

    Examples
    --------
    >>> import saleg
    >>> from saleg import control
    >>> engine = saleg.machines.thesis_transient()
    >>> holding = control.DeadCentreControl(saleg.steady_state(engine))
    >>> run = control.simulate(engine, holding, 1.0)
    >>> round(run.performance.compression_ratio, 2)
    17.87
    """

    @checked(
        steady=a(SteadyState),
        tolerance=POSITIVE,
        scatter=POSITIVE,
        drift=POSITIVE,
        maximum_weight=POSITIVE,
    )
    def __init__(
        self,
        steady: SteadyState,
        *,
        noise: Mapping[str, float] = NOISE,
        tolerance: float = 1e-3,
        scatter: float = 0.05,
        drift: float = 0.003,
        maximum_weight: float = 2.0,
    ):
        outputs = tuple(dict.fromkeys(("dead_centre", *noise)))
        self.model = steady.linear(("load_weight", "equivalence_ratio"), outputs)
        self.gains = gains_of(self.model, noise, tolerance, scatter, drift)
        self.maximum_weight = maximum_weight
        self._measured = tuple(noise)
        shown = dict(zip(outputs, self.model.output_values, strict=True))
        self._rest = np.array([shown[name] for name in noise])
        self._rest_weight = float(self.model.input_values[0])
        self._estimate = np.zeros(len(self.gains.A))
        self._surprise = np.zeros(len(noise))
        self._latest: Commands | None = None

    @property
    def surprise(self) -> dict[str, float]:
        """Measurements of the latest dead centre less what the model expected, by name."""
        return dict(zip(self._measured, self._surprise.tolist(), strict=True))

    def act(self, signals: Signals) -> Commands:
        """Commands at a dead centre.

        Parameters
        ----------
        signals : Signals

        Returns
        -------
        Commands
            A load weight, rated fuel and rated intake.
        """
        if self._latest is not None and not self.model.mirrored and signals.direction < 0.0:
            return self._latest
        gains = self.gains
        if signals.frequency > 0.0:  # there has been a stroke to measure
            self._surprise = self._deviations(signals) - gains.C @ self._estimate
            self._estimate = self._estimate + gains.observer @ self._surprise
        wanted = self._rest_weight - float(gains.feedback @ self._estimate)
        weight = min(max(wanted, 0.0), self.maximum_weight)
        self._estimate = gains.A @ self._estimate + gains.B * (weight - self._rest_weight)
        self._latest = generator(signals, load_weight=weight)
        return self._latest

    def _deviations(self, signals: Signals) -> np.ndarray:
        """Measurements less those of the steady state."""
        return measurements(signals, self._measured) - self._rest


def measurements(signals: Signals, names: tuple[str, ...]) -> np.ndarray:
    """Outputs of a linear model as they are measured at a dead centre [in their units]."""
    return np.array([output_of(signals, name) for name in names])
