"""Dead-centre control: state feedback on the linear model of a steady state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from saleg.checks import NUMBER, POSITIVE, a, checked
from saleg.control.demand import Demand
from saleg.control.load_feedback import INPUTS, Feedback, LoadFeedback
from saleg.control.operating_line import OperatingLine
from saleg.control.running import generator
from saleg.laws.arguments import Commands, Signals
from saleg.steady.state import SteadyState

if TYPE_CHECKING:
    from saleg.control.running import Acts


class DeadCentreControl:
    """Dead centre held by the load: feed-forward, state feedback and disturbance observer.

    The load weight of the steady state is the feed-forward, see :class:`Feedback` for the rest.
    The regulator of the alternator is left out, but for the way to the steady state and wherever
    the model has not held for some strokes. Of an engine with unlike sides the left dead
    centre is held, and the load stays as it is at right ones.

    Parameters
    ----------
    steady : SteadyState
        The steady state to hold.
    feedback : Feedback, optional

    Attributes
    ----------
    failures : list of float
        When a charge was found to have failed [s].

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
        self.failures: list[float] = []
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
            self.loop.observe(signals, self.model.output_values)
            if self.loop.failed and not self.loop.lost:
                self.failures.append(signals.t)
            weight = signals.regulated_weight if self.loop.lost else self.loop.weight(rest)
            self.loop.go_on(weight - rest)
            self._latest = generator(signals, load_weight=weight)
        return self._latest


class MisfireGuard:
    """Load of another controller, lowered where the next charge would miss its dead centre.

    The linear model of a steady state says at every dead centre where the engine will turn next;
    a load weight with which it would turn too early to light the charge is lowered. Fuel, intake
    and motor stay as the other controller has them.

    Parameters
    ----------
    controller : object with a method ``act(signals)``
        What commands otherwise.
    steady : SteadyState
        Steady state of an engine whose sides are alike.
    least : float
        Least distance of a dead centre from the midpoint [m].
    feedback : Feedback, optional

    Attributes
    ----------
    lowered : list of float
        When the load was lowered [s].
    """

    @checked(steady=a(SteadyState), least=POSITIVE, feedback=a(Feedback).optional)
    def __init__(
        self,
        controller: Acts,
        steady: SteadyState,
        least: float,
        feedback: Feedback | None = None,
    ):
        settings = feedback or Feedback()
        self.controller, self.least = controller, least
        self.model = steady.linear(INPUTS, tuple(settings.noise))
        # The swings of an overload are no load to get used to.
        self.loop = LoadFeedback.of(self.model, settings, regains=False)
        self.lowered: list[float] = []

    def act(self, signals: Signals) -> Commands:
        """Commands at a dead centre.

        Parameters
        ----------
        signals : Signals

        Returns
        -------
        Commands
            Those of the other controller, with a load weight that is no larger.
        """
        commands = self.controller.act(signals)
        rest, at_rest = float(self.model.input_values[0]), self.model.output_values
        self.loop.observe(signals, at_rest)
        greatest = self.loop.greatest_weight(rest, self.least - float(at_rest[0]))
        if commands.motoring == 0.0 and commands.load_weight > greatest:
            commands = commands._replace(load_weight=greatest)
            self.lowered.append(signals.t)
        self.loop.go_on(commands.load_weight - rest)
        return commands


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
        self.loop.observe(signals, shown)
        load = signals.regulated_weight if self.loop.lost else self.loop.weight(weight)
        self.loop.go_on(load - weight)
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
