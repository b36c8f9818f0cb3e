"""Optimisation: a 4 kW engine by the score of Figure 85, then as efficient as its limits allow.

Run with ``python examples/10_optimise.py [FOLDER]``; without a name it makes the pictures of
docs/optimisation.md.
"""

import sys
from pathlib import Path

from saleg import optimize
from saleg.optimize import Archive, Limit, Objective

#: Designs of each search.
DESIGNS = {"score": 1500, "efficiency": 500, "archive": 600, "front": 600}
PICTURES = Path(__file__).resolve().parent.parent / "docs" / "images"


def main(folder: Path = PICTURES) -> None:
    def save(axes, name, dpi=80):
        axes.figure.savefig(folder / f"optimisation_{name}.png", dpi=dpi)

    # Compression ratio of 5 to 25, intake from 300 K and 1 bar, mixtures from 0.35 on (Table 11).
    problem = optimize.thesis_problem(target_power=4e3, compression_ratio=(5.0, 25.0))
    found = optimize.optimize(problem, evaluations=DESIGNS["score"], seed=11, stop_at=0.999)
    print(found)
    assert found.best["score"] > 0.99
    assert found.best["stable"]
    save(found.plot.score()[0], "score")
    save(found.plot.convergence(), "convergence")
    save(found.plot.design_map(), "map")

    # The score is met from 42 % on; within its limits there is more to win.
    better = optimize.improve(found, "efficiency", evaluations=DESIGNS["efficiency"], seed=11)
    print(better)
    assert better.best["efficiency"] > found.best["efficiency"]
    assert abs(better.best["power"] / 4e3 - 1.0) <= 0.05
    save(better.plot.parallel(count=40), "parallel", 72)
    save(better.plot.engine(), "engine", 120)

    # Where good designs are, and where there are none.
    count = DESIGNS["archive"]
    archive = optimize.optimize(problem, Archive(), evaluations=count, seed=1, start=found.table)
    save(archive.plot.archive(), "archive")

    # Efficiency against power density, from 3.5 kW on.
    goals = (Objective("efficiency"), Objective("power_density"))
    limits = (Limit("power", 3.5e3), Limit("compression_ratio", 5.0, 25.0))
    limits += (Limit("peak_pressure", high=250e5),)
    two = problem.replace(objectives=goals, constraints=limits)
    start, count = optimize.winners(better, two), DESIGNS["front"]
    front = optimize.optimize(two, evaluations=count, seed=1, start=start)
    print(f"{len(front.front)} designs in front")
    save(front.plot.front(), "front")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
