"""What other installed packages offer, by entry points."""

from __future__ import annotations

import warnings
from functools import lru_cache
from importlib.metadata import entry_points
from typing import Any

from saleg.errors import SalegWarning


@lru_cache(maxsize=8)
def offered(group: str) -> dict[str, Any]:
    """Objects other packages offer in a group, by name; what cannot be loaded is warned of once.

    Parameters
    ----------
    group : str
        "saleg.laws" or "saleg.machines".

    Returns
    -------
    dict of str to object
    """
    found = {}
    for entry in entry_points(group=group):
        try:
            found[entry.name] = entry.load()
        except Exception as error:  # whatever somebody's module does when it is imported
            where = f"{entry.value} of {group}"
            warnings.warn(f"{where} cannot be loaded: {error}", SalegWarning, stacklevel=2)
    return found
