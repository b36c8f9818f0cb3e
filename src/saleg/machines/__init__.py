"""Published machines, one module each."""

from collections.abc import Callable

from saleg.engine import Engine
from saleg.files.entry_points import offered
from saleg.machines.thesis import thesis_base, thesis_transient

__all__ = ["CATALOGUE", "catalogue", "thesis_base", "thesis_transient"]

#: Machines of the library by the name the command line uses.
CATALOGUE: dict[str, Callable[[], Engine]] = {
    "thesis-base": thesis_base,
    "thesis-transient": thesis_transient,
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
