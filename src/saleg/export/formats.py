"""Saving and loading a run: one way for all formats, chosen by suffix or by name."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from saleg.engine.toml import checked_laws
from saleg.errors import RunFileError, SalegError
from saleg.export import csv_folder, hdf5, matlab, netcdf, npz
from saleg.export.description import as_tables
from saleg.export.extras import MissingExtra, extra
from saleg.export.restore import restored
from saleg.files.atomic import new_file, new_folder
from saleg.files.reading import as_path, is_folder
from saleg.simulation.run import Run

#: Format of a file by its suffix; a name without one is a folder of CSV tables.
SUFFIXES: dict[str, ModuleType] = {
    "": csv_folder,
    ".npz": npz,
    ".mat": matlab,
    ".h5": hdf5,
    ".hdf5": hdf5,
    ".nc": netcdf,
}
AnyPath = str | PathLike[str]
Format = TypeVar("Format", bound=Callable[..., Any])
#: What the parameters of all functions here mean.
PARAMETERS = {
    "run": "run : Run",
    "path": "path : path-like\n    File, or folder of CSV tables.",
    "folder": "folder : path-like",
    "overwrite": "overwrite : bool\n    Whether to replace what exists.",
    "laws": "laws : sequence of type\n    Own laws and starts the engine uses, as classes.",
}


def documented(function: Format) -> Format:
    """Complete the docstring of a function that saves or loads with what all of them share."""
    if function.__doc__ is not None:  # python -OO has none
        names = inspect.signature(function).parameters
        parameters = "\n".join(PARAMETERS[name] for name in names)
        returned = "" if "run" in names else "\n\nReturns\n-------\nRun"
        raises = "\n\nRaises\n------\nRunFileError\n    Saying which file, and why."
        section = f"\n\nParameters\n----------\n{parameters}"
        function.__doc__ += f"{section}{returned}{raises}\n"
    return function


@documented
def save(run: Run, path: AnyPath, *, overwrite: bool = False) -> None:
    """Save a run in the format its suffix asks for; see :meth:`saleg.Run.save`."""
    _save(_format(as_path(path, RunFileError)), run, path, overwrite)


@documented
def load(path: AnyPath, *, laws: Sequence[type] = ()) -> Run:
    """Load a run from the format its suffix tells; see :meth:`saleg.Run.load`."""
    path = as_path(path, RunFileError)
    folder = is_folder(path, RunFileError)
    return _load(csv_folder if folder else _format(path), path, laws)


@documented
def save_npz(run: Run, path: AnyPath, *, overwrite: bool = False) -> None:
    """Save a run as numpy's npz: arrays named ``cycles.stroke`` and texts, no pickles."""
    _save(npz, run, path, overwrite)


@documented
def load_npz(path: AnyPath, *, laws: Sequence[type] = ()) -> Run:
    """Load a run :func:`save_npz` saved."""
    return _load(npz, path, laws)


@documented
def save_mat(run: Run, path: AnyPath, *, overwrite: bool = False) -> None:
    """Save a run for MATLAB: ``cycles.stroke`` a column, ``cycles_units.stroke`` its unit."""
    _save(matlab, run, path, overwrite)


@documented
def load_mat(path: AnyPath, *, laws: Sequence[type] = ()) -> Run:
    """Load a run :func:`save_mat` saved."""
    return _load(matlab, path, laws)


@documented
def save_hdf5(run: Run, path: AnyPath, *, overwrite: bool = False) -> None:
    """Save a run as HDF5: dataset ``cycles/stroke`` with an attribute ``units``; needs h5py."""
    _save(hdf5, run, path, overwrite)


@documented
def load_hdf5(path: AnyPath, *, laws: Sequence[type] = ()) -> Run:
    """Load a run :func:`save_hdf5` saved; needs h5py."""
    return _load(hdf5, path, laws)


@documented
def save_netcdf(run: Run, path: AnyPath, *, overwrite: bool = False) -> None:
    """Save the datasets of :func:`to_xarray` as groups of a netCDF file; needs xarray, h5netcdf."""
    _save(netcdf, run, path, overwrite)


@documented
def load_netcdf(path: AnyPath, *, laws: Sequence[type] = ()) -> Run:
    """Load a run :func:`save_netcdf` saved; needs h5py."""
    return _load(netcdf, path, laws)


@documented
def save_csv(run: Run, folder: AnyPath, *, overwrite: bool = False) -> None:
    """Save a run as a folder of CSV tables, units in the headers, with the engine as TOML."""
    _save(csv_folder, run, folder, overwrite)


@documented
def load_csv(folder: AnyPath, *, laws: Sequence[type] = ()) -> Run:
    """Load a run :func:`save_csv` saved."""
    return _load(csv_folder, folder, laws)


def check(suffix: str) -> None:
    """Check that the packages of a format are installed.

    Parameters
    ----------
    suffix : str
        One of :data:`SUFFIXES`.

    Raises
    ------
    MissingExtra
        Saying what to type.
    """
    for package in getattr(SUFFIXES[suffix], "NEEDS", ()):
        extra(package)


def _format(path: Path) -> ModuleType:
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        known = ", ".join(name for name in SUFFIXES if name)
        raise RunFileError(
            f"{path}: no format has the suffix '{path.suffix}'; there are {known}, "
            "and a name without suffix for a folder of CSV tables"
        )
    return SUFFIXES[suffix]


def _save(form: ModuleType, run: Run, path: AnyPath, overwrite: bool) -> None:
    path = as_path(path, RunFileError)
    if form is csv_folder:
        place = new_folder(path, overwrite, csv_folder.FILES)
    else:
        place = new_file(path, overwrite)
    with place as temporary:
        form.write(as_tables(run), temporary)


def _load(form: ModuleType, path: AnyPath, laws: Sequence[type]) -> Run:
    path = as_path(path, RunFileError)
    folder = is_folder(path, RunFileError)
    if not path.exists():
        raise RunFileError(f"{path} does not exist")
    if folder != (form is csv_folder):
        raise RunFileError(f"{path} is a {'folder' if folder else 'file'}, no {form.KIND}")
    checked_laws(laws, RunFileError)
    with _naming(path, form.KIND), form.opened(path) as stored:
        return restored(stored, laws)


@contextmanager
def _naming(path: Path, kind: str) -> Iterator[None]:
    """Say of whatever goes wrong in reading which file it is.

    The readers of strange bytes raise what they like; it stays attached as the cause.
    """
    try:
        yield
    except MissingExtra:
        raise
    except SalegError as error:
        raise RunFileError(f"cannot load {path}: {error}") from None
    except KeyError as error:
        raise RunFileError(f"cannot load {path}: it lacks {error}") from error
    except PermissionError as error:
        raise RunFileError(f"cannot read {path}: {error.strerror or error}") from None
    except Exception as error:
        raise RunFileError(
            f"cannot load {path}: it is no {kind} of saleg, or it is damaged ({error})"
        ) from error
