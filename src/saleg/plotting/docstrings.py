"""Docstrings and arguments of figures: what all of them share.

A figure's own docstring says what it draws, and describes the parameters that are its own. The
decorator adds the sections every figure has: the parameters it shares with others in the order of
its signature, what it returns, and what it raises. What is drawn is checked by its name.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from saleg.checks import FRAME, a, checked
from saleg.control import OperatingMap, PartLoadMap
from saleg.design import Geometry
from saleg.fundamental import History
from saleg.simulation.run import Run
from saleg.steady.continuation import Branch
from saleg.studies.sensitivity import Study

Draw = TypeVar("Draw", bound=Callable[..., Any])

#: Parameters that mean the same in every figure; `ax` depends on the number of axes.
PARAMETERS = {
    "run": "run : Run",
    "study": (
        "study : Study\n    From :func:`saleg.sensitivity.study` or one of the studies built on it."
    ),
    "label": (
        "label : str, optional\n"
        "    Name of the run in the legend. Runs on the same axes differ in colour or line."
    ),
    "history": "history : History",
    "histories": "histories : mapping of str to History\n    By the name in the legend.",
}
#: What a figure is drawn of, by the name of its parameter.
SUBJECTS = {
    "run": a(Run),
    "study": a(Study),
    "history": a(History),
    "table": FRAME,
    "known": a(OperatingMap),
    "best": a(PartLoadMap),
    "branch": a(Branch),
    "geometry": a(Geometry),
}
NUMBERS = {2: "two", 4: "four", 5: "five", 6: "six", 8: "eight"}
#: What figures raise, by their first parameter.
RAISES = {
    "run": "NoCycle\n    If the run completed no full cycle.",
    "study": "NoCycle\n    If no run of the study completed a full cycle.",
}


def documented(axes: int = 1) -> Callable[[Draw], Draw]:
    """Complete the docstring of a figure, and check what it is drawn of.

    Parameters
    ----------
    axes : int
        Number of axes it draws on and returns: one, or an array of more.

    Returns
    -------
    callable
        Decorator of a function with a parameter `ax`. Sections its docstring has, and parameters
        described there, stay as they are.
    """

    def complete(draw: Draw) -> Draw:
        if draw.__doc__ is not None:  # python -OO has none
            names = list(inspect.signature(draw).parameters)
            draw.__doc__ = completed(draw.__doc__, names, axes)
        return checked(**SUBJECTS)(draw)  # type: ignore[return-value]

    return complete


def completed(text: str, names: Sequence[str], axes: int = 1) -> str:
    """Docstring with the sections figures share.

    Parameters
    ----------
    text : str
        What the figure draws, and any section of its own.
    names : sequence of str
        Parameters of the figure in order, each described in the text or shared by all figures.
    axes : int
        Number of axes.

    Returns
    -------
    str
    """
    summary, sections = _sections(inspect.cleandoc(text))
    kind = "matplotlib.axes.Axes"
    taken, returned = kind, kind
    if axes > 1:
        taken = f"array of {NUMBERS[axes]} {kind}"
        returned = f"Panels\n    Array of {NUMBERS[axes]} {kind}; ``.figure`` holds them all."
    place = f"ax : {taken}, optional\n    Axes to draw on; new ones unless given."
    shared = {**PARAMETERS, "ax": place, **_entries(sections.pop("Parameters", ""))}
    sections = {
        "Parameters": "\n".join(dict.fromkeys(shared[name] for name in names)),
        "Returns": returned,
        **({"Raises": RAISES[names[0]]} if names[0] in RAISES else {}),
        **sections,
    }
    parts = [f"{title}\n{'-' * len(title)}\n{body}" for title, body in sections.items()]
    return "\n\n".join([summary, *parts]) + "\n"


def _sections(text: str) -> tuple[str, dict[str, str]]:
    """Text before the first section of a docstring, and the sections by title."""
    summary, *rest = re.split(r"^(\w+)\n-+\n", text, flags=re.MULTILINE)
    pairs = zip(rest[::2], rest[1::2], strict=True)
    return summary.strip(), {title: body.strip() for title, body in pairs}


def _entries(body: str) -> dict[str, str]:
    """Descriptions of parameters by name; names described together have the same."""
    entries = re.split(r"\n(?=\S)", body) if body else []
    return {name: entry for entry in entries for name in entry.partition(" :")[0].split(", ")}
