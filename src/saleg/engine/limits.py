"""Limits between the fields of an engine: lengths, ports, crankcases, backs and gases that fit.

Each family yields, for one side, the limits it knows: path within the chamber, whether it is kept,
unit, and what is allowed. Of an engine of columns, whether it is kept is an array. ``engine`` is a
:class:`saleg.Engine` throughout; it is checked by these limits, so its type is not named.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

from saleg.engine.chambers import CombustionChamber, Cylinder, GasChamber, OpenEnd
from saleg.engine.charge_gas import is_gas_of_fuel
from saleg.laws import Crankcase, DirectInjection, PortFlow
from saleg.quantities import Problem

#: Path within a chamber, whether the limit is kept, unit, and what is allowed.
Limit = tuple[str, Any, str, str]
WINDOWS = "exhaust_width", "intake_width"


def lengths_fit(engine: Any) -> Any:
    """Whether all limits are kept; of an engine of columns, in each row."""
    most, fit = _most(engine), True
    for family, _ in FAMILIES:
        for side in range(2):
            for _, kept, _, _ in family(engine, side, most):
                fit = fit & kept
    return fit


def limits_exceeded(engine: Any, found: Iterable[Problem]) -> list[Problem]:
    """Limits that are not kept, where the fields they are between are right by themselves.

    Parameters
    ----------
    engine : saleg.Engine
        With a chamber on either side.
    found : iterable of Problem
        What is wrong by itself.
    """
    sides = ("",) if engine.is_mirrored else ("left.", "right.")
    wrong, exceeded = paths_of(engine, found), list[Problem]()
    for family, fields in FAMILIES:
        for side, prefix in enumerate(sides):
            needed = [prefix + field for field in fields if field != BOTH]
            if BOTH in fields:
                needed += [one + "half_stroke" for one in sides]
            if any(is_within(path, needed) for path in wrong):
                continue
            for field, kept, unit, allowed in family(engine, side, _most(engine)):
                if not kept:
                    value = _value(engine.chambers[side], field)
                    exceeded.append(Problem(prefix + field, value, unit, allowed))
                    wrong.append(prefix + field)
    return exceeded


def paths_of(engine: Any, found: Iterable[Problem]) -> list[str]:
    """Paths of what is wrong; of chambers that are alike, without their side too."""
    paths = [problem.path for problem in found]
    if engine.is_mirrored:
        paths += [path.removeprefix("left.") for path in paths if path.startswith("left.")]
    return paths


def is_within(path: str, places: Iterable[str]) -> bool:
    """Whether a path leads to one of some places, or into it."""
    return any(path == place or path.startswith(place + ".") for place in places)


def windows_too_wide(engine: Any) -> list[Problem]:
    """Windows of ports wider than the circumference of their cylinder, which nobody can cut."""
    sides = ("",) if engine.is_mirrored else ("left.", "right.")
    found = []
    for prefix, chamber in zip(sides, engine.chambers, strict=False):
        for name, width, around in _windows(chamber):
            if width > around:
                allowed = f"usually no more than the circumference ({around:.3g} m)"
                found.append(Problem(f"{prefix}gas_exchange.{name}", width, "m", allowed))
    return found


def windows_fit(chamber: Any) -> Any:
    """Whether no window is wider than the circumference; of columns, in each row."""
    fit = True
    for _, width, around in _windows(chamber):
        fit = fit & (width <= around)
    return fit


def _windows(chamber: Any) -> Iterator[tuple[str, Any, Any]]:
    ports = getattr(chamber, "gas_exchange", None)
    if isinstance(ports, PortFlow):
        for name in WINDOWS:
            yield name, getattr(ports, name), math.pi * chamber.bore


def _most(engine: Any) -> Any:
    """Clearances at the midpoint together [m]."""
    return engine.left.half_stroke + engine.right.half_stroke


def _value(chamber: Any, field: str) -> Any:
    for name in field.split("."):
        chamber = getattr(chamber, name)
    return chamber


def _shown(length: Any) -> str:
    return f" ({length:g} m)" if isinstance(length, float) else ""


def _limits_of_gaps(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    chamber = engine.chambers[side]
    allowed = f"must be < half_stroke{_shown(chamber.half_stroke)}"
    yield "head_gap", chamber.head_gap < chamber.half_stroke, "m", allowed


def _limits_of_edges(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    chamber = engine.chambers[side]
    if isinstance(chamber, Cylinder):
        gap, port = chamber.head_gap, chamber.port_closing
        lowest, highest = f"> head_gap{_shown(gap)}", f"< the maximum stroke{_shown(most)}"
        kept = (gap < port) & (port < most)
        yield "port_closing", kept, "m", f"must be {lowest} and {highest}"


def _limits_of_intake_edges(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    chamber = engine.chambers[side]
    ports = getattr(chamber, "gas_exchange", None)
    if isinstance(chamber, Cylinder) and isinstance(ports, PortFlow):
        kept = ports.intake_delay < most - chamber.port_closing
        allowed = "must be less than the way from port_closing to the maximum stroke"
        yield "gas_exchange.intake_delay", kept, "m", allowed


def _limits_of_exhausts(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    return _limits_of_heights(engine, side, most, "exhaust_height")


def _limits_of_intakes(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    return _limits_of_heights(engine, side, most, "intake_height")


def _limits_of_heights(engine: Any, side: int, most: Any, name: str) -> Iterator[Limit]:
    """A window may end beyond what the piston uncovers, but is no taller than the stroke."""
    chamber = engine.chambers[side]
    ports = getattr(chamber, "gas_exchange", None)
    if isinstance(chamber, Cylinder) and isinstance(ports, PortFlow):
        allowed = f"must be no more than the maximum stroke{_shown(most)}"
        yield f"gas_exchange.{name}", getattr(ports, name) <= most, "m", allowed


def _limits_of_crankcases(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    chamber = engine.chambers[side]
    supply = getattr(chamber, "supply", None)
    if isinstance(supply, Crankcase):
        kept = supply.volume(most - chamber.half_stroke) > 0.0
        allowed = "must be more than the piston displaces on its way from the midpoint"
        yield "supply.volume_at_midpoint", kept, "m^3", allowed


def _limits_of_feeds(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    chamber = engine.chambers[side]
    if isinstance(getattr(chamber, "supply", None), Crankcase):
        ports: Any = getattr(chamber, "gas_exchange", None)
        allowed = "must be a PortFlow, or another law by which gas flows, with a crankcase"
        yield "gas_exchange", "contents" in getattr(ports, "states", ()), "-", allowed


def _limits_of_backs(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    """Limits of pressures behind the pistons."""
    chamber, opposite = engine.chambers[side], engine.chambers[1 - side]
    if not isinstance(chamber, GasChamber):
        return
    if isinstance(opposite, OpenEnd):
        allowed = "must be 0 opposite an open end, whose pressure acts behind the piston"
        yield "back_pressure", chamber.back_pressure == 0.0, "Pa", allowed
    else:
        kept = (chamber.back_area > 0.0) | (chamber.back_pressure == 0.0)
        yield "back_area", kept, "m^2", "must be > 0 with a back_pressure"


def _limits_of_injection(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    chamber = engine.chambers[side]
    if isinstance(chamber, CombustionChamber) and chamber.injection.is_direct:
        first, allowed = most, "must be > head_gap and < the maximum stroke"
        if isinstance(chamber, Cylinder):
            first, allowed = chamber.port_closing, "must be > head_gap and < port_closing"
        place = chamber.injection.place
        kept = (chamber.head_gap < place) & (place < first)
        is_ours = isinstance(chamber.injection, DirectInjection)
        yield "injection.clearance" if is_ours else "injection", kept, "m", allowed


def _limits_of_composition(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    """Limits of gases that follow the composition."""
    chamber = engine.chambers[side]
    if getattr(getattr(chamber, "gas_properties", None), "follows_composition", False):
        others = [law for slot, law in chamber.laws.items() if slot != "gas_properties"]
        flows = any("contents" in getattr(law, "states", ()) for law in others)
        allowed = "must be one gas, such as MixtureGas, in a chamber that gas flows or leaks into"
        yield "gas_properties", not flows, "-", allowed


def _limits_of_fuels(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    allowed = "must be the fuel that gas_properties is made of: saleg.fuels.fill sets both"
    yield "fuel", is_gas_of_fuel(engine.chambers[side]), "-", allowed


def _limits_of_foresight(engine: Any, side: int, most: Any) -> Iterator[Limit]:
    """Limits of laws that foresee dead centres."""
    ignition = getattr(engine.chambers[side], "ignition", None)
    if getattr(ignition, "foresees_dead_centre", False):
        allowed = (
            "must not foresee the dead centre from the stroke before in an engine with one "
            "cylinder, whose strokes either way differ: take SparkAtClearance"
        )
        burns = all(isinstance(chamber, CombustionChamber) for chamber in engine.chambers)
        yield "ignition", burns, "-", allowed


#: In place of a field: the half strokes of both sides.
BOTH = "maximum stroke"
_EDGES = "port_closing", "head_gap", BOTH
#: Families of limits, and the fields of a chamber that have to be right by themselves for each.
FAMILIES: tuple[tuple[Any, tuple[str, ...]], ...] = (
    (_limits_of_gaps, ("head_gap", "half_stroke")),
    (_limits_of_edges, _EDGES),
    (_limits_of_intake_edges, (*_EDGES, "gas_exchange.intake_delay")),
    (_limits_of_exhausts, (BOTH, "gas_exchange.exhaust_height")),
    (_limits_of_intakes, (BOTH, "gas_exchange.intake_height")),
    (_limits_of_crankcases, ("supply", BOTH)),
    (_limits_of_backs, ("back_area", "back_pressure")),
    (_limits_of_injection, (*_EDGES, "injection")),
    (_limits_of_feeds, ()),
    (_limits_of_composition, ()),
    (_limits_of_fuels, ("fuel", "gas_properties")),
    (_limits_of_foresight, ("ignition",)),
)
