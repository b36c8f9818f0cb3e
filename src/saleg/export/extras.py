"""Optional packages, asked for only when they are needed."""

from __future__ import annotations

import importlib
from typing import Any

from saleg.errors import SalegError

#: Extra of saleg that brings a package.
EXTRAS = {
    "gymnasium": "rl",
    "h5netcdf": "xarray",
    "h5py": "hdf5",
    "pythonfmu": "fmu",
    "xarray": "xarray",
}


class MissingExtra(SalegError, ImportError):
    """An optional package that is not installed; says what to type."""


def extra(package: str) -> Any:
    """Import an optional package.

    Parameters
    ----------
    package : str
        One of :data:`EXTRAS`.

    Returns
    -------
    module

    Raises
    ------
    MissingExtra
        With the command that installs it.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise MissingExtra(
            f'this needs {package}: type  pip install "saleg[{EXTRAS[package]}]"  ({error})'
        ) from None
