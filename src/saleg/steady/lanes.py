"""Searches for the fixed points of many engines side by side, where that pays.

It takes half to two thirds of the time and a kernel of its own, some ten seconds of a processor to
compile. So only batches of :data:`MANY` engines and more go that way, if that
kernel has been compiled before, and those of :data:`WORTH_COMPILING` in any case. What is found is
the same within the tolerance, not to the last bit: therefore the whole batch decides, so that
nothing depends on how it is cut. What must be the same on every machine to the last bit (an
optimisation, a sweep that is gone on with) does not ask what has been compiled before.
"""

from __future__ import annotations

import warnings
from functools import lru_cache

import numpy as np

from saleg.compiler.compiled_engine import compiled_engine, kernel_of_lanes
from saleg.compiler.kernel import Kernel
from saleg.compiler.lanes.group import address_of_steps, group_of
from saleg.compiler.lanes.width import WIDTH
from saleg.compiler.source import is_ours
from saleg.errors import LawError
from saleg.kernel.lanes.search import Lanes
from saleg.kernel.orbits import Searches
from saleg.kernel.tuples import Iterates
from saleg.steady.return_map import ReturnMap, iterates_from

#: Engines in a batch that are searched for side by side, if the kernel for that is there.
MANY = 500
#: Engines in a batch for which it is compiled.
WORTH_COMPILING = 20_000

#: In place of the number of engines in a batch: each from its own start, beside no other.
BY_ITSELF = 0
#: In place of that number, where it is not known: along lines, not side by side.
UNKNOWN = 1


def repeatable(total: int) -> int:
    """Number of engines in a batch whose results must not depend on what was compiled before."""
    return total if total >= WORTH_COMPILING else UNKNOWN


def find_each(
    return_map: ReturnMap,
    max_maps: int,
    tolerance: float,
    searches: Searches,
    total: int,
    width: int = WIDTH,
) -> None:
    """Look for the fixed points of engines of the same laws, side by side where that pays.

    Parameters
    ----------
    return_map : ReturnMap
        Of one of them.
    max_maps : int
        Maps each may take.
    tolerance : float
        Residual at a fixed point [-].
    searches : Searches
        The engines; takes what is found.
    total : int
        Number of engines in the batch they are a piece of, :data:`UNKNOWN` or :data:`BY_ITSELF`.
    width : int
        Engines side by side.

    Warns
    -----
    RuntimeWarning
        Once, if a law of the user's cannot be compiled for engines side by side.
    """
    lanes = None
    if total >= MANY:
        kernel = kernel_of_lanes(return_map.engine, width)
        if total >= WORTH_COMPILING or _was_there(kernel):
            lanes = _lanes_if_possible(return_map, kernel, width)
    if lanes is None:
        return_map.find_each(max_maps, tolerance, searches)
    else:
        arguments = (lanes, return_map.mirrored, max_maps, tolerance, searches)
        return_map.kernel.call("find_orbits_side_by_side", *arguments)


@lru_cache(maxsize=128)
def _was_there(kernel: Kernel) -> bool:
    """Whether a kernel had been compiled when this process first asked, and for good."""
    return kernel.is_kept("advance")


def _lanes_if_possible(return_map: ReturnMap, kernel: Kernel, width: int) -> Lanes | None:
    """Room for searches side by side; None if a law cannot be compiled for that."""
    if _refused(kernel):
        return None
    try:
        return lanes_of(return_map, kernel, width)
    except LawError as error:
        _refused(kernel).append(str(error))
        _say_one_by_one(return_map, str(error))
        return None


@lru_cache(maxsize=128)
def _refused(kernel: Kernel) -> list[str]:
    """Why a kernel cannot be compiled, once that is known."""
    return []


def lanes_of(return_map: ReturnMap, kernel: Kernel, width: int) -> Lanes:
    """Room for searches side by side, and what steps them, compiled if need be."""
    mapping = return_map.mapping
    group = group_of(mapping.integration, mapping.address, width)
    laws = compiled_engine(return_map.engine).parameters
    steps = address_of_steps(kernel, group, laws)
    iterates = Iterates(*(np.repeat(part[np.newaxis], width, axis=0) for part in iterates_from()))
    return Lanes(group, steps, iterates, np.full(width, -1))


def _say_one_by_one(return_map: ReturnMap, reason: str) -> None:
    """Say that a law of the user's keeps engines from being searched for side by side."""
    own = {type(law) for law in return_map.engine.laws.values() if not is_ours(type(law))}
    if own:
        names = ", ".join(sorted(law.__name__ for law in own))
        warnings.warn(
            f"engines with {names} are searched for one by one: {reason}; the documentation of own "
            "laws lists what can be compiled for several engines at once (saleg.laws.where in "
            "place of an 'if' on what a law is shown)",
            RuntimeWarning,
            stacklevel=2,
        )
