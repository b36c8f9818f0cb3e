"""Many different designs for half a second each: heyoka's batches beside saleg's lanes.

    python benchmarks/ensemble.py [--designs 200] [--repeats 5] [--accuracy 1e-6]

Mass, springs, friction, load, intake pressure, equivalence ratio and recirculation are each within
a tenth of the base case. Each way is given the loosest tolerance at which nine designs of ten have
the accuracy of benchmarks/run.py. heyoka steps as many designs side by side as it recommends, in
one call until any of them meets an event or its end; Python then does what is due there, puts the
next design in the place of one that is over, and goes on. saleg's lanes have no public way to
simulate, only to look for steady states; what the package has for that steps them here from dead
centre to dead centre, without tables.
"""

from __future__ import annotations

import argparse
import math
import time

import model
import numba
import numpy as np
import run
import solvers

import saleg
from saleg.compiler.compiled_engine import kernel_of_lanes, numbers_of_rows
from saleg.compiler.lanes.width import WIDTH
from saleg.compiler.run_at import run_at
from saleg.engine.columns import rows_by_make
from saleg.kernel.lanes.group import run_of
from saleg.kernel.layout import BEGIN, GOES_ON
from saleg.simulation.initial_rows import prepare_rows
from saleg.steady import lanes
from saleg.steady.return_map import STEPS_PER_CALL, ReturnMap

PATHS = (
    "moving_mass",
    "spring.stiffness",
    "friction.coefficient",
    "alternator.load_constant",
    "intake.pressure",
    "equivalence_ratio",
    "egr",
)
#: Those that stand in the equations, behind the parameters of the base case and the switches.
IN_EQUATIONS = PATHS[:4]
SECONDS = 0.5
TOLERANCES = run.TOLERANCES[4::2]
#: Share of the designs that must be as accurate as wanted.
SHARE = 0.9
#: Time from a turn within which another one is the same [s].
SAME_TURN = 1e-4


def designs(count):
    """Random engines of the geometry and the laws of the base case."""
    rng = np.random.default_rng(5)
    for _ in range(count):
        yield model.E.replace(**{p: model.E.get(p) * rng.uniform(0.9, 1.1) for p in PATHS})


class Batch:
    """heyoka's integrator for some designs side by side.

    Parameters
    ----------
    rtol : float
    width : int

    Attributes
    ----------
    inside : float
        Time spent in its compiled code so far [s].
    """

    def __init__(self, rtol, width):
        import heyoka as hk

        self.switch, self.width = model.N_PARAMETERS, width
        first = self.switch + 7
        own = [hk.par[first + n] for n in range(len(IN_EQUATIONS))]
        system, self.kinds, functions = solvers.heyoka_equations(*own)
        self.inside = 0.0
        self.own = slice(first, first + len(own))
        self.integrator = hk.taylor_adaptive_batch(
            system,
            np.zeros((model.N, width)),
            pars=np.zeros((first + len(own), width)),
            tol=rtol,
            t_events=[hk.t_event_batch(function) for function in functions],
        )

    def run(self, engines):
        """Bring each engine to the end of its time."""
        waiting = list(reversed(engines))
        held = [waiting.pop() for _ in range(self.width)]
        busy = np.full(self.width, True)
        ends = np.array([self.restart(lane, held[lane]) for lane in range(self.width)])
        while busy.any():
            begun = time.process_time()
            self.integrator.propagate_until(ends)
            self.inside += time.process_time() - begun
            for lane in np.flatnonzero(busy).tolist():
                hit = -int(self.integrator.propagate_res[lane][0]) - 1  # events are -1, -2, ...
                at_event = 0 <= hit < len(self.kinds)
                if not at_event and self.integrator.time[lane] < ends[lane]:
                    continue
                if not self.happen(lane, held[lane], self.kinds[hit] if at_event else None):
                    continue
                if held[lane].t >= SECONDS:
                    busy[lane] = bool(waiting)
                    held[lane] = waiting.pop() if waiting else held[lane]
                ends[lane] = self.restart(lane, held[lane])

    def happen(self, lane, engine, kind):
        """Do what is due in a lane, an event of a kind or a known time; whether anything was."""
        engine.t = float(self.integrator.time[lane])
        engine.y = self.integrator.state[:, lane].copy()
        event = {event[:2]: event for event in engine.possible()}.get(kind)
        if kind is not None and not self.counts(event, engine):
            return False
        if engine.t < SECONDS:
            engine.happen(event)
        return True

    def counts(self, event, engine):
        """Whether an event is passed in the direction that counts, and for the first time."""
        if event is None:
            return False
        kind, _, _, _, direction = event
        if kind == "turn":
            return engine.t > engine.last_turn[0] + SAME_TURN
        return kind != "port" or np.sign(engine.y[model.V]) == np.sign(direction)

    def restart(self, lane, engine):
        """Put an engine into a lane; until when to go on."""
        integrator = self.integrator
        times = np.array(integrator.time)
        times[lane] = engine.t
        integrator.set_time(times)
        integrator.state[:, lane] = engine.y
        wanted = {event[:2] for event in engine.possible()}
        integrator.pars[: self.switch, lane] = engine.par
        integrator.pars[self.switch : self.own.start, lane] = [k in wanted for k in self.kinds]
        integrator.pars[self.own, lane] = engine.numbers
        integrator.reset_cooldowns(lane)
        return min(engine.end_of_combustion(), SECONDS)


@numba.njit
def begin(group, lane, t_end):
    """Let a lane go on to its next dead centre or its end."""
    run = lane_of(group.runs, lane)
    E, O = run.engine[0], run.options[0]
    O.last_stroke, O.t_end, O.part = E.strokes + 1.0, t_end, BEGIN
    run.tables.filled[0].strokes = 0
    run.tables.filled[0].events = 0
    run_at(group.address, run)
    group.fresh[lane], group.codes[lane] = 1, GOES_ON


@numba.njit
def all_in_lanes(steps, group, rows, t_end):
    """Simulate every row, as many side by side as there are lanes."""
    laws, engine, chambers, y = rows
    words, width = group.runs.words, len(group.codes)
    row, begun, busy = np.full(width, -1), 0, True
    while busy:
        busy = False
        for lane in range(width):
            if row[lane] >= 0 and group.runs.engine[lane, 0].t >= t_end:
                y[row[lane]] = group.runs.y[lane]
                row[lane] = -1
            if row[lane] < 0 and begun < len(laws):
                row[lane] = begun
                group.runs.laws[lane] = laws[begun]
                words.engine[lane, 0] = engine[begun]
                words.chambers[lane] = chambers[begun]
                group.runs.y[lane] = y[begun]
                begun += 1
            if row[lane] >= 0:
                begin(group, lane, t_end)
                busy = True
        if busy:
            run_at(steps, group)
    return y


lane_of = numba.njit(run_of)


def in_lanes(engines, rtol):
    """States of all engines at the end of their time, stepped in lanes."""
    (rows,) = rows_by_make(engines)
    states, _ = prepare_rows(rows, lambda engine: engine)
    one = rows.row(0)
    return_map = ReturnMap.of(one, states.row(0), rtol, False, STEPS_PER_CALL)
    room = lanes.lanes_of(return_map, kernel_of_lanes(one, WIDTH), WIDTH)
    count = len(engines)
    words = states.engine.view(np.int64).reshape(count, -1)
    chambers = states.chambers.view(np.int64).reshape(count, 2, -1)
    held = numbers_of_rows(rows.engine, count), words, chambers, states.y
    return all_in_lanes(room.address, room.group, held, SECONDS)


def worst_of_most(found, wanted):
    """Error that nine designs of ten keep, over what is wanted of each figure."""
    errors = (np.abs(found / wanted - 1.0) / run.WEIGHTS).max(axis=1)
    return float(np.quantile(errors, SHARE))


def loosest(figures_at, wanted, accuracy):
    """Loosest tolerance with the accuracy, and the error there."""
    for rtol in TOLERANCES:
        error = worst_of_most(figures_at(rtol), wanted)
        if error <= accuracy:
            return rtol, error
    raise SystemExit("no tolerance reaches the accuracy")


def prepared(engines):
    """The engines as the model has them, at their starts."""
    ready = [model.Engine(engine) for engine in engines]
    for one, engine in zip(ready, engines, strict=True):
        one.peaks_from = SECONDS - 0.03
        one.numbers = [engine.get(path) for path in IN_EQUATIONS]
    return ready


def of_heyoka(batch, engines):
    """Figures of all engines."""
    ready = prepared(engines)
    batch.run(ready)
    return np.array([engine.figures() for engine in ready])


def of_saleg(engines, rtol):
    """Figures of all engines."""
    return np.array([run.figures(saleg.simulate(engine, SECONDS, rtol=rtol)) for engine in engines])


def timed(function, *arguments):
    """Seconds of a processor a call takes."""
    start = time.process_time()
    function(*arguments)
    return time.process_time() - start


def main():
    """Print what a design takes each way, in turns."""
    import heyoka as hk

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--designs", type=int, default=200)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--accuracy", type=float, default=1e-6)
    options = parser.parse_args()
    hk.set_logger_level_error()
    engines, width = list(designs(options.designs)), hk.recommended_simd_size()
    compiling = timed(Batch, TOLERANCES[-1], width)
    print(f"heyoka compiles its integrator of {width} designs side by side in {compiling:.1f} s\n")
    wanted = of_saleg(engines, 1e-12)
    ours, error = loosest(lambda rtol: of_saleg(engines, rtol), wanted, options.accuracy)
    theirs, their_error = loosest(
        lambda rtol: of_heyoka(Batch(rtol, width), engines), wanted, options.accuracy
    )
    batches = {w: Batch(theirs, w) for w in (1, width)}
    in_lanes(engines, ours)  # compiled
    lanes.MANY = lanes.WORTH_COMPILING = 0
    ways = {
        "saleg, one by one": lambda: of_saleg_alone(engines, ours),
        f"saleg, {WIDTH} lanes": lambda: in_lanes(engines, ours),
        f"saleg, steady states in {WIDTH} lanes": lambda: saleg.steady_states(
            engines, rtol=ours, workers=1
        ),
    }
    for w, batch in batches.items():
        ways[f"heyoka, {w} side by side"] = lambda batch=batch: batch.run(prepared(engines))
    best = dict.fromkeys(ways, math.inf)
    inside = dict.fromkeys(batches, math.inf)
    for _ in range(options.repeats):
        for batch in batches.values():
            batch.inside = 0.0
        for name, way in ways.items():
            best[name] = min(best[name], timed(way))
        inside = {w: min(inside[w], batch.inside) for w, batch in batches.items()}
    rows = [
        (name, theirs, their_error) if "heyoka" in name else (name, ours, error) for name in ways
    ]
    rows = [(*row, best[row[0]]) for row in rows]
    for w, spent in inside.items():
        rows.append((f"heyoka, {w} side by side, without Python", theirs, their_error, spent))
    base = best["saleg, one by one"]
    run.print_table(
        ("way", "rtol", "error", "ms a design", "time over one by one"),
        [
            (name, f"{r:.1e}", f"{e:.1e}", f"{1e3 * t / len(engines):.3f}", f"{t / base:.2f}")
            for name, r, e, t in rows
        ],
    )


def of_saleg_alone(engines, rtol):
    """Simulate all engines one by one."""
    for engine in engines:
        saleg.simulate(engine, SECONDS, rtol=rtol)


if __name__ == "__main__":
    main()
