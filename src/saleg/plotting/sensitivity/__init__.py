"""Figures of the studies of :mod:`saleg.studies.sensitivity` (Figures 43 to 59 of the thesis).

Curves are drawn of a :class:`saleg.sensitivity.Study`, trends of its table. What is stable has full
lines and the marker o; what is not, broken lines and the marker x, which lies on the axis itself
where there is no figure at all.
"""

from saleg.plotting.sensitivity.curves import (
    heat_flow_time,
    pressure_time,
    pressure_volume,
    release_rates,
    velocity_position,
)
from saleg.plotting.sensitivity.panels import regulator_gains, trends

__all__ = [
    "heat_flow_time",
    "pressure_time",
    "pressure_volume",
    "regulator_gains",
    "release_rates",
    "trends",
    "velocity_position",
]
