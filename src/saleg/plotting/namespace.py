"""``run.plot``: the figures of a run under their names."""

from __future__ import annotations

from collections.abc import Callable
from types import MethodType
from typing import TYPE_CHECKING, Any

from saleg.errors import nearest
from saleg.plotting.control.timelines import controlled
from saleg.plotting.energy import energy_pie
from saleg.plotting.gas import (
    heat_flow_time,
    pressure_position,
    pressure_time,
    pressure_volume,
)
from saleg.plotting.overview import approach_to_steady_state, dynamics
from saleg.plotting.sankey import energy_balance, energy_sankey
from saleg.plotting.translator import (
    acceleration_velocity,
    efficiency,
    forces,
    power,
    velocity_position,
)

if TYPE_CHECKING:
    from saleg.simulation.run import Run

#: All figures of a run by name.
FIGURES: dict[str, Callable[..., Any]] = {
    "velocity_position": velocity_position,
    "acceleration_velocity": acceleration_velocity,
    "pressure_position": pressure_position,
    "pressure_volume": pressure_volume,
    "pressure_time": pressure_time,
    "heat_flow_time": heat_flow_time,
    "forces": forces,
    "power": power,
    "efficiency": efficiency,
    "energy_balance": energy_balance,
    "energy_sankey": energy_sankey,
    "energy_pie": energy_pie,
    "approach_to_steady_state": approach_to_steady_state,
    "dynamics": dynamics,
    "controlled": controlled,
}


class Plots:
    """The figures of a run: ``run.plot.pressure_volume()`` and so on; ``dir`` lists them.

    Each returns its axes, ``ax``; ``ax.figure.savefig("name.png")`` saves the picture, and
    ``ax.figure`` at the end of a notebook's cell shows it.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run):
        self._run = run

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name in FIGURES:
            return MethodType(FIGURES[name], self._run)
        hint = "" if name.startswith("_") else nearest(name, FIGURES)
        raise AttributeError(f"no figure {name!r}{hint or '; there are ' + ', '.join(FIGURES)}")

    def __dir__(self) -> list[str]:
        return list(FIGURES)

    def __repr__(self) -> str:
        return "figures of a run: " + ", ".join(FIGURES)
