"""Figures of Chapter 5 by their number: experiments with the engine of Table 13."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from saleg import Run, plotting, simulate
from saleg.machines import thesis_transient
from saleg.plotting.style import panels_or_new
from saleg.thesis.chapter_5 import demand, misfire, resonance, start_up
from saleg.thesis.experiment import Experiment
from saleg.thesis.figure import Figure

if TYPE_CHECKING:
    from saleg.plotting.figure import Panels


def base_case() -> Run:
    """Engine of Table 13, simulated until it is steady (Figures 92, 93)."""
    return simulate(thesis_transient(), 1.5)


def _forces_and_energy(run: Run, ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 11.0, 4.4)
    plotting.forces(run, panels[0])
    plotting.energy_pie(run, panels[1])
    return panels


def _figure(experiment: Experiment, picture: str) -> Figure:
    return Figure(partial(experiment.run, thesis_transient()), experiment.draw[picture])


_RESONANCE, _START, _DEMAND, _MISFIRE = (
    of.EXPERIMENTS for of in (resonance, start_up, demand, misfire)
)

#: Figures by their number.
FIGURES = {
    92: Figure(base_case, plotting.dynamics),
    93: Figure(base_case, _forces_and_energy),
    94: _figure(_RESONANCE["amplitude"], "amplitude.png"),
    95: _figure(_RESONANCE["resonance"], "resonance.png"),
    97: _figure(_START["start-up"], "start_up.png"),
    98: _figure(_START["start-up"], "approach.png"),
    99: _figure(_START["start-ups"], "start_ups.png"),
    100: _figure(_DEMAND["load-step"], "demand.png"),
    101: _figure(_DEMAND["intake-map"], "map.png"),
    102: _figure(_DEMAND["intake-step"], "demand.png"),
    103: _figure(_DEMAND["intake-ramp"], "demand.png"),
    104: _figure(_DEMAND["fuel-map"], "map.png"),
    105: _figure(_DEMAND["map"], "map.png"),
    106: _figure(_MISFIRE["fuel-cut"], "duty_cycle.png"),
    107: _figure(_MISFIRE["overload"], "duty_cycle.png"),
    108: _figure(_MISFIRE["misfire"], "recovery.png"),
}
