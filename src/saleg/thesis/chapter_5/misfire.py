"""Misfire and what the engine survives (5.3, Figures 106 to 108)."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from saleg import Engine, Run, control
from saleg.plotting import control as plots
from saleg.thesis.experiment import Experiment, Line, seconds, state_at

if TYPE_CHECKING:
    import pandas as pd

#: When the fuel is cut [s], and the time shown before and after a misfire [s].
CUT, BEFORE, AFTER = 1.5, 0.1, 0.6
#: Numbers of strokes without fuel.
STROKES = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)


def fuel_cut(engine: Engine, duration: float = 3.0) -> Run:
    """Engine started, run, and left without fuel for good (Fig. 106)."""
    return control.fuel_cut(engine, at=CUT, duration=duration)


def report_fuel_cut(run: Run) -> list[Line]:
    """Compression ratio before and after the cut."""
    before, after = state_at(run, CUT), state_at(run, CUT + 0.1)
    last = state_at(run, math.inf)
    return [
        Line("fired", seconds(control.fired_at(run)), "rapidly, from 38 Hz"),
        Line("compression ratio before the cut", f"{before.compression_ratio:.2f}"),
        Line("0.1 s later", f"{after.compression_ratio:.2f}", "falls very steeply"),
        Line("at last", f"{last.compression_ratio:.2f}", "rings down"),
    ]


def overload(engine: Engine, duration: float = 8.0) -> Run:
    """Engine loaded ever more until it misfires (Fig. 107)."""
    return control.overload(engine, duration=duration)


def report_overload(run: Run) -> list[Line]:
    """When the engine misfired, and what lit late."""
    missed, late = control.first_misfire(run), control.late_ignitions(run)
    ratio = "-" if math.isnan(missed) else f"{state_at(run, missed).compression_ratio:.2f}"
    return [
        Line("first charge that does not light", seconds(missed), "near 3 s"),
        Line("compression ratio there", ratio, "below 10"),
        Line("late ignitions", f"{len(late)}", "one, with the ports closed"),
        Line("last of them", seconds(late[-1] if len(late) else math.nan)),
    ]


def misfire(engine: Engine, strokes: int = 1, motor: bool = True, duration: float = 3.0) -> Run:
    """Engine without fuel for some strokes; the motor brings it back (Fig. 108)."""
    return control.misfire(engine, strokes=strokes, motor=motor, at=CUT, duration=duration)


def draw_recovery(run: Run) -> object:
    """Misfire and recovery, near the cut."""
    return plots.duty_cycle(run, window=(CUT - BEFORE, min(CUT + AFTER, run.duration)))


def report_misfire(run: Run) -> list[Line]:
    """How deep the engine fell, and how long it took to recover."""
    after = run.dead_centres[run.dead_centres["t"] > CUT]
    return [
        Line("least compression ratio", f"{after['compression_ratio'].min():.2f}"),
        Line("recovered after", seconds(control.recovery_time(run, CUT)), "within half a second"),
        Line("compression ratio at last", f"{state_at(run, math.inf).compression_ratio:.2f}"),
    ]


def survival(engine: Engine, duration: float = 4.0) -> pd.DataFrame:
    """Numbers of strokes without fuel, with the motor and without it (5.3)."""
    return control.misfires(engine, STROKES, at=CUT, duration=duration)


def report_survival(table: pd.DataFrame) -> list[Line]:
    """Greatest number of strokes survived."""
    lines = []
    for motor, text in ((True, "with the motor"), (False, "without the motor")):
        rows = table[table["motor"] == motor]
        alive = rows[rows["survives"]]
        most = int(alive["strokes"].max()) if len(alive) else 0
        here = f"up to {most} (of {rows['strokes'].max()} tried)"
        lines.append(Line(f"strokes survived {text}", here, "1, no other tried" if motor else ""))
    return lines


#: Experiments by name.
EXPERIMENTS = {
    "fuel-cut": Experiment(
        "start, run, and cut the fuel for good (Fig. 106)",
        fuel_cut,
        {"duty_cycle.png": plots.duty_cycle},
        report_fuel_cut,
    ),
    "overload": Experiment(
        "load the engine ever more until it misfires (Fig. 107)",
        overload,
        {"duty_cycle.png": partial(plots.duty_cycle, gas=True)},
        report_overload,
    ),
    "misfire": Experiment(
        "cut the fuel for some strokes; the motor brings the engine back (Fig. 108)",
        misfire,
        {"duty_cycle.png": plots.duty_cycle, "recovery.png": draw_recovery},
        report_misfire,
    ),
    "survival": Experiment(
        "how many strokes without fuel the engine survives (5.3)",
        survival,
        {"survival.png": plots.survival},
        report_survival,
        is_run=False,
    ),
}
