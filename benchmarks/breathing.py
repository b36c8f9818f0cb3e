"""Fixed points of random engines that breathe, solved for and waited for.

    python benchmarks/breathing.py [--engines 500] [--first 0]

An engine whose disturbances die away within a thousand cycles or so is simulated from its own
start until they are gone. A slower one begins at its fixed point, where it has to stay: what it
moves is scaled up by how much of the way it had time for.
"""

from __future__ import annotations

import argparse
import collections
import math
import sys
import time
import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

import saleg
from saleg import laws
from saleg.simulation.course import Course
from saleg.simulation.settings import Settings

BASE = saleg.machines.thesis_base()
#: Makes of engines: whether they have one piston, and leaks, walls and a crankcase.
MAKES = (
    ("double", False, False),
    ("double, all laws", False, True),
    ("single-piston, all laws", True, True),
)
FIGURES = ("stroke", "frequency", "power", "charge_mass", "peak_pressure")
#: How near solved and waited for have to be.
WANTED = 1e-5
#: Largest multiplier with which an engine is waited for from its own start.
WAITED_FOR = 0.985
#: Cycles in which a disturbance falls below what is wanted, over 1 / (1 - multiplier).
TIMES = 16.0
#: Cycles at the least, and at the most from a fixed point.
FEWEST, MOST = 150.0, 600.0
#: Tolerance to solve with and to wait with from a start; from a fixed point, where noise adds up.
RTOL = 1e-8
FINE = 1e-10


class Outcome(NamedTuple):
    """What came of one engine.

    Attributes
    ----------
    kind : str
        "agrees", "apart", or why there was nothing to compare.
    what : str
        How far apart, or a message.
    seconds : float
        Time to solve for it [s].
    """

    kind: str
    what: str
    seconds: float


def random_engine(number: int, makes=MAKES) -> saleg.Engine:
    """Random engine of a number; every choice of laws is one of few, so that few are compiled."""
    rng = np.random.default_rng(number)
    uniform = rng.uniform
    _, single, full = makes[number % len(makes)]
    length = 10 ** uniform(-1.3, -0.8)
    bore = length * uniform(0.4, 0.9)
    area, around = math.pi * bore**2 / 4, math.pi * bore
    ports = laws.PortFlow(
        exhaust_width=around * uniform(0.15, 0.45),
        exhaust_height=length * uniform(0.15, 0.5),
        intake_width=around * uniform(0.15, 0.5),
        intake_height=length * uniform(0.1, 0.4),
        intake_delay=length * uniform(0.0, 0.25),
        displacement=uniform(0.0, 0.9),
        exhaust_temperature=uniform(350.0, 900.0),
        exhaust_pressure=1e5 * uniform(0.9, 1.2),
        exhaust_coefficient=uniform(0.5, 0.9),
        intake_coefficient=uniform(0.5, 0.9),
    )
    cylinder = replace(
        BASE.left,
        bore=bore,
        half_stroke=length,
        port_closing=length * uniform(1.1, 1.5),
        gas_exchange=ports,
        equivalence_ratio=uniform(0.25, 0.9),
        intake=saleg.Intake(1e5 * uniform(1.05, 2.0), uniform(300.0, 400.0)),
    )
    if full:
        behind = area * uniform(0.6, 1.2)
        cylinder = replace(
            cylinder,
            leak=laws.RingLeak(gap=area * 10 ** uniform(-6, -4)),
            wall=laws.LumpedWall(
                heat_capacity=10 ** uniform(-1, 1.5), conductance=10 ** uniform(0.3, 1.7)
            ),
            supply=laws.Crankcase(
                volume_at_midpoint=behind * length * uniform(1.6, 4.0),
                area=behind,
                reed=area * uniform(0.05, 0.3),
            ),
        )
    mass = 2.4 * (length / 0.1) ** 3 * 10 ** uniform(-0.2, 0.3)
    stiffness = mass * (2 * math.pi * uniform(20.0, 60.0)) ** 2 / 2
    right = replace(cylinder, equivalence_ratio=uniform(0.25, 0.9))
    if single:
        right = saleg.BounceChamber(
            bore=bore,
            half_stroke=length,
            pressure=1e5 * uniform(1.0, 4.0),
            leak=laws.MakeUpValve(
                valve=area * 10 ** uniform(-5, -3),
                gap=area * 10 ** uniform(-6, -4),
                pressure=1e5 * uniform(1.0, 3.0),
            ),
        )
    elif rng.random() < 0.6:
        right = cylinder
    return saleg.Engine(
        translator=saleg.Translator(mass),
        left=cylinder,
        right=right,
        springs=laws.LinearSprings(stiffness=stiffness),
        alternator=laws.LinearLoad(load_constant=mass * uniform(8.0, 60.0)),
        name=f"random {number}",
    )


def compared(engine: saleg.Engine) -> Outcome:
    """Solve an engine and wait for it."""
    begun = time.perf_counter()
    steady = saleg.steady_state(engine, rtol=RTOL)
    took = time.perf_counter() - begun
    if not steady.found or not steady.has_multipliers:
        return Outcome(str(steady.status), steady.message, took)
    if not steady.stable:
        return Outcome(f"unstable: {steady.stability.kind}", steady.message, took)
    slowest = min(float(np.abs(steady.multipliers).max(initial=0.0)), 1.0 - 1e-9)
    cycles = max(TIMES / (1.0 - slowest), FEWEST)
    from_start = slowest <= WAITED_FOR
    if not from_start:
        cycles = min(cycles, MOST)
    state = saleg.simulation.initial_state.prepare(engine) if from_start else steady.replay.start
    tolerance = RTOL if from_start else FINE
    settings = Settings(cycles / steady.performance.frequency, rtol=tolerance)
    run = Course(engine, state, settings).finish()
    share = 1.0 if from_start else 1.0 - slowest**cycles
    off = {}
    for name in FIGURES:
        solved, waited = (getattr(found.performance, name) for found in (steady, run))
        off[name] = (
            abs(waited - solved) / max(abs(solved), 1e-300) / share if solved != waited else 0.0
        )
    worst = max(off, key=off.__getitem__)
    where = f"{worst} by {off[worst]:.1e}, multiplier {slowest:.5f}, {run.message}"
    if off[worst] < WANTED:
        return Outcome("agrees", where, took)
    kind = "apart" if run.status.value in ("steady", "completed") else "started elsewhere"
    return Outcome(kind, where, took)


def main() -> None:
    """Compare engines and name those that do not agree."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--engines", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    counts: collections.Counter[str] = collections.Counter()
    seconds = []
    for number in range(given.first, given.first + given.engines):
        engine = random_engine(number)
        if engine.problems():
            counts["not valid"] += 1
            continue
        outcome = compared(engine)
        counts[outcome.kind] += 1
        seconds.append(outcome.seconds)
        if outcome.kind != "agrees":
            print(number, outcome.kind, f"{outcome.seconds:.1f} s", outcome.what, flush=True)
    print(dict(counts))
    print(f"to solve, median {1e3 * np.median(seconds):.0f} ms, longest {max(seconds):.1f} s")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
