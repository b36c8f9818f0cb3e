"""Parametric sweeps (4.2, Appendix C): every point a row, on one machine or many.

Examples
--------
>>> from saleg import sweep
>>> table = sweep.run(sweep.grid({"equivalence_ratio": [0.4, 0.5, 0.6]}))
>>> bool(table.power.is_monotonic_increasing)
True
>>> table.attrs["units"]["power_density"]
'W/kg'
"""

from saleg.design.subjects import DesignSubject, EngineSubject, Subject
from saleg.errors import SweepError
from saleg.sweep.points import grid, latin_hypercube, listed, sobol
from saleg.sweep.runs import load, run
from saleg.sweep.sobol_indices import Indices, NoIndices, indices, saltelli_points

__all__ = [
    "DesignSubject",
    "EngineSubject",
    "Indices",
    "NoIndices",
    "Subject",
    "SweepError",
    "grid",
    "indices",
    "latin_hypercube",
    "listed",
    "load",
    "run",
    "saltelli_points",
    "sobol",
]
