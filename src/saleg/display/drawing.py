"""An engine as a section: cylinders to scale, rod, springs and alternator schematic."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.design import formulas
from saleg.design.schematic import SIDES, dimensions
from saleg.display.svg import GREEN, LEFT, RIGHT, YELLOW, path, picture, tag, text
from saleg.engine import Engine

#: Width of a drawing [px], thickness of walls [mm], turns of a spring.
WIDTH, WALL, TURNS = 520.0, 4.0, 9
#: Room above a drawing for the names of parts, and size of text [px].
ABOVE, TEXT = 40.0, 14
_COLOURS = {"left": LEFT, "right": RIGHT}


def drawing(engine: Engine) -> str:
    """Section of an engine with the translator at its midpoint."""
    sides = {side: dimensions(engine, side) for side in SIDES}
    end = max(mm["head"] for mm in sides.values()) + 2.0 * WALL
    reach = 0.5 * max(mm["mover_outer_diameter"] for mm in sides.values()) + 3.0 * WALL
    scale = 0.5 * WIDTH / end
    # In mm from the midpoint, y upward: the picture is symmetric, so its sign does not matter.
    middle = ABOVE + reach * scale
    place = f"translate({0.5 * WIDTH:g} {middle:.1f}) scale({scale:.4f})"
    parts = [part for side, mm in sides.items() for part in _side(side, mm)]
    parts += _mover(sides["left"])
    below = middle + reach * scale + TEXT
    look: dict[str, Any] = {"font_size": TEXT}
    names = [
        text(2, below, _name(engine, "left"), **look),
        text(WIDTH - 2, below, _name(engine, "right"), text_anchor="end", **look),
        *_rule(scale, below - 5),
        *_named(sides, scale, middle),
    ]
    section = tag("g", "".join(parts), transform=place)
    return picture(WIDTH, below + 8, f"section of {engine.name}", section, *names)


def _named(sides: dict[str, dict[str, float]], scale: float, middle: float) -> list[str]:
    """Names of parts in a row above a drawing, each with a line to its part."""
    # Those of a chamber on a side that has one, the others on the side across.
    gas, bare = ("left", "right") if sides["left"]["bore"] else ("right", "left")
    mm, sign, across, away = sides[gas], SIDES[gas], sides[bare], SIDES[bare]
    foot = mm["crown"] - 0.5e3 * formulas.SKIRT_LENGTH
    mover = 0.25 * (mm["mover_outer_diameter"] + mm["mover_inner_diameter"])
    coil, rod = 0.25 * mm["mover_inner_diameter"], 0.25 * mm["rod_diameter"]
    points = {
        "head": (sign * (mm["head"] + 0.5 * WALL), 0.5 * mm["bore"]),
        "piston": (sign * foot, 0.3 * mm["bore"]),
        "ports": (sign * (mm["port"] - 0.5 * WALL), 0.5 * mm["bore"] + 0.5 * WALL),
        "mover": (0.0, mover),
        "spring": (away * 0.5 * (across["mover_end"] + across["bearing"]), coil),
        "bearing": (away * (across["bearing"] + 0.5 * WALL), coil),
        "rod": (away * 0.5 * (across["bearing"] + across["crown"]), rod),
    }
    known = {name: at for name, at in points.items() if not math.isnan(at[0])}
    names, found = sorted(known, key=lambda name: known[name][0]), []
    for place, name in enumerate(names):
        x = WIDTH * (place + 0.5) / len(names)
        to = 0.5 * WIDTH + scale * known[name][0], middle - scale * known[name][1]
        found.append(text(x, TEXT, name, text_anchor="middle", font_size=TEXT))
        found.append(path([(x, TEXT + 4.0), to], stroke="currentColor", stroke_width=0.9))
        found.append(tag("circle", cx=to[0], cy=to[1], r=2.0))
    return found


def _side(side: str, mm: dict[str, float]) -> list[str]:
    """Head, liner with its ports, bearing, spring, rod and piston of one side."""
    sign, radius, rod = SIDES[side], 0.5 * mm["bore"], 0.5 * mm["rod_diameter"]
    wall: dict[str, Any] = {"fill": "currentColor", "fill_opacity": 0.45}
    coil = _coil(sign, mm)
    if radius == 0.0:  # an open end
        rest = _box(sign, 0.0, mm["crown"], -rod, rod, fill="currentColor", fill_opacity=0.6)
        return [*_bearing(sign, mm, 3.0 * rod, wall), *coil, rest]
    parts = [_box(sign, mm["head"], mm["head"] + WALL, -radius - WALL, radius + WALL, **wall)]
    ported = not math.isnan(mm["port"])
    opens = mm["port"] if ported else mm["bearing"]
    gap = min(0.06 * mm["head"], 3.0 * WALL) if ported else 0.0
    for y in (radius, -radius - WALL):
        parts.append(_box(sign, opens, mm["head"], y, y + WALL, **wall))
        parts.append(_box(sign, min(mm["bearing"], opens - gap), opens - gap, y, y + WALL, **wall))
    parts += [*_bearing(sign, mm, radius, wall), *coil]
    foot = mm["crown"] - 1e3 * formulas.SKIRT_LENGTH
    parts.append(_box(sign, 0.0, foot, -rod, rod, fill="currentColor", fill_opacity=0.6))
    piston = _box(sign, foot, mm["crown"], -radius, radius, fill=_COLOURS[side])
    return [*parts, tag("g", tag("title", f"{side} piston") + piston)]


def _bearing(sign: float, mm: dict[str, float], radius: float, wall: dict[str, Any]) -> list[str]:
    """Wall the rod passes through, above and below it, which holds the spring."""
    rod, start = 0.5 * mm["rod_diameter"], mm["bearing"]
    return [
        _box(sign, start, start + WALL, y, y + radius + WALL - rod, **wall)
        for y in (rod, -radius - WALL)
    ]


def _coil(sign: float, mm: dict[str, float]) -> list[str]:
    """A spring between the mover and the bearing, above and below the rod."""
    rod = 0.5 * mm["rod_diameter"]
    x = sign * np.linspace(mm["mover_end"], mm["bearing"], 2 * TURNS + 1)
    outer = max(0.4 * (mm["bore"] or mm["mover_outer_diameter"]), rod + 3.0)
    y = np.where(np.arange(len(x)) % 2, outer, rod + 1.5)
    return [
        path(zip(x, way * y, strict=True), stroke=YELLOW, stroke_width=1.2) for way in (1.0, -1.0)
    ]


def _mover(mm: dict[str, float]) -> list[str]:
    """Hollow mover of the alternator, cut open, with the web that carries it."""
    outer, inner = 0.5 * mm["mover_outer_diameter"], 0.5 * mm["mover_inner_diameter"]
    end = mm["mover_end"]
    parts = [_box(1.0, -end, end, y, y + outer - inner, fill=GREEN) for y in (inner, -outer)]
    return [*parts, _box(1.0, -0.5 * WALL, 0.5 * WALL, -inner, inner, fill=GREEN)]


def _box(sign: float, start: float, end: float, low: float, high: float, **look: Any) -> str:
    """A rectangle between two distances from the midpoint on one side [mm]."""
    x = min(sign * start, sign * end)
    return tag("rect", x=x, y=low, width=abs(end - start), height=high - low, **look)


def _name(engine: Engine, side: str) -> str:
    kind = type(getattr(engine, side)).__name__
    words = "".join(f" {sign.lower()}" if sign.isupper() else sign for sign in kind)
    return f"{side}{words}"


def _rule(scale: float, y: float) -> list[str]:
    """A bar with its length, to read lengths by."""
    length = next(
        step for step in (500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 1.0) if step * scale < 160.0
    )
    x = 0.5 * (WIDTH - length * scale) - 25.0
    bar = path([(x, y), (x + length * scale, y)], stroke="currentColor", stroke_width=2)
    return [bar, text(x + length * scale + 6, y + 5, f"{length:g} mm", font_size=TEXT)]
