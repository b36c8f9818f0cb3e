"""Part load at the best efficiency, beside the thesis' temperature control.

Run with ``python examples/18_part_load.py [FOLDER]``; without a folder the picture is thrown away.
With docs/images it makes that of docs/control.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

import saleg
from saleg import control
from saleg.control import Demand
from saleg.plotting import control as plots
from saleg.plotting import new_figure

ENGINE = saleg.machines.thesis_transient()
RATED = saleg.steady_state(ENGINE).performance.power
#: A made-up cycle: times [s] and power over the rated one.
CYCLE = pd.DataFrame(
    {
        "t": [1.5, 1.5, 2.5, 3.0, 3.5, 3.5, 4.5, 5.0, 6.0],
        "share": [1.0, 0.6, 0.6, 0.9, 0.9, 0.3, 0.3, 0.8, 0.5],
    }
)


def at_load(table, share):
    """Efficiency of a map at a share of the rated power, between its stable steady states."""
    good = table[(table.status == "steady") & table.stable].sort_values("power")
    return float(np.interp(share * RATED, good.power, good.efficiency))


def main(folder):
    """Maps, steps, and a cycle that is followed; the picture of them."""
    known = control.part_load_map(ENGINE)
    heated, lean = control.intake_map(ENGINE).table, control.fuel_map(ENGINE).table
    for share in (0.25, 0.5, 0.75):
        found = [at_load(table, share) for table in (heated, lean, known.table)]
        print(
            f"{share:.0%} load: heated {found[0]:.1%}, leaner {found[1]:.1%}, best {found[2]:.1%}"
        )
    assert at_load(known.table, 0.5) > at_load(heated, 0.5) + 0.07

    step = Demand.step(2.0, RATED, RATED - 2000.0)
    answers = {
        "map": control.demand_by_map(ENGINE, step, known),
        "intake temperature": control.demand_by_intake(ENGINE, step),
        "fuel": control.demand_by_fuel(ENGINE, step),
    }
    for name, run in answers.items():
        answer = control.step_response(run, step)
        print(f"{name}: settles in {answer.settling_time:.2f} s, overshoot {answer.overshoot:.1%}")

    cycle = Demand.of(CYCLE.t, CYCLE.share * RATED)
    run = control.demand_by_map(ENGINE, cycle, known, duration=7.0)
    assert run.status in (saleg.Status.STEADY, saleg.Status.COMPLETED), run.message
    after = run.dead_centres[run.dead_centres.t > 1.5]
    wanted = np.interp(after.t, CYCLE.t, CYCLE.share * RATED)
    print(f"cycle: power within {np.sqrt(np.mean((after.power - wanted) ** 2)):.0f} W rms")

    figure = new_figure(width=10.5, height=4.4)
    axes = figure.subplots(1, 2)
    others = {"heated intake": heated, "leaner charge": lean}
    plots.part_load(known, axes[0], others=others)
    axes[1].plot(after.t, after.power / 1e3, label="power")
    axes[1].plot(after.t, wanted / 1e3, "--", label="demand")
    axes[1].set_xlabel("time [s]")
    axes[1].set_ylabel("power [kW]")
    axes[1].legend()
    axes[1].set_title("A made-up cycle", fontsize="medium")
    figure.savefig(folder / "part_load.png")


if __name__ == "__main__":
    with TemporaryDirectory() as scratch:
        main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(scratch))
