"""The state of an engine without its laws: where the piston is, the begin of a stroke, snapshots.

The search for fixed points takes this module and no law, so that it is compiled once for all.
"""

import numpy as np

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import N_ALL, N_PEAKS, N_PLAIN, N_STATE, SUPPLIED, X


@inline
def clearance_of(C, side, x):
    """Clearance between crown and head [m]."""
    return C[side].half_stroke + C[side].sign * x


@compiled
def begin_stroke(E, C, y, peaks):
    """Reset the quantities that are counted per stroke."""
    for n in range(N_STATE, N_PLAIN):
        y[n] = 0.0
    for n in range(SUPPLIED, N_ALL):
        y[n] = 0.0
    for peak in range(N_PEAKS):
        peaks[peak] = 0.0
    for side in range(2):
        C[side].fresh_fuel_energy = 0.0
        C[side].exhaust_energy = 0.0
        C[side].exhaust_fuel_energy = 0.0
        C[side].ignition_time = -1.0
        C[side].ignition_height = 0.0
    E.x_dead_centre = y[X]
    E.t_dead_centre = E.t


@inline
def copy_row(destination, i, source, j):
    """Copy row j of an array of records to row i of another, word by word.

    As one value a record of this length takes numba a second to compile.
    """
    to, given = destination.view(np.int64), source.view(np.int64)
    words = given.shape[0] // source.shape[0]
    for n in range(words):
        to[i * words + n] = given[j * words + n]


@compiled
def keep_snapshot(words, y, kept_y):
    """Remember the state at a left dead centre; the one before moves to second place.

    `words` are the records as whole numbers of 8 bytes (:class:`~saleg.kernel.tuples.Words`).
    """
    for n in range(words.engine.shape[1]):
        words.kept_engine[1, n] = words.kept_engine[0, n]
        words.kept_engine[0, n] = words.engine[0, n]
    for side in range(2):
        for n in range(words.chambers.shape[1]):
            words.kept_chambers[1, side, n] = words.kept_chambers[0, side, n]
            words.kept_chambers[0, side, n] = words.chambers[side, n]
    for n in range(N_ALL):
        kept_y[1, n] = kept_y[0, n]
        kept_y[0, n] = y[n]
