"""Parts of an engine as a section drawn to scale; springs and walls are schematic.

Dimensions come as a dictionary in mm, named as in :class:`saleg.design.geometry.Geometry`; a side
is -1 (left) or 1 (right). Parts that move take the displacement of the translator [mm] and return
what was drawn.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design import formulas
from saleg.plotting.style import (
    ALTERNATOR_COLOUR,
    LEFT_COLOUR,
    SPRING_COLOUR,
    TRANSLATOR_COLOUR,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

#: Thickness of walls [mm], turns of a spring, and depth of a bearing [mm].
WALL, TURNS, BEARING = 4.0, 9, 6.0
HOUSING = "0.55"


def box(ax: Axes, x: float, y: float, width: float, height: float, **look: Any) -> Artist:
    """A rectangle from a corner on [mm]; width and height may be negative."""
    from matplotlib.patches import Rectangle

    return ax.add_patch(Rectangle((x, y), width, height, **look))


def housing(ax: Axes, mm: dict[str, float], side: float) -> None:
    """Head, liner with its ports, and bearing of one side; no ports where ``port`` is NaN."""
    radius, look = 0.5 * mm["bore"], {"color": HOUSING, "linewidth": 0.0}
    rod = 0.5 * mm["rod_diameter"]
    if radius == 0.0:  # an open end has its bearing only
        radius = 3.0 * rod
        for y in (rod, -radius - WALL):
            box(ax, side * mm["bearing"], y, side * BEARING, radius + WALL - rod, **look)
        return
    box(ax, side * mm["head"], -radius - WALL, side * WALL, 2 * (radius + WALL), **look)
    width = min(0.06 * mm["head"], 3 * WALL)
    ported = not math.isnan(mm["port"])
    port = mm["port"] if ported else mm["bearing"]
    inner = min(mm["bearing"], port - width) if ported else port
    for y in (radius, -radius - WALL):
        box(ax, side * inner, y, side * (port - inner), WALL, **look)
        box(ax, side * port, y, side * (mm["head"] - port), WALL, **look)
        if ported:
            edge = side * (port - width)
            box(ax, edge, y, side * width, WALL, color="white", zorder=3)
            box(ax, edge, y, side * width, WALL, ec=HOUSING, fc="none", zorder=4)
    for y in (rod, -radius - WALL):
        box(ax, side * mm["bearing"], y, side * BEARING, radius + WALL - rod, **look)


def springs(ax: Axes, mm: dict[str, float], side: float, shift: float = 0.0) -> list[Artist]:
    """A spring between the mover and the bearing, above and below the rod."""
    x = np.linspace(side * mm["mover_end"] + shift, side * mm["bearing"], 2 * TURNS + 1)
    rod = 0.5 * mm["rod_diameter"]
    outer = max(0.4 * (mm["bore"] or mm["mover_outer_diameter"]), rod + 3.0)
    y = np.where(np.arange(len(x)) % 2, outer, rod + 1.5)
    look: dict[str, Any] = {"color": SPRING_COLOUR, "linewidth": 1.2, "zorder": 1}
    return [ax.plot(x, sign * y, **look)[0] for sign in (-1.0, 1.0)]


def piston(
    ax: Axes, mm: dict[str, float], side: float, shift: float = 0.0, colour: str = LEFT_COLOUR
) -> list[Artist]:
    """Rod and piston of one side."""
    rod, radius = 0.5 * mm["rod_diameter"], 0.5 * mm["bore"]
    skirt = 1e3 * formulas.SKIRT_LENGTH
    look: dict[str, Any] = {"fc": colour, "ec": TRANSLATOR_COLOUR, "linewidth": 0.6, "zorder": 2}
    if radius == 0.0:
        return [box(ax, shift, -rod, side * mm["crown"], 2 * rod, **look)]
    foot = side * (mm["crown"] - skirt)
    return [
        box(ax, shift, -rod, foot, 2 * rod, **look),
        box(ax, shift + foot, -radius, side * skirt, 2 * radius, **look),
    ]


def mover(ax: Axes, mm: dict[str, float], shift: float = 0.0) -> list[Artist]:
    """Hollow mover of the alternator, cut open, with the web that carries it."""
    outer, inner = 0.5 * mm["mover_outer_diameter"], 0.5 * mm["mover_inner_diameter"]
    length, web = 2.0 * mm["mover_end"], 0.5 * WALL
    look: dict[str, Any] = {"fc": ALTERNATOR_COLOUR, "ec": TRANSLATOR_COLOUR, "linewidth": 0.6}
    return [
        box(ax, shift - mm["mover_end"], inner, length, outer - inner, zorder=2, **look),
        box(ax, shift - mm["mover_end"], -outer, length, outer - inner, zorder=2, **look),
        box(ax, shift - web, -inner, 2 * web, 2 * inner, zorder=1, **look),
    ]
