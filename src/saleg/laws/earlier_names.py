"""Earlier names of what laws are shown: a law written with them runs on, in Python and compiled.

In Python they are properties, and keywords that warn; when a law's text is composed its attributes
are renamed (:mod:`saleg.compiler.source`). Methods are renamed by ``Law.earlier_names``.
"""

from __future__ import annotations

import functools
import warnings
from operator import attrgetter
from typing import Any

from saleg.laws.arguments import Gas

#: Fields of :class:`saleg.laws.Gas` by their earlier names.
ATTRIBUTES = {"height": "clearance", "height_rate": "clearance_rate"}


def accept_earlier_names() -> None:
    """Let a gas be read, and made, by the earlier names of its fields."""
    plain = Gas.__new__

    @functools.wraps(plain)
    def new(cls: type[Gas], *values: float, **named: float) -> Gas:
        for earlier in [name for name in ATTRIBUTES if name in named]:
            warnings.warn(
                f"Gas({earlier}=...) is called {ATTRIBUTES[earlier]} now",
                DeprecationWarning,
                stacklevel=2,
            )
            named[ATTRIBUTES[earlier]] = named.pop(earlier)
        return plain(cls, *values, **named)

    kind: Any = Gas
    kind.__new__ = new
    for earlier, name in ATTRIBUTES.items():
        setattr(kind, earlier, property(attrgetter(name), doc=f"Earlier name of `{name}`."))
