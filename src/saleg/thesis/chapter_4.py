"""Chapter 4: sweeps of the base case, and the optimised designs of Tables 9 to 12.

Designs are computed from their eight inputs alone, through the loop of the component design.

Examples
--------
>>> from saleg.thesis import chapter_4
>>> beside = chapter_4.deviations(12)
>>> float(beside["stroke"].abs().max().round(3))
0.005
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg import sweep
from saleg.design import Design, evaluate_many
from saleg.errors import nearest, shown
from saleg.plotting import design as drawings
from saleg.plotting import sweeps
from saleg.plotting.docstrings import documented
from saleg.sweep import SweepError
from saleg.thesis.figure import Figure
from saleg.thesis.tables import columns

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels

#: Ranges of the sweeps of Figures 67 to 82, two figures each, by input (SI). The text prints that
#: of the retained exhaust gas; the others hold the borders of stability it names.
SWEEPS = {
    "bore": (0.025, 0.1),
    "half_stroke": (0.04, 0.3),
    "port_location": (0.03, 0.6),
    "intake_pressure": (0.8e5, 2.5e5),
    "intake_temperature": (280.0, 480.0),
    "spring_stiffness": (5e3, 300e3),
    "equivalence_ratio": (0.15, 1.0),
    "egr": (0.0, 0.5),
}
#: Tables of designs.
TABLES = (9, 10, 11, 12)
#: Inputs of a design (Table 8), and what Tables 9 to 12 call them.
INPUTS = {
    "bore": "bore",
    "half_stroke": "neutral_clearance_length",
    "port_location": "port_location",
    "spring_stiffness": "spring_stiffness",
    "intake_pressure": "intake_pressure",
    "intake_temperature": "intake_temperature",
    "equivalence_ratio": "equivalence_ratio",
    "egr": "egr",
}
#: Figures compared, as a table of designs has them and as Tables 9 to 12 call them.
PRINTED_AS = {
    "stroke": "stroke",
    "compression_ratio": "compression_ratio",
    "frequency": "frequency",
    "moving_mass": "moving_mass",
    "efficiency": "efficiency",
    "power": "power",
    "peak_pressure": "peak_pressure",
    "displacement": "displacement",
    "stroke_to_bore": "maximum_stroke_to_bore",
}


def sweep_along(name: str, count: int = 61) -> pd.DataFrame:
    """Base case along one of its eight inputs (Figures 67 to 82).

    Parameters
    ----------
    name : str
        A key of :data:`SWEEPS`.
    count : int
        Number of points.

    Returns
    -------
    DataFrame
        As :func:`saleg.sweep.run` gives it.

    Raises
    ------
    SweepError
        If the chapter has no such sweep.
    """
    if name not in SWEEPS:
        raise SweepError(f"no sweep of Chapter 4 along {shown(name)}{nearest(name, SWEEPS)}")
    return sweep.run(sweep.grid({name: np.linspace(*SWEEPS[name], count).tolist()}))


@documented(axes=8)
def draw_sweep(table: pd.DataFrame, name: str, ax: Any = None) -> Panels:
    """Draw a table of :func:`sweep_along`.

    Parameters
    ----------
    table : DataFrame
        What :func:`sweep_along` gives.
    name : str
        The parameter it goes along.
    """
    return sweeps.panels(table, name, ax)


def printed(number: int) -> pd.DataFrame:
    """Designs of Table 9, 10, 11 or 12 as printed.

    Parameters
    ----------
    number : int

    Returns
    -------
    DataFrame
        One row per design, all quantities in SI.
    """
    import pandas as pd

    return pd.DataFrame.from_dict(columns(number), orient="index")


def inputs(number: int) -> pd.DataFrame:
    """Inputs of the designs of a table.

    Parameters
    ----------
    number : int
        9, 10, 11 or 12.

    Returns
    -------
    DataFrame
        One row per design, the eight inputs of :func:`saleg.design.evaluate` in SI.
    """
    return printed(number)[list(INPUTS.values())].set_axis(list(INPUTS), axis=1)


def run(number: int = 9, design: Design | None = None) -> pd.DataFrame:
    """Designs of a table from their eight inputs alone.

    Parameters
    ----------
    number : int
        9, 10, 11 or 12.
    design : Design, optional
        Laws and mass model; those of Chapter 4 unless given.

    Returns
    -------
    DataFrame
        As :func:`saleg.design.evaluate_many` gives it, one row per column of the table.
    """
    given = inputs(number)
    return evaluate_many(given, design, multipliers=True).set_axis(given.index)


def deviations(number: int = 9, design: Design | None = None) -> pd.DataFrame:
    """Relative deviations of the designs of a table from what is printed of them [-].

    Parameters
    ----------
    number, design
        As for :func:`run`.

    Returns
    -------
    DataFrame
        One row per design, one column per figure.
    """
    ours = run(number, design)[list(PRINTED_AS)]
    theirs = printed(number)[list(PRINTED_AS.values())].set_axis(list(PRINTED_AS), axis=1)
    return ours.div(theirs).sub(1.0)


def draw(beside: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Draw the deviations [%] of :func:`deviations`, a column of points per figure.

    Parameters
    ----------
    beside : DataFrame
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes
    """
    from saleg.plotting.style import axes_or_new, finish

    ax = axes_or_new(ax)
    places = range(len(beside.columns))
    ax.axhline(0.0, color="0.6", lw=0.8)
    for name, row in beside.iterrows():
        ax.plot(places, 100.0 * row, "o", ms=5, label=str(name))
    ax.plot(places, 100.0 * beside.median(), "_", color="black", ms=18, mew=2, label="median")
    labels = [name.replace("_", "\n") for name in beside.columns]
    ax.set_xticks(list(places), labels)
    ax.set_ylabel("deviation from the print [%]")
    return finish(ax, "Designs from their inputs alone", "below", columns=5)


def report(beside: pd.DataFrame) -> str:
    """Deviations as text, in percent, with the median magnitude of each figure below.

    Parameters
    ----------
    beside : DataFrame
        What :func:`deviations` gives.

    Returns
    -------
    str
    """
    shown = (100.0 * beside).round(1)
    shown.loc["median magnitude"] = (100.0 * beside.abs().median()).round(1)
    return str(shown.to_string())


#: Figures by their number. Those of the design equations have no data but the equations; both
#: figures of a sweep share a picture.
FIGURES = {
    63: Figure(lambda: None, lambda _, ax=None: drawings.alternator_map(ax=ax)),
    65: Figure(lambda: None, lambda _, ax=None: drawings.piston_mass(ax)),
    66: Figure(lambda: None, lambda _, ax=None: drawings.natural_frequency(ax=ax)),
    **{
        67 + 2 * place + other: Figure(partial(sweep_along, name), partial(draw_sweep, name=name))
        for place, name in enumerate(SWEEPS)
        for other in (0, 1)
    },
}
