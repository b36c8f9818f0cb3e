"""Motion in pictures: phase portraits, comparisons, compression ratios."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.fundamental.history import History
from saleg.fundamental.stroke import Stroke
from saleg.plotting.docstrings import documented
from saleg.plotting.style import (
    LEFT_COLOUR,
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    axes_or_new,
    finish,
    zero_lines,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes


class Shown(NamedTuple):
    """A quantity as an axis shows it."""

    label: str
    of: Callable[[Stroke, Any], Any]


POSITION = "position x* [-]"
VELOCITY = Shown("velocity v* [-]", Stroke.velocity)
ACCELERATION = Shown("acceleration a* [-]", Stroke.acceleration)
#: Shades of the first and the last stroke, from white (0) to the darkest (1).
FADED, FULL = 0.25, 0.95
#: Looks of two curves drawn together: both show where they coincide.
TOGETHER: tuple[dict[str, Any], ...] = (
    {"color": LEFT_COLOUR, "linestyle": "-", "linewidth": 2.0},
    {"color": RIGHT_COLOUR, "linestyle": (0, (4, 2)), "linewidth": 1.5},
)


@documented()
def phase_portrait(history: History, ax: Axes | None = None, title: str = "") -> ShownAxes:
    """Draw velocity over position, stroke by stroke from light to dark.

    Parameters
    ----------
    title : str
        Title; what became of the engine unless given.
    """
    return _portrait(history, VELOCITY, ax, title)


@documented()
def acceleration_portrait(history: History, ax: Axes | None = None, title: str = "") -> ShownAxes:
    """Draw acceleration over position, stroke by stroke from light to dark.

    Parameters
    ----------
    title : str
        Title; what became of the engine unless given.
    """
    return _portrait(history, ACCELERATION, ax, title)


@documented()
def compare_velocities(
    histories: Mapping[str, History], ax: Axes | None = None, title: str = ""
) -> ShownAxes:
    """Draw velocity over position in the last cycles of two histories.

    Parameters
    ----------
    title : str
    """
    return _compare(histories, VELOCITY, ax, title)


@documented()
def compare_accelerations(
    histories: Mapping[str, History], ax: Axes | None = None, title: str = ""
) -> ShownAxes:
    """Draw acceleration over position in the last cycles of two histories.

    Parameters
    ----------
    title : str
    """
    return _compare(histories, ACCELERATION, ax, title)


@documented()
def compression_ratios(history: History, ax: Axes | None = None, title: str = "") -> ShownAxes:
    """Draw the compression ratio of every stroke.

    Parameters
    ----------
    title : str
        Title; what became of the engine unless given.
    """
    ax = axes_or_new(ax)
    ratios = history.compression_ratios
    look: dict[str, Any] = {"color": TRANSLATOR_COLOUR, "marker": ".", "linewidth": 1.0}
    ax.plot(np.arange(1, len(ratios) + 1), ratios, **look)
    ax.set_xlabel("stroke [-]")
    ax.set_ylabel("compression ratio [-]")
    ax.ticklabel_format(useOffset=False)
    return finish(ax, title or f"Compression ratio: {history.outcome}", None)


def _portrait(history: History, shown: Shown, ax: Axes | None, title: str) -> ShownAxes:
    ax = axes_or_new(ax)
    from matplotlib import colormaps

    shades = colormaps["Blues"](np.linspace(FADED, FULL, len(history.strokes)))
    for stroke, colour in zip(history.strokes, shades, strict=True):
        x = stroke.positions()
        ax.plot(x, shown.of(stroke, x), color=colour, linewidth=1.3)
    ends = {"stroke 1": shades[0], f"stroke {len(shades)}": shades[-1]}
    for name, colour in ends.items():
        ax.plot([], [], color=colour, linewidth=2.0, label=name)
    first = history.strokes[0]
    look: dict[str, Any] = {"color": RIGHT_COLOUR, "marker": "o", "linestyle": "none"}
    begin = [shown.of(first, first.start)]
    ax.plot([first.start], begin, **look, markersize=5.0, zorder=4, label="start")
    zero_lines(ax, x=True, y=True)
    ax.set_xlabel(POSITION)
    ax.set_ylabel(shown.label)
    return finish(ax, title or _story(history), "below", columns=3)


def _story(history: History) -> str:
    first, last = history.compression_ratios[[0, -1]]
    return f"{history.outcome}: compression ratio {first:.1f} to {last:.1f}".capitalize()


def _compare(
    histories: Mapping[str, History], shown: Shown, ax: Axes | None, title: str
) -> ShownAxes:
    ax = axes_or_new(ax)
    for (name, history), look in zip(histories.items(), TOGETHER, strict=False):
        x = [stroke.positions() for stroke in history.strokes[-2:]]
        y = [shown.of(stroke, x) for stroke, x in zip(history.strokes[-2:], x, strict=True)]
        ax.plot(np.concatenate(x), np.concatenate(y), label=name, **look)
    zero_lines(ax, x=True, y=True)
    ax.set_xlabel(POSITION)
    ax.set_ylabel(shown.label)
    return finish(ax, title, "below", columns=2)
