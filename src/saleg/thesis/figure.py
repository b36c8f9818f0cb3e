"""Figure of the dissertation: what gives its data, and what draws it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple


class Figure(NamedTuple):
    """Figure of the dissertation.

    Attributes
    ----------
    run : callable
        Gives what is drawn.
    draw : callable
        Draws it, on axes handed in or on new ones.
    """

    run: Callable[..., Any]
    draw: Callable[..., Any]
