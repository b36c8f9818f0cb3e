"""Figures of transient operation and control (94 to 108)."""

from saleg.plotting.control.tables import (
    motored_amplitudes,
    motored_resonance,
    operating_grid,
    operating_map,
    part_load,
    survival,
)
from saleg.plotting.control.timelines import (
    approach,
    controlled,
    demand,
    duty_cycle,
    start_up,
    start_ups,
)

__all__ = [
    "approach",
    "controlled",
    "demand",
    "duty_cycle",
    "motored_amplitudes",
    "motored_resonance",
    "operating_grid",
    "operating_map",
    "part_load",
    "start_up",
    "start_ups",
    "survival",
]
