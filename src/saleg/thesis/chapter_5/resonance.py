"""Motored resonance (5.1, Figures 94 and 95)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from saleg import Engine, control
from saleg.plotting import control as plots
from saleg.thesis.experiment import Experiment, Line

if TYPE_CHECKING:
    import pandas as pd

#: Time every motored engine is given to settle [s].
SETTLING = 15.0
#: Amplitudes [N] at one frequency [Hz] (Fig. 94), frequencies at one amplitude (Fig. 95).
AMPLITUDES, AT_FREQUENCY = np.arange(20.0, 661.0, 20.0).tolist(), 35.0
FREQUENCIES = np.unique(np.r_[30.0:50.01:0.5, 39.0:42.01:0.1].round(6)).tolist()
AT_AMPLITUDE = 66.0


def amplitudes(engine: Engine, duration: float = SETTLING) -> pd.DataFrame:
    """Motored engine at several amplitudes (Fig. 94)."""
    return control.motored(engine, [AT_FREQUENCY], AMPLITUDES, duration=duration)


def report_amplitudes(table: pd.DataFrame) -> list[Line]:
    """Greatest stroke, and where the ports begin to open."""
    opened = table["opened_ports"].to_numpy(dtype=bool)
    first = int(opened.argmax()) if opened.any() else -1
    forces = table["motor_amplitude"]
    where = f"{forces[first - 1]:g} to {forces[first]:g} N" if first > 0 else "nowhere"
    greatest = 100.0 * float(table["relative_stroke"].max())
    return [
        Line("stroke over maximum, at most", f"{greatest:.1f} %", "no significant change"),
        Line("ports begin to open", where, "a small step in the curve"),
    ]


def frequencies(engine: Engine, duration: float = SETTLING) -> pd.DataFrame:
    """Motored engine at several frequencies (Fig. 95)."""
    return control.motored(engine, FREQUENCIES, [AT_AMPLITUDE], duration=duration)


def report_frequencies(table: pd.DataFrame) -> list[Line]:
    """Resonance, and the stroke there."""
    best = table.iloc[int(np.nanargmax(table["stroke"]))]
    return [
        Line("resonance", f"{best.motor_frequency:.1f} Hz", "just above 40 Hz"),
        Line("stroke over maximum there", f"{100.0 * best.relative_stroke:.1f} %"),
        Line("compression ratio there", f"{best.compression_ratio:.2f}"),
    ]


#: Experiments by name.
EXPERIMENTS = {
    "amplitude": Experiment(
        "motor the engine at several amplitudes (Fig. 94)",
        amplitudes,
        {"amplitude.png": plots.motored_amplitudes},
        report_amplitudes,
        is_run=False,
    ),
    "resonance": Experiment(
        "motor the engine at several frequencies (Fig. 95)",
        frequencies,
        {"resonance.png": plots.motored_resonance},
        report_frequencies,
        is_run=False,
    ),
}
