"""Settings of a run through scipy, and the run that comes of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg.errors import Problem
from saleg.kernel import layout
from saleg.quantities import as_float
from saleg.reference.running_engine import RunningEngine
from saleg.reference.segments import Tally, natural_speed
from saleg.simulation.initial_state import State
from saleg.simulation.outcome import outcome_of
from saleg.simulation.run import Run
from saleg.simulation.settings import refuse

_LIMITS = {"rtol": (1e-14, 1.0), "stall_stroke": (0.0, 1.0), "duration": (0.0, math.inf)}


def checked_settings(**given: Any) -> list[float]:
    """Tolerance, stall stroke and duration as floats, in the order given.

    Raises
    ------
    SettingsError
        Naming all that are no numbers in their range.
    """
    refuse("simulate", [], setting_problems(**given))
    return [float(value) for value in given.values()]


def setting_problems(**given: Any) -> list[Problem]:
    """Those of tolerance, stall stroke and duration that are no numbers in their range."""
    found = []
    for name, value in given.items():
        number, (low, high) = as_float(value), _LIMITS[name]
        if number is None or not low <= number < high:
            wanted = f"must be a number >= {low:g} and < {high:g}"
            found.append(Problem(name, value, "", wanted))
    return found


def run_of(
    running: RunningEngine, code: int, trouble: str, tally: Tally, settings: dict[str, Any]
) -> Run:
    """Run of an engine that has come to its end, without a history."""
    strokes = _rows(running.strokes, layout.STROKE_RECORD)
    status, message = outcome_of(running.engine, code, _final_state(running), strokes)
    return Run(
        engine=running.engine,
        status=status,
        message=message + trouble,
        duration=running.t,
        strokes=strokes,
        event_rows=np.array(running.events, layout.EVENT_RECORD),
        history_rows=None,
        evaluations=tally.evaluations,
        steps=tally.steps,
        settings=settings,
    )


def _rows(rows: list[np.ndarray], dtype: np.dtype) -> np.ndarray:
    return np.concatenate(rows) if rows else np.zeros(0, dtype)


def _final_state(running: RunningEngine) -> State:
    """State at the end of a run, in the records its outcome is read from."""
    E = np.zeros(1, layout.ENGINE_RECORD)
    E["t"], E["stroke"] = running.t, running.machine.stroke
    E["maximum_stroke"] = running.engine.maximum_stroke
    E["direction"], E["t_dead_centre"] = running.machine.direction, running.t_dead_centre
    E["length_scale"] = 0.5 * running.engine.maximum_stroke
    E["speed_scale"] = natural_speed(running)
    y = np.zeros(layout.N_ALL)
    y[: len(running.y)] = running.y
    return State(E, np.zeros(2, layout.CHAMBER_RECORD), y, running.peaks)
