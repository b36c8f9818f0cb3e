"""Feedback of the load on the dead centre: an observer and a regulator on a linear model."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from saleg.errors import InvalidController
from saleg.laws.arguments import Signals
from saleg.laws.usual import LENGTH
from saleg.quantities import Quantities, problems, quantity
from saleg.steady.linear import LinearModel, output_of

#: Failed charges in a row from which on the model does not hold.
PATIENCE = 8
#: Inputs of the models: what is commanded, and what scatters.
INPUTS = ("load_weight", "equivalence_ratio")


@dataclass(frozen=True, kw_only=True)
class Feedback(Quantities):
    """What a state feedback on the dead centre expects and may do.

    Parameters
    ----------
    position_noise : float
        Standard deviation of the error of a measured dead centre [m].
    frequency_noise : float
        Standard deviation of the error of the frequency of a stroke [Hz].
    scatter : float
        Standard deviation of the equivalence ratio of a charge [-].
    drift : float
        Change of the unknown load from one dead centre to the next [-].
    tolerance : float
        Deviation of the dead centre that costs as much as a load weight of one [m].
    maximum_weight : float
        Largest load weight [-].
    strange : float
        Deviation of the measurements, over that to be expected, from which on a charge has failed
        to light [-].

    Raises
    ------
    InvalidController
        Naming every wrong field.
    """

    position_noise: float = quantity("m", default=1e-5, low=0, open_low=True, usual=LENGTH)
    frequency_noise: float = quantity("Hz", default=0.01, low=0, open_low=True)
    scatter: float = quantity("-", default=0.05, low=0)
    drift: float = quantity("-", default=0.003, low=0, open_low=True)
    tolerance: float = quantity("m", default=1e-3, low=0, open_low=True, usual=LENGTH)
    maximum_weight: float = quantity("-", default=2.0, low=0)
    strange: float = quantity("-", default=5.0, low=0, open_low=True)

    def __post_init__(self) -> None:
        """Check every field."""
        super().__post_init__()
        found = problems(self, "feedback")
        if found:
            raise InvalidController(found)

    @property
    def noise(self) -> dict[str, float]:
        """Outputs that are measured, with the standard deviation of their errors."""
        return {"dead_centre": self.position_noise, "frequency": self.frequency_noise}


@dataclass(eq=False)
class LoadFeedback:
    """Load weight by the estimated state of a linear model.

    What is measured at a dead centre corrects the estimate (Kalman filter); the load weight is
    that of a linear-quadratic regulator on the dead centre. The load d that the engine seems to
    bear beside the one commanded is the last state: it stays as it is, ``d[k+1] = d[k]``, and the
    feedback takes it away again (disturbance observer, which is the integral part). Nothing is
    learnt of it from a dead centre so strange that a charge must have failed.

    Attributes
    ----------
    A, B, C : ndarray
        Model of the observer, with the load weight itself as input.
    goal : ndarray, shape (n,)
        Row of C that is the dead centre.
    feedback : ndarray, shape (n,)
        ``u = -feedback x``.
    observer : ndarray, shape (n, p)
        What a deviation of the measurements adds to the estimate.
    expected : ndarray, shape (p, p)
        Covariance of what the measurements deviate by from what is expected of them.
    shifts : ndarray, shape (n, 2)
        By how much the state at rest changes with load weight and equivalence ratio.
    settings : Feedback
    regains : bool
        Whether the unknown load is learnt all the same where the model is lost.
    estimate : ndarray, shape (n,)
        State less that at rest, estimated for the dead centre that comes, or is at hand.
    strangeness : float
        Deviation of the latest measurements over what is to be expected [-].
    failed_in_a_row : int
        Dead centres in a row at which a charge seems to have failed; many at first.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    goal: np.ndarray
    feedback: np.ndarray
    observer: np.ndarray
    expected: np.ndarray
    shifts: np.ndarray
    settings: Feedback
    regains: bool = True
    estimate: np.ndarray = field(init=False)
    strangeness: float = 0.0
    failed_in_a_row: int = PATIENCE

    def __post_init__(self) -> None:
        """Begin at rest."""
        self.estimate = np.zeros(len(self.A))

    @classmethod
    def of(cls, model: LinearModel, settings: Feedback, regains: bool = True) -> LoadFeedback:
        """Feedback for a model by two Riccati equations.

        Parameters
        ----------
        model : LinearModel
            With ``load_weight`` and ``equivalence_ratio`` as inputs, and with ``dead_centre`` and
            ``frequency`` among its outputs.
        settings : Feedback
        regains : bool
        """
        from scipy.linalg import solve_discrete_are

        # The controller sets the load weight itself: what the regulator asks for acts on nothing.
        A = np.where(np.array(model.states) == "load_weight", 0.0, model.A)
        n = len(A)
        by_inputs = model.B[:, [model.inputs.index(name) for name in INPUTS]]
        load, fuel = by_inputs[:, :1], by_inputs[:, 1:] * settings.scatter
        goal = model.C[[model.outputs.index("dead_centre")]]
        weighted = goal / settings.tolerance
        cost = solve_discrete_are(A, load, weighted.T @ weighted, np.eye(1))
        feedback = np.linalg.solve(np.eye(1) + load.T @ cost @ load, load.T @ cost @ A)
        with_load = np.block([[A, load], [np.zeros((1, n)), np.eye(1)]])
        shown = np.zeros((len(settings.noise), n + 1))
        shown[:, :n] = model.C[[model.outputs.index(name) for name in settings.noise]]
        disturbed = np.zeros((n + 1, n + 1))
        disturbed[:n, :n] = fuel @ fuel.T
        disturbed[n, n] = settings.drift**2
        errors = np.diag(np.square(list(settings.noise.values())))
        spread = solve_discrete_are(with_load.T, shown.T, disturbed, errors)
        expected = shown @ spread @ shown.T + errors
        return cls(
            A=with_load,
            B=np.append(load, 0.0),
            C=shown,
            goal=np.append(goal, 0.0),
            feedback=np.append(feedback, 1.0),
            observer=np.linalg.solve(expected, shown @ spread).T,
            expected=expected,
            shifts=np.vstack([np.linalg.solve(np.eye(n) - A, by_inputs), np.zeros((1, 2))]),
            settings=settings,
            regains=regains,
        )

    @property
    def failed(self) -> bool:
        """Whether the latest dead centre is one of a charge that has failed."""
        return self.strangeness > self.settings.strange

    @property
    def lost(self) -> bool:
        """Whether so many have failed in a row that the model does not hold, as at the start."""
        return self.failed_in_a_row >= PATIENCE

    def observe(self, signals: Signals, at_rest: np.ndarray) -> None:
        """Correct the estimate by what is measured at a dead centre.

        Parameters
        ----------
        signals : Signals
        at_rest : ndarray, shape (p,)
            What would be measured at rest [in its units].
        """
        if signals.frequency <= 0.0:  # no stroke yet to measure
            return
        shown = np.array([output_of(signals, name) for name in self.settings.noise])
        surprise = shown - at_rest - self.C @ self.estimate
        self.strangeness = float(np.sqrt(surprise @ np.linalg.solve(self.expected, surprise)))
        self.failed_in_a_row = self.failed_in_a_row + 1 if self.failed else 0
        correction = self.observer @ surprise
        if self.failed and not (self.regains and self.lost):
            correction[-1] = 0.0
        self.estimate = self.estimate + correction

    def weight(self, rest: float) -> float:
        """Load weight that brings the dead centre back, by the estimate; `rest` is that at rest."""
        wanted = rest - float(self.feedback @ self.estimate)
        return min(max(wanted, 0.0), self.settings.maximum_weight)

    def greatest_weight(self, rest: float, least: float) -> float:
        """Load weight with which the next dead centre is at a least one, over that at rest [m]."""
        unloaded = float(self.goal @ self.A @ self.estimate)
        return max(rest + (least - unloaded) / float(self.goal @ self.B), 0.0)

    def go_on(self, change: float) -> None:
        """Expect the next dead centre, with a load weight so much beside that at rest [-]."""
        self.estimate = self.A @ self.estimate + self.B * change

    def shift(self, weight: float, equivalence_ratio: float) -> None:
        """Go over to a rest of another load weight and equivalence ratio, by so much [-]."""
        self.estimate = self.estimate - self.shifts @ np.array([weight, equivalence_ratio])
