"""When things happened in a run, and what they cost: they only read."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from saleg.checks import POSITIVE, a, checked
from saleg.control.demand import Demand
from saleg.kernel import layout
from saleg.simulation.run import Run
from saleg.simulation.settings import SettingsError

if TYPE_CHECKING:
    import pandas as pd


class StepResponse(NamedTuple):
    """Answer to a step in demand.

    Attributes
    ----------
    settling_time : float
        From the step to the dead centre from which on the power stays within the band [s];
        infinite if it leaves it at last.
    overshoot : float
        How far it goes beyond the new demand, over the height of the step [-].
    """

    settling_time: float
    overshoot: float


#: Kinds of events after which a charge is a new one.
NEW_CHARGE = (layout.EVENT_PORT_CLOSING, layout.EVENT_CHARGE_RENEWAL)


def stretches(mask: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of every stretch of a mask that is true.

    Parameters
    ----------
    mask : ndarray of bool

    Returns
    -------
    list of (int, int)

    Examples
    --------
    >>> stretches(np.array([True, True, False, True]))
    [(0, 1), (3, 3)]
    """
    edges = np.diff(np.concatenate([[0], np.asarray(mask, dtype=np.int8), [0]]))
    begins, ends = np.flatnonzero(edges > 0), np.flatnonzero(edges < 0) - 1
    return [(int(first), int(last)) for first, last in zip(begins, ends, strict=True)]


@checked(run=a(Run))
def ports_opened_at(run: Run) -> float:
    """When a port first opened [s]; NaN if never, or no longer recorded.

    Parameters
    ----------
    run : Run

    Returns
    -------
    float
    """
    opened = run.event_rows["t"][run.event_rows["kind"] == layout.EVENT_PORT_OPENING]
    return float(opened[0]) if len(opened) else math.nan


@checked(run=a(Run))
def motored_times(run: Run) -> list[tuple[float, float]]:
    """Begin and end of every stretch of strokes in which the alternator was a motor [s].

    Parameters
    ----------
    run : Run

    Returns
    -------
    list of (float, float)
    """
    return _times(run, run.strokes["motoring"] > 0.0)


@checked(run=a(Run))
def fuel_cuts(run: Run) -> list[tuple[float, float]]:
    """Begin and end of every stretch of strokes without motor that composed no fuel [s].

    Parameters
    ----------
    run : Run

    Returns
    -------
    list of (float, float)
    """
    strokes = run.strokes
    return _times(run, (strokes["motoring"] == 0.0) & (strokes["equivalence_ratio"] == 0.0))


@checked(run=a(Run))
def first_misfire(run: Run) -> float:
    """When a charge with fuel first failed to light [s], at its dead centre; NaN if none did.

    One that lights late, before its ports open, has not failed.

    Parameters
    ----------
    run : Run

    Returns
    -------
    float
    """
    rows = run.event_rows
    for index in np.flatnonzero(rows["kind"] == layout.EVENT_MISFIRE):
        after = rows[index:][rows["side"][index:] == rows["side"][index]]
        ends = np.isin(after["kind"], (layout.EVENT_IGNITION, layout.EVENT_PORT_OPENING))
        if not ends.any() or after["kind"][ends][0] != layout.EVENT_IGNITION:
            return float(rows["t"][index])
    return math.nan


@checked(run=a(Run))
def late_ignitions(run: Run) -> np.ndarray:
    """When charges lit that had missed their dead centre before [s].

    Parameters
    ----------
    run : Run

    Returns
    -------
    ndarray of float
    """
    missed, found = [False, False], []
    for kind, side, t in zip(
        *(run.event_rows[name] for name in ("kind", "side", "t")), strict=True
    ):
        if kind in NEW_CHARGE:
            missed[int(side)] = False
        elif kind == layout.EVENT_MISFIRE:
            missed[int(side)] = True
        elif kind == layout.EVENT_IGNITION and missed[int(side)]:
            found.append(float(t))
    return np.array(found)


@checked(run=a(Run), demand=a(Demand), band=POSITIVE)
def step_response(run: Run, demand: Demand, band: float = 0.05) -> StepResponse:
    """How the power of a run answers a step in demand.

    Parameters
    ----------
    run : Run
    demand : Demand
        Whose last change is a step.
    band : float
        Half width of the band around the last demand in which power has settled, over the height of
        the step [-].

    Returns
    -------
    StepResponse
    """
    at, before, last = demand.times[-1], demand.powers[-2], demand.powers[-1]
    after = run.dead_centres[run.dead_centres.t > at]
    # 0 before the step, 1 where it is met.
    answer = (after.power.to_numpy() - before) / (last - before)
    outside = np.flatnonzero(np.abs(answer - 1.0) > band)
    times = after.t.to_numpy()
    settled = len(answer) > 0 and (len(outside) == 0 or outside[-1] + 1 < len(times))
    first = outside[-1] + 1 if len(outside) else 0
    settling_time = float(times[first] - at) if settled else math.inf
    overshoot = max(float(answer.max()) - 1.0, 0.0) if len(answer) else math.nan
    return StepResponse(settling_time, overshoot)


class BusEnergy(NamedTuple):
    """Energy that a run has drawn from the electrical side and returned to it.

    Attributes
    ----------
    drawn, returned : float
        Sums over the strokes that took energy and over those that gave some [J].
    """

    drawn: float
    returned: float


@checked(run=a(Run))
def bus_energy(run: Run) -> BusEnergy:
    """Energy account of the DC bus, stroke by stroke; what start-up and recovery cost.

    Parameters
    ----------
    run : Run

    Returns
    -------
    BusEnergy
    """
    energy = run.strokes["electrical_energy"]
    drawn, returned = -energy[energy < 0.0].sum(), energy[energy > 0.0].sum()
    return BusEnergy(float(drawn), float(returned))


@checked(run=a(Run))
def bus_energy_over_time(run: Run) -> pd.DataFrame:
    """Energy that has passed the DC bus either way by every instant of a run, within strokes too.

    Where a stroke draws in one place and returns in another, this counts both;
    :func:`bus_energy` has what is left of them.

    Parameters
    ----------
    run : Run
        With its history, ``history=1``, whose ``electrical_power`` is integrated (trapezia).

    Returns
    -------
    DataFrame
        ``t`` [s], and ``drawn`` and ``returned`` since the first instant [J].

    Raises
    ------
    SettingsError
        If the run has no history.
    """
    import pandas as pd

    rows = run.history_rows
    if rows is None:
        raise SettingsError("history: the energy within strokes takes a run with history=1")
    steps, power = np.diff(rows["t"]), rows["electrical_power"]
    columns = {"t": rows["t"]}
    for name, flow in (("drawn", np.maximum(-power, 0.0)), ("returned", np.maximum(power, 0.0))):
        columns[name] = np.append(0.0, np.cumsum(0.5 * steps * (flow[1:] + flow[:-1])))
    table = pd.DataFrame(columns)
    table.attrs["units"] = {"t": "s", "drawn": "J", "returned": "J"}
    return table


def _times(run: Run, mask: np.ndarray) -> list[tuple[float, float]]:
    """Begin and end of stretches of strokes [s]."""
    end = run.strokes["t"]
    begin = end - run.strokes["duration"]
    return [(float(begin[first]), float(end[last])) for first, last in stretches(mask)]
