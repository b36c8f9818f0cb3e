"""The folder ``saleg run --out`` writes: there whole or not at all."""

from __future__ import annotations

import os
import shutil
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from saleg.errors import SalegError

if TYPE_CHECKING:
    import pandas as pd

    from saleg.results import Run

#: What a folder of ours may hold.
FILES = (
    "engine.toml",
    "performance.csv",
    "cycles.csv",
    "events.csv",
    "orbit.csv",
    "pv.png",
    "velocity_position.png",
)

PERFORMANCE_UNITS = {
    "stroke": "m",
    "compression_ratio": "-",
    "frequency": "Hz",
    "power": "W",
    "rms_power": "W",
    "efficiency": "-",
    "mean_alternator_force": "N",
    "peak_pressure": "Pa",
    "peak_acceleration": "m/s^2",
    "peak_velocity": "m/s",
    "fuel_energy_per_cycle": "J",
    "charge_mass": "kg",
    "moving_mass": "kg",
    "peak_temperature": "K",
    "peak_pressure_rise": "Pa/s",
    "indicated_work": "J",
    "indicated_efficiency": "-",
    "adverse_work": "J",
    "start_of_combustion": "s",
    "start_of_combustion_position": "m",
    "burn_centre": "s",
    "stability": "-",
    "cr_change": "-",
}


class FolderError(SalegError, OSError):
    """A folder that cannot or must not be written."""


@contextmanager
def new_folder(target: Path, force: bool = False) -> Iterator[Path]:
    """Give a temporary folder beside `target` that takes its place once all is written.

    Parameters
    ----------
    target : Path
        The folder wanted; folders above it are made.
    force : bool
        Replace an earlier folder of ours; it stays until the new one is complete.

    Yields
    ------
    Path
        Folder to write to. It is removed if anything goes wrong, Ctrl-C included.

    Raises
    ------
    FolderError
        If the target is in the way or cannot be written.
    """
    made: list[Path] = []
    try:
        target = target.resolve()
        _check(target, force)
        made = _make_parents(target)
        temporary = target.parent / f".{target.name}-{os.getpid()}"
        made.append(temporary)
        temporary.mkdir()
        yield temporary
        _check(target, force)
        _put_in_place(temporary, target)
    except BaseException as error:
        _remove(made)
        if isinstance(error, OSError) and not isinstance(error, FolderError):
            raise FolderError(f"cannot write {target}: {error.strerror or error}") from None
        raise


def _check(target: Path, force: bool) -> None:
    """Refuse a target that is in the way."""
    for folder in (target, *target.parents):
        if folder.exists() and not folder.is_dir():
            raise FolderError(f"{folder} is a file; name another folder")
    if not target.exists():
        return
    if not force:
        raise FolderError(f"{target} exists already; name another folder, or add --force")
    strange = sorted(
        entry.name for entry in target.iterdir() if entry.name not in FILES or not entry.is_file()
    )
    if strange:
        raise FolderError(
            f"{target} holds what no run of saleg writes ({', '.join(strange[:3])}"
            f"{', ...' if len(strange) > 3 else ''}) and is left alone; name another folder"
        )


def _make_parents(target: Path) -> list[Path]:
    """Make the folders above the target; returns those that were missing, outermost first."""
    missing = [folder for folder in reversed(target.parents) if not folder.exists()]
    target.parent.mkdir(parents=True, exist_ok=True)
    return missing


def _remove(made: list[Path]) -> None:
    """Remove the temporary folder and what was made above it, as far as it is empty."""
    with _undisturbed():
        if made:
            shutil.rmtree(made[-1], ignore_errors=True)
        for folder in reversed(made[:-1]):
            try:
                folder.rmdir()
            except OSError:
                return


def _put_in_place(temporary: Path, target: Path) -> None:
    """Give a complete folder its name, and remove the one that had it."""
    aside = temporary.with_name(f"{temporary.name}-old")
    with _undisturbed():
        replaces = target.exists()
        if replaces:
            target.rename(aside)
        try:
            temporary.rename(target)
        except BaseException:
            if replaces:
                aside.rename(target)
            raise
        if replaces:
            shutil.rmtree(aside)


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Hold off Ctrl-C for the moment folders change names."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def write_run(run: Run, folder: Path) -> list[str]:
    """Write tables, plots and the engine of a run; returns the names of the files.

    Plots and ``orbit.csv`` are left out if the run completed no full cycle.
    """
    import pandas as pd

    _write_text(folder / "engine.toml", run.engine.to_toml())
    performance = pd.DataFrame([run.performance.to_dict()])
    performance.attrs["units"] = PERFORMANCE_UNITS
    _write_table(folder / "performance.csv", performance)
    _write_table(folder / "cycles.csv", run.cycles.reset_index())
    _write_table(folder / "events.csv", run.events)
    if run.orbit is not None and run.orbit.history is not None:
        _write_table(folder / "orbit.csv", run.orbit.history)
        _write_plots(run, folder)
    return [name for name in FILES if (folder / name).exists()]


def _write_plots(run: Run, folder: Path) -> None:
    from saleg.plotting import new_figure, pressure_volume, velocity_position

    for name, plot in (("pv", pressure_volume), ("velocity_position", velocity_position)):
        figure = new_figure()
        plot(run, figure.subplots())
        figure.savefig(folder / f"{name}.png")


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")


def _write_table(path: Path, frame: pd.DataFrame) -> None:
    """CSV with the unit of every number in the header."""
    units = frame.attrs["units"]
    numbers = set(frame.select_dtypes("number").columns) & set(units)
    header = [f"{name} [{units[name]}]" if name in numbers else str(name) for name in frame.columns]
    frame.to_csv(path, index=False, header=header)
