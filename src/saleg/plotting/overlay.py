"""Several runs on the same axes: the colour, line and name of each."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from saleg.plotting.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.simulation.run import Run

#: Colours of runs on the same axes, each with a darker one for the right side (Okabe and Ito).
#: The vermilion of the right side of a run that stands alone is none of them.
RUN_COLOURS = ("#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8A8F98")
#: Lines of runs on the same axes where the colours tell quantities apart.
RUN_LINES: tuple[Any, ...] = ("-", "--", ":", "-.", (0, (8, 2, 1, 2, 1, 2)), (0, (1, 4)))
#: Length of a name beside which four columns of a legend fit below the axes.
SHORT = 14
#: Brightness of the right side's colour over that of the left side.
DARKER = 0.62
#: Marks the first curve of a run.
_FIRST_CURVE = "saleg: first curve of a run"


@dataclass(frozen=True)
class Place:
    """One of the runs on some axes.

    Attributes
    ----------
    number : int
        Runs drawn there before it.
    name : str
        Its name in the legend; empty for a run that stands alone.
    """

    number: int = 0
    name: str = ""

    @property
    def alone(self) -> bool:
        """Whether the run is drawn as one that shares its axes with no other."""
        return self.number == 0 and not self.name

    def colour(self, usual: str) -> str:
        """Colour of a curve: its usual one if the run stands alone."""
        return usual if self.alone else RUN_COLOURS[self.number % len(RUN_COLOURS)]

    @property
    def sides(self) -> dict[str, str]:
        """Colours of the left and the right side."""
        if self.alone:
            return COLOURS
        colour = self.colour("")
        return {"left": colour, "right": darker(colour)}

    def line(self, usual: Any = "-") -> Any:
        """Line of a curve whose colour says what it is: its usual one if the run stands alone."""
        return usual if self.alone else RUN_LINES[self.number % len(RUN_LINES)]

    def text(self, words: str) -> str:
        """Text of a curve in the legend."""
        return f"{self.name}: {words}" if self.name else words

    @property
    def columns(self) -> int:
        """Columns of a legend below the axes that long names leave room for."""
        return 4 if len(self.name) <= SHORT else 2


#: Of a run that stands alone.
ALONE = Place()


def darker(colour: str) -> str:
    """The colour of the right side beside that of the left."""
    from matplotlib.colors import to_hex, to_rgb

    red, green, blue = to_rgb(colour)
    return to_hex((DARKER * red, DARKER * green, DARKER * blue))


def runs_on(ax: Axes) -> int:
    """Number of runs drawn on some axes."""
    return sum(line.get_gid() == _FIRST_CURVE for line in ax.get_lines())


@contextmanager
def placed(ax: Axes, run: Run, label: str | None) -> Iterator[Place]:
    """Place of a run on some axes, on which it is drawn inside the ``with`` block.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        The first of several panels.
    run : Run
    label : str, optional
        Name in the legend; "run 2" and so on where there is another run already.

    Yields
    ------
    Place
    """
    ending = "" if run.status.ended_well else f" ({run.status})"
    with _placed(ax, label, "run", ending) as place:
        yield place


@contextmanager
def placed_table(ax: Axes, label: str | None) -> Iterator[Place]:
    """Place of a table on some axes, as :func:`placed` gives that of a run."""
    with _placed(ax, label, "table") as place:
        yield place


@contextmanager
def _placed(ax: Axes, label: str | None, what: str, ending: str = "") -> Iterator[Place]:
    count, number = len(ax.get_lines()), runs_on(ax)
    name = str(label) if label else f"{what} {number + 1}" if number else ""
    yield Place(number, f"{name}{ending}" if name else "")
    ax.get_lines()[count].set_gid(_FIRST_CURVE)


def sign(ax: Axes, run: Run) -> None:
    """Name engine and settings of a run below a figure made here; others are left as they are."""
    from saleg.plotting.figure import ShownFigure

    if isinstance(ax.figure, ShownFigure):
        ax.figure.sign(", ".join([run.engine.name or "engine", *_settings(run)]))


def _settings(run: Run) -> list[str]:
    """How a run was integrated, in words."""
    known = run.settings
    if known.get("method") == "fixed":
        return [f"order {known.get('order', '-')}, steps of {1e6 * known['step']:g} µs"]
    return [f"rtol {known['rtol']:g}"] if "rtol" in known else []
