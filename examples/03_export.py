"""A run saved and loaded: npz and CSV, and the same numbers in MATLAB, HDF5 and xarray.

Run with ``python examples/03_export.py [FOLDER]``; without a folder the files are thrown away.
"""

import importlib.util
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import scipy.io

import saleg
from saleg.export import to_xarray


def main(folder: Path) -> None:
    run = saleg.simulate(saleg.machines.thesis_base(), duration=1.0, history=10)
    stroke = run.performance.stroke

    # What is loaded equals what was saved; nothing is simulated again.
    run.save(folder / "run.npz")
    run.save(folder / "tables")  # no suffix: a folder of CSV tables
    for name in ("run.npz", "tables"):
        loaded = saleg.Run.load(folder / name)
        assert loaded.engine == run.engine
        assert loaded.performance == run.performance
        assert loaded.history.equals(run.history)

    # Without saleg: arrays with numpy, structs of columns in MATLAB.
    with np.load(folder / "run.npz") as arrays:
        assert arrays["performance.stroke"][0] == stroke
    run.save(folder / "run.mat")
    content = scipy.io.loadmat(folder / "run.mat", simplify_cells=True)
    assert content["performance"]["stroke"] == stroke
    assert content["performance_units"]["stroke"] == "m"

    if importlib.util.find_spec("h5py"):  # pip install "saleg[hdf5]"
        run.save(folder / "run.h5")
        assert saleg.Run.load(folder / "run.h5").performance == run.performance
    if importlib.util.find_spec("xarray"):  # pip install "saleg[xarray]"
        history = to_xarray(run)["history"]
        print(history.p_left.max().item() / 1e5, "bar, peak of", history.p_left.attrs["units"])
    # Table 2 of the thesis at its finest step: 180.7 mm.
    assert abs(stroke / 180.7e-3 - 1.0) < 0.001


if __name__ == "__main__":
    with TemporaryDirectory() as scratch:
        main(Path(sys.argv[1] if len(sys.argv) > 1 else scratch))
