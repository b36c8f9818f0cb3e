"""Plots of a run's last full cycle.

matplotlib is imported only when something is drawn. Axes are made without pyplot, so that no
display is needed and nothing has to be closed; hand in axes of your own to draw elsewhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from saleg.errors import SalegError

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from saleg.results import Run

#: Colours of the two chambers in every plot (Okabe and Ito, safe for the colour-blind).
LEFT_COLOUR = "#0072B2"
RIGHT_COLOUR = "#D55E00"
#: Colour of what belongs to the translator, hence to no side.
TRANSLATOR_COLOUR = "#333333"
COLOURS = {"left": LEFT_COLOUR, "right": RIGHT_COLOUR}

#: Marker of each kind of event.
MARKERS = {
    "port closing": "v",
    "port opening": "^",
    "ignition": "*",
    "end of combustion": "s",
}


class NoCycle(SalegError, ValueError):
    """A run without a full cycle has nothing to draw."""


class _Style(NamedTuple):
    """How the curve of one side is drawn, so that both show where they coincide."""

    line: Any
    width: float
    marker_scale: float


_STYLES = {"left": _Style("-", 2.4, 1.9), "right": _Style((0, (4, 2)), 1.4, 1.0)}


def new_figure(width: float = 6.4, height: float = 4.4) -> Figure:
    """Make an empty figure that needs no display.

    Parameters
    ----------
    width, height : float
        Size [inch].

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=150, layout="constrained")


def pressure_volume(run: Run, ax: Axes | None = None) -> Axes:
    """Draw pressure [bar] over volume [cm^3] of both chambers over the last full cycle.

    Parameters
    ----------
    run : Run
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    history, events = _last_cycle(run)
    ax = new_figure().subplots() if ax is None else ax
    for side, style in _STYLES.items():
        ax.plot(
            1e6 * history[f"V_{side}"],
            1e-5 * history[f"p_{side}"],
            color=COLOURS[side],
            linestyle=style.line,
            linewidth=style.width,
            label=side,
        )
    volumes = _volumes(run, events)
    scales = {side: style.marker_scale for side, style in _STYLES.items()}
    _mark(ax, 1e6 * volumes, 1e-5 * events["pressure"], events, scales)
    ax.set_xlabel(r"volume [cm$^3$]")
    ax.set_ylabel("pressure [bar]")
    ax.set_xlim(left=0.0)
    ax.set_ylim(bottom=0.0)
    return _finish(ax, "Pressure and volume", "upper right")


def velocity_position(run: Run, ax: Axes | None = None) -> Axes:
    """Draw velocity [m/s] over position [mm] of the translator over the last full cycle.

    Parameters
    ----------
    run : Run
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; new ones unless given.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    NoCycle
        If the run completed no full cycle.
    """
    import numpy as np

    history, events = _last_cycle(run)
    ax = new_figure().subplots() if ax is None else ax
    ax.plot(
        1e3 * np.concatenate([_dead_centre(run), history["x"]]),
        np.concatenate([[0.0], history["v"]]),
        color=TRANSLATOR_COLOUR,
        linewidth=1.6,
    )
    _mark(ax, 1e3 * events["x"], events["v"], events, {})
    ax.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
    ax.axvline(0.0, color="0.8", linewidth=0.8, zorder=0)
    ax.set_xlabel("position [mm]")
    ax.set_ylabel("velocity [m/s]")
    for side, colour in COLOURS.items():
        ax.plot([], [], color=colour, marker="o", linestyle="none", label=side)
    return _finish(ax, "Velocity and position", "center")


def _last_cycle(run: Run) -> tuple[pd.DataFrame, pd.DataFrame]:
    """History and marked events of the last full cycle."""
    orbit = run.orbit
    if orbit is None or orbit.history is None:
        raise NoCycle(f"nothing to draw: the run completed no full cycle ({run.message})")
    events = orbit.events
    return orbit.history, events[events["event"].isin(list(MARKERS))]


def _dead_centre(run: Run) -> Any:
    """Where the last full cycle begins [m]; the history starts with the step after it."""
    return run.orbit.strokes["x_start"][:1] if run.orbit is not None else []


def _volumes(run: Run, events: pd.DataFrame) -> Any:
    """Volume of the chamber each event belongs to [m^3]."""
    import numpy as np

    left, right = run.engine.chambers
    areas = [np.pi * chamber.bore**2 / 4.0 for chamber in (left, right)]
    x = events["x"].to_numpy()
    on_left = (events["side"] == "left").to_numpy()
    return np.where(on_left, areas[0] * (left.half_stroke + x), areas[1] * (right.half_stroke - x))


def _mark(ax: Axes, x: Any, y: Any, events: pd.DataFrame, scales: dict[str, float]) -> None:
    """Small markers, one shape per kind of event, in the colour (and size) of their side."""
    import numpy as np

    x, y = np.asarray(x), np.asarray(y)
    for kind, marker in MARKERS.items():
        for side, colour in COLOURS.items():
            chosen = ((events["event"] == kind) & (events["side"] == side)).to_numpy()
            if chosen.any():
                ax.plot(x[chosen], y[chosen], **_marker(marker, colour, scales.get(side, 1.0)))
        if (events["event"] == kind).any():
            ax.plot([], [], **_marker(marker, "0.6"), label=kind)


def _marker(marker: str, colour: str, scale: float = 1.0) -> dict[str, Any]:
    return {
        "marker": marker,
        "color": colour,
        "markersize": scale * (9.0 if marker == "*" else 5.5),
        "markeredgecolor": "white",
        "markeredgewidth": 0.5,
        "linestyle": "none",
        "zorder": 3,
    }


def _finish(ax: Axes, title: str, place: Literal["upper right", "center"]) -> Axes:
    ax.set_title(title, fontsize="medium")
    ax.grid(visible=True, color="0.92", linewidth=0.6)
    ax.set_axisbelow(True)
    for edge in ("top", "right"):
        ax.spines[edge].set_visible(False)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles, labels, loc=place, fontsize="small", framealpha=1.0, edgecolor="none")
    return ax
