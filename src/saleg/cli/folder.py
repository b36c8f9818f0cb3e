"""The folder ``saleg run --out`` writes: there whole or not at all."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

from saleg.cli import pictures
from saleg.export import csv_folder, formats
from saleg.export.description import as_tables
from saleg.files import atomic
from saleg.simulation.performance import UNITS as PERFORMANCE_UNITS

if TYPE_CHECKING:
    from saleg.simulation.run import Run

__all__ = ["FILES", "FORMATS", "PERFORMANCE_UNITS", "new_folder", "write_run"]

#: Formats of the whole run, by the word on the command line, with the suffix of their file.
FORMATS = {"csv": "", "npz": ".npz", "mat": ".mat", "hdf5": ".h5", "netcdf": ".nc"}
PLOTS = ("pv.png", "velocity_position.png")
#: What a folder of ours holds after a run with a full cycle and without history.
FILES = (*(name for name in csv_folder.FILES if name != "history.csv"), *PLOTS)
#: What it may hold.
KNOWN = (*csv_folder.FILES, *PLOTS, *(f"run{suffix}" for suffix in FORMATS.values() if suffix))


def new_folder(target: Path, force: bool = False) -> AbstractContextManager[Path]:
    """Give a temporary folder beside `target` that takes its place once all is written.

    Parameters
    ----------
    target : Path
        The folder wanted; folders above it are made.
    force : bool
        Replace an earlier folder of ours; it stays until the new one is complete.

    Returns
    -------
    context manager
        Gives the folder to write to; see :func:`saleg.files.atomic.new_folder`.
    """
    known = (*KNOWN, *(f"{name}.png" for name in pictures.names()))
    return atomic.new_folder(target, force, known, how="add --force")


def write_run(run: Run, folder: Path, wanted: Sequence[str] = ("csv",)) -> list[str]:
    """Write the engine, the run in the formats wanted, and plots; returns the names of the files.

    Without a full cycle there are no plots.
    """
    description = as_tables(run)
    atomic.write_text(folder / csv_folder.ENGINE, description.engine_toml)
    for suffix in (FORMATS[word] for word in wanted):
        target = folder / f"run{suffix}" if suffix else folder
        formats.SUFFIXES[suffix].write(description, target)
    if run.orbit is not None:
        _write_plots(run, folder)
    return [name for name in KNOWN if (folder / name).exists()]


def _write_plots(run: Run, folder: Path) -> None:
    from saleg.plotting import new_figure, pressure_volume, velocity_position

    for name, plot in zip(PLOTS, (pressure_volume, velocity_position), strict=True):
        figure = new_figure()
        plot(run, figure.subplots())
        figure.savefig(folder / name)
