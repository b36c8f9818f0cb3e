"""Section 4.3: the score of Figure 85, Tables 9 to 12 under it, and the designs it leads to.

Examples
--------
>>> from saleg.thesis import optimisation
>>> scores = optimisation.rescored()
>>> scores.idxmax(axis=1).to_dict()
{'3-3-2-1-1': 'A', '1-1-1-1-1': 'B', '2-2-2-1-1': 'B', '1-1-1-3-3': 'B'}
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from saleg import optimize
from saleg.optimize import Found, Problem, Score
from saleg.plotting import optimisation as figures
from saleg.plotting.scores import score_terms
from saleg.thesis import chapter_4
from saleg.thesis.tables import columns

if TYPE_CHECKING:
    import pandas as pd

#: Target powers of Table 9 by its headings [W].
TARGETS = {name: 1e3 * float(name.split()[0]) for name in columns(9)}
#: Range of the compression ratio by table: Table 9 has the wide one of Figure 85.
RATIOS = {9: (5.0, 35.0), 10: (5.0, 25.0), 11: (5.0, 25.0), 12: (5.0, 35.0)}
#: Target power of the figures and of Table 11 [W].
FOUR = 4e3
#: Lowest intake temperature of Table 9, that of the script [K].
COLDEST = 250.0
#: The two designs of Table 11, as the first set of weights ranks them.
DESIGNS = {"A": "3-3-2-1-1_best", "B": "3-3-2-1-1_second"}
#: Order of the weights in the headings of Table 11.
WEIGHED = ("efficiency", "stability", "power", "compression_ratio", "peak_pressure")
#: Axes of the design maps: x, y, z.
MAPS = {
    87: ("stroke_to_bore", "compression_ratio", "efficiency"),
    88: ("stroke_to_bore", "frequency", "power_density"),
    89: ("equivalence_ratio", "intake_temperature", "compression_ratio"),
    90: ("equivalence_ratio", "efficiency", "peak_pressure"),
    91: ("intake_temperature", "frequency", "power"),
}


def problem(number: int = 9, target_power: float | None = FOUR) -> Problem:
    """Problem of Table 9, 10, 11 or 12.

    Parameters
    ----------
    number : int
        Table 12 has no target power, Table 9 an intake as cold as 250 K.
    target_power : float, optional
        Power [W].
    """
    bounds = {"intake_temperature": (COLDEST, 1000.0), "equivalence_ratio": (0.2, 1.0)}
    target = None if number == 12 else target_power
    return optimize.thesis_problem(target, RATIOS[number], bounds if number == 9 else None)


def printed_scores(number: int = 9) -> pd.DataFrame:
    """Scores of the designs of a table: as printed, and as saleg evaluates them.

    Parameters
    ----------
    number : int
        9, 10 or 12.

    Returns
    -------
    DataFrame
        One row per design; columns ``printed`` and ``computed`` [-].
    """
    import pandas as pd

    ours, theirs = chapter_4.run(number), chapter_4.printed(number)
    found = {}
    for name in theirs.index:
        of = problem(number, TARGETS.get(str(name), FOUR))
        found[name] = [
            float(optimize.score(table.loc[[name]], of).iloc[0]) for table in (theirs, ours)
        ]
    return pd.DataFrame.from_dict(found, orient="index", columns=["printed", "computed"])


def rescored() -> pd.DataFrame:
    """Scores of both designs of Table 11, as printed, under its four sets of weights.

    Returns
    -------
    DataFrame
        One row per set of weights, one column per design [-].
    """
    import pandas as pd

    designs = chapter_4.printed(11).loc[list(DESIGNS.values())].set_axis(list(DESIGNS))
    low, high = RATIOS[11]
    scores = {}
    for heading in dict.fromkeys(name.partition("_")[0] for name in columns(11)):
        weights = dict(zip(WEIGHED, map(float, heading.split("-")), strict=True))
        limits = {"least_compression_ratio": low, "greatest_compression_ratio": high}
        score = Score(target_power=FOUR, **limits, **weights)
        scores[heading] = optimize.score(designs, score)
    return pd.DataFrame(scores).T


def optimised(number: int = 10, target_power: float = FOUR, **settings: Any) -> Found:
    """Optimisation of the problem of a table.

    Parameters
    ----------
    number, target_power
        As for :func:`problem`.
    **settings
        As for :func:`saleg.optimize.optimize`; 2000 designs by its default method unless given.
    """
    return optimize.optimize(problem(number, target_power), **settings)


class Figure(NamedTuple):
    """Figure of the section.

    Attributes
    ----------
    run : callable
        Gives what is drawn.
    draw : callable
        Draws it, on axes handed in or on new ones.
    """

    run: Callable[..., Any]
    draw: Callable[..., Any]


#: Figures by their number. Those of an optimisation may share one: run it once, draw it often.
FIGURES = {
    85: Figure(partial(Score, target_power=FOUR), score_terms),
    86: Figure(optimised, figures.convergence),
    **{
        number: Figure(optimised, partial(figures.design_map, x=x, y=y, z=z))
        for number, (x, y, z) in MAPS.items()
    },
}
