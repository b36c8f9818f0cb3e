"""Steady state of an engine, as a result that only reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from saleg.checks import NAMES, checked
from saleg.engine import Engine
from saleg.errors import SalegError
from saleg.simulation.course import Replay
from saleg.simulation.net_output import Auxiliaries, NetOutput, net_output_of
from saleg.simulation.performance import EnergyBalance, Performance
from saleg.simulation.plausibility import remarks_on
from saleg.simulation.run import Run, read_only
from saleg.simulation.scavenging import Scavenging, scavenging_of
from saleg.simulation.shaking import Shaking, shaking_of
from saleg.simulation.validity import ValidityReport, validity_of
from saleg.status import Status
from saleg.steady.linear import OUTPUTS, LinearModel, linear_model
from saleg.steady.linear_inputs import INPUTS
from saleg.steady.stability import Stability, stability
from saleg.steady.symmetry import repeats_itself

if TYPE_CHECKING:
    from saleg.plotting import Plots


class NoSteadyState(SalegError, ValueError):
    """There is no steady state, and so nothing of what was asked about it."""


@dataclass(eq=False)
class SteadyState:
    """A steady state of an engine, or what there is instead.

    Attributes
    ----------
    engine : Engine
    status : Status
        ``STEADY`` or ``IDLING`` for a fixed point; else why there is none.
    message : str
        What was found and how.
    half_cycles : int
        Strokes integrated to find it, the verifying cycle included, stability apart.
    evaluations : int
        Right-hand sides evaluated for that.
    residual : float
        How far the verifying cycle misses its start, in the numbers of order one a state is
        written in [-]; NaN without a fixed point.
    method : str
        "fixed point", "continuation" (a point of a branch), "simulation", or "none" where a quick
        search has found nothing.
    strokes : ndarray of STROKE_RECORD
        The two strokes of the cycle, read-only; empty without one.
    mirrored : bool
        Whether the second stroke is known to be the mirror image of the first: found by the map of
        half a cycle. A symmetric engine may also run on an orbit that is not.
    replay : callable, optional
        Integrates the cycle again, for `orbit`.
    fallback : Run, optional
        Simulation of an engine without a steady state.
    """

    engine: Engine
    status: Status
    message: str
    half_cycles: int
    evaluations: int
    residual: float
    method: str
    strokes: np.ndarray = field(repr=False)
    mirrored: bool = False
    replay: Replay | None = field(default=None, repr=False)
    fallback: Run | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        """Show the strokes, but let nobody write to them."""
        self.strokes = read_only(self.strokes)

    @property
    def found(self) -> bool:
        """Whether there is a steady state, be it stable or not."""
        return self.status in (Status.STEADY, Status.IDLING)

    @cached_property
    def orbit(self) -> Run | None:
        """The cycle with its whole history and all peaks located; None without a steady state."""
        return self.replay() if self.replay is not None else None

    @cached_property
    def performance(self) -> Performance:
        """Figures of the cycle; zeros and NaN without one."""
        if not len(self.strokes):
            return Performance.of_nothing(self.engine)
        history = None if self.orbit is None else self.orbit.history_rows
        return Performance.of_cycle(self.engine, self.strokes, self.strokes, history)

    @cached_property
    def scavenging(self) -> tuple[Scavenging, Scavenging]:
        """Gas exchange of the left and the right cylinder, as of a run."""
        return scavenging_of(self.engine, self.strokes if len(self.strokes) else None)

    @cached_property
    def shaking(self) -> Shaking:
        """Force on what the engine stands on, and motion of its frame, as of a run."""
        history = self.orbit.history_rows if self.orbit is not None else None
        return shaking_of(self.strokes if len(self.strokes) else None, history)

    def net_output(self, auxiliaries: Auxiliaries | None = None) -> NetOutput:
        """Power once charger, electronics and consumers are paid for, as of a run.

        Parameters
        ----------
        auxiliaries : Auxiliaries, optional

        Returns
        -------
        NetOutput

        Raises
        ------
        InvalidEngine
            If a number of the auxiliaries is out of range.
        """
        cycle = self.strokes if len(self.strokes) else None
        return net_output_of(self.engine, cycle, auxiliaries)

    @property
    def plot(self) -> Plots:
        """Figures of the cycle, as ``run.plot`` has them; ``dir`` lists them.

        Raises
        ------
        NoSteadyState
            If there is no cycle to draw.
        """
        from saleg.plotting import Plots

        if self.orbit is None:
            raise NoSteadyState(f"no steady state to draw: {self.message}")
        return Plots(self.orbit)

    @cached_property
    def quick_performance(self) -> Performance:
        """The same without what needs the history of the cycle: the adverse work is NaN."""
        if not len(self.strokes):
            return Performance.of_nothing(self.engine)
        return Performance.of_cycle(self.engine, self.strokes, self.strokes)

    @property
    def remarks(self) -> list[str]:
        """Figures of the cycle that no engine built comes near, as text; often none."""
        return remarks_on(self.engine, vars(self.quick_performance), self.strokes)

    @property
    def validity(self) -> ValidityReport:
        """Laws outside their ranges, implausible figures, and what a published machine supports."""
        exits = [] if self.orbit is None else self.orbit.range_exits
        return validity_of(self.engine, self.quick_performance, self.strokes, exits)

    @property
    def moving_mass(self) -> float:
        """Moving mass [kg]."""
        return float(self.engine.translator.mass)

    @cached_property
    def energy(self) -> EnergyBalance | None:
        """Energy balance of the cycle, which ends as it began; None without a steady state."""
        return EnergyBalance.between(self.strokes[-1], self.strokes) if self.found else None

    @cached_property
    def stability(self) -> Stability:
        """Multipliers of the cycle and what they mean, differentiated when first asked for.

        Raises
        ------
        NoSteadyState
            If there is no cycle to differentiate.
        """
        self._check_map()
        assert self.replay is not None
        return stability(self.replay, self.mirrored, float(self.strokes["duration"].sum()))

    @checked(inputs=NAMES, outputs=NAMES)
    def linear(
        self, inputs: Sequence[str] = INPUTS, outputs: Sequence[str] = OUTPUTS
    ) -> LinearModel:
        """Linear model from dead centre to dead centre: A, B, C and D with names.

        Parameters
        ----------
        inputs : sequence of str
            What a controller commands at a dead centre, ``load_weight`` [-], ``equivalence_ratio``
            [-] and ``intake_temperature`` [K], or any number of the engine by its path that
            changes neither geometry nor gas, in its SI unit. The load weight is added to what the
            alternator's regulator sets; fuel and intake temperature take effect at the next port
            closing.
        outputs : sequence of str
            What is measured there: ``dead_centre``, its distance from the midpoint [m], and any
            measured field of :class:`saleg.laws.Signals`, in its SI unit.

        Returns
        -------
        LinearModel

        Raises
        ------
        NoSteadyState
            If there is no cycle to differentiate.
        NoLinearModel
            If an output is not known, an input changes geometry or gas, a name stands twice, or the
            least change ends the motion; all that is wrong is named.
        UnknownPath, InvalidEngine
            If nothing else is wrong than that inputs are no paths of the engine, or that one stands
            at a limit of its range.

        Examples
        --------
        >>> import saleg
        >>> model = saleg.steady_state(saleg.machines.thesis_base()).linear(["load_weight"])
        >>> model
        <LinearModel: 18 states, 1 inputs, 5 outputs, a step is half a cycle (10.65 ms)>
        """
        self._check_map()
        assert self.replay is not None
        period = float(self.strokes["duration"].sum())
        return linear_model(self.replay, self.mirrored, period, inputs, outputs)

    def _check_map(self) -> None:
        """Refuse a result without a return map to differentiate."""
        if self.replay is None:
            raise NoSteadyState(f"no steady state to differentiate: {self.message}")
        if not self.has_multipliers:
            raise NoSteadyState(f"no return map to differentiate: {self.message}")

    @property
    def has_multipliers(self) -> bool:
        """Whether there is a steady state and a return map to differentiate there.

        An engine with a law of time may repeat its cycles but has no such map.
        """
        return self.replay is not None and repeats_itself(self.engine)

    @property
    def multipliers(self) -> np.ndarray:
        """Multipliers of a whole cycle, the largest first [-]."""
        return self.stability.multipliers

    @property
    def stable(self) -> bool:
        """Whether small disturbances of the cycle die away; False where that is not known."""
        return self.found and self.has_multipliers and self.stability.stable

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.engine.name!r}: {self.status}, by {self.method}>"

    def _repr_html_(self) -> str:
        from saleg.display import steady_card

        return steady_card(self)

    def __str__(self) -> str:
        from saleg.simulation.report import describe_cycle

        known = vars(self).get("stability")
        stable = "stability not examined" if known is None else known.kind
        head = f"{self.engine.name}: {self.status} ({stable}) - {self.message}"
        head = head if self.found else head.replace(f" ({stable})", "")
        shown = describe_cycle(self.performance, self.scavenging, self.validity)
        return "\n".join([head, *shown])
