"""Saving runs to files and loading them: CSV, npz, MATLAB, HDF5, netCDF and xarray.

A run becomes tables of columns with units and two texts (:func:`as_tables`); each format maps these
to a file and back. What is loaded equals what was saved, and nothing is simulated again.
"""

from saleg.errors import RunFileError
from saleg.export.description import Column, Description, as_tables
from saleg.export.extras import MissingExtra
from saleg.export.formats import (
    load,
    load_csv,
    load_hdf5,
    load_mat,
    load_netcdf,
    load_npz,
    save,
    save_csv,
    save_hdf5,
    save_mat,
    save_netcdf,
    save_npz,
)
from saleg.export.netcdf import to_xarray
from saleg.export.restore import from_tables

__all__ = [
    "Column",
    "Description",
    "MissingExtra",
    "RunFileError",
    "as_tables",
    "from_tables",
    "load",
    "load_csv",
    "load_hdf5",
    "load_mat",
    "load_netcdf",
    "load_npz",
    "save",
    "save_csv",
    "save_hdf5",
    "save_mat",
    "save_netcdf",
    "save_npz",
    "to_xarray",
]
