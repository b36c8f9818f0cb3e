"""Chapter 4: the optimised designs of Tables 9 to 12, from their eight inputs through the loop.

Examples
--------
>>> from saleg.thesis import chapter_4
>>> beside = chapter_4.deviations(12)
>>> float(beside["stroke"].abs().max().round(2))
0.01
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from saleg.thesis.tables import columns

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.design import Design

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
FIGURES = {
    "stroke": "stroke",
    "compression_ratio": "compression_ratio",
    "frequency": "frequency",
    "moving_mass": "moving_mass",
    "efficiency": "efficiency",
    "power": "power",
    "peak_pressure": "peak_pressure",
}


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
    from saleg.design import evaluate_many

    given = printed(number)
    inputs = given[list(INPUTS.values())].set_axis(list(INPUTS), axis=1)
    return evaluate_many(inputs, design, multipliers=True).set_axis(given.index)


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
    ours = run(number, design)[list(FIGURES)]
    theirs = printed(number)[list(FIGURES.values())].set_axis(list(FIGURES), axis=1)
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
    """Deviations as text, in percent, with the median magnitude of each figure below."""
    shown = (100.0 * beside).round(1)
    shown.loc["median magnitude"] = (100.0 * beside.abs().median()).round(1)
    return str(shown.to_string())
