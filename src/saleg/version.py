"""Version of the package, and of what it runs on."""

__version__ = "0.1.0"


def show_versions() -> None:
    """Print the versions of saleg, Python and all dependencies, for reports of faults.

    Examples
    --------
    >>> import saleg
    >>> saleg.show_versions()  # doctest: +ELLIPSIS
    saleg ...
    """
    import os
    import platform
    from importlib import metadata

    packages = "numpy scipy numba llvmlite pandas matplotlib tqdm"
    extras = "h5py xarray h5netcdf dask distributed cma pymoo"
    lines = {"saleg": __version__, "python": platform.python_version()}
    for name in f"{packages} {extras}".split():
        try:
            lines[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            lines[name] = "not installed"
    lines["platform"] = platform.platform()
    lines["processors"] = str(os.cpu_count())
    print("\n".join(f"{name:<12}{value}" for name, value in lines.items()))
