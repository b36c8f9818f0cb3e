"""Side by side in one run: saleg and general solvers on the base case at equal accuracy.

    python benchmarks/run.py [--seconds 1.0] [--accuracy 1e-6] [--repeats 9]

Every solver is given the loosest of a row of tolerances at which frequency, stroke and electrical
work of the last cycle come within the accuracy of the converged ones, and the peak pressure within
five times that. Times are of a processor, the best of some repeats in turns, and are of the
integration with its start and its records, without reading figures off them; ratios are to saleg's.
scikit-sundae and heyoka take part where installed. CVODE and scipy's solvers restart from Python at
every event, some 470 times a second, which is part of what they cost here.
"""

from __future__ import annotations

import argparse
import functools
import importlib.util
import itertools
import math
import os
import platform
import subprocess
import sys
import tempfile
import time

import model
import numpy as np
import solvers

import saleg

#: Greatest resident memory of this very program; getrusage would count what started it.
USED = """
import time
def peak_memory():
    lines = open("/proc/self/status").read().splitlines()
    return next(float(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))
"""

TOLERANCES = [10.0 ** (-0.25 * n) for n in range(12, 46)]
#: Accuracy wanted of frequency, stroke, work and peak pressure, over the one asked for.
WEIGHTS = np.array([1.0, 1.0, 1.0, 5.0])


def figures(run):
    """What is compared: frequency, stroke, electrical work per cycle, peak pressure."""
    last = run.last_cycle_strokes
    stroke = np.abs(last["x_end"] - last["x_start"]).mean()
    work = last["electrical_energy"].sum()
    return np.array([1.0 / last["duration"].sum(), stroke, work, last["peak_pressure"].max()])


def candidates():
    """Solvers to compare, as functions of the tolerance returning a driver."""
    found = {
        f"solve_ivp {method}": functools.partial(solvers.scipy_solver, method)
        for method in ("DOP853", "RK45", "LSODA")
    }
    if importlib.util.find_spec("sksundae"):
        for method in ("Adams", "BDF"):
            found[f"CVODE {method}"] = functools.partial(solvers.cvode_solver, method)
    if importlib.util.find_spec("heyoka"):
        found["heyoka"] = solvers.heyoka_solver
    return found


def best_times(functions, repeats):
    """Shortest of some runs of each [s of a processor], in turns."""
    best = dict.fromkeys(functions, math.inf)
    for _ in range(repeats):
        for name, function in functions.items():
            start = time.process_time()
            function()
            best[name] = min(best[name], time.process_time() - start)
    return best


def saleg_run(rtol, seconds):
    """One run of saleg, without what only figures need."""
    return saleg.simulate(model.E, seconds, rtol=rtol)


def loosest(figures_at, wanted, accuracy):
    """Loosest tolerance that reaches the accuracy, and the error there; None if none does.

    A tolerance counts only if the next tighter one reaches the accuracy too: not by luck.
    """
    errors = {}
    for rtol, tighter in itertools.pairwise(TOLERANCES):
        for value in (rtol, tighter):
            if value not in errors:
                errors[value] = float((np.abs(figures_at(value) / wanted - 1.0) / WEIGHTS).max())
        if errors[rtol] <= accuracy and errors[tighter] <= accuracy:
            return rtol, errors[rtol]
    return None


def compare(seconds, accuracy, repeats):
    """Rows of the comparison: name, tolerance, error, seconds."""
    wanted = figures(saleg.simulate(model.E, seconds, rtol=1e-12))
    rtol, error = loosest(lambda r: figures(saleg_run(r, seconds)), wanted, accuracy)
    tolerances, runs = {"saleg": (rtol, error)}, {"saleg": lambda: saleg_run(rtol, seconds)}
    for name, make in candidates().items():
        found = loosest(
            lambda r, make=make: model.run(make(r), seconds).figures(), wanted, accuracy
        )
        tolerances[name] = found or (None, None)
        if found is not None:
            runs[name] = functools.partial(model.run, make(found[0]), seconds)
    best = best_times(runs, repeats)
    return [(name, *found, best.get(name)) for name, found in tolerances.items()]


def in_a_process(code, cache):
    """Seconds of a processor and greatest memory [MB] of a fresh interpreter running some code."""
    env = {**os.environ, "SALEG_CACHE_DIR": cache}
    out = subprocess.run(
        [sys.executable, "-c", f"{code}\n{USED}\nprint(time.process_time(), peak_memory())"],
        env=env,
        check=True,
        capture_output=True,
        text=True,
    )
    spent, memory = out.stdout.split()[-2:]
    return float(spent), float(memory)


def start_up():
    """What a fresh process costs: first ever, and with the kernel on disk."""
    result = "import saleg; saleg.simulate(saleg.machines.thesis_base(), 1.0).performance"
    cases = {
        "numpy alone": "import numpy",
        "import saleg": "import saleg",
        "first result, kernel compiled": result,
        "first result, kernel on disk": result,
    }
    with tempfile.TemporaryDirectory() as cache:
        return {name: in_a_process(code, cache) for name, code in cases.items()}


def long_run_memory(cycles):
    """Growth of memory [MB] over a long run that keeps its last ten cycles."""
    code = (
        f"{USED}\nimport saleg; e = saleg.machines.thesis_base();"
        "saleg.simulate(e, 1.0, rtol=1e-5, keep_cycles=10); before = peak_memory();"
        f"r = saleg.simulate(e, {cycles / 46.97}, rtol=1e-5, keep_cycles=10);"
        "print(peak_memory() - before)"
    )
    out = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return float(out.stdout)


def print_table(head, rows):
    """Print a table in Markdown."""
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def main():
    """Run everything and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=1.0, help="engine time to simulate")
    parser.add_argument("--accuracy", type=float, default=1e-6)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--cycles", type=int, default=100_000, help="cycles of the long run")
    options = parser.parse_args()
    machine = f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores"
    print(f"{machine}; Python {platform.python_version()}; saleg {saleg.__version__}\n")
    rows = compare(options.seconds, options.accuracy, options.repeats)
    ours = rows[0][3]
    run = saleg_run(rows[0][1], options.seconds)
    cycles = options.seconds * run.performance.frequency
    print(f"saleg evaluates {run.evaluations / cycles:.0f} right-hand sides per cycle\n")
    print_table(
        ("solver", "time / saleg", "rtol", "error", "time [ms]"),
        [
            (name, f"{t / ours:.1f}", f"{r:.1e}", f"{e:.1e}", f"{1e3 * t:.1f}")
            if r
            else (name, "-", "-", f"> {options.accuracy:g}", "-")
            for name, r, e, t in rows
        ],
    )
    base = start_up()
    floor = base["numpy alone"][0]
    print_table(
        ("start of a process", "above numpy [s]", "time [s]", "memory [MB]"),
        [(n, f"{t - floor:.2f}", f"{t:.2f}", f"{m:.0f}") for n, (t, m) in base.items()],
    )
    growth = long_run_memory(options.cycles)
    print(f"{options.cycles} cycles, the last ten kept: memory grows by {growth:.1f} MB")


if __name__ == "__main__":
    main()
