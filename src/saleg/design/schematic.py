"""Dimensions of any engine for a drawing of it: cylinders to scale, all else schematic."""

from __future__ import annotations

import math

from saleg.design import formulas
from saleg.engine import Engine, GasChamber

#: Direction of either side from the midpoint.
SIDES = {"left": -1.0, "right": 1.0}


def dimensions(engine: Engine, side: str) -> dict[str, float]:
    """Dimensions of one side of an engine for the drawing [mm].

    Bore, clearances and ports are the engine's; rod, mover and the room between are such that all
    of it has space to move.

    Parameters
    ----------
    engine : Engine
    side : str
        "left" or "right".

    Returns
    -------
    dict of str to float
        Named as in :class:`saleg.design.geometry.Geometry`; of an open end, where there is neither
        piston nor head, the rod ends at ``crown`` and ``bore`` is 0.
    """
    chamber = getattr(engine, side)
    chambers = [part for part in engine.chambers if isinstance(part, GasChamber)]
    reach = 1e3 * max(part.half_stroke for part in chambers)
    bore = 1e3 * max(part.bore for part in chambers)
    mover_end = 0.7 * reach
    bearing = mover_end + reach
    crown = bearing + reach + 1e3 * (formulas.crown_position(0.0))
    head = crown + 1e3 * chamber.half_stroke
    if not isinstance(chamber, GasChamber):
        head = crown
    return {
        "bore": 1e3 * getattr(chamber, "bore", 0.0),
        "rod_diameter": 0.25 * bore,
        "mover_end": mover_end,
        "mover_outer_diameter": 1.15 * bore,
        "mover_inner_diameter": 0.75 * bore,
        "bearing": bearing,
        "port": head - 1e3 * getattr(chamber, "port_closing", math.nan),
        "crown": crown,
        "head": head,
    }
