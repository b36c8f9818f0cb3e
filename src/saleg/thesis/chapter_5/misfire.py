"""Misfire and what the engine survives (5.3, Figures 106 to 108)."""

from __future__ import annotations

import math

from saleg import control
from saleg.engine import Engine
from saleg.plotting import control as draw
from saleg.thesis.experiment import Experiment, Line, Result, seconds, state_at

#: When the fuel is cut [s], and the time shown before and after a misfire [s].
CUT, BEFORE, AFTER = 1.5, 0.1, 0.6
#: Numbers of strokes without fuel.
STROKES = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)


def _fuel_cut(engine: Engine, duration: float = 3.0) -> Result:
    return Result(run=control.fuel_cut(engine, at=CUT, duration=duration))


def _report_fuel_cut(result: Result) -> list[Line]:
    run = result.one
    before, after = state_at(run, CUT), state_at(run, CUT + 0.1)
    last = state_at(run, math.inf)
    return [
        Line("fired", seconds(control.fired_at(run)), "rapidly, from 38 Hz"),
        Line("compression ratio before the cut", f"{before.compression_ratio:.2f}"),
        Line("0.1 s later", f"{after.compression_ratio:.2f}", "falls very steeply"),
        Line("at last", f"{last.compression_ratio:.2f}", "rings down"),
    ]


def _overload(engine: Engine, duration: float = 8.0) -> Result:
    return Result(run=control.overload(engine, duration=duration))


def _report_overload(result: Result) -> list[Line]:
    run, missed = result.one, control.first_misfire(result.one)
    late = control.late_ignitions(run)
    ratio = "-" if math.isnan(missed) else f"{state_at(run, missed).compression_ratio:.2f}"
    return [
        Line("first charge that does not light", seconds(missed), "near 3 s"),
        Line("compression ratio there", ratio, "below 10"),
        Line("late ignitions", f"{len(late)}", "one, with the ports closed"),
        Line("last of them", seconds(late[-1] if len(late) else math.nan)),
    ]


def _misfire(engine: Engine, strokes: int = 1, motor: bool = True, duration: float = 3.0) -> Result:
    run = control.misfire(engine, strokes=strokes, motor=motor, at=CUT, duration=duration)
    return Result(run=run)


def _report_misfire(result: Result) -> list[Line]:
    run, table = result.one, result.one.dead_centres
    after = table[table["t"] > CUT]
    return [
        Line("least compression ratio", f"{after['compression_ratio'].min():.2f}"),
        Line("recovered after", seconds(control.recovery_time(run, CUT)), "within half a second"),
        Line("compression ratio at last", f"{state_at(run, math.inf).compression_ratio:.2f}"),
    ]


def _survival(engine: Engine, duration: float = 4.0) -> Result:
    return Result(table=control.misfires(engine, STROKES, at=CUT, duration=duration))


def _report_survival(result: Result) -> list[Line]:
    lines = []
    for motor, text in ((True, "with the motor"), (False, "without the motor")):
        rows = result.many[result.many["motor"] == motor]
        alive = rows[rows["survives"]]
        most = int(alive["strokes"].max()) if len(alive) else 0
        here = f"up to {most} (of {rows['strokes'].max()} tried)"
        lines.append(Line(f"strokes survived {text}", here, "1, no other tried" if motor else ""))
    return lines


def _window(result: Result) -> tuple[float, float]:
    return CUT - BEFORE, min(CUT + AFTER, result.one.duration)


#: Experiments by name.
EXPERIMENTS = {
    "fuel-cut": Experiment(
        "start, run, and cut the fuel for good (Fig. 106)",
        _fuel_cut,
        {"duty_cycle.png": lambda result: draw.duty_cycle(result.one)},
        _report_fuel_cut,
    ),
    "overload": Experiment(
        "load the engine ever more until it misfires (Fig. 107)",
        _overload,
        {"duty_cycle.png": lambda result: draw.duty_cycle(result.one, gas=True)},
        _report_overload,
    ),
    "misfire": Experiment(
        "cut the fuel for some strokes; the motor brings the engine back (Fig. 108)",
        _misfire,
        {
            "duty_cycle.png": lambda result: draw.duty_cycle(result.one),
            "recovery.png": lambda result: draw.duty_cycle(result.one, window=_window(result)),
        },
        _report_misfire,
        ("duration", "strokes", "motor"),
    ),
    "survival": Experiment(
        "how many strokes without fuel the engine survives (5.3)",
        _survival,
        {"survival.png": lambda result: draw.survival(result.many)},
        _report_survival,
        is_run=False,
    ),
}
