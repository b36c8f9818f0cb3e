"""Dead-centre control: state feedback on the linear model of a steady state."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from saleg.checks import NUMBER, POSITIVE, a, checked
from saleg.control.demand import Demand
from saleg.control.operating_line import OperatingLine
from saleg.control.running import generator
from saleg.errors import InvalidController
from saleg.laws.arguments import Commands, Signals
from saleg.laws.usual import LENGTH
from saleg.quantities import Quantities, problems, quantity
from saleg.steady.linear import LinearModel, output_of
from saleg.steady.solver import SteadyState

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
    feedback takes it away again (disturbance observer, which is the integral part).

    Attributes
    ----------
    A, B, C : ndarray
        Model of the observer, with the load weight itself as input.
    feedback : ndarray, shape (n,)
        ``u = -feedback x``.
    observer : ndarray, shape (n, p)
        What a deviation of the measurements adds to the estimate.
    shifts : ndarray, shape (n, 2)
        By how much the state at rest changes with load weight and equivalence ratio.
    maximum_weight : float
        Largest load weight [-].
    measured : tuple of str
        Outputs that are measured.
    estimate : ndarray, shape (n,)
        State estimated for the next dead centre, less that at rest.
    surprise : ndarray, shape (p,)
        What has been measured at the latest dead centre less what was expected.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    feedback: np.ndarray
    observer: np.ndarray
    shifts: np.ndarray
    maximum_weight: float
    measured: tuple[str, ...]
    estimate: np.ndarray = field(init=False)
    surprise: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        """Begin at rest."""
        self.estimate, self.surprise = np.zeros(len(self.A)), np.zeros(len(self.C))

    @classmethod
    def of(cls, model: LinearModel, settings: Feedback) -> LoadFeedback:
        """Feedback for a model by two Riccati equations.

        Parameters
        ----------
        model : LinearModel
            With ``load_weight`` and ``equivalence_ratio`` as inputs, and with ``dead_centre`` and
            ``frequency`` among its outputs.
        settings : Feedback
        """
        from scipy.linalg import solve_discrete_are

        noise = settings.noise
        # The controller sets the load weight itself: what the regulator asks for acts on nothing.
        A = np.where(np.array(model.states) == "load_weight", 0.0, model.A)
        n = len(A)
        by_inputs = model.B[:, [model.inputs.index(name) for name in INPUTS]]
        load, fuel = by_inputs[:, :1], by_inputs[:, 1:] * settings.scatter
        goal = model.C[[model.outputs.index("dead_centre")]] / settings.tolerance
        cost = solve_discrete_are(A, load, goal.T @ goal, np.eye(1))
        feedback = np.linalg.solve(np.eye(1) + load.T @ cost @ load, load.T @ cost @ A)
        with_load = np.block([[A, load], [np.zeros((1, n)), np.eye(1)]])
        shown = np.zeros((len(noise), n + 1))
        shown[:, :n] = model.C[[model.outputs.index(name) for name in noise]]
        disturbed = np.zeros((n + 1, n + 1))
        disturbed[:n, :n] = fuel @ fuel.T
        disturbed[n, n] = settings.drift**2
        errors = np.diag(np.square(list(noise.values())))
        spread = solve_discrete_are(with_load.T, shown.T, disturbed, errors)
        return cls(
            A=with_load,
            B=np.append(load, 0.0),
            C=shown,
            feedback=np.append(feedback, 1.0),
            observer=np.linalg.solve(shown @ spread @ shown.T + errors, shown @ spread).T,
            shifts=np.vstack([np.linalg.solve(np.eye(n) - A, by_inputs), np.zeros((1, 2))]),
            maximum_weight=settings.maximum_weight,
            measured=tuple(noise),
        )

    def weight(self, signals: Signals, shown_at_rest: np.ndarray, rest_weight: float) -> float:
        """Load weight until the next dead centre [-].

        Parameters
        ----------
        signals : Signals
        shown_at_rest : ndarray, shape (p,)
            What would be measured at rest [in its units].
        rest_weight : float
            Load weight at rest [-].
        """
        if signals.frequency > 0.0:  # there has been a stroke to measure
            shown = np.array([output_of(signals, name) for name in self.measured])
            self.surprise = shown - shown_at_rest - self.C @ self.estimate
            self.estimate = self.estimate + self.observer @ self.surprise
        wanted = rest_weight - float(self.feedback @ self.estimate)
        weight = min(max(wanted, 0.0), self.maximum_weight)
        self.estimate = self.A @ self.estimate + self.B * (weight - rest_weight)
        return weight

    def shift(self, weight: float, equivalence_ratio: float) -> None:
        """Go over to a rest of another load weight and equivalence ratio, by so much [-]."""
        self.estimate = self.estimate - self.shifts @ np.array([weight, equivalence_ratio])


class DeadCentreControl:
    """Dead centre held by the load: feed-forward, state feedback and disturbance observer.

    The load weight of the steady state is the feed-forward, see :class:`Feedback` for the rest.
    The regulator of the alternator is left out. Of an engine with unlike sides the left dead
    centre is held, and the load stays as it is at right ones.

    Parameters
    ----------
    steady : SteadyState
        The steady state to hold.
    feedback : Feedback, optional

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

    @checked(steady=a(SteadyState), feedback=a(Feedback).optional)
    def __init__(self, steady: SteadyState, feedback: Feedback | None = None):
        settings = feedback or Feedback()
        self.model = steady.linear(INPUTS, tuple(settings.noise))
        self.loop = LoadFeedback.of(self.model, settings)
        self._latest: Commands | None = None

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
        if self._latest is None or self.model.mirrored or signals.direction > 0.0:
            rest = float(self.model.input_values[0])
            weight = self.loop.weight(signals, self.model.output_values, rest)
            self._latest = generator(signals, load_weight=weight)
        return self._latest


class PowerAtDeadCentre:
    """Power by load and fuel at one dead centre: feed-forward by the return map, and feedback.

    Load weight and equivalence ratio are those of the steady state of the power demanded, which
    has the same dead centres as all others on its line. A feedback as that of
    :class:`DeadCentreControl` holds them on the way, along which the power goes at a limited pace:
    the charges already in the cylinders are those of the power before. What power is missing is
    integrated and added.

    Parameters
    ----------
    line : OperatingLine
        Of an engine whose sides are alike.
    demand : Demand
        Power over time; beyond the ends of the line it is that at its ends.
    feedback : Feedback, optional
    gain : float
        Gain on the integral of the power missing [1/s].
    pace : float
        Greatest change of the power in a second, over the greatest power of the line [1/s].

    Examples
    --------
    >>> import saleg
    >>> from saleg import control
    >>> engine = saleg.machines.thesis_transient()
    >>> line = control.operating_line(engine, [1900.0, 2900.0, 3900.0])
    >>> controller = control.PowerAtDeadCentre(line, control.Demand.step(1.0, 3900.0, 1900.0))
    >>> run = control.simulate(engine, controller, 2.0)
    >>> round(1e-3 * run.performance.power, 1), round(run.performance.compression_ratio, 1)
    (1.9, 17.9)
    """

    @checked(
        line=a(OperatingLine),
        demand=a(Demand),
        feedback=a(Feedback).optional,
        gain=NUMBER,
        pace=POSITIVE,
    )
    def __init__(
        self,
        line: OperatingLine,
        demand: Demand,
        feedback: Feedback | None = None,
        gain: float = 2.0,
        pace: float = 5.0,
    ):
        settings = feedback or Feedback()
        self.line, self.demand, self.gain = line, demand, gain
        model = line.models[len(line.models) // 2]
        self.loop = LoadFeedback.of(model, settings)
        at = [model.outputs.index(name) for name in settings.noise]
        self._shown = np.array([model.output_values[at] for model in line.models])
        self._pace = pace * float(line.powers[-1])
        self._power = self._demanded(0.0)
        self._missing, self._time = 0.0, 0.0
        self._rest: tuple[float, float] | None = None

    def act(self, signals: Signals) -> Commands:
        """Commands at a dead centre.

        Parameters
        ----------
        signals : Signals

        Returns
        -------
        Commands
            Load weight and equivalence ratio, and rated intake.
        """
        line = self.line
        power = self._go_on(signals)
        weight, fuel = (
            float(np.interp(power, line.powers, values))
            for values in (line.load_weights, line.equivalence_ratios)
        )
        if self._rest is not None:
            self.loop.shift(weight - self._rest[0], fuel - self._rest[1])
        self._rest = weight, fuel
        shown = np.array([np.interp(power, line.powers, values) for values in self._shown.T])
        load = self.loop.weight(signals, shown, weight)
        return generator(signals, load_weight=load, equivalence_ratio=fuel)

    def _demanded(self, t: float) -> float:
        """Power demanded at a time [W]."""
        return float(np.interp(t, self.demand.times, self.demand.powers))

    def _go_on(self, signals: Signals) -> float:
        """Power to command now [W]: that demanded, at the pace, and what has been missing."""
        elapsed, self._time = signals.t - self._time, signals.t
        longest, most = self._pace * elapsed, 0.1 * float(self.line.powers[-1])
        change = self._demanded(signals.t) - self._power
        self._power += min(max(change, -longest), longest)
        gathered = self._missing + self.gain * (self._power - signals.power) * elapsed
        self._missing = min(max(gathered, -most), most)
        return self._power + self._missing
