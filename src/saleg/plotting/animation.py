"""An animation of a run: the translator in its housing, pressures in time, and p-V loops."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design import formulas
from saleg.engine import Engine
from saleg.errors import SalegError
from saleg.files.atomic import new_file
from saleg.plotting.cycle import last_cycle
from saleg.plotting.machine import HOUSING, WALL, box, housing, mover, piston, springs
from saleg.plotting.style import COINCIDING, COLOURS, finish, from_zero, marker, new_figure
from saleg.quantities import is_number

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from saleg.simulation.run import Run

#: Limits of the number of frames, of the width [inch] and of the frames shown per second.
FRAMES, WIDTHS, RATES = (2, 400), (4.0, 16.0), (1.0, 60.0)
#: Height over width, and dots per inch.
SHAPE, DOTS = 0.62, 80
#: Colours of a GIF.
PALETTE = 128
SIDES = {"left": -1.0, "right": 1.0}


class AnimationError(SalegError, ValueError):
    """An animation that cannot be made as asked."""


def animate(
    run: Run,
    path: str | Path,
    *,
    window: tuple[float, float] | None = None,
    frames: int = 48,
    width: float = 9.0,
    rate: float = 20.0,
    overwrite: bool = False,
) -> Path:
    """Write an animation of the translator with both pressures in time and the p-V loops.

    The cylinders are to scale; springs, alternator and rod are schematic.

    Parameters
    ----------
    run : Run
    path : str or Path
        File to write; its suffix chooses the format: ``.gif``, or ``.html`` for a page with
        controls that needs nothing else. It is there whole or not at all.
    window : (float, float), optional
        Begin and end of the time shown [s], of a run with a history; the last full cycle unless
        given.
    frames : int
        Number of frames, 2 to 400.
    width : float
        Width [inch], 4 to 16, of 80 dots each.
    rate : float
        Frames shown per second, 1 to 60.
    overwrite : bool
        Whether an earlier file is replaced.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    AnimationError
        Naming what to change.
    NoCycle
        If there is no full cycle to show.
    RunFileError
        If the file is in the way or cannot be written.

    Examples
    --------
    >>> import saleg
    >>> run = saleg.simulate(saleg.machines.thesis_base(), 0.5)
    >>> saleg.plotting.animate(run, "engine.gif")  # doctest: +SKIP
    """
    path = Path(path)
    check_suffix(path)
    _within("frames", frames, FRAMES)
    _within("width", width, WIDTHS)
    _within("rate", rate, RATES)
    if frames != int(frames):
        raise AnimationError(f"frames = {frames!r}: must be a whole number")
    film = _Film.of(run, window, int(frames), float(rate), float(width))
    with new_file(path, overwrite) as temporary:
        WRITERS[path.suffix.lower()](film, temporary)
    return path


def check_suffix(path: Path) -> None:
    """Raise an :class:`AnimationError` unless the file has a suffix that is known."""
    if path.suffix.lower() not in WRITERS:
        raise AnimationError(f"{path}: must end in {' or '.join(WRITERS)}")


def _within(name: str, value: float, limits: tuple[float, float]) -> None:
    if not is_number(value) or not limits[0] <= value <= limits[1]:
        low, high = limits
        raise AnimationError(f"{name} = {value!r}: must be a number from {low:g} to {high:g}")


def dimensions(engine: Engine, side: str) -> dict[str, float]:
    """Dimensions of one side of an engine for the drawing [mm].

    Bore, clearances and ports are the engine's; rod, mover and the room between are such that all
    of it has space to move.

    Parameters
    ----------
    engine : Engine
    side : str
        "left" or "right".

    Returns
    -------
    dict of str to float
        As :mod:`saleg.plotting.machine` takes them.
    """
    chamber = engine.chambers[list(SIDES).index(side)]
    reach = 1e3 * max(part.half_stroke for part in engine.chambers)
    bore = 1e3 * max(part.bore for part in engine.chambers)
    mover_end = 0.7 * reach
    bearing = mover_end + reach
    crown = bearing + reach + 1e3 * (formulas.crown_position(0.0))
    head = crown + 1e3 * chamber.half_stroke
    return {
        "bore": 1e3 * chamber.bore,
        "rod_diameter": 0.25 * bore,
        "mover_end": mover_end,
        "mover_outer_diameter": 1.15 * bore,
        "mover_inner_diameter": 0.75 * bore,
        "bearing": bearing,
        "port": head - 1e3 * getattr(chamber, "port_closing", math.nan),
        "crown": crown,
        "head": head,
    }


@dataclass
class _Film:
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
    ) -> _Film:
        """A film of the last cycle, or of a window of time."""
        whole, closed = _shown(run, window)
        t = whole["t"].to_numpy()
        chosen = np.linspace(t[0], t[-1], frames, endpoint=not closed)
        history = type(whole)({name: np.interp(chosen, t, whole[name]) for name in whole})
        figure = new_figure(width, SHAPE * width)
        figure.set_dpi(DOTS)
        grid = figure.add_gridspec(2, 2, height_ratios=(1.0, 1.7))
        machine = figure.add_subplot(grid[0, :])
        film = cls(figure, machine, history, run.engine, rate, [], [])
        film._draw_machine(run, (t[-1] - t[0]) * rate / frames)
        film._draw_pressures(figure.add_subplot(grid[1, 0]), whole, "t", 1e3, "time [ms]")
        film._draw_pressures(figure.add_subplot(grid[1, 1]), whole, "V", 1e6, "volume [cm$^3$]")
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
            self.moving.append(self._gas(mm, side, shift, frame))
        self.moving += mover(self.machine, dimensions(self.engine, "left"), shift)
        for cursor in self.cursors:
            cursor(frame)

    def _gas(self, mm: dict[str, float], side: str, shift: float, frame: int) -> Artist:
        """Gas of one chamber, the darker the hotter."""
        from matplotlib import colormaps

        hottest = max(float(self.history[f"T_{name}"].max()) for name in SIDES)
        colour = colormaps["YlOrRd"](0.9 * self.history[f"T_{side}"].iloc[frame] / hottest)
        crown, head = SIDES[side] * mm["crown"] + shift, SIDES[side] * mm["head"]
        look: dict[str, Any] = {"color": colour, "linewidth": 0.0, "zorder": 0}
        return box(self.machine, crown, -0.5 * mm["bore"], head - crown, mm["bore"], **look)

    def _draw_machine(self, run: Run, slowness: float) -> None:
        """What does not move: housing, stator, and the frame around it."""
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

        def tell(frame: int) -> None:
            speed = f"slowed down {1.0 / slowness:.0f} times"
            title.set_text(f"{name}, t = {t[frame]:.4f} s, {speed}")

        self.cursors.append(tell)

    def _draw_pressures(
        self, ax: Axes, whole: pd.DataFrame, across: str, scale: float, text: str
    ) -> None:
        """Pressures of both sides over time or volume, with a dot where they are now."""
        for side, colour in COLOURS.items():
            column = f"{across}_{side}" if across == "V" else across
            start = float(whole["t"].iloc[0]) if across == "t" else 0.0
            look = COINCIDING[side]
            curve: dict[str, Any] = {"linestyle": look.line, "color": colour, "label": side}
            x, p = scale * (whole[column] - start), 1e-5 * whole[f"p_{side}"]
            ax.plot(x, p, linewidth=0.7 * look.width, **curve)
            dot_look = {**marker("o", colour), "markersize": 9, "clip_on": False}
            (dot,) = ax.plot([], [], **dot_look)
            self.cursors.append(self._follow(dot, column, f"p_{side}", start, scale))
        from_zero(ax)
        ax.set_xlim(left=0.0)
        ax.set_xlabel(text)
        ax.set_ylabel("pressure [bar]")
        finish(ax, "", "upper right" if across == "V" else None)

    def _follow(
        self, dot: Any, column: str, pressure: str, start: float, scale: float
    ) -> Callable[[int], Any]:
        """What moves a dot along its curve."""
        x = scale * (self.history[column].to_numpy() - start)
        p = 1e-5 * self.history[pressure].to_numpy()
        return lambda frame: dot.set_data([x[frame]], [p[frame]])


def _shown(run: Run, window: tuple[float, float] | None) -> tuple[pd.DataFrame, bool]:
    """What is shown, and whether its end is its beginning."""
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


def _write_gif(film: _Film, path: Path) -> None:
    """All frames in one GIF that begins again at its end."""
    from PIL import Image

    images = []
    for frame in range(len(film.history)):
        film.show(frame)
        film.figure.canvas.draw()
        pixels = np.asarray(film.figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]
        images.append(Image.fromarray(pixels.copy()).quantize(PALETTE))
    look: dict[str, Any] = {"duration": 1e3 / film.rate, "loop": 0, "optimize": True}
    images[0].save(path, format="GIF", save_all=True, append_images=images[1:], **look)


def _write_html(film: _Film, path: Path) -> None:
    """A page with all frames and their controls in it; it loads nothing."""
    from matplotlib import rc_context
    from matplotlib.animation import FuncAnimation

    def update(frame: int) -> list[Artist]:
        film.show(frame)
        return []

    count = len(film.history)
    moved = FuncAnimation(film.figure, update, frames=count, init_func=lambda: [])
    with rc_context({"animation.embed_limit": 1e3}):
        page = moved.to_jshtml(fps=round(film.rate), embed_frames=True, default_mode="loop")
    head, _, rest = page.partition("<link")
    body = head + rest.partition(">")[2]
    path.write_text(PAGE.format(style=_glyphs(), body=body), encoding="utf-8", newline="\n")


PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>saleg</title>
<style>
body {{ text-align: center; font-family: sans-serif; }}
.fa {{ font-style: normal; display: inline-block; }}
.fa-flip-horizontal {{ transform: scaleX(-1); }}
{style}
</style></head>
<body>
{body}
</body>
</html>
"""

#: Signs on the buttons, in place of those of a font matplotlib's page loads from elsewhere.
SIGNS = {
    "minus": "-",
    "plus": "+",
    "play": "\N{BLACK RIGHT-POINTING POINTER}",
    "pause": "||",
    "fast-backward": "|<",
    "fast-forward": ">|",
    "step-backward": "<",
    "step-forward": ">",
}


def _glyphs() -> str:
    rules = (f'.fa-{name}::before {{ content: "{sign}"; }}' for name, sign in SIGNS.items())
    return "\n".join(rules)


#: How each kind of file is written, by suffix.
WRITERS: dict[str, Callable[[_Film, Path], None]] = {".gif": _write_gif, ".html": _write_html}
