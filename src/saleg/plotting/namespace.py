"""``run.plot`` and its like: figures of a result as methods."""

from __future__ import annotations

from collections.abc import Callable
from types import MethodType
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, TypeVar

from saleg.errors import nearest
from saleg.plotting import animations, energy, gas, overview, sankey, translator
from saleg.plotting.control import timelines

Settings = ParamSpec("Settings")
Drawn = TypeVar("Drawn")


class Method(Generic[Settings, Drawn]):
    """A figure as a method: a function whose first parameter is what it is drawn of."""

    def __init__(self, draw: Callable[Concatenate[Any, Settings], Drawn]):
        self.draw = draw

    def __get__(self, plots: Namespace | None, kind: type) -> Callable[Settings, Drawn]:
        method: Any = self.draw if plots is None else MethodType(self.draw, plots._result)
        return method


class Namespace:
    """Figures of a result; ``dir`` lists them.

    Parameters
    ----------
    result : Run or another result
        What each figure is drawn of.
    """

    _kind = "a result"

    def __init__(self, result: Any):
        self._result = result

    @classmethod
    def _figures(cls) -> dict[str, Callable[..., Any]]:
        """The functions behind the methods, by name."""
        return {name: item.draw for name, item in vars(cls).items() if isinstance(item, Method)}

    if not TYPE_CHECKING:  # a type checker is to refuse what is not there

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):  # also before __init__, as copy and pickle ask
                raise AttributeError(name)
            hint = nearest(name, self._figures()) or "; there are " + ", ".join(self._figures())
            raise AttributeError(f"no figure {name!r}{hint}")

    def __dir__(self) -> list[str]:
        return list(self._figures())

    def __repr__(self) -> str:
        return f"figures of {self._kind}: " + ", ".join(self._figures())


class Plots(Namespace):
    """Figures of a run: ``run.plot.pressure_volume()`` and so on; ``dir`` lists them.

    Each returns its axes, or an array of them, which show as the result of a notebook's cell;
    ``.figure.savefig("name.png")`` saves the picture.

    Parameters
    ----------
    result : Run
    """

    _kind = "a run"

    velocity_position = Method(translator.velocity_position)
    acceleration_velocity = Method(translator.acceleration_velocity)
    pressure_position = Method(gas.pressure_position)
    pressure_volume = Method(gas.pressure_volume)
    pressure_time = Method(gas.pressure_time)
    heat_flow_time = Method(gas.heat_flow_time)
    forces = Method(translator.forces)
    power = Method(translator.power)
    efficiency = Method(translator.efficiency)
    energy_balance = Method(sankey.energy_balance)
    energy_sankey = Method(sankey.energy_sankey)
    energy_pie = Method(energy.energy_pie)
    approach_to_steady_state = Method(overview.approach_to_steady_state)
    dynamics = Method(overview.dynamics)
    controlled = Method(timelines.controlled)
    animation = Method(animations.animation)


#: All figures of a run by name.
FIGURES = {name: draw for name, draw in Plots._figures().items() if name != "animation"}
