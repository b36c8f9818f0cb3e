"""Docstrings of figures: complete, whoever reads them."""

import inspect

import pytest

from saleg import plotting
from saleg.plotting import branches, control, design, fundamental, sensitivity, studies, sweeps
from saleg.plotting.docstrings import completed

MODULES = (plotting, branches, control, design, fundamental, sensitivity, studies, sweeps)


def takes_axes(function):
    """Whether a function is a figure: it draws on axes of yours or its own."""
    ax = inspect.signature(function).parameters.get("ax")
    return ax is not None and ax.default is None


DRAWN = {
    f"{function.__module__}.{name}": function
    for module in MODULES
    for name, function in vars(module).items()
    if inspect.isfunction(function) and takes_axes(function)
}


@pytest.mark.parametrize("name", DRAWN)
def test_every_figure_describes_its_parameters_and_what_it_returns(name):
    text = inspect.getdoc(DRAWN[name])
    titles = [
        title for title in ("Parameters", "Returns", "Raises", "Examples") if f"\n{title}\n" in text
    ]
    assert titles[:2] == ["Parameters", "Returns"]
    section = text.partition("\nParameters\n")[2].partition("\nReturns\n")[0]
    entries = [line.partition(" : ")[0] for line in section.splitlines() if " : " in line]
    described = [one for entry in entries if entry[0] != " " for one in entry.split(", ")]
    assert described == list(inspect.signature(DRAWN[name]).parameters)


def test_a_figure_keeps_the_sections_of_its_own():
    text = completed(
        "Draw it.\n\nParameters\n----------\nwindow : float\n    Time [s].\n",
        ["run", "window", "ax"],
    )
    assert text.index("run : Run") < text.index("window : float") < text.index("ax : ")
    with pytest.raises(KeyError, match="colour"):
        completed("Draw it.", ["colour", "ax"])
