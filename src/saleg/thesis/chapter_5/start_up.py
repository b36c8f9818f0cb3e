"""Start-up from rest by motored resonance (5.1, Figures 97 to 99)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from saleg import Controller, Engine, Run, control
from saleg.laws import ResonanceSearch
from saleg.plotting import control as plots
from saleg.thesis.experiment import Experiment, Line, kilowatts, seconds
from saleg.thesis.tables import columns

if TYPE_CHECKING:
    import pandas as pd

#: Base frequencies of the start-ups that are compared [Hz].
BASE_FREQUENCIES = (30.0, 35.0, 38.0, 40.0, 50.0)
#: Phases of the motor; the force sin(2 pi f t) keeps the dates of Fig. 97, the integral does not.
PHASES = {"literal": 1.0, "integrated": 0.0}
#: Within this share of the last compression ratio an engine has settled [-].
SETTLED = 0.02


class StartUps(NamedTuple):
    """Start-ups from several base frequencies [Hz], and a table of them."""

    runs: dict[float, Run]
    table: pd.DataFrame


def start_up(
    engine: Engine, base_frequency: float = 30.0, duration: float = 3.5, phase: str = "literal"
) -> Run:
    """Engine started up from rest (Fig. 97, 98)."""
    chosen = Controller(motor_control=ResonanceSearch(literal_phase=PHASES[phase]))
    return control.start_up(engine, base_frequency, duration=duration, controller=chosen)


def settled_at(run: Run) -> float:
    """Time from which on the compression ratio stays near its last one [s]; NaN if never fired."""
    table = run.dead_centres
    ratio = table["compression_ratio"].to_numpy()
    away = np.flatnonzero(np.abs(ratio / ratio[-1] - 1.0) > SETTLED)
    if math.isnan(control.fired_at(run)) or not len(away):
        return math.nan
    return float(table["t"].iloc[away[-1] + 1])


def report_start_up(run: Run) -> list[Line]:
    """Dates of the start-up, and the steady state beside Table 13."""
    reached, printed = run.performance, columns(13)["value"]
    opened, fired = control.ports_opened_at(run), control.fired_at(run)
    return [
        Line("ports first open", seconds(opened), "near 1 s, from 30 Hz"),
        Line("fired", seconds(fired), "just before 2 s, from 30 Hz"),
        Line("settled", seconds(settled_at(run)), "under 2.5 s"),
        Line("motor came back", f"{control.motor_returns(run)} times"),
        Line(
            "compression ratio",
            f"{reached.compression_ratio:.2f}",
            f"{printed['compression_ratio']:g}",
        ),
        Line("frequency", f"{reached.frequency:.2f} Hz", f"{printed['frequency']:g} Hz"),
        Line("power", kilowatts(reached.power), kilowatts(printed["power"])),
    ]


def start_ups(engine: Engine, duration: float = 3.5, phase: str = "literal") -> StartUps:
    """Engine started up from several base frequencies (Fig. 99)."""
    import pandas as pd

    runs = {f: start_up(engine, f, duration, phase) for f in BASE_FREQUENCIES}
    table = pd.DataFrame(
        {
            "base_frequency": list(runs),
            "fired_at": [control.fired_at(run) for run in runs.values()],
            "compression_ratio": [run.performance.compression_ratio for run in runs.values()],
            "status": [str(run.status) for run in runs.values()],
        }
    )
    table.attrs["units"] = {name: "-" for name in table} | {"base_frequency": "Hz", "fired_at": "s"}
    return StartUps(runs, table)


def draw_start_ups(found: StartUps) -> object:
    """Compression ratio of every start-up (Fig. 99)."""
    return plots.start_ups(found.runs)


def report_start_ups(found: StartUps) -> list[Line]:
    """When the engine was fired, from each base frequency."""
    said = {30.0: "fires", 40.0: "never", 50.0: "never"}
    table = found.table
    return [
        Line(f"fired from {frequency:g} Hz", seconds(at), said.get(frequency, ""))
        for frequency, at in zip(table["base_frequency"], table["fired_at"], strict=True)
    ]


#: Experiments by name.
EXPERIMENTS = {
    "start-up": Experiment(
        "start from rest by motored resonance (Fig. 97, 98)",
        start_up,
        {"start_up.png": plots.start_up, "approach.png": plots.approach},
        report_start_up,
    ),
    "start-ups": Experiment(
        "start from several base frequencies (Fig. 99)",
        start_ups,
        {"start_ups.png": draw_start_ups},
        report_start_ups,
        is_run=False,
    ),
}
