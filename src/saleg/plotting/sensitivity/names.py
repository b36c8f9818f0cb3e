"""Names and colours of what a study varies and shows."""

from __future__ import annotations

from saleg.simulation.performance import FIGURES, Figure
from saleg.simulation.readable import readable

#: What can be drawn of a table, by column.
SHOWN = {
    **FIGURES,
    "power": Figure("W", "electrical power"),
    "heat_transfer": Figure("J", readable("heat_transfer", "J").words),
    "heat_transfer_share": Figure("-", "heat to the walls", note="of fuel energy"),
    "friction_share": Figure("-", "friction", note="of fuel energy"),
}
#: Colours of cases with names (Okabe and Ito, safe for the colour-blind).
NAMED = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


def label_of(figure: str) -> tuple[str, float]:
    """Label of a figure of a study with its unit, and the factor from SI."""
    unit, words, _, note = SHOWN[figure]
    shown = readable(figure, unit)
    return f"{words.strip()} [{f'{shown.unit} {note}'.strip()}]", shown.factor


def words_of(path: str) -> str:
    """The last part of a dotted path, in words."""
    return path.rpartition(".")[2].replace("_", " ")
