"""Motored resonance (5.1, Figures 94 and 95)."""

from __future__ import annotations

import numpy as np

from saleg import control
from saleg.control.experiments import SETTLING
from saleg.engine import Engine
from saleg.plotting import control as draw
from saleg.thesis.experiment import Experiment, Line, Result

#: Amplitudes [N] at one frequency [Hz] (Fig. 94), frequencies at one amplitude (Fig. 95).
AMPLITUDES, AT_FREQUENCY = np.arange(20.0, 661.0, 20.0).tolist(), 35.0
FREQUENCIES = np.unique(np.r_[30.0:50.01:0.5, 39.0:42.01:0.1].round(6)).tolist()
AT_AMPLITUDE = 66.0


def _amplitude(engine: Engine, duration: float = SETTLING) -> Result:
    return Result(table=control.motored(engine, [AT_FREQUENCY], AMPLITUDES, duration=duration))


def _report_amplitude(result: Result) -> list[Line]:
    table = result.many
    opened = table["opened_ports"].to_numpy(dtype=bool)
    first = int(opened.argmax()) if opened.any() else -1
    amplitudes = table["motor_amplitude"]
    where = f"{amplitudes[first - 1]:g} to {amplitudes[first]:g} N" if first > 0 else "nowhere"
    greatest = 100.0 * float(table["relative_stroke"].max())
    return [
        Line("stroke over maximum, at most", f"{greatest:.1f} %", "no significant change"),
        Line("ports begin to open", where, "a small step in the curve"),
    ]


def _resonance(engine: Engine, duration: float = SETTLING) -> Result:
    return Result(table=control.motored(engine, FREQUENCIES, [AT_AMPLITUDE], duration=duration))


def _report_resonance(result: Result) -> list[Line]:
    best = result.many.iloc[int(np.nanargmax(result.many["stroke"]))]
    return [
        Line("resonance", f"{best.motor_frequency:.1f} Hz", "just above 40 Hz"),
        Line("stroke over maximum there", f"{100.0 * best.relative_stroke:.1f} %"),
        Line("compression ratio there", f"{best.compression_ratio:.2f}"),
    ]


#: Experiments by name.
EXPERIMENTS = {
    "amplitude": Experiment(
        "motor the engine at several amplitudes (Fig. 94)",
        _amplitude,
        {"amplitude.png": lambda result: draw.motored_amplitudes(result.many)},
        _report_amplitude,
        is_run=False,
    ),
    "resonance": Experiment(
        "motor the engine at several frequencies (Fig. 95)",
        _resonance,
        {"resonance.png": lambda result: draw.motored_resonance(result.many)},
        _report_resonance,
        is_run=False,
    ),
}
