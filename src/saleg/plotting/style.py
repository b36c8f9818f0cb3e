"""Colours, axes and legends: what all figures share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from saleg.checks import POSITIVE, checked
from saleg.errors import AxesError, shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from saleg.plotting.figure import Panels, ShownAxes

#: Colours of the two chambers in every plot (Okabe and Ito, safe for the colour-blind).
LEFT_COLOUR = "#0072B2"
RIGHT_COLOUR = "#D55E00"
COLOURS = {"left": LEFT_COLOUR, "right": RIGHT_COLOUR}
#: Colour of what belongs to the translator, hence to no side.
TRANSLATOR_COLOUR = "#333333"
#: Colours of what acts on the translator; energies that went there have the same.
SPRING_COLOUR = "#E0A800"
FRICTION_COLOUR = "#8C6D46"
ALTERNATOR_COLOUR = "#009E73"

#: Marker of each kind of event.
MARKERS = {
    "port closing": "v",
    "port opening": "^",
    "ignition": "*",
    "end of combustion": "s",
}


Drawn = TypeVar("Drawn", bound="Axes")


class CurveLook(NamedTuple):
    """Look of the curve of one side."""

    line: Any
    width: float
    marker_scale: float


#: Marks the legend below all panels.
BELOW_PANELS = "saleg: legend below the panels"
#: Distance from the axes to a legend below them, past ticks and label [pt].
BELOW = 38.0

#: Curves of both sides that lie apart.
APART = {"left": CurveLook("-", 1.6, 1.0), "right": CurveLook("-", 1.6, 1.0)}
#: Curves that may coincide: both show, one through the gaps of the other.
COINCIDING = {"left": CurveLook("-", 2.4, 1.7), "right": CurveLook((0, (4, 2)), 1.4, 1.0)}
#: Motored pressures; dots of both sides alternate where the curves coincide.
DOTTED: dict[str, Any] = {"left": (0, (1, 2.6)), "right": (1.8, (1, 2.6))}


@checked(width=POSITIVE, height=POSITIVE)
def new_figure(width: float = 6.4, height: float = 4.4) -> Figure:
    """Make an empty figure that needs no display.

    It shows as the result of a notebook's cell, and so do its axes.

    Parameters
    ----------
    width, height : float
        Size [inch].

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from saleg.plotting.figure import ShownFigure

    figure = ShownFigure(figsize=(width, height), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def axes_or_new(ax: Axes | None, width: float = 6.4, height: float = 4.4) -> ShownAxes:
    """The axes handed in, or those of a new figure of the given size [inch].

    Raises
    ------
    AxesError
        If it is no axes.
    """
    drawn: Any = new_figure(width, height).subplots() if ax is None else _checked(ax)
    return drawn


def panels_or_new(
    ax: Sequence[Axes] | np.ndarray | None,
    shape: tuple[int, int],
    width: float,
    height: float,
    count: int | None = None,
    **settings: Any,
) -> Panels:
    """The axes handed in, or new ones in rows and columns, as a flat array.

    Parameters
    ----------
    ax : array of matplotlib.axes.Axes, optional
        Axes handed in.
    shape : (int, int)
        Rows and columns.
    width, height : float
        Size of a new figure [inch].
    count : int, optional
        Number of axes; all of the grid unless given.
    **settings
        Further settings of ``Figure.subplots``.

    Returns
    -------
    Panels

    Raises
    ------
    AxesError
        If there are not as many axes as the figure needs.
    """
    from saleg.plotting.figure import Panels

    needed = shape[0] * shape[1] if count is None else count
    if ax is None:
        made = new_figure(width, height).subplots(*shape, squeeze=False, **settings).ravel()
        for spare in made[needed:]:
            spare.remove()
        return Panels.of(made[:needed])
    panels = Panels.of(np.ravel(np.asarray(ax, dtype=object)))
    if len(panels) != needed:
        raise AxesError(f"this figure needs {needed} axes, not {len(panels)}; {_HINT}")
    for panel in panels:
        _checked(panel)
    return panels


_HINT = "hand in as many, as plt.subplots(...)[1] gives them, or none"


def _checked(ax: Any) -> Any:
    """The axes handed in; anything else is refused."""
    from matplotlib.axes import Axes

    if not isinstance(ax, Axes):
        many = isinstance(ax, (np.ndarray, list, tuple))
        what = f"{len(ax)} in a {type(ax).__name__}" if many else shown(ax)
        raise AxesError(f"ax must be one matplotlib axes here, not {what}")
    return ax


def marker(shape: str, colour: str, scale: float = 1.0) -> dict[str, Any]:
    """Look of a single point."""
    return {
        "marker": shape,
        "color": colour,
        "markersize": scale * (9.0 if shape == "*" else 5.5),
        "markeredgecolor": "white",
        "markeredgewidth": 0.5,
        "linestyle": "none",
        "zorder": 3,
    }


def zero_lines(ax: Axes, *, x: bool = False, y: bool = False) -> None:
    """Faint lines through zero of either axis."""
    if x:
        ax.axvline(0.0, color="0.75", linewidth=0.8, zorder=0)
    if y:
        ax.axhline(0.0, color="0.75", linewidth=0.8, zorder=0)


def from_zero(ax: Axes) -> None:
    """Set the upward axis from zero to above all that is drawn."""
    ax.set_ylim(0.0, 1.05 * ax.dataLim.ymax)


def finish(ax: Drawn, title: str, legend: str | None, columns: int = 1) -> Drawn:
    """Title, grid, frame and legend; the legend ``"below"`` stands under the axes."""
    ax.set_title(title, fontsize="medium")
    ax.grid(visible=True, color="0.92", linewidth=0.6)
    ax.set_axisbelow(True)
    for edge in ("top", "right"):
        ax.spines[edge].set_visible(False)
    if legend is None:
        return ax
    look: dict[str, Any] = {"fontsize": "small", "framealpha": 1.0, "edgecolor": "none"}
    if legend == "below":
        from matplotlib.transforms import ScaledTranslation

        down = ScaledTranslation(0.0, -BELOW / 72.0, ax.figure.dpi_scale_trans)
        look |= {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "borderaxespad": 0.0}
        look |= {"bbox_transform": ax.transAxes + down}
    else:
        look |= {"loc": legend}
    entries = legend_entries([ax])
    ax.legend(list(entries.values()), list(entries), ncols=columns, **look)
    return ax


def legend_entries(panels: Iterable[Axes]) -> dict[str, Any]:
    """What the legend of some axes shows by its text, every text once."""
    entries: dict[str, Any] = {}
    for panel in panels:
        for handle, text in zip(*panel.get_legend_handles_labels(), strict=True):
            entries.setdefault(text, handle)
    return entries


def legend_below(panels: Iterable[Axes], columns: int = 4) -> None:
    """Draw one legend for all panels of a figure, below them, in place of an earlier one."""
    axes = list(panels)
    entries, figure = legend_entries(axes), axes[0].figure
    for earlier in [legend for legend in figure.legends if legend.get_gid() == BELOW_PANELS]:
        earlier.remove()
    if entries:
        look: dict[str, Any] = {"ncols": columns, "frameon": False, "fontsize": "small"}
        place: dict[str, Any] = {"loc": "outside lower center", **look}
        figure.legend(list(entries.values()), list(entries), **place).set_gid(BELOW_PANELS)
