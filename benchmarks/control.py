"""Start-ups in a batch against the same half cycles without a controller.

    python benchmarks/control.py [--count 1000]

Plainly run, a motored half cycle is one of an engine whose alternator is a sinusoidal motor, a
fired one that of the engine at its steady state; both are timed in turns with the batch, in one
run.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import saleg
from saleg import Controller, control
from saleg.engine.start import AtRest
from saleg.laws import ResonanceSearch, SinusoidalMotor

RTOL = 1e-6
DURATION = 2.5
ENGINE = saleg.machines.thesis_transient()


def seconds(function):
    """How long a call takes [s], and what it returns."""
    start = time.perf_counter()
    result = function()
    return time.perf_counter() - start, result


def plain(engine, duration):
    """Time of a half cycle of a plain run [s]."""
    spent, run = seconds(lambda: saleg.simulate(engine, duration, rtol=RTOL, stall_stroke=0.0))
    return spent / len(run.strokes)


def main(count: int) -> None:
    """Time the batch and the plain runs in turns, and print what they cost."""
    rng = np.random.default_rng(0)
    at_rest = ENGINE.replace(start=AtRest())
    searches = [ResonanceSearch(base_frequency=f) for f in rng.uniform(32.0, 38.5, count)]
    pairs = [(at_rest, Controller(motor_control=search)) for search in searches]
    motor = at_rest.replace(alternator=SinusoidalMotor(amplitude=264.0, frequency=36.0))
    control.simulate_many(pairs[:2], DURATION, workers=1, rtol=RTOL)
    plain(motor, 0.5), plain(ENGINE, 0.5)
    spent, cost_motored, cost_fired, rows = 0.0, [], [], []
    for first in range(0, count, 100):
        part = pairs[first : first + 100]
        took, table = seconds(
            lambda part=part: control.simulate_many(part, DURATION, workers=1, rtol=RTOL)
        )
        spent += took
        rows.append(table)
        cost_motored.append(plain(motor, DURATION))
        cost_fired.append(plain(ENGINE, DURATION))
    shares = np.concatenate([table.motored_share for table in rows])
    strokes = np.concatenate([table.strokes for table in rows])
    motored = float((shares * strokes).sum())
    fired = float(((1.0 - shares) * strokes).sum())
    alone = motored * np.median(cost_motored) + fired * np.median(cost_fired)
    fired_at = np.concatenate([table.fired_at for table in rows])
    print(f"{count} start-ups of {DURATION} s: {1e3 * spent / count:.2f} ms each")
    print(
        f"half cycles: {motored:.0f} motored, {fired:.0f} fired; {np.isfinite(fired_at).sum()} lit"
    )
    print(f"the same half cycles plainly: {1e3 * alone / count:.2f} ms; ratio {spent / alone:.2f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=1000)
    main(parser.parse_args().count)
