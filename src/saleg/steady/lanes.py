"""Searches for the fixed points of many engines side by side."""

from __future__ import annotations

import numpy as np

from saleg.compiler.compiled_engine import compiled_engine, kernel_of_lanes
from saleg.compiler.lanes.group import address_of_steps, group_of
from saleg.kernel.lanes.search import Lanes
from saleg.kernel.orbits import Searches
from saleg.kernel.tuples import Iterates
from saleg.steady.return_map import ReturnMap, iterates_from


def find_side_by_side(
    return_map: ReturnMap, max_maps: int, tolerance: float, searches: Searches, width: int
) -> None:
    """Look for the fixed points of many engines of the same laws, so many of them at once."""
    mapping = return_map.mapping
    group = group_of(mapping.integration, mapping.address, width)
    laws = compiled_engine(return_map.engine).parameters
    steps = address_of_steps(kernel_of_lanes(return_map.engine, width), group, laws)
    iterates = Iterates(*(np.repeat(part[np.newaxis], width, axis=0) for part in iterates_from()))
    lanes = Lanes(group, steps, iterates, np.full(width, -1))
    arguments = (lanes, mapping.mirrored, max_maps, tolerance, searches)
    return_map.kernel.call("find_orbits_side_by_side", *arguments)
