"""Stability of many steady states of one make, their maps differentiated in compiled code."""

from __future__ import annotations

from saleg.compiler.compiled_engine import numbers_of_rows
from saleg.kernel.layout import END_OF_TIME
from saleg.steady.many import Orbits
from saleg.steady.return_map import ReturnMap, differences_at, step_tolerance
from saleg.steady.stability import DIFFERENCE, TOLERANCE, Stability, stability_of

#: What in the state of an engine says how its mass follows from its motion. No disturbance of an
#: orbit rebuilds the engine.
MASS_LAW = ("mass_fixed", "mass_per_stroke", "mass_per_work")


def stabilities(orbits: Orbits) -> list[Stability]:
    """Stability of each orbit, equal to :func:`.stability.stability`.

    Parameters
    ----------
    orbits : Orbits

    Returns
    -------
    list of Stability
    """
    count = len(orbits.mass)
    if not count:
        return []
    one, starts = orbits.rows.row(0), orbits.starts
    for name in MASS_LAW:
        starts.engine[name] = 0.0
    steps = step_tolerance(one, TOLERANCE)
    return_map = ReturnMap.of(one, starts.row(0), steps, orbits.mirrored)
    differences = differences_at(one, starts, DIFFERENCE)
    return_map.jacobians(numbers_of_rows(orbits.rows.engine, count), differences)
    periods = orbits.strokes["duration"].sum(axis=1).tolist()
    found = zip(differences.codes.tolist(), differences.matrices, periods, strict=True)
    return [
        stability_of(one, matrix if code == END_OF_TIME else None, orbits.mirrored, period)
        for code, matrix, period in found
    ]
