"""The base case of the thesis: its figures, its p-V diagram and its orbit.

Run with ``python examples/01_base_case.py [FOLDER]``; without a folder the picture is thrown away.
With docs/images it makes that of the README.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import saleg
from saleg.plotting import new_figure, pressure_volume, velocity_position


def main(folder: Path) -> None:
    run = saleg.simulate(saleg.machines.thesis_base(), duration=2.5)
    print(run)

    # Table 2 at the finest step (0.5 us): 180.7 mm, 103.3 bar. Table 5: 47.02 Hz.
    performance = run.performance
    assert run.status is saleg.Status.STEADY
    assert abs(performance.stroke / 180.7e-3 - 1.0) < 0.001
    assert abs(performance.peak_pressure / 103.3e5 - 1.0) < 0.002
    assert abs(performance.frequency / 47.02 - 1.0) < 0.002

    figure = new_figure(width=10.0, height=3.8)
    left, right = figure.subplots(1, 2)
    pressure_volume(run, left)
    velocity_position(run, right)
    figure.savefig(folder / "base_case.png", dpi=110)


if __name__ == "__main__":
    with TemporaryDirectory() as scratch:
        main(Path(sys.argv[1] if len(sys.argv) > 1 else scratch))
