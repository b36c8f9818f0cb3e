"""Methods of optimisation side by side on the 4 kW problem, and what they cost.

Run with ``python benchmarks/optimise.py [PART ...]``, all parts unless given. Needs
``saleg[optimize]``. The tables of docs/optimisation.md are from here.

``methods``: 2,000 designs for each of ten seeds. ``cost``: the genetic algorithm of the text at
full size beside a plain batch of the same designs. ``box``: 18,000 uniform designs of the script's
box. ``targets``: designs for the powers of Tables 9 and 10. ``fronts``: what dominates the printed
4 kW designs. ``findings``: what the text finds, on designs of ours.
"""

import itertools
import math
import sys
import time

import numpy as np
import pandas as pd

from saleg import optimize as o
from saleg.thesis import chapter_4, optimisation

DESIGNS, SEEDS, WORKERS = 2000, range(10), 2
#: The 4 kW problem in the limits of Table 11, and the same as the front behind its score.
PROBLEM = optimisation.problem(11)
FRONT = PROBLEM.replace(
    objectives=(o.Objective("efficiency"), o.Objective("power_density")),
    constraints=PROBLEM.score.limits,
)
GENETIC = o.GeneticAlgorithm(stop=math.inf)
#: Ranges in which 4 kW designs are sought [K, -].
RANGES = {
    "intake_temperature": (300, 350, 400, 500, 600, 800, 1000),
    "stroke_to_bore": (0.5, 1, 1.5, 2, 3, 4, 5, 6, 8),
}
#: Searches in each of these.
RUNS = (
    {"goal": "efficiency", "evaluations": 2000},
    {"goal": "efficiency", "evaluations": 4000, "seed": 1},
    {"goal": "power_density", "evaluations": 2000},
)
#: Methods with their problems. NSGA-II is made for fronts; it is shown as the plain genetic
#: algorithm of a single objective, too. The text's genetic algorithm makes six generations of 500
#: from 2,000 designs, so that of 100 individuals stands beside it.
METHODS = {
    "CMA-ES": (o.CMAES(), PROBLEM),
    "differential evolution": (o.DifferentialEvolution(), PROBLEM),
    "GA, 500 individuals": (GENETIC, PROBLEM),
    "GA, 100 individuals": (o.GeneticAlgorithm(size=100, stop=math.inf), PROBLEM),
    "NSGA-II, the score": (o.NSGA2(), PROBLEM),
    "NSGA-II, the front": (o.NSGA2(), FRONT),
}


def best_efficiency(found):
    """Greatest efficiency within the limits of the score of what is stable by its multipliers."""
    goal = FRONT.replace(objectives=FRONT.objectives[:1])
    rows = goal.evaluate(o.winners(found, goal, 20), multipliers=True, workers=1)
    within = goal.told(rows).violation == 0.0
    return rows["efficiency"][within & rows["stable"]].max()


def both_stages(seed):
    """CMA-ES to a score of 0.999, then efficiency within the limits, from as many designs."""
    found = o.optimize(PROBLEM, o.CMAES(), DESIGNS, seed, stop_at=0.999, workers=1)
    left = DESIGNS - len(found.table)
    return found, o.improve(found, evaluations=left, seed=seed, workers=1) if left else found


def figures(found, last):
    """Best score, designs up to 0.999, best efficiency within the limits."""
    scores = o.score(found.table, PROBLEM).to_numpy()
    reached = np.flatnonzero(scores > 0.999)
    return scores.max(), reached[0] + 1 if len(reached) else np.inf, best_efficiency(last)


def show(name, rows, seconds):
    """Print a row of the table of methods."""
    scores, counts, efficiencies = np.array(rows, dtype=float).T
    above = counts[np.isfinite(counts)]
    at = f"{np.median(above):.0f}" if len(above) else "-"
    efficiency = f"{100 * np.nanmedian(efficiencies):.1f} | {100 * np.nanmin(efficiencies):.1f}"
    print(
        f"| {name} | {np.median(scores):.4f} | {scores.min():.4f} | {len(above)} | {at} "
        f"| {efficiency} | {np.isnan(efficiencies).sum()} | {seconds / len(rows):.1f} |",
        flush=True,
    )


def methods():
    """Print what each method finds in 2,000 designs."""
    print("| method | median score | worst | seeds above 0.999 | after designs | median eff. [%] "
          "| worst | seeds without | CPU [s] |\n" + "|---" * 9 + "|")  # fmt: skip
    for name, (method, problem) in METHODS.items():
        begin = time.process_time()
        runs = [o.optimize(problem, method, DESIGNS, seed, workers=1) for seed in SEEDS]
        show(name, [figures(found, found) for found in runs], time.process_time() - begin)
    begin = time.process_time()
    rows = [figures(*both_stages(seed)) for seed in SEEDS]
    show("CMA-ES, both stages", rows, time.process_time() - begin)


def timed(work):
    """Result of some work, and the wall and processor seconds it took."""
    wall, cpu = time.perf_counter(), time.process_time()
    result = work()
    return result, time.perf_counter() - wall, time.process_time() - cpu


def cost():
    """Print the cost of the genetic algorithm of the text beside a plain batch."""
    found, wall, cpu = timed(lambda: o.optimize(PROBLEM, GENETIC, 10**6, workers=WORKERS))
    designs = found.table[~found.table["copied"]]
    _, plain_wall, plain_cpu = timed(lambda: PROBLEM.evaluate(designs, workers=WORKERS))
    print(f"{found}: {len(designs)} distinct, {found.table['verified'].sum()} with multipliers")
    print(f"  genetic algorithm  {wall:6.1f} s, {cpu:6.1f} s of processors, {WORKERS} workers")
    print(f"  plain batch        {plain_wall:6.1f} s, {plain_cpu:6.1f} s of processors")
    print(f"  ratio              {wall / plain_wall:6.2f}    {cpu / plain_cpu:6.2f}")


def box(count=18_000):
    """Print the time of uniform designs of the script's box."""
    problem = o.thesis_script.problem(4e3)
    low, high = problem.box
    designs = low + np.random.default_rng(0).random((count, len(low))) * (high - low)
    table, wall, cpu = timed(lambda: problem.evaluate(designs, workers=WORKERS))
    print(f"{count} uniform designs of the script's box: {table.status.value_counts().to_dict()}")
    print(f"  {wall:6.1f} s, {cpu:6.1f} s of processors, {WORKERS} workers")


def targets():
    """Print the best design for each target power beside the printed one."""
    for number in (9, 10):
        print(
            f"Table {number}", optimisation.targets(number, workers=WORKERS), sep="\n", flush=True
        )


def fronts():
    """Print the printed 4 kW designs, as saleg evaluates them, and what dominates them."""
    figures = ["efficiency", "power_density", "power", "compression_ratio", "intake_temperature"]
    for number, names in ((9, ["4 kW"]), (10, ["4 kW"]), (11, [*optimisation.DESIGNS.values()])):
        printed = chapter_4.run(number).loc[names]
        found = optimisation.front(number, workers=WORKERS)
        better = optimisation.beaten(found, printed)
        print(f"Table {number}: {len(found.front)} designs in front", printed[figures], sep="\n")
        print(better[[*figures, "stable"]], flush=True)


def findings():
    """Print what is favoured at 4 kW, and good designs by power."""
    figures = ["low", "high", "best_score", "efficiency", "frequency", "power_density"]
    for name, run in itertools.product(RANGES, RUNS):
        table = optimisation.along(name, RANGES[name], workers=WORKERS, **run)
        print(name, run, table[figures], sep="\n", flush=True)
    table = optimisation.uniform(12_000, workers=WORKERS)
    print(optimisation.by_power(table))
    steady = table[table["status"] == "steady"]
    ranks = steady[["efficiency", "power_density", *RANGES]].rank().corr()
    print(ranks.loc[list(RANGES), ["efficiency", "power_density"]])


def main(*wanted):
    """Print what is asked for, or all."""
    parts = {
        "methods": methods,
        "cost": cost,
        "box": box,
        "targets": targets,
        "fronts": fronts,
        "findings": findings,
    }
    pd.set_option("display.width", 120, "display.max_columns", None)
    PROBLEM.evaluate([[low for low, _ in PROBLEM.bounds.values()]], multipliers=True)  # compiles
    for name in wanted or parts:
        parts[name]()


if __name__ == "__main__":
    main(*sys.argv[1:])
