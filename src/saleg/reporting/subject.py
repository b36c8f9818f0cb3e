"""What a report is about: a result, its cycle, and the steady state of its engine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from saleg.engine import Engine
from saleg.simulation.performance import EnergyBalance, Performance
from saleg.simulation.run import Run, is_orbit
from saleg.status import Status
from saleg.steady.solver import Effort, found_steady_state
from saleg.steady.state import SteadyState

#: Tolerance of the steady state of a run's engine.
TOLERANCE = 1e-6


@dataclass(frozen=True)
class Subject:
    """What a report is about.

    Attributes
    ----------
    result : Run or SteadyState
    steady : SteadyState
        The result, or the steady state of a run's engine, found or not.
    """

    result: Run | SteadyState
    steady: SteadyState

    @classmethod
    def of(cls, result: Run | SteadyState) -> Subject:
        """Subject of a report on a result."""
        if isinstance(result, SteadyState):
            return cls(result, result)
        return cls(result, found_steady_state(result.engine, TOLERANCE, effort=Effort.QUICK))

    @property
    def engine(self) -> Engine:
        """The engine."""
        return self.result.engine

    @property
    def is_run(self) -> bool:
        """Whether the result is a run."""
        return isinstance(self.result, Run)

    @property
    def status(self) -> Status:
        """How the result ended."""
        return self.result.status

    @property
    def performance(self) -> Performance:
        """Figures of the last cycle."""
        return self.result.performance

    @property
    def energy(self) -> EnergyBalance | None:
        """Energy balance of the last cycle; None without one."""
        return self.result.energy

    @property
    def orbit(self) -> Run | None:
        """The last cycle with its history; None without one."""
        run = self.result
        if isinstance(run, Run) and is_orbit(run):
            return run
        orbit = run.orbit
        known = orbit is not None and orbit.history_rows is not None and len(orbit.strokes) == 2
        return orbit if known else None

    @property
    def settings(self) -> dict[str, Any]:
        """How the equations were integrated."""
        if isinstance(self.result, Run):
            return self.result.settings
        orbit = self.result.orbit
        return {} if orbit is None else orbit.settings
