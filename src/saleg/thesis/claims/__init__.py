"""What the dissertation says of every figure that holds data, beside what saleg finds.

Examples
--------
>>> from saleg.thesis import claims
>>> shown = claims.of(13)
>>> found = shown.claims[0].ours(claims.data(shown))
>>> found < 1e-9
True
"""

from __future__ import annotations

from typing import Any

from saleg.thesis.claims import chapter_2, chapter_3, chapter_4, chapter_5
from saleg.thesis.claims.claim import Claim, Shown
from saleg.thesis.figures import FIGURES

__all__ = ["LONG", "SHOWN", "Claim", "Shown", "data", "of"]

#: All that is shown, in the order of the figures.
SHOWN: tuple[Shown, ...] = tuple(
    sorted(
        (*chapter_2.SHOWN, *chapter_3.SHOWN, *chapter_4.SHOWN, *chapter_5.SHOWN),
        key=lambda shown: shown.figures[0],
    )
)
#: Figures whose data take more than some seconds, kernels compiled.
LONG = (44, 45, 50, 86, 87, 88, 89, 90, 91)


def of(number: int) -> Shown:
    """What is said of a figure.

    Parameters
    ----------
    number : int
        Number of a figure that holds data.

    Returns
    -------
    Shown
    """
    return next(shown for shown in SHOWN if number in shown.figures)


def data(shown: Shown) -> Any:
    """What figures show.

    Parameters
    ----------
    shown : Shown

    Returns
    -------
    Any
        What :data:`saleg.thesis.figures.FIGURES` runs for them.
    """
    return FIGURES[shown.figures[0]].run()
