"""Dead-centre control: a step of power, scattering fuel and a failed charge beside the thesis.

Run with ``python examples/12_dead_centre.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/dead_centre.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import saleg
from saleg import control
from saleg.control import DeadCentreControl, Demand, Feedback, PowerAtDeadCentre, generator


class Regulator:
    """The stroke regulator (Eq. 59) alone."""

    def act(self, signals):
        return generator(signals)


class ScatteredFuel:
    """Another controller, whose equivalence ratio scatters evenly by a share on either side."""

    def __init__(self, controller, share, seed=1):
        self.controller, self.share = controller, share
        self.random = np.random.default_rng(seed)

    def act(self, signals):
        commands = self.controller.act(signals)
        factor = 1.0 + self.share * self.random.uniform(-1.0, 1.0)
        return commands._replace(equivalence_ratio=factor * commands.equivalence_ratio)


class Cut:
    """Another controller, without fuel for one stroke."""

    def __init__(self, controller, at):
        self.controller, self.at, self.done = controller, at, False

    def act(self, signals):
        commands = self.controller.act(signals)
        if self.done or signals.t < self.at:
            return commands
        self.done = True
        return commands._replace(equivalence_ratio=0.0)


def distances(run):
    """Distance of every dead centre from the midpoint [mm]."""
    return 1e3 * np.abs(run.strokes["x_end"])


def step(engine, ax):
    """A step of -2 kW, by load and fuel at one dead centre and as in the dissertation."""
    power = saleg.steady_state(engine).performance.power
    demand = Demand.step(2.0, power, power - 2000.0)
    line = control.operating_line(engine, np.linspace(power - 3000.0, power, 7))
    runs = {
        "one dead centre": control.simulate(engine, PowerAtDeadCentre(line, demand), 5.0),
        "intake temperature": control.demand_by_intake(engine, demand, duration=5.0),
        "fuel": control.demand_by_fuel(engine, demand, duration=5.0),
        "load": control.demand_by_load(engine, demand, duration=5.0),
    }
    times = {}
    for name, run in runs.items():
        t, powers = run.strokes["t"] - 2.0, run.strokes["electrical_energy"]
        powers = powers / run.strokes["duration"]
        seen = (t > -0.2) & (t < 1.5)
        ax.plot(t[seen], 1e-3 * powers[seen], label=name)
        away = (np.abs(powers - power + 2000.0) > 100.0) & (t > 0.0)
        times[name] = np.nan if away[-1] else t[np.flatnonzero(away)[-1] + 1]
        print(f"-2 kW by {name}: settles in {times[name]:.2f} s, {run.performance.efficiency:.3f}")
    ax.set(xlabel="Time after the step [s]", ylabel="Power [kW]", ylim=(0.0, 5.0))
    ax.legend(fontsize="small")
    assert times["one dead centre"] < 0.25 < times["fuel"]
    assert np.isnan(times["load"])


def scatter(engine, ax):
    """Dead centres under 15 % scatter of the fuel."""
    steady = saleg.steady_state(engine)
    target = 1e3 * np.abs(steady.strokes["x_end"]).mean()
    holding = DeadCentreControl(steady, Feedback(scatter=0.1))
    for name, controller in (("stroke regulator", Regulator()), ("state feedback", holding)):
        run = control.simulate(engine, ScatteredFuel(controller, 0.15), 4.0)
        kept = run.strokes["t"] > 1.0
        off = (distances(run) - target)[kept]
        print(f"{name}: {np.sqrt(np.mean(off**2)):.3f} mm rms, {np.abs(off).max():.3f} mm at most")
        ax.plot(off[:150], label=name, linewidth=0.8)
    ax.set(xlabel="Stroke", ylabel="Dead centre beside target [mm]")
    ax.legend(fontsize="small")
    assert np.abs(off).max() < 0.5


def failure(engine, ax):
    """One charge without fuel, without the motor."""
    for name, controller in (
        ("stroke regulator", Regulator()),
        ("state feedback", DeadCentreControl(saleg.steady_state(engine))),
    ):
        rows = control.simulate(engine, Cut(controller, 1.5), 2.2).dead_centres
        seen = (rows.t > 1.45) & (rows.t < 1.75)
        ax.plot(1e3 * (rows.t[seen] - 1.5), rows.compression_ratio[seen], "o-", ms=3, label=name)
        print(f"{name}: least compression ratio {rows.compression_ratio[rows.t > 1.0].min():.1f}")
    ax.set(xlabel="Time after the cut [ms]", ylabel="Compression ratio [-]")
    ax.legend(fontsize="small")
    assert rows.compression_ratio[rows.t > 1.0].min() > 17.0


def main(folder: Path) -> None:
    engine = saleg.machines.thesis_transient()
    figure, axes = plt.subplots(1, 3, figsize=(12.0, 3.4), layout="constrained")
    step(engine, axes[0])
    scatter(saleg.machines.thesis_base(), axes[1])
    failure(engine, axes[2])
    figure.savefig(folder / "dead_centre.png", dpi=90)
    plt.close(figure)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
