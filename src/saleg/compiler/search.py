"""The search for fixed points of the return map, compiled once for all laws.

It knows the integrator by its address and the numbers of the laws as numbers: what record they
form, and so which laws they are of, is the integrator's affair.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from saleg.compiler import machine_code, plain
from saleg.compiler.kernel import Kernel
from saleg.compiler.module import load
from saleg.compiler.text import INTEGRATOR, INTEGRATOR_WITH_SEARCH, compose_search

if TYPE_CHECKING:
    from saleg.kernel.tuples import Integration


class CompiledSearch(NamedTuple):
    """The search for fixed points as it is called for one engine.

    Attributes
    ----------
    kernel : Kernel
        With the entry point ``do_orbit``.
    integration : Integration
        Arguments of the integrator, as the search hands them on.
    address : int
        Address of the integrator; 0 where it is called by name.
    """

    kernel: Kernel
    integration: Integration
    address: int


def modules() -> tuple[str, ...]:
    """Modules of a kernel with the integrator that a search calls."""
    return INTEGRATOR if stands_alone() else INTEGRATOR_WITH_SEARCH


def compiled_search(integrator: Kernel, arguments: Integration) -> CompiledSearch:
    """Search that calls the integrator of an engine.

    Parameters
    ----------
    integrator : Kernel
        Kernel of its laws, of :func:`modules`.
    arguments : Integration
        Arguments of the integrator.
    """
    if not stands_alone():
        return CompiledSearch(integrator, arguments, 0)
    address = integrator.address("run_on", (arguments,))
    numbers = arguments.laws.view(np.float64)
    return CompiledSearch(_search(), arguments._replace(laws=numbers), address)


def stands_alone() -> bool:
    """Whether the integrator can be called by its address."""
    return machine_code.has_addresses() and not plain.is_wanted()


@lru_cache(maxsize=1)
def _search() -> Kernel:
    """Kernel of the search."""
    return Kernel(*load(compose_search(), "search"))
