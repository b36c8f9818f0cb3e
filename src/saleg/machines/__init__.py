"""Published machines, one module each."""

from collections.abc import Callable

from saleg.engine import Engine
from saleg.files.entry_points import offered
from saleg.machines import mikalsen_roskilly, milan, university_of_ulsan, west_virginia
from saleg.machines.mikalsen_roskilly import newcastle
from saleg.machines.milan import polimi
from saleg.machines.published import OpenQuantity, Published, PublishedMachine
from saleg.machines.thesis import thesis_base, thesis_transient
from saleg.machines.university_of_ulsan import ulsan
from saleg.machines.west_virginia import wvu

__all__ = [
    "CATALOGUE",
    "PUBLISHED",
    "OpenQuantity",
    "Published",
    "PublishedMachine",
    "catalogue",
    "newcastle",
    "polimi",
    "thesis_base",
    "thesis_transient",
    "ulsan",
    "wvu",
]

#: Machines of others by name: what their sources give, leave open, and found.
PUBLISHED: dict[str, PublishedMachine] = {
    module.MACHINE.name: module.MACHINE
    for module in (university_of_ulsan, west_virginia, milan, mikalsen_roskilly)
}

#: Machines of the library by the name the command line uses.
CATALOGUE: dict[str, Callable[[], Engine]] = {
    "thesis-base": thesis_base,
    "thesis-transient": thesis_transient,
    **{name: machine.engine for name, machine in PUBLISHED.items()},
}


def catalogue() -> dict[str, Callable[[], Engine]]:
    """Machines by name: those of the library, and those other installed packages offer.

    A package offers a function that returns an :class:`saleg.Engine` as an entry point of the group
    ``saleg.machines``. None takes the name of one of ours.

    Returns
    -------
    dict of str to callable
    """
    return {**offered("saleg.machines"), **CATALOGUE}
