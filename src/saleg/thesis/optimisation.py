"""Section 4.3: the score of Figure 85, Tables 9 to 12 under it, and the designs it leads to.

Examples
--------
>>> from saleg.thesis import optimisation
>>> scores = optimisation.rescored()
>>> scores.idxmax(axis=1).to_dict()
{'3-3-2-1-1': 'A', '1-1-1-1-1': 'B', '2-2-2-1-1': 'B', '1-1-1-3-3': 'B'}
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg import optimize
from saleg.optimize import NSGA2, Found, Limit, Objective, Problem, Score
from saleg.plotting import optimisation as figures
from saleg.plotting import sweeps
from saleg.plotting.scores import score_terms
from saleg.thesis import chapter_4
from saleg.thesis.figure import Figure
from saleg.thesis.tables import columns

if TYPE_CHECKING:
    import pandas as pd

#: Target powers of Table 9 by its headings [W].
TARGETS = {name: 1e3 * float(name.split()[0]) for name in columns(9)}
#: Range of the compression ratio by table: Table 9 has the wide one of Figure 85.
RATIOS = {9: (5.0, 35.0), 10: (5.0, 25.0), 11: (5.0, 25.0), 12: (5.0, 35.0)}
#: Target power of the figures and of Table 11 [W].
FOUR = 4e3
#: Bounds of Tables 9 and 10 where they are those of the script: designs of both lie at 250 K, and
#: of Table 10 at 0.9 bar and an equivalence ratio of 0.2, too.
WIDE = {
    name: optimize.SCRIPT_BOX[name]
    for name in ("intake_pressure", "intake_temperature", "equivalence_ratio")
}
#: Score at which the thesis ends its searches.
STOP = 0.999
#: Range of power of the designs in the front at 4 kW: of the printed ones, as saleg evaluates them,
#: the weakest has 3.5 kW, and none is to be beaten by a larger machine [W].
FRONT_POWER = (3.5e3, 4.5e3)
#: Powers between which designs are counted [W].
POWERS = (1e3, 2e3, 4e3, 8e3, 16e3, 32e3)
#: The two designs of Table 11, as the first set of weights ranks them.
DESIGNS = {"A": "3-3-2-1-1_best", "B": "3-3-2-1-1_second"}
#: Order of the weights in the headings of Table 11.
WEIGHED = ("efficiency", "stability", "power", "compression_ratio", "peak_pressure")
#: Compression ratio and power [W] of designs beyond which design maps do not show them.
HIGHEST, MOST = 60.0, 20e3
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
        Tables 9 and 10 have the wide bounds of the intake, Tables 11 and 12 those from 300 K, 1 bar
        and an equivalence ratio of 0.35 on. Table 12 has no target power.
    target_power : float, optional
        Power [W].
    """
    target = None if number == 12 else target_power
    return optimize.thesis_problem(target, RATIOS[number], WIDE if number in (9, 10) else None)


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


def optimised(number: int = 11, target_power: float = FOUR, **settings: Any) -> Found:
    """Optimisation of the problem of a table.

    Parameters
    ----------
    number, target_power
        As for :func:`problem`.
    **settings
        As for :func:`saleg.optimize.optimize`; 2000 designs by its default method unless given.
    """
    return optimize.optimize(problem(number, target_power), **settings)


def targets(number: int = 9, names: Iterable[str] = TARGETS, **settings: Any) -> pd.DataFrame:
    """Best design for each target power of Table 9 or 10, beside that of the dissertation.

    Parameters
    ----------
    number : int
        9 or 10.
    names : iterable of str
        Headings of the table; all unless given.
    **settings
        As for :func:`saleg.optimize.optimize`.

    Returns
    -------
    DataFrame
        One row per target: figures of the best design, ``designs`` evaluated up to a score of
        0.999, and ``thesis_score``, that of the printed design as saleg evaluates it.
    """
    import pandas as pd

    rows = {}
    for name in names:
        found = optimised(number, TARGETS[name], **{"stop_at": STOP, **settings})
        best = found.best
        figures = {key: best[key] for key in ("score", "stable", "efficiency", "power")}
        rows[name] = {"designs": len(found.table), **figures}
    table = pd.DataFrame.from_dict(rows, orient="index")
    return table.assign(thesis_score=printed_scores(number)["computed"])


def in_two_stages(
    given: Problem, goal: str = "efficiency", evaluations: int = 2000, **settings: Any
) -> tuple[Found, Found]:
    """Half of some designs for a score of 0.999, the others for a figure within its limits.

    Parameters
    ----------
    given : Problem
    goal : str
        Figure to maximise.
    evaluations : int
    **settings
        As for :func:`saleg.optimize.optimize`.

    Returns
    -------
    (Found, Found)
        Of the score, and of the figure.
    """
    half = evaluations // 2
    found = optimize.optimize(given, evaluations=half, stop_at=STOP, **settings)
    return found, optimize.improve(found, goal, evaluations=half, **settings)


def front(number: int = 11, evaluations: int = 5000, **settings: Any) -> Found:
    """Front of efficiency and power density at 4 kW, under the limits of a table.

    Its ends are sought one by one, then NSGA-II fills what lies between them.

    Parameters
    ----------
    number : int
        9, 10 or 11.
    evaluations : int
        Designs in all.
    **settings
        As for :func:`saleg.optimize.optimize`.
    """
    import pandas as pd

    of = problem(number)
    names, share = ("efficiency", "power_density"), evaluations // 5
    least, greatest = RATIOS[number]
    others = Score(least_compression_ratio=least, greatest_compression_ratio=greatest).limits
    limits = (*others, Limit("power", *FRONT_POWER))
    both = of.replace(objectives=tuple(map(Objective, names)), constraints=limits)
    ends = [end for name in names for end in in_two_stages(of, name, 2 * share, **settings)]
    start = pd.concat([optimize.winners(end, both) for end in ends])
    return optimize.optimize(both, NSGA2(), evaluations - 4 * share, start=start, **settings)


def beaten(found: Found, designs: pd.DataFrame) -> pd.DataFrame:
    """Designs of a front that are at least as good as others in all objectives.

    Parameters
    ----------
    found : Found
    designs : DataFrame
        One row per design, with the figures that are the objectives.

    Returns
    -------
    DataFrame
        Rows of the front by the names of the designs: for each one of those that dominate it,
        that with the greatest least gain over its figures. A design nothing dominates has no row.
    """
    import pandas as pd

    kept = {}
    figures = [objective.figure for objective in found.problem.objectives]
    for name, row in designs.iterrows():
        gains = (found.front[figures] / row[figures].astype(float)).min(axis=1)
        if gains.max() >= 1.0:
            kept[name] = found.front.iloc[int(gains.argmax())]
    return pd.DataFrame.from_dict(kept, orient="index")


def along(
    figure: str, edges: Iterable[float], number: int = 11, goal: str = "efficiency", **settings: Any
) -> pd.DataFrame:
    """Best 4 kW designs between two values of a figure each: what is favoured, searched for.

    Parameters
    ----------
    figure : str
        Parameter or figure of a row, such as ``"intake_temperature"``.
    edges : iterable of float
        Values (SI) in rising order.
    number : int
        Table whose limits hold.
    goal : str
        Figure to maximise after the score.
    **settings
        As for :func:`in_two_stages`.

    Returns
    -------
    DataFrame
        One row per range: the row of the best design, with the ``best_score`` of the range; NaN
        where none was found within the limits.
    """
    import pandas as pd

    rows = []
    for low, high in itertools.pairwise(edges):
        within = problem(number).replace(constraints=(Limit(figure, low, high),))
        found, better = in_two_stages(within, goal, **settings)
        best = better.best if better.succeeded else {}
        score = found.best["score"] if found.succeeded else float("nan")
        rows.append({"low": low, "high": high, "best_score": score, **best})
    return pd.DataFrame(rows)


def uniform(count: int, number: int = 9, seed: int = 0, **settings: Any) -> pd.DataFrame:
    """Designs spread uniformly over the box of a table: what no search has drawn to its favourites.

    Parameters
    ----------
    count : int
    number : int
    seed : int
    **settings
        As for :meth:`saleg.optimize.Problem.evaluate`.
    """
    of = problem(number)
    low, high = of.box
    designs = np.random.default_rng(seed).random((count, len(low)))
    return of.evaluate(low + (high - low) * designs, **settings)


def by_power(
    table: pd.DataFrame, powers: Iterable[float] = POWERS, efficiency: float = 0.30
) -> pd.DataFrame:
    """Good designs of a table by their power, and how wide they spread.

    Parameters
    ----------
    table : DataFrame
        Such as :func:`uniform` gives one.
    powers : iterable of float
        Powers between which designs are counted [W].
    efficiency : float
        Least efficiency of a good design [-]. The 40 % the text aims at are met by too few designs
        that nobody searched for: 19 of 12,000.

    Returns
    -------
    DataFrame
        One row per range of power: ``steady`` designs in it, ``good`` ones, within the limits of
        Figure 85, and between which values the middle nine tenths of these lie.
    """
    import pandas as pd

    rows = []
    limits = (*Score().limits, Limit("efficiency", efficiency))
    met = table[problem(9).replace(constraints=limits).told(table).violation == 0.0]
    for low, high in itertools.pairwise(powers):
        steady, good = (of[of["power"].between(low, high)] for of in (table, met))
        row: dict[str, Any] = {"low": low, "high": high, "steady": len(steady), "good": len(good)}
        for name in ("intake_temperature", "frequency", "stroke_to_bore"):
            row[f"{name}_5"], row[f"{name}_95"] = good[name].quantile([0.05, 0.95])
        rows.append(row)
    return pd.DataFrame(rows)


def design_map(found: Found, x: str, y: str, z: str, ax: Any = None) -> Any:
    """Draw a design map of section 4.3, without runaways that would stretch its axes.

    Parameters
    ----------
    found : Found
    x, y, z : str
        Columns of ``found.table``.
    ax : mpl_toolkits.mplot3d.axes3d.Axes3D, optional
        Three-dimensional axes to draw on; new ones unless given.

    Returns
    -------
    Axes3D
    """
    table = found.table
    shown = table[(table["compression_ratio"] < HIGHEST) & (table["power"] < MOST)]
    shown.attrs = table.attrs
    ax = sweeps.design_map(shown, x, y, z, ax=ax)
    ax.set_title(f"{len(shown)} of {len(table)} designs: compression ratio below {HIGHEST:g}")
    return ax


#: Figures by their number. Those of an optimisation may share one: run it once, draw it often.
FIGURES = {
    85: Figure(partial(Score, target_power=FOUR), score_terms),
    86: Figure(optimised, figures.convergence),
    **{
        number: Figure(optimised, partial(design_map, x=x, y=y, z=z))
        for number, (x, y, z) in MAPS.items()
    },
}
