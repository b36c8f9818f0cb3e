"""Inputs of a linear model: commands at a dead centre, and numbers of the engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from saleg.engine import Engine
from saleg.engine.paths import claimed, known_paths
from saleg.errors import SalegError, UnknownPath, nearest, shown
from saleg.kernel import layout
from saleg.kernel.control import supply
from saleg.simulation.initial_state import State, prepare
from saleg.steady.stability import DIFFERENCE
from saleg.steady.symmetry import is_symmetric

#: Commands at a dead centre.
INPUTS = ("load_weight", "equivalence_ratio", "intake_temperature")
#: Numbers of the engine that change what happens next and not where it stands.
ENGINE_NUMBERS = ("mass", "back_force")
CHAMBER_NUMBERS = (
    "port",
    "intake_pressure",
    "intake_temperature",
    "equivalence_ratio_wanted",
    "lower_heating_value",
    "air_fuel_ratio",
    "combustion_efficiency",
    "late_ignition",
    "beside_rated_temperature",
    "over_rated_fuel",
)
#: Numbers of a chamber with which its present contents would be others.
GEOMETRY = ("bore", "area", "half_stroke", "head_gap", "gas_constant", "curve_exponent")


class NoLinearModel(SalegError, ValueError):
    """There is no linear model with such inputs and outputs, or none at all."""


@dataclass(frozen=True)
class Input:
    """One input: its value at the steady state, and the engine and state with another value."""

    value: float
    changed: Callable[[float], tuple[Engine, State]]
    keeps_mirror: bool = True

    @classmethod
    def of(cls, engine: Engine, start: State, name: str) -> Input:
        """A command at a dead centre, or else a number of the engine by its path."""
        if name in INPUTS:
            value = float(start.engine[name][0])
            return cls(value, lambda new: (engine, _commanded(start, name, new)))
        value = _number(engine, name)
        by = difference_of(value)
        beside = [engine.replace(**{name: value + change}) for change in (by, -by)]
        for other in beside:
            other.validate()
        _check_geometry(engine, beside[0], name)

        def changed(new: float) -> tuple[Engine, State]:
            other = engine.replace(**{name: new})
            return other, _with_numbers(engine, other, start)

        return cls(float(value), changed, is_symmetric(beside[0]) or not is_symmetric(engine))


def place_of(engine: Engine, name: str) -> object:
    """What an input stands for: the same for two names of one number."""
    return name if name in INPUTS else tuple(claimed({}, engine, name))


def _number(engine: Engine, name: str) -> float:
    """Number of an engine at a path."""
    try:
        value = engine.get(name)
    except UnknownPath as error:
        hint = nearest(name, [*INPUTS, *known_paths(engine)])
        raise UnknownPath(f"input '{name}': no such input{hint}" if hint else str(error)) from None
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise NoLinearModel(f"input {shown(name)}: must be a number of the engine")
    return value


def difference_of(value: float) -> float:
    """Difference on either side of a number."""
    return DIFFERENCE * (abs(value) or 1.0)


def _commanded(start: State, name: str, value: float) -> State:
    """A state at which something else is commanded."""
    state = start.copy()
    state.engine[name] = value
    supply(*state.records)
    return state


def _check_geometry(engine: Engine, other: Engine, name: str) -> None:
    """Refuse an input with which what stands in the chambers would be another."""
    was, now = prepare(engine).chambers, prepare(other).chambers
    if any((was[field] != now[field]).any() for field in GEOMETRY):
        raise NoLinearModel(
            f"input '{name}': must not change the geometry or the gas, for then what stands "
            "in the chambers is another"
        )


def _with_numbers(engine: Engine, other: Engine, start: State) -> State:
    """A state as it stands, in an engine with another number from now on."""
    state, was, now = start.copy(), prepare(engine), prepare(other)
    for field in ENGINE_NUMBERS:
        state.engine[field] += now.engine[field] - was.engine[field]
    for field in CHAMBER_NUMBERS:
        changes = now.chambers[field] != was.chambers[field]
        state.chambers[field] = np.where(changes, now.chambers[field], state.chambers[field])
    for side, chamber in enumerate(engine.chambers):
        if "wall_temperature" not in chamber.states:
            by = now.chambers["wall_temperature"][side] - was.chambers["wall_temperature"][side]
            state.chambers["wall_temperature"][side] += by
            state.y[layout.WALL + side] += by
    return state
