"""The state of an engine without its laws: where the piston is, the begin of a stroke, snapshots.

The search for fixed points takes this module and no law, so that it is compiled once for all.
"""

import numpy as np

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import N_ALL, N_PEAKS, N_STATE, X


@inline
def clearance_of(C, side, x):
    """Clearance between crown and head [m]."""
    return C[side].half_stroke + C[side].sign * x


@compiled
def begin_stroke(E, C, y, peaks):
    """Reset the quantities that are counted per stroke."""
    for n in range(N_STATE, N_ALL):
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
def keep_snapshot(E1, C, y, snapshots):
    """Remember the state at a left dead centre; the one before moves to second place."""
    chambers = snapshots.chambers.reshape(4)
    copy_row(snapshots.engine, 1, snapshots.engine, 0)
    copy_row(snapshots.engine, 0, E1, 0)
    for side in range(2):
        copy_row(chambers, 2 + side, chambers, side)
        copy_row(chambers, side, C, side)
    for n in range(N_ALL):
        snapshots.y[1, n] = snapshots.y[0, n]
        snapshots.y[0, n] = y[n]
