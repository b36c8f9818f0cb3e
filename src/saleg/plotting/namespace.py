"""``run.plot`` and its like: figures of a result under their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MethodType
from typing import Any

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
    """Figures of a result: ``run.plot.pressure_volume()`` and so on; ``dir`` lists them.

    Each returns its axes, ``ax``; ``ax.figure.savefig("name.png")`` saves the picture, and
    ``ax.figure`` at the end of a notebook's cell shows it.

    Parameters
    ----------
    result : Run or another result
        What each figure is drawn of.
    figures : mapping
        Functions by name, each with the result as its first parameter.
    kind : str
        What the result is, in words.
    """

    def __init__(
        self,
        result: Any,
        figures: Mapping[str, Callable[..., Any]] = FIGURES,
        kind: str = "a run",
    ):
        self._result, self._figures, self._kind = result, figures, kind

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name.startswith("_"):  # also before __init__, as copy and pickle ask
            raise AttributeError(name)
        if name in self._figures:
            return MethodType(self._figures[name], self._result)
        hint = nearest(name, self._figures) or "; there are " + ", ".join(self._figures)
        raise AttributeError(f"no figure {name!r}{hint}")

    def __dir__(self) -> list[str]:
        return list(self._figures)

    def __repr__(self) -> str:
        return f"figures of {self._kind}: " + ", ".join(self._figures)
