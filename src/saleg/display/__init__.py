"""Results as cards that a notebook's cell shows: key figures with units and a small picture.

A card is HTML with SVG of its own making: no script, no figure library, nothing loaded. Text and
lines have the colour of the page around it, so it is read in light and dark themes. Results offer
their cards as ``_repr_html_``; cards only read.
"""

from saleg.display.cards import (
    balance_card,
    engine_card,
    performance_card,
    run_card,
    stability_card,
    steady_card,
)
from saleg.display.design_cards import (
    branch_card,
    design_card,
    designed_card,
    found_card,
    indices_card,
)
from saleg.display.tables import table_card

__all__ = [
    "balance_card",
    "branch_card",
    "design_card",
    "designed_card",
    "engine_card",
    "found_card",
    "indices_card",
    "performance_card",
    "run_card",
    "stability_card",
    "steady_card",
    "table_card",
]
