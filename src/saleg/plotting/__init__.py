"""Figures of a run: of its last full cycle, of its energy balance, of how it settled.

Every figure is a function of a run and, if wanted, of the axes to draw on; it returns the axes.
Axes of one's own may belong to pyplot; those made here do not, so no display is needed and nothing
has to be closed; as the result of a notebook's cell they show the picture. ``run.plot`` offers the
same functions: ``run.plot.forces()``. Figures of the numerical studies are in
``saleg.plotting.studies``, those of sensitivity studies in ``saleg.plotting.sensitivity``, those of
engines under control in ``saleg.plotting.control``.

matplotlib is imported only when something is drawn.

Examples
--------
>>> import saleg
>>> run = saleg.simulate(saleg.machines.thesis_base(), 0.5)
>>> ax = run.plot.pressure_volume()
>>> ax.figure.savefig("pressure_volume.png")  # doctest: +SKIP
>>> ax.get_ylabel()
'pressure [bar]'
"""

from saleg.plotting import control, sensitivity, studies
from saleg.plotting.animations import Animation, animate, animation
from saleg.plotting.control import controlled
from saleg.plotting.cycle import NoCycle
from saleg.plotting.energy import energy_pie
from saleg.plotting.film import AnimationError
from saleg.plotting.gas import (
    heat_flow_time,
    pressure_position,
    pressure_time,
    pressure_volume,
)
from saleg.plotting.namespace import FIGURES, Plots
from saleg.plotting.overview import approach_to_steady_state, dynamics
from saleg.plotting.sankey import energy_balance, energy_sankey
from saleg.plotting.style import (
    COLOURS,
    LEFT_COLOUR,
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    new_figure,
)
from saleg.plotting.translator import (
    acceleration_velocity,
    efficiency,
    forces,
    power,
    velocity_position,
)

__all__ = [
    "COLOURS",
    "FIGURES",
    "LEFT_COLOUR",
    "RIGHT_COLOUR",
    "TRANSLATOR_COLOUR",
    "Animation",
    "AnimationError",
    "NoCycle",
    "Plots",
    "acceleration_velocity",
    "animate",
    "animation",
    "approach_to_steady_state",
    "control",
    "controlled",
    "dynamics",
    "efficiency",
    "energy_balance",
    "energy_pie",
    "energy_sankey",
    "forces",
    "heat_flow_time",
    "new_figure",
    "power",
    "pressure_position",
    "pressure_time",
    "pressure_volume",
    "sensitivity",
    "studies",
    "velocity_position",
]
