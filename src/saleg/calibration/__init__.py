"""Calibration: measured traces, how far a simulation is from them, and parameters fitted to them.

A :class:`Trace` holds what was measured over a cycle; :func:`calibrate` fits open parameters of an
engine to traces and figures and says how well they are known.
"""

from saleg.calibration.alignment import Comparison, comparison, synthetic
from saleg.calibration.fit import CalibrationError, calibrate
from saleg.calibration.result import Calibration
from saleg.calibration.traces import Trace, TraceError

__all__ = [
    "Calibration",
    "CalibrationError",
    "Comparison",
    "Trace",
    "TraceError",
    "calibrate",
    "comparison",
    "synthetic",
]
