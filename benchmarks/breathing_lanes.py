"""Engines that breathe, one after the other and in lanes.

    python benchmarks/breathing_lanes.py [--engines 1000] [--repeats 2]

Random engines of benchmarks/breathing.py with ports on both sides, or opposite a gas spring without
leaks; times are of one core, in turns.
"""

from __future__ import annotations

import argparse
import itertools
import math
import time
import warnings
from dataclasses import replace

import numpy as np

from breathing import random_engine
from saleg import Effort, laws
from saleg.engine.columns import rows_by_make
from saleg.steady import lanes
from saleg.steady.many import steady_rows

RTOL = 1e-6
#: Engines that are not many: they compile what has to be.
FEW = 9


def with_ports(number):
    """Random engine with ports on both sides."""
    return random_engine(3 * number)


def with_a_gas_spring(number):
    """Random engine with ports opposite a gas spring; neither leaks."""
    engine = random_engine(3 * number + 2)
    left = replace(engine.left, wall=laws.FixedWall(), supply=laws.Plenum(), leak=laws.NoLeak())
    return replace(engine, left=left, right=replace(engine.right, leak=laws.NoLeak()))


def valid(make, count):
    """The first valid engines of a make."""
    engines = map(make, itertools.count())
    return list(itertools.islice((e for e in engines if not e.problems()), count))


def spent(rows, total):
    """Time of a processor for some rows of a batch of so many [s], and how many have an orbit."""
    start = time.process_time()
    found = steady_rows(rows, RTOL, Effort.THOROUGH, total)
    return time.process_time() - start, sum(len(orbits.strokes) for orbits in found)


def compare(what, engines, repeats):
    """Print what a row takes either way."""
    (rows,) = rows_by_make(engines)
    few = rows.some(np.arange(min(FEW, rows.count)))
    ways = {"one after the other": 0, "in lanes": rows.count}
    best = dict.fromkeys(ways, (math.inf, 0))
    for total in ways.values():
        spent(few, total)
    for _ in range(repeats):
        for name, total in ways.items():
            best[name] = min(best[name], spent(rows, total))
    each = ", ".join(f"{n} {1e3 * t / rows.count:.2f} ({k} found)" for n, (t, k) in best.items())
    print(f"{rows.count} {what}: {each} ms a row", flush=True)


def main():
    """Compare both makes, and of the first those with sides alike and unlike."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--engines", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=2)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    lanes.MANY = lanes.WORTH_COMPILING = 1
    engines = valid(with_ports, options.engines)
    alike = [engine.right == engine.left for engine in engines]
    for what, wanted in (("with sides alike", True), ("with sides unlike", False)):
        some = [engine for engine, same in zip(engines, alike, strict=True) if same == wanted]
        compare(f"engines with ports on both sides, {what}", some, options.repeats)
    compare(
        "engines with ports opposite a gas spring",
        valid(with_a_gas_spring, options.engines),
        options.repeats,
    )


if __name__ == "__main__":
    main()
