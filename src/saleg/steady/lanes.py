"""Searches for the fixed points of many engines side by side, where that pays.

Compiling a kernel for engines side by side takes some ten seconds of a processor. It is done once
engines of the same laws have been searched for, one after the other in this process, as long as
that (:data:`PATIENCE`); whoever has few engines never waits for it, and nobody waits more than
twice as long as with the better choice. A kernel found on disk is used at once.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
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

#: Time spent on engines one by one after which a kernel for engines side by side is compiled [s].
PATIENCE = 10.0
#: Engines a lane should have at least: the last of them leave lanes empty.
FEWEST_PER_LANE = 4


@dataclass
class Account:
    """What is known of a kernel for engines side by side.

    Attributes
    ----------
    spent : float
        Time spent on its engines one by one [s].
    refused : bool
        Whether a law cannot be compiled for engines side by side.
    """

    spent: float = 0.0
    refused: bool = False

    def pays(self, kernel: Kernel) -> bool:
        """Whether the kernel is there, or worth its compilation."""
        return not self.refused and (self.spent >= PATIENCE or kernel.is_kept("advance"))


@lru_cache(maxsize=128)
def account_of(kernel: Kernel) -> Account:
    """Account of a kernel for engines side by side."""
    return Account()


def find_each(
    return_map: ReturnMap, max_maps: int, tolerance: float, searches: Searches, width: int = WIDTH
) -> None:
    """Look for the fixed points of many engines of the same laws, side by side where that pays.

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
    width : int
        Engines side by side.

    Warns
    -----
    RuntimeWarning
        Once, if a law of the user's cannot be compiled for engines side by side.
    """
    kernel = kernel_of_lanes(return_map.engine, width)
    account = account_of(kernel)
    if len(searches.codes) >= FEWEST_PER_LANE * width and account.pays(kernel):
        try:
            lanes = lanes_of(return_map, kernel, width)
        except LawError as error:
            account.refused = True
            _say_one_by_one(return_map, str(error))
        else:
            arguments = (lanes, return_map.mirrored, max_maps, tolerance, searches)
            return_map.kernel.call("find_orbits_side_by_side", *arguments)
            return
    begun = time.thread_time()
    return_map.find_each(max_maps, tolerance, searches)
    account.spent += time.thread_time() - begun


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
            f"engines with {names} are searched for one by one: {reason}; an 'if' on what a law "
            "is shown can be written with saleg.laws.where",
            RuntimeWarning,
            stacklevel=2,
        )
