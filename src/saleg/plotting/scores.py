"""Figure of a score: the curve of each of its terms (Figure 85)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.errors import SalegError
from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label
from saleg.plotting.style import LEFT_COLOUR, finish, panels_or_new
from saleg.quantities import is_number
from saleg.simulation.performance import UNITS
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    from saleg.design.terms import Term
    from saleg.plotting.figure import Panels

#: Fields of terms that are values of their figure, and those that are lengths along it.
PLACES, LENGTHS = ("target", "limit", "low", "high"), ("tolerance", "width")
#: Where curves without such fields are drawn.
UNIT_INTERVAL = (0.0, 1.0)


@documented()
def score_terms(score: Any, ax: Any = None) -> Panels:
    """Draw what each term of a score earns over its figure (Figure 85).

    Parameters
    ----------
    score : Score or WeightedScore
    ax : array of matplotlib.axes.Axes, optional
        One for each term; new ones unless given.

    Returns
    -------
    Panels

    Raises
    ------
    SalegError
        If the score has no terms, as a function of one's own.
    """
    terms = getattr(score, "terms", None)
    if not terms:
        raise SalegError(f"{score!r} has no terms to draw: use Score or WeightedScore")
    columns = min(len(terms), 3)
    rows = math.ceil(len(terms) / columns)
    panels = panels_or_new(ax, (rows, columns), 3.4 * columns, 2.7 * rows, len(terms))
    for panel, (weight, term) in zip(panels, terms, strict=True):
        shown = readable(term.figure, UNITS.get(term.figure, "-"))
        at = np.linspace(*_ends(term), 401)
        panel.plot(shown.of(at), term.curve(at), color=LEFT_COLOUR)
        panel.fill_between(shown.of(at), term.curve(at), color=LEFT_COLOUR, alpha=0.12, linewidth=0)
        panel.set_xlabel(axis_label(shown))
        panel.set_ylim(0.0, 1.08)
        panel.margins(x=0.0)
        finish(panel, f"weight {weight:g}", None)
    for first in panels[::columns]:
        first.set_ylabel("earns [-]")
    return panels


def _ends(term: Term) -> tuple[float, float]:
    """Where a curve is drawn: a little beyond all that its fields name."""
    inner = getattr(term, "term", term)
    places, lengths = _numbers(inner, PLACES), _numbers(inner, LENGTHS)
    if not places and not lengths:
        return UNIT_INTERVAL
    low, high = min(places, default=0.0), max(places, default=0.0)
    room = 2.5 * max(lengths, default=0.4 * (high - low) or high)
    return max(low - room, 0.0) if low >= 0.0 else low - room, high + room


def _numbers(term: Any, names: tuple[str, ...]) -> list[float]:
    """Those fields of a term that are numbers."""
    held: list[Any] = [getattr(term, name, None) for name in names]
    return [float(value) for value in held if is_number(value)]
