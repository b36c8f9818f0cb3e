"""An animation of a run: the translator in its housing, pressures in time, and p-V loops."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from html import escape
from io import BytesIO
from pathlib import Path

from saleg.checks import a, checked
from saleg.files.atomic import new_file
from saleg.files.reading import as_path
from saleg.plotting.film import AnimationError, Film
from saleg.plotting.film_files import WRITERS, write_gif
from saleg.quantities import is_number
from saleg.simulation.run import Run

#: Limits of the number of frames, of the width [inch] and of the frames shown per second.
FRAMES, WIDTHS, RATES = (2, 400), (4.0, 16.0), (1.0, 60.0)


@dataclass(frozen=True, eq=False)
class Animation:
    """An animation of a run, made by :func:`animation`; a notebook's cell shows it.

    Attributes
    ----------
    run : Run
    window : (float, float) or None
        Begin and end of the time shown [s].
    frames : int
    width : float
        Width [inch].
    rate : float
        Frames shown per second [1/s].
    """

    run: Run
    window: tuple[float, float] | None
    frames: int
    width: float
    rate: float

    def save(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write a file; its suffix chooses the format: ``.gif``, or ``.html`` with controls.

        Parameters
        ----------
        path : str or Path
            It is there whole or not at all; the page needs nothing else.
        overwrite : bool
            Whether an earlier file is replaced.

        Returns
        -------
        Path
            The file written.

        Raises
        ------
        AnimationError
            If the suffix is another.
        RunFileError
            If the file is in the way or cannot be written.
        """
        path = as_path(path, AnimationError)
        check_suffix(path)
        film = self._film()
        with new_file(path, overwrite) as temporary:
            WRITERS[path.suffix.lower()](film, temporary)
        return path

    def _film(self) -> Film:
        return Film.of(self.run, self.window, self.frames, self.rate, self.width)

    def __repr__(self) -> str:
        return f"<Animation of {self.run.engine.name!r}: {self.frames} frames>"

    def _repr_html_(self) -> str:
        image = BytesIO()
        write_gif(self._film(), image)
        data = b64encode(image.getvalue()).decode("ascii")
        alt = escape(f"animation of {self.run.engine.name}")
        return f'<img src="data:image/gif;base64,{data}" alt="{alt}" style="max-width: 100%">'


@checked(run=a(Run))
def animation(
    run: Run,
    *,
    window: tuple[float, float] | None = None,
    frames: int = 48,
    width: float = 9.0,
    rate: float = 20.0,
) -> Animation:
    """Animation of the translator with both pressures in time and the p-V loops.

    The cylinders are to scale; springs, alternator and rod are schematic. It is drawn when a
    notebook's cell shows it or when it is saved.

    Parameters
    ----------
    run : Run
    window : (float, float), optional
        Begin and end of the time shown [s], of a run with a history; the last full cycle unless
        given.
    frames : int
        Number of frames, 2 to 400.
    width : float
        Width [inch], 4 to 16, of 80 dots each.
    rate : float
        Frames shown per second [1/s], 1 to 60.

    Returns
    -------
    Animation

    Raises
    ------
    AnimationError
        Naming what to change.
    """
    _within("frames", frames, FRAMES)
    _within("width", width, WIDTHS)
    _within("rate", rate, RATES)
    if frames != int(frames):
        raise AnimationError(f"frames = {frames!r}: must be a whole number")
    return Animation(run, window, int(frames), float(width), float(rate))


@checked(run=a(Run))
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
    """Write an :func:`animation` of the translator, of both pressures in time and the p-V loops.

    Parameters
    ----------
    run : Run
    path : str or Path
        File to write; its suffix chooses the format: ``.gif``, or ``.html`` for a page with
        controls that needs nothing else. It is there whole or not at all.
    window, frames, width, rate
        As for :func:`animation`.
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
    check_suffix(as_path(path, AnimationError))
    shown = animation(run, window=window, frames=frames, width=width, rate=rate)
    return shown.save(path, overwrite=overwrite)


def check_suffix(path: Path) -> None:
    """Raise an :class:`AnimationError` unless the file has a suffix that is known."""
    if path.suffix.lower() not in WRITERS:
        raise AnimationError(f"{path}: must end in {' or '.join(WRITERS)}")


def _within(name: str, value: float, limits: tuple[float, float]) -> None:
    if not is_number(value) or not limits[0] <= value <= limits[1]:
        low, high = limits
        raise AnimationError(f"{name} = {value!r}: must be a number from {low:g} to {high:g}")
