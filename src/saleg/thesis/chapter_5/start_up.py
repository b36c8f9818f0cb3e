"""Start-up from rest by motored resonance (5.1, Figures 97 to 99)."""

from __future__ import annotations

import math

import numpy as np

from saleg import control
from saleg.control.experiments import RECOVERED
from saleg.engine import Engine
from saleg.plotting import control as draw
from saleg.simulation.run import Run
from saleg.thesis.experiment import Experiment, Line, Result, kilowatts, seconds

#: Base frequencies of the start-ups that are compared [Hz].
BASE_FREQUENCIES = (30.0, 35.0, 38.0, 40.0, 50.0)


def settled(run: Run) -> float:
    """Time from which on the compression ratio stays near its last one [s]; NaN if never fired."""
    table = run.dead_centres
    ratio = table["compression_ratio"].to_numpy()
    away = np.flatnonzero(np.abs(ratio / ratio[-1] - 1.0) > RECOVERED)
    if math.isnan(control.fired_at(run)) or not len(away):
        return math.nan
    return float(table["t"].iloc[away[-1] + 1])


def _start_up(engine: Engine, base_frequency: float = 30.0, duration: float = 3.5) -> Result:
    return Result(run=control.start_up(engine, base_frequency, duration=duration))


def _report_start_up(result: Result) -> list[Line]:
    run, fired = result.one, control.fired_at(result.one)
    reached = run.performance
    return [
        Line("fired", seconds(fired), "just before 2 s, from 30 Hz"),
        Line("settled", seconds(settled(run)), "under 2.5 s"),
        Line("motor came back", f"{control.motor_returns(run)} times"),
        Line("compression ratio", f"{reached.compression_ratio:.2f}", "17.9"),
        Line("frequency", f"{reached.frequency:.2f} Hz", "44.8 Hz"),
        Line("power", kilowatts(reached.power), "3.81 kW"),
    ]


def _start_ups(engine: Engine, duration: float = 3.5) -> Result:
    import pandas as pd

    runs = {f: control.start_up(engine, f, duration=duration) for f in BASE_FREQUENCIES}
    table = pd.DataFrame(
        {
            "base_frequency": list(runs),
            "fired_at": [control.fired_at(run) for run in runs.values()],
            "compression_ratio": [run.performance.compression_ratio for run in runs.values()],
            "status": [str(run.status) for run in runs.values()],
        }
    )
    table.attrs["units"] = {name: "-" for name in table} | {"base_frequency": "Hz", "fired_at": "s"}
    return Result(table=table, also={"runs": runs})


def _report_start_ups(result: Result) -> list[Line]:
    said = {30.0: "fires", 40.0: "never", 50.0: "never"}
    table = result.many
    return [
        Line(f"fired from {frequency:g} Hz", seconds(at), said.get(frequency, ""))
        for frequency, at in zip(table["base_frequency"], table["fired_at"], strict=True)
    ]


#: Experiments by name.
EXPERIMENTS = {
    "start-up": Experiment(
        "start from rest by motored resonance (Fig. 97, 98)",
        _start_up,
        {
            "start_up.png": lambda result: draw.start_up(result.one),
            "approach.png": lambda result: draw.approach(result.one),
        },
        _report_start_up,
        ("duration", "base_frequency"),
    ),
    "start-ups": Experiment(
        "start from several base frequencies (Fig. 99)",
        _start_ups,
        {"start_ups.png": lambda result: draw.start_ups(result.also["runs"])},
        _report_start_ups,
        is_run=False,
    ),
}
