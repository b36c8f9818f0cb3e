"""How an engine shakes what it stands on, over a cycle."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np


@dataclass(frozen=True)
class Shaking:
    """Forces on what an engine stands on, and the motion of its frame, over a cycle.

    NaN without a cycle.

    Attributes
    ----------
    peak_force, rms_force : float
        Greatest and root-mean-square force on what the frame stands on [N]; a fixed frame hands on
        all that accelerates the translator, one on mounts their force.
    peak_displacement : float
        Greatest distance of the frame from its place at rest [m].
    peak_velocity : float
        Greatest speed of the frame [m/s].
    mount_power : float
        Heat in the mounts [W].

    Examples
    --------
    >>> import saleg
    >>> run = saleg.simulate(saleg.machines.thesis_transient(), 0.3)
    >>> f"{run.shaking.peak_force / 1e3:.0f} kN"
    '22 kN'
    """

    peak_force: float
    rms_force: float
    peak_displacement: float
    peak_velocity: float
    mount_power: float


def shaking_of(cycle: np.ndarray | None, history: np.ndarray | None) -> Shaking:
    """Shaking over a cycle.

    Parameters
    ----------
    cycle : ndarray of STROKE_RECORD, shape (2,)
        Its strokes; None if there is none.
    history : ndarray of HISTORY_RECORD, optional
        Its instants.
    """
    if cycle is None or history is None:
        return Shaking(**{item.name: math.nan for item in fields(Shaking)})
    t, force = history["t"], history["shaking_force"]
    mean_square = np.trapezoid(force * force, t) / (t[-1] - t[0])
    return Shaking(
        peak_force=float(np.abs(force).max()),
        rms_force=float(np.sqrt(mean_square)),
        peak_displacement=float(np.abs(history["frame_x"]).max()),
        peak_velocity=float(np.abs(history["frame_v"]).max()),
        mount_power=float(cycle["mount_loss"].sum() / cycle["duration"].sum()),
    )
