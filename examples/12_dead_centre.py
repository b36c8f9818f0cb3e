"""Dead-centre control: a step of power, scattering fuel and failed charges beside the thesis.

Run with ``python examples/12_dead_centre.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/dead_centre.md.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import saleg
from saleg import control
from saleg.control import DeadCentreControl, Demand, Feedback, PowerAtDeadCentre, generator
from saleg.laws import FuelControl, FuelCut, NeverMotored, PositionSensor
from saleg.quantities import series

SENSOR = PositionSensor(sample_time=2.5e-5, noise=2e-5, resolution=1e-5, delay=1)


class Regulator:
    """The stroke regulator (Eq. 59) alone."""

    def act(self, signals):
        return generator(signals)


class WithFuel:
    """Another controller, with the fuel of a law."""

    def __init__(self, controller, fuel):
        self.controller, self.fuel, self.memory = controller, fuel, np.zeros(4)

    def act(self, signals):
        ratio = self.fuel.equivalence_ratio(self.memory, signals)
        return self.controller.act(signals)._replace(equivalence_ratio=ratio)


@dataclass(frozen=True)
class ScatteredFuel(FuelControl):
    """Rated fuel times a factor of each dead centre."""

    factors: tuple[float, ...] = series("-", default=(1.0,), low=0)

    def equivalence_ratio(self, memory, signals):
        memory[0] += 1.0
        return self.factors[int(memory[0]) - 1] * signals.rated_equivalence_ratio


def controlled(steady, feedback, fuel, duration):
    """Runs of an engine by stroke regulator, state feedback and trajectory tracking."""
    at_dead_centres = {
        "stroke regulator": Regulator(),
        "state feedback": DeadCentreControl(steady, feedback),
    }
    for name, controller in at_dead_centres.items():
        yield name, control.simulate(steady.engine, WithFuel(controller, fuel), duration)
    within = saleg.Controller(
        state_logic=NeverMotored(),
        fuel_control=fuel,
        force_control=control.trajectory_tracking(steady, SENSOR),
        position_sensor=SENSOR,
    )
    yield "trajectory tracking", control.simulate(steady.engine, within, duration)


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
    factors = 1.0 + 0.15 * np.random.default_rng(1).uniform(-1.0, 1.0, 500)
    fuel = ScatteredFuel(factors=tuple(factors))
    worst = {}
    for name, run in controlled(steady, Feedback(scatter=0.1), fuel, 4.0):
        off = (distances(run) - target)[run.strokes["t"] > 1.0]
        worst[name] = np.abs(off).max()
        print(f"{name}: {np.sqrt(np.mean(off**2)):.3f} mm rms, {worst[name]:.3f} mm at most")
        ax.plot(off[:100], label=name, linewidth=0.8, alpha=0.4 if "regulator" in name else 1.0)
    ax.set(xlabel="Stroke", ylabel="Dead centre beside target [mm]", ylim=(-0.7, 0.7))
    ax.legend(fontsize="small")
    assert worst["state feedback"] < 0.5
    assert worst["trajectory tracking"] < 0.25


def failure(engine, ax):
    """Two charges without fuel; the motor has its part in the tracking alone."""
    steady, least = saleg.steady_state(engine), {}
    for name, run in controlled(steady, Feedback(), FuelCut(at=1.5, strokes=2), 2.2):
        rows = run.dead_centres
        seen = (rows.t > 1.45) & (rows.t < 1.75)
        ax.plot(1e3 * (rows.t[seen] - 1.5), rows.compression_ratio[seen], "o-", ms=3, label=name)
        least[name] = rows.compression_ratio[rows.t > 1.0].min()
        print(f"{name}: least compression ratio {least[name]:.1f}")
    ax.set(xlabel="Time after the cut of two charges [ms]", ylabel="Compression ratio [-]")
    ax.set_ylim(12.0, 20.0)
    ax.legend(fontsize="small")
    assert least["state feedback"] > 16.0
    assert least["trajectory tracking"] > 17.7


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
