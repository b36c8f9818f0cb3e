"""What compiling costs a process with an empty cache folder, and one that finds it filled.

    python benchmarks/cold.py [--repeats 1] [--beside FOLDER]

Times are of a processor, each beside a fixed loop of Python's just before and after: seconds differ
by half with what else the machine does, numbers of loops by a tenth. FOLDER holds another state of
the package (its `src`), which is timed in turns with this one.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile

#: Defines `spend`, which times a function and says so.
SPEND = """
import time
def loop():
    start, held, x = time.process_time(), {}, 0
    for n in range(1_500_000):
        x += n * n % 7
        held[n & 1023] = x
    return time.process_time() - start
def spend(what, function):
    unit, start = loop(), time.process_time()
    function()
    took = time.process_time() - start
    unit = (unit + loop()) / 2
    print(f"| {what} | {took:.1f} s | {took / unit:.0f} |", flush=True)
"""
COLD = f"""{SPEND}
import saleg
from saleg import laws
from saleg.steady import lanes
base = saleg.machines.thesis_base()
def batch(laws_of=base, in_lanes=False):
    lanes.MANY = lanes.WORTH_COMPILING = 0 if in_lanes else 10**9
    some = [laws_of.replace(**{{"translator.mass": 2.0 + n / 100}}) for n in range(3)]
    saleg.steady_states(some, workers=1)
same = base.replace(heat_transfer=laws.Annand(), friction=laws.FrictionShare(share=0.06))
more = base.replace(heat_transfer=laws.Woschni())
spend("first `simulate`", lambda: saleg.simulate(base, 0.3))
spend("first `steady_state` after it", lambda: saleg.steady_state(base))
spend("first batch after it", batch)
spend("first batch in lanes after it", lambda: batch(in_lanes=True))
spend("`simulate`, another choice with the same needs", lambda: saleg.simulate(same, 0.3))
spend("its lanes", lambda: batch(same, True))
spend("`simulate`, a choice that needs the motored pressure", lambda: saleg.simulate(more, 0.3))
"""
WARM = """
import time
import numpy
start = time.process_time()
import saleg
middle = time.process_time()
saleg.simulate(saleg.machines.thesis_base(), 1.0).performance
end = time.process_time()
print(f"| `import saleg` above numpy | {middle - start:.2f} s | |")
print(f"| first result after it, kernel on disk | {end - middle:.2f} s | |", flush=True)
"""


def run(code, cache, source):
    """Run some code in a process of its own."""
    environment = {**os.environ, "SALEG_CACHE_DIR": cache}
    if source is not None:
        environment["PYTHONPATH"] = os.path.abspath(source)
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)


def main():
    """Print what each first call costs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--beside", help="folder of another state of the package")
    options = parser.parse_args()
    sources = [None, options.beside] if options.beside else [None]
    for _ in range(options.repeats):
        for source in sources:
            print(f"| {source or 'this state'} | processor | loops |\n|---|---|---|", flush=True)
            with tempfile.TemporaryDirectory() as cache:
                run(COLD, cache, source)
                run(WARM, cache, source)
            print()


if __name__ == "__main__":
    main()
