"""xarray, and with it netCDF: a dataset per table, the engine in its attributes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from saleg.export import hdf5
from saleg.export.description import Description, Table, as_tables
from saleg.export.extras import extra
from saleg.simulation.run import Run

if TYPE_CHECKING:
    import xarray

KIND = "netCDF file"
NEEDS = ("h5netcdf", "xarray", "h5py")
#: A netCDF file is an HDF5 file, with tables and columns where our HDF5 files have them.
opened = hdf5.opened
#: Dimension of a table; the others go along time, and the performance is single numbers.
DIMENSIONS = {"cycles": "cycle", "performance": ""}


def to_xarray(run: Run) -> dict[str, xarray.Dataset]:
    """Turn a run into datasets, with units and words for codes in the attributes.

    Parameters
    ----------
    run : Run

    Returns
    -------
    dict of str to xarray.Dataset
        ``cycles`` along ``cycle``; ``history`` (if there is one), ``events``, ``strokes`` and the
        tables of the last cycle, ``orbit...``, along time ``t``; ``performance`` as single
        numbers. Each has the engine (TOML) and the facts of the run (JSON) as attributes.

    Raises
    ------
    MissingExtra
        Without xarray.

    Examples
    --------
    >>> import saleg
    >>> run = saleg.simulate(saleg.machines.thesis_base(), 0.5)
    >>> to_xarray(run)["cycles"].stroke.attrs["units"]
    'm'
    """
    extra("xarray")
    description = as_tables(run)
    return {
        name: _dataset(table, DIMENSIONS.get(name, "t"), description.texts)
        for name, table in description.tables.items()
    }


def _dataset(table: Table, dimension: str, texts: dict[str, str]) -> xarray.Dataset:
    import xarray

    variables: dict[str, Any] = {
        name: (dimension, column.values, hdf5.attributes(column))
        if dimension
        else ((), column.values[0], hdf5.attributes(column))
        for name, column in table.items()
    }
    times = [name for name in ("t",) if dimension and name in variables]
    return xarray.Dataset(variables, attrs=texts).set_coords(times)


def write(description: Description, path: Path) -> None:
    """Write a description as groups of a netCDF file, column by column."""
    for package in NEEDS:
        extra(package)
    import xarray

    with hdf5.writing(description, path):
        xarray.Dataset(attrs=description.texts).to_netcdf(path, engine="h5netcdf")
        for name, table in description.tables.items():
            dataset = _dataset(table, DIMENSIONS.get(name, "t"), description.texts)
            plain = {variable: {"_FillValue": None} for variable in dataset.variables}
            dataset.to_netcdf(path, mode="a", group=name, engine="h5netcdf", encoding=plain)
