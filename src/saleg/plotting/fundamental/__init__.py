"""Figures of the fundamental model: each draws on axes of yours or new ones, and returns them.

matplotlib is imported only when something is drawn.

Examples
--------
>>> from saleg.fundamental import ConstantLoad, System, march, plots
>>> history = march(System(pressure=0.5, heat=1.0, load=ConstantLoad(0.3)), -0.5, strokes=10)
>>> plots.phase_portrait(history).get_title()
'Rising: compression ratio 3.1 to 5.9'
"""

from saleg.plotting.fundamental.diagrams import energy_pie, load_profiles, pressure_loops
from saleg.plotting.fundamental.portraits import (
    acceleration_portrait,
    compare_accelerations,
    compare_velocities,
    compression_ratios,
    phase_portrait,
)
from saleg.plotting.fundamental.stability import cobweb, tolerance

__all__ = [
    "acceleration_portrait",
    "cobweb",
    "compare_accelerations",
    "compare_velocities",
    "compression_ratios",
    "energy_pie",
    "load_profiles",
    "phase_portrait",
    "pressure_loops",
    "tolerance",
]
