"""Steady states: solved against waited for, one by one, together, in lanes, sweeps, threads.

    python benchmarks/steady.py [--designs 1000] [--repeats 5] [--agree 500] [--memory 100000]
                                [--line 1000] [--grid 100]

Random designs vary the base case by a fifth. Waiting is 2.5 s of simulation with the same
integrator at the same tolerance, as the thesis does it; both are timed in turns in one run. Times
are of a processor but for grids, threads and processes, which need an idle machine.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np

import saleg
from saleg import sweep
from saleg.batch.many import steady_row
from saleg.steady import lanes, lines, many
from saleg.steady.solver import found_steady_state

BASE = saleg.machines.thesis_base()
PATHS = (
    "bore",
    "half_stroke",
    "moving_mass",
    "spring.stiffness",
    "intake.pressure",
    "equivalence_ratio",
    "egr",
    "alternator.load_constant",
    "friction.coefficient",
)
RTOL = 1e-6


def designs(count, seed=0, spread=0.2):
    """Random engines around the base case, one after the other."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        changes = {path: BASE.get(path) * rng.uniform(1 - spread, 1 + spread) for path in PATHS}
        changes["port_closing"] = changes["half_stroke"] * 1.33 * rng.uniform(0.9, 1.1)
        changes["intake.temperature"] = 325.0 * rng.uniform(0.9, 1.1)
        changes["alternator.regulator_gain"] = rng.uniform(3.0, 7.5)
        yield BASE.replace(**changes)


def seconds(function, clock=time.process_time):
    """How long a call takes [s of a processor, unless of the clock], and what it returns."""
    start = clock()
    result = function()
    return clock() - start, result


def compare(engines):
    """Solving against waiting, a few designs of each in turns."""
    solved, waited, found = 0.0, 0.0, []
    for first in range(0, len(engines), 20):
        part = engines[first : first + 20]
        spent, states = seconds(lambda part=part: [saleg.steady_state(e, rtol=RTOL) for e in part])
        solved += spent
        found += states
        waited += seconds(lambda part=part: [saleg.simulate(e, 2.5, rtol=RTOL) for e in part])[0]
    count = len(engines)
    halves = [state.half_cycles for state in found]
    methods = {method: sum(s.method == method for s in found) for method in ("fixed point",)}
    print(f"solving {1e3 * solved / count:.2f} ms, waiting {1e3 * waited / count:.2f} ms a design")
    print(
        f"ratio {waited / solved:.1f}; half cycles: mean {np.mean(halves):.1f}, most {max(halves)}"
    )
    print(f"found as a fixed point: {methods['fixed point']} of {count}\n")


def batch(engines, rtol, in_lanes):
    """Table of engines solved together, one after the other or in lanes."""
    least, enough = lanes.MANY, lanes.WORTH_COMPILING
    lanes.MANY = lanes.WORTH_COMPILING = 0 if in_lanes else np.inf
    try:
        return saleg.steady_states(engines, rtol=rtol, workers=1)
    finally:
        lanes.MANY, lanes.WORTH_COMPILING = least, enough


def together(engines, repeats):
    """Best of some repeats of tables of engines solved one by one and together, in turns."""
    row_of = partial(steady_row, multipliers=False)
    for rtol in (RTOL, 1e-9):
        ways = {
            "one by one": lambda rtol=rtol: [row_of(found_steady_state(e, rtol)) for e in engines],
            "together": lambda rtol=rtol: batch(engines, rtol, False),
            "in lanes": lambda rtol=rtol: batch(engines, rtol, True),
        }
        batch(engines[: lanes.WIDTH], rtol, True)  # compiled, if it has to be
        best = dict.fromkeys(ways, np.inf)
        for _ in range(repeats):
            for name, way in ways.items():
                best[name] = min(best[name], seconds(way)[0])
        for name, spent in best.items():
            ratio = best["one by one"] / spent
            print(
                f"rtol {rtol:.0e}, {name}: {1e3 * spent / len(engines):.3f} ms a row ({ratio:.2f})"
            )
    print()


def from_own_starts(solve):
    """What a call gives, and its time, where no row follows another."""
    kept, many.lines_among = many.lines_among, lambda numbers: lines.no_lines(len(numbers))
    try:
        return seconds(solve)
    finally:
        many.lines_among = kept


def along_a_line(points, repeats):
    """Best of some repeats of a sweep, with and without multipliers, and one by one, in turns."""
    ratios = np.linspace(0.4, 0.6, points)
    for what, multipliers, swept in (
        ("engines", False, BASE),
        ("designs", False, None),
        ("engines, multipliers", True, BASE),
    ):
        table = sweep.listed({"equivalence_ratio": ratios[:: 10 if multipliers else 1]})
        run = partial(sweep.run, table, swept, rtol=RTOL, multipliers=multipliers, workers=1)
        engines = [BASE.replace(equivalence_ratio=ratio) for ratio in table.equivalence_ratio]
        row_of = partial(steady_row, multipliers=multipliers)
        alone = partial(lambda engines, row: [row(saleg.steady_state(e)) for e in engines], engines)
        best = {}
        for _ in range(repeats):
            spent = {"along the line": seconds(run), "own starts": from_own_starts(run)}
            if swept is not None:
                spent["one by one"] = seconds(partial(alone, row_of))
            for name, (time_, found) in spent.items():
                best[name] = min(best.get(name, np.inf), time_)
                if name == "along the line":
                    half_cycles = found.half_cycles.mean()
        each = ", ".join(f"{name} {1e3 * t / len(table):.3f}" for name, t in best.items())
        print(f"{len(table)} {what} along a line: {each} ms a row; {half_cycles:.1f} half cycles")
    print()


def on_a_grid(points):
    """Time of a square grid with all processors."""
    ends = {"bore": (0.056, 0.070), "equivalence_ratio": (0.4, 0.8)}
    table = sweep.grid({name: np.linspace(*pair, points) for name, pair in ends.items()})
    for multipliers in (False, True):
        run = partial(sweep.run, table, BASE, rtol=RTOL, multipliers=multipliers)
        spent, found = seconds(run, time.perf_counter)
        print(
            f"{points} x {points} grid, multipliers {multipliers}: {spent:.1f} s, "
            f"{found.half_cycles.mean():.1f} half cycles, {(found.status == 'steady').sum()} steady"
        )
    print()


def at_once(engines, repeats):
    """Best of some repeats of a table with one thread, two, and two processes, in turns."""
    with ProcessPoolExecutor(2) as pool:
        ways = {
            "one thread": {"workers": 1},
            "two threads": {"workers": 2},
            "two processes": {"executor": pool},
        }
        best = dict.fromkeys(ways, np.inf)
        for _ in range(repeats):
            for name, how in ways.items():
                table = partial(saleg.steady_states, engines, **how)
                best[name] = min(best[name], seconds(table, time.perf_counter)[0])
    each = ", ".join(f"{name} {1e3 * t / len(engines):.3f}" for name, t in best.items())
    print(f"{len(engines)} rows: {each} ms a row\n")


def agreement(count):
    """Greatest difference of the figures of states solved for and waited for 8 s, at rtol 1e-9."""
    names = ("stroke", "frequency", "compression_ratio", "power", "peak_pressure")
    worst, disagree = 0.0, []
    for number, engine in enumerate(designs(count, seed=11)):
        found = saleg.steady_state(engine, rtol=1e-9)
        run = saleg.simulate(engine, 8.0, rtol=1e-9, keep_cycles=20)
        pairs = [(getattr(found.performance, n), getattr(run.performance, n)) for n in names]
        off = max(abs(a / b - 1.0) for a, b in pairs) if found.found else np.inf
        if off < 1e-5:
            worst = max(worst, off)
        else:
            disagree.append(f"  {number}: {off:.1e}; {found.message}; waited: {run.message}")
    print(f"solved and waited for: {count - len(disagree)} of {count} within {worst:.1e}")
    print("\n".join(disagree))


def memory(count):
    """Growth of memory [MB] of a process over a table of many designs."""
    code = f"""
import sys; sys.path.insert(0, {os.path.dirname(os.path.abspath(__file__))!r})
import steady
def peak():
    lines = open("/proc/self/status").read().splitlines()
    return next(float(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))
steady.saleg.steady_states(steady.designs(100)); before = peak()
table = steady.saleg.steady_states(steady.designs({count}))
print(len(table), before, peak())
"""
    out = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    rows, before, after = (float(number) for number in out.stdout.split())
    print(f"{rows:.0f} designs in one call: {before:.0f} MB before, {after:.0f} MB at most")


def main():
    """Run everything and print it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--designs", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--agree", type=int, default=500, help="designs also waited for at 1e-9")
    parser.add_argument("--memory", type=int, default=100_000, help="designs of the memory test")
    parser.add_argument("--line", type=int, default=1000, help="points of a sweep along a line")
    parser.add_argument("--grid", type=int, default=100, help="points of a grid in each direction")
    options = parser.parse_args()
    machine = f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores"
    print(f"{machine}; Python {platform.python_version()}; saleg {saleg.__version__}\n")
    engines = list(designs(options.designs))
    saleg.steady_state(BASE)
    saleg.simulate(BASE, 0.1)
    compare(engines)
    together(engines, options.repeats)
    if options.line:
        along_a_line(options.line, options.repeats)
    if options.grid:
        on_a_grid(options.grid)
    at_once(engines, options.repeats)
    if options.agree:
        agreement(options.agree)
    if options.memory:
        memory(options.memory)


if __name__ == "__main__":
    main()
