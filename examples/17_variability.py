"""Cyclic variability: how cycles scatter with the fuel, and what springs do about it.

Run with ``python examples/17_variability.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/variability.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.optimize import brentq

import saleg
from saleg import laws
from saleg.plotting import new_figure

ENGINE = saleg.machines.thesis_transient()
#: Share of the springs that each engine has, and the range in which its mass is looked for [kg].
SHARES = {0.0: (0.95, 1.0), 0.25: (1.5, 2.6), 0.5: (2.5, 3.6), 1.0: (4.5, 5.5), 2.0: (8.0, 9.5)}


def with_springs(share):
    """The engine with other springs, and the mass that keeps its frequency."""
    frequency = saleg.steady_state(ENGINE).performance.frequency
    stiffness = share * ENGINE.springs.stiffness

    def off(mass):
        changed = ENGINE.replace(**{"springs.stiffness": stiffness, "moving_mass": mass})
        return saleg.steady_state(changed).performance.frequency - frequency

    mass = brentq(off, *SHARES[share], xtol=1e-3)
    return ENGINE.replace(**{"springs.stiffness": stiffness, "moving_mass": mass})


def scattered(engine, runs=10, **spread):
    """Means over some seeds."""
    table = saleg.studies.variability(
        engine.replace(scatter=laws.CyclicVariability(**spread)), runs, 6.0
    )
    assert not table["ended_early"].any()
    return table.mean(numeric_only=True)


def main(folder: Path) -> None:
    spreads = [0.01, 0.03, 0.06, 0.1]
    by_fuel = [scattered(ENGINE, fuel=spread) for spread in spreads]
    by_springs = [scattered(with_springs(share), fuel=0.05) for share in SHARES]
    for share, found in zip(SHARES, by_springs, strict=True):
        print(
            f"springs x {share:4}: COV of work {100 * found.cov_work:.2f} %, dead centre "
            f"{1e3 * found.dead_centre_left:.3f} mm, CR {found.compression_ratio_scatter:.2f}"
        )
    # The springs halve the scatter of the work and more than halve that of the dead centre.
    without, its_own = by_springs[0], by_springs[3]
    assert 1.8 < without.cov_work / its_own.cov_work < 2.2
    assert without.dead_centre_left > 2.5 * its_own.dead_centre_left
    # Small scatter is in proportion to its cause.
    assert np.isclose(by_fuel[1].cov_imep, 3.0 * by_fuel[0].cov_imep, rtol=0.02)

    figure = new_figure(width=11.0, height=4.3)
    left, right = figure.subplots(1, 2)
    percent = [100 * spread for spread in spreads]
    left.plot(percent, [100 * row.cov_imep for row in by_fuel], "o-", label="IMEP")
    left.plot(percent, [100 * row.cov_work for row in by_fuel], "s-", label="work of both sides")
    left.set_xlabel("standard deviation of the fuel of a charge [%]")
    left.set_ylabel("coefficient of variation [%]")
    left.set_title(f"{ENGINE.name}, its own springs")
    left.legend()
    shares = list(SHARES)
    right.plot(
        shares, [1e3 * row.dead_centre_left for row in by_springs], "o-", label="dead centre"
    )
    right.set_xlabel("stiffness over that of the engine, at the same frequency")
    right.set_ylabel("standard deviation of a dead centre [mm]")
    beside = right.twinx()
    beside.plot(shares, [100 * row.cov_work for row in by_springs], "s--", color="C1", label="work")
    beside.set_ylabel("coefficient of variation of the work [%]")
    right.set_ylim(bottom=0.0)
    beside.set_ylim(bottom=0.0)
    right.set_title("fuel scattered by 5 %")
    lines = [*right.get_lines(), *beside.get_lines()]
    right.legend(lines, [line.get_label() for line in lines], loc="upper right")
    figure.savefig(folder / "variability.png", dpi=100)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as folder:
            main(Path(folder))
