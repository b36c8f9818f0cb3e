"""The thesis' figures of its base case, and of the engine of its Chapter 5.

Run with ``python examples/02_figures.py [FOLDER]``; without a folder the pictures are thrown away.
With docs/images it makes those of docs/figures.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import saleg
from saleg.plotting import new_figure


def main(folder: Path) -> None:
    run = saleg.simulate(saleg.machines.thesis_base(), duration=1.0, motored_pressure=True)

    # Figures 36 to 38, and the p-V diagram.
    figure = new_figure(width=10.5, height=8.0)
    axes = figure.subplots(2, 2)
    run.plot.velocity_position(axes[0, 0])
    run.plot.acceleration_velocity(axes[0, 1])
    run.plot.pressure_position(axes[1, 0])
    run.plot.pressure_volume(axes[1, 1])
    figure.savefig(folder / "cycle_position.png", dpi=90)

    # Figures 39 and 40.
    figure = new_figure(width=10.5, height=8.0)
    axes = figure.subplots(2, 2)
    run.plot.pressure_time(axes[0, 0])
    run.plot.heat_flow_time(axes[0, 1])
    power = run.plot.power(axes[1, 0])
    run.plot.efficiency(axes[1, 1])
    figure.savefig(folder / "cycle_time.png", dpi=90)

    # Figure 41, as a Sankey diagram, and Figure 42.
    run.plot.energy_balance().figure.savefig(folder / "energy_balance.png", dpi=100)
    settling = run.plot.approach_to_steady_state()
    settling[0].figure.savefig(folder / "approach_to_steady_state.png", dpi=90)

    # Figures 92 and 93: the engine of Chapter 5.
    small = saleg.simulate(saleg.machines.thesis_transient(), 2.5, motored_pressure=True)
    figure = new_figure(width=10.5, height=8.0)
    axes = figure.subplots(2, 2)
    small.plot.dynamics(axes[0])
    small.plot.forces(axes[1, 0])
    small.plot.energy_pie(axes[1, 1])
    figure.savefig(folder / "chapter_5.png", dpi=90)

    # The power swings between nothing and 35 kW, twice a cycle, about a mean of 22.6 kW.
    curve = power.get_lines()[0].get_ydata()
    assert abs(curve.max() - 35.2) < 0.1
    # Table 2 at the finest step: 34.38 % efficiency. 3.6.1: more than half of the fuel's energy
    # is lost to heat ("55 %" in Figure 41; here 53 %).
    energy = run.energy
    assert abs(energy.electrical / energy.fuel - 0.3438) < 0.005
    assert abs((energy.exhaust + energy.heat_transfer) / energy.fuel - 0.53) < 0.005
    # Figure 42: steady after 0.2 s.
    late = run.cycles[run.cycles["t"] > 0.2]
    assert abs(late["stroke"] / late["stroke"].iloc[-1] - 1.0).max() < 1e-3


if __name__ == "__main__":
    with TemporaryDirectory() as scratch:
        main(Path(sys.argv[1] if len(sys.argv) > 1 else scratch))
