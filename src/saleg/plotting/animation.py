"""An animation of a run: the translator in its housing, pressures in time, and p-V loops."""

from __future__ import annotations

from pathlib import Path

from saleg.checks import a, checked
from saleg.files.atomic import new_file
from saleg.files.reading import as_path
from saleg.plotting.film import AnimationError, Film
from saleg.plotting.film_files import WRITERS
from saleg.quantities import is_number
from saleg.simulation.run import Run

#: Limits of the number of frames, of the width [inch] and of the frames shown per second.
FRAMES, WIDTHS, RATES = (2, 400), (4.0, 16.0), (1.0, 60.0)


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
        Frames shown per second [1/s], 1 to 60.
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
    path = as_path(path, AnimationError)
    check_suffix(path)
    _within("frames", frames, FRAMES)
    _within("width", width, WIDTHS)
    _within("rate", rate, RATES)
    if frames != int(frames):
        raise AnimationError(f"frames = {frames!r}: must be a whole number")
    film = Film.of(run, window, int(frames), float(rate), float(width))
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
