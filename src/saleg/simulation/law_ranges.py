"""Ranges of what laws of flow give: areas, pressures and shares a gas can have.

A negative area lets gas flow against its pressure; nothing in an integration would say so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from saleg.compiler.source import is_ours
from saleg.engine import Chamber, Engine
from saleg.errors import LawError
from saleg.laws.arguments import Gas
from saleg.laws.base import Law

#: Places along the stroke at which laws are asked.
PLACES = 41
#: Pressures in a chamber at which its leak is asked, over that of its reference state.
PRESSURES = (0.1, 0.5, 1.0, 2.0, 10.0, 100.0)
#: Pressure differences at which the inlet of a crankcase is asked [Pa].
RISES = (-1e5, 0.0, 1e2, 1e3, 1e4, 1e5)

#: Method, what it is asked for, what its answers must be, and whether one is.
Question = tuple[str, list[Any], str, Callable[[float], bool]]


def check_flows(engine: Engine) -> None:
    """Refuse laws of a user's that give negative areas, pressures or shares.

    Raises
    ------
    LawError
        Naming law, method, and where it was asked.
    """
    most = engine.left.half_stroke + engine.right.half_stroke
    for chamber in engine.chambers:
        for slot, law in chamber.laws.items():
            if "contents" in law.states and not is_ours(type(law)):
                for question in _questions(chamber, slot, most):
                    _ask(law, *question)


def _questions(chamber: Chamber, slot: str, most: float) -> Iterator[Question]:
    """What a law is asked: method, arguments, what must come and whether it does."""
    if slot == "gas_exchange":
        way = most - getattr(chamber, "port_closing", most)
        openings = np.linspace(0.0, way, PLACES).tolist()
        yield "areas", openings, "must not be negative", _is_not_negative
        yield "fresh_share", [0.0, 0.25, 0.5, 0.75, 1.0], "must lie between 0 and 1", _is_share
        yield "exhaust", [], "must be positive", _is_positive
    elif slot == "leak":
        yield "area", _gases(chamber), "must not be negative", _is_not_negative
        yield "beyond", [], "must be positive", _is_positive
    elif slot == "supply":
        ways = np.linspace(-chamber.half_stroke, most - chamber.half_stroke, PLACES).tolist()
        yield "volume", ways, "must be positive", _is_positive
        yield "inlet_area", list(RISES), "must not be negative", _is_not_negative
        yield "piston_area", [], "must not be negative", _is_not_negative


def _ask(law: Law, name: str, shown: list[Any], wanted: str, good: Callable[[float], bool]) -> None:
    """Refuse a law with a method that answers a question wrongly."""
    method = getattr(law, name)
    arguments: list[tuple[Any, ...]] = [(item,) for item in shown] or [()]
    for one in arguments:
        answer = method(*one)
        numbers = answer if isinstance(answer, tuple) else (answer,)
        if not all(map(good, numbers)):
            at = (
                " at " + ", ".join(f"{getattr(item, 'p', item):.6g}" for item in one) if one else ""
            )
            raise LawError(f"{type(law).__name__}.{name} returned {answer}{at}: {wanted}")


def _gases(chamber: Chamber) -> list[Gas]:
    """Gas of a chamber at its reference temperature, thin and compressed."""
    full: Any = chamber.reference_state
    bore, wall = (getattr(chamber, name) for name in ("bore", "wall_temperature"))
    pressures = [share * full.pressure for share in PRESSURES]
    volume = chamber.area * full.clearance
    return [
        Gas(p, full.temperature, volume, p, full.clearance, bore, 0.0, wall, 0.0) for p in pressures
    ]


def _is_not_negative(value: float) -> bool:
    return value >= 0.0


def _is_positive(value: float) -> bool:
    return value > 0.0


def _is_share(value: float) -> bool:
    return 0.0 <= value <= 1.0
