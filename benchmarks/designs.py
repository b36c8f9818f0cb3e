"""Cost of the design loop beside plain steady states, and of Dask beside threads.

Run with ``python benchmarks/designs.py [COUNT]``; ten thousand designs unless given. Needs
``saleg[dask]`` for the second part.
"""

import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

import saleg
from saleg import sweep
from saleg.design import Design

#: Box around the base case in which nearly all designs run.
RANGES = {
    "bore": (0.052, 0.080),
    "half_stroke": (0.08, 0.12),
    "port_location": (0.25, 0.42),
    "spring_stiffness": (15e3, 60e3),
    "intake_pressure": (0.9e5, 1.3e5),
    "intake_temperature": (300.0, 350.0),
    "equivalence_ratio": (0.4, 0.8),
    "egr": (0.05, 0.25),
}
WORKERS = 2


@contextmanager
def cluster(folder):
    """Scheduler and workers on loopback, each a process."""
    from distributed import Client

    file = folder / "scheduler.json"
    common = ["--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file)]
    scheduler = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", *common]
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", *common]
    worker += ["--nthreads", "1", "--local-directory", str(folder)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    processes = [subprocess.Popen(scheduler, **quiet)]
    processes += [subprocess.Popen(worker, **quiet) for _ in range(WORKERS)]
    try:
        with Client(scheduler_file=str(file), timeout=60) as client:
            client.wait_for_workers(WORKERS, timeout=60)
            yield client
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.wait()


def timed(work):
    """Result of some work and the seconds it took."""
    begin = time.perf_counter()
    result = work()
    return result, time.perf_counter() - begin


def main(count=10_000):
    """Print the costs."""
    points = sweep.latin_hypercube(RANGES, count, seed=1)
    saleg.design.evaluate_many(points.iloc[:64])  # compiles
    table, loop = timed(lambda: saleg.design.evaluate_many(points, workers=WORKERS))
    rows = zip(points.to_dict("records"), table.moving_mass, strict=True)
    engines = [Design().replace(values).engine(mass) for values, mass in rows]
    plain, alone = timed(lambda: saleg.steady_states(engines, workers=WORKERS))
    print(f"{count} designs, {WORKERS} threads: {table.status.value_counts().to_dict()}")
    print(f"  design loop    {1e3 * loop / count:6.2f} ms per design")
    print(f"  plain states   {1e3 * alone / count:6.2f} ms per engine, ratio {loop / alone:.2f}")
    strokes = table.half_cycles.sum() / plain.half_cycles.sum()
    print(f"  strokes integrated: ratio {strokes:.2f}")
    with tempfile.TemporaryDirectory() as folder, cluster(Path(folder)) as client:
        with client.get_executor() as pool:
            saleg.design.evaluate_many(points.iloc[:128], executor=pool, workers=WORKERS, chunk=8)
            again, dask = timed(
                lambda: saleg.design.evaluate_many(points, executor=pool, workers=WORKERS)
            )
        assert again.equals(table)
        print(f"  Dask, {WORKERS} workers {1e3 * dask / count:5.2f} ms, {dask / loop - 1:+.1%}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
