"""Every figure of the dissertation that holds data, by its number.

Examples
--------
>>> from saleg.thesis.figures import FIGURES
>>> figure = FIGURES[10]
>>> ax = figure.draw(figure.run())
>>> ax.figure.savefig("figure_10.png")  # doctest: +SKIP
"""

from __future__ import annotations

from saleg.thesis import appendix_c, chapter_2, chapter_3, chapter_4, optimisation, prototypes
from saleg.thesis.chapter_5 import figures as chapter_5
from saleg.thesis.figure import Figure

#: Figures by their number: what gives the data, and what draws them.
FIGURES: dict[int, Figure] = {
    **chapter_2.CASES,
    **chapter_3.FIGURES,
    **prototypes.FIGURES,
    **chapter_4.FIGURES,
    **optimisation.FIGURES,
    **chapter_5.FIGURES,
    **appendix_c.FIGURES,
}
