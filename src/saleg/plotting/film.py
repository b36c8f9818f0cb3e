"""An engine and the curves of its last cycle as a figure in which everything moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design.schematic import SIDES, dimensions
from saleg.engine import Engine
from saleg.errors import SalegError
from saleg.plotting.cycle import PRESSURE, TIME, VOLUME, Quantity, last_cycle
from saleg.plotting.labels import axis_label
from saleg.plotting.machine import HOUSING, WALL, box, housing, mover, piston, springs
from saleg.plotting.style import COINCIDING, COLOURS, finish, from_zero, marker, new_figure
from saleg.quantities import is_number
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from saleg.simulation.run import Run

#: Height over width, dots per inch, and size of text [pt]: it is read on a phone too.
SHAPE, DOTS, FONT = 0.62, 80, 13.0
#: Time since the beginning of what is shown.
SHOWN_TIME = TIME._replace(label=axis_label(readable("", "s", "time")))


class AnimationError(SalegError, ValueError):
    """An animation that cannot be made as asked."""


@dataclass
class Film:
    """A figure and what moves in it.

    Attributes
    ----------
    history : DataFrame
        One row per frame (SI).
    """

    figure: Figure
    machine: Axes
    history: pd.DataFrame
    engine: Engine
    rate: float
    cursors: list[Callable[[int], Any]]
    moving: list[Artist]

    @classmethod
    def of(
        cls,
        run: Run,
        window: tuple[float, float] | None,
        frames: int,
        rate: float,
        width: float,
    ) -> Film:
        """A film of the last cycle, or of a window of time."""
        from matplotlib import rc_context

        whole, closed = _shown(run, window)
        t = whole["t"].to_numpy()
        chosen = np.linspace(t[0], t[-1], frames, endpoint=not closed)
        history = type(whole)({name: np.interp(chosen, t, whole[name]) for name in whole})
        slowness = (t[-1] - t[0]) * rate / frames
        with rc_context({"font.size": FONT}):
            figure = new_figure(width, SHAPE * width)
            figure.set_dpi(DOTS)
            grid = figure.add_gridspec(2, 2, height_ratios=(1.0, 1.7))
            machine = figure.add_subplot(grid[0, :])
            film = cls(figure, machine, history, run.engine, rate, [], [])
            film._draw_machine(run, slowness)
            film._draw_pressures(figure.add_subplot(grid[1, 0]), whole, SHOWN_TIME)
            film._draw_pressures(figure.add_subplot(grid[1, 1]), whole, VOLUME)
            film.show(0)
            figure.canvas.draw()
        figure.set_layout_engine("none")  # nothing but the engine moves from frame to frame
        return film

    def show(self, frame: int) -> None:
        """Move everything to where it is in a frame."""
        for artist in self.moving:
            artist.remove()
        self.moving = []
        shift = 1e3 * float(self.history["x"].iloc[frame])
        for side, sign in SIDES.items():
            mm = dimensions(self.engine, side)
            self.moving += springs(self.machine, mm, sign, shift)
            self.moving += piston(self.machine, mm, sign, shift, COLOURS[side])
            if side in self.engine.gas_sides:
                self.moving.append(self._gas(mm, side, shift, frame))
        self.moving += mover(self.machine, dimensions(self.engine, "left"), shift)
        for cursor in self.cursors:
            cursor(frame)

    def _gas(self, mm: dict[str, float], side: str, shift: float, frame: int) -> Artist:
        """Gas of one chamber, the darker the hotter."""
        from matplotlib import colormaps

        sides = self.engine.gas_sides
        max_temperature = max(float(self.history[f"T_{name}"].max()) for name in sides)
        share = self.history[f"T_{side}"].iloc[frame] / max_temperature
        colour = colormaps["YlOrRd"](0.9 * share)
        crown, head = SIDES[side] * mm["crown"] + shift, SIDES[side] * mm["head"]
        look: dict[str, Any] = {"color": colour, "linewidth": 0.0, "zorder": 0}
        return box(self.machine, crown, -0.5 * mm["bore"], head - crown, mm["bore"], **look)

    def _draw_machine(self, run: Run, slowness: float) -> None:
        """Draw the fixed parts: housing, stator, and the frame around them."""
        ax, sizes = self.machine, {side: dimensions(run.engine, side) for side in SIDES}
        for side, sign in SIDES.items():
            housing(ax, sizes[side], sign)
        mm = sizes["left"]
        outer, end = 0.5 * mm["mover_outer_diameter"] + 2.0, 0.6 * mm["mover_end"]
        for y in (outer, -outer - 1.5 * WALL):
            box(ax, -end, y, 2.0 * end, 1.5 * WALL, color=HOUSING, linewidth=0.0)
        ax.set_aspect("equal")
        ax.set_xlim(-mm["head"] - 3.0 * WALL, sizes["right"]["head"] + 3.0 * WALL)
        ax.set_ylim(-outer - 3.0 * WALL, outer + 3.0 * WALL)
        ax.set_axis_off()
        name = run.engine.name or "engine"
        title = ax.set_title("", fontsize="medium")
        t = self.history["t"].to_numpy()

        def retitle(frame: int) -> None:
            speed = f"slowed down {1.0 / slowness:.0f} times"
            title.set_text(f"{name}, t = {t[frame]:.4f} s, {speed}")

        self.cursors.append(retitle)

    def _draw_pressures(self, ax: Axes, whole: pd.DataFrame, across: Quantity) -> None:
        """Pressures of both sides over time or volume, with a dot where they are now."""
        for side in self.engine.gas_sides:
            colour = COLOURS[side]
            column = f"{across.column}_{side}" if across.sided else across.column
            start = 0.0 if across.sided else float(whole["t"].iloc[0])
            look = COINCIDING[side]
            curve: dict[str, Any] = {"linestyle": look.line, "color": colour, "label": side}
            x, p = across.scale * (whole[column] - start), PRESSURE.scale * whole[f"p_{side}"]
            ax.plot(x, p, linewidth=0.7 * look.width, **curve)
            dot_look = {**marker("o", colour), "markersize": 9, "clip_on": False}
            (dot,) = ax.plot([], [], **dot_look)
            self.cursors.append(self._follow(dot, column, f"p_{side}", start, across.scale))
        from_zero(ax)
        ax.set_xlim(left=0.0)
        ax.locator_params(axis="x", nbins=5)
        ax.set_xlabel(across.label)
        ax.set_ylabel(PRESSURE.label)
        finish(ax, "", "upper right" if across.sided else None)

    def _follow(
        self, dot: Any, column: str, pressure: str, start: float, scale: float
    ) -> Callable[[int], Any]:
        """Function that moves a dot along its curve."""
        x = scale * (self.history[column].to_numpy() - start)
        p = PRESSURE.scale * self.history[pressure].to_numpy()
        return lambda frame: dot.set_data([x[frame]], [p[frame]])


def _shown(run: Run, window: tuple[float, float] | None) -> tuple[pd.DataFrame, bool]:
    """History that is shown, and whether it is a closed cycle."""
    if window is None:
        return last_cycle(run).history, True
    if len(window) != 2 or not all(is_number(t) for t in window):
        raise AnimationError(f"window = {window!r}: must be two times [s]")
    begin, end = window
    if run.history is None:
        raise AnimationError("the run has no history for a window; simulate it with history=1")
    t = run.history["t"]
    shown = run.history[(t >= begin) & (t <= end)]
    if len(shown) < 2 or shown["t"].iloc[-1] <= shown["t"].iloc[0]:
        raise AnimationError(
            f"window = ({begin:g}, {end:g}) s: the history has nothing there; "
            f"it goes from {t.iloc[0]:g} to {t.iloc[-1]:g} s"
        )
    return shown, False
