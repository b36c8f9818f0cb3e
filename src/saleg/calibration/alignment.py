"""Simulated cycles at the instants of measured ones, shifted in time so that they agree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from saleg.calibration.traces import CHANNELS, FEWEST, WORDS, Trace, TraceError
from saleg.checks import a, checked, whole
from saleg.simulation.run import Run
from saleg.steady.state import SteadyState

#: Shifts tried before the best is refined.
SHIFTS = 240


@dataclass(frozen=True, eq=False)
class Comparison:
    """A measured trace beside a simulated cycle.

    Attributes
    ----------
    trace : Trace
    shift : float
        Time of the trace at which the simulated cycle has its left dead centre [s].
    simulated : dict of str to ndarray
        What the simulation has at the instants of the trace, by channel (SI).
    rms : dict of str to float
        Root mean square of the difference, by channel [in the unit of the channel].
    relative : dict of str to float
        The same over the range of what was measured [-].
    """

    trace: Trace
    shift: float
    simulated: dict[str, np.ndarray]
    rms: dict[str, float]
    relative: dict[str, float]

    def __repr__(self) -> str:
        parts = (f"{WORDS[name]} {100.0 * share:.2f} %" for name, share in self.relative.items())
        return f"{self.trace.name}: off by {', '.join(parts)} of its range (RMS)"


class SimulatedCycle:
    """One cycle of a result, as often as time asks for it."""

    def __init__(self, orbit: Run):
        rows = orbit.history_rows
        if rows is None or len(orbit.strokes) < 2:
            raise TraceError(f"no full cycle to compare with: {orbit.message}")
        self.t = rows["t"]
        self.values = {"x": rows["x"], "p_left": rows["p"][:, 0], "p_right": rows["p"][:, 1]}
        self.start = float(self.t[0])
        self.period = float(orbit.strokes["duration"].sum())

    def at(self, t: np.ndarray, shift: float, channels: list[str]) -> dict[str, np.ndarray]:
        """Channels at times after a shift."""
        phase = self.start + np.mod(t - shift, self.period)
        return {name: np.interp(phase, self.t, self.values[name]) for name in channels}

    def residuals(self, trace: Trace, shift: float) -> np.ndarray:
        """Differences at all instants of a trace, each over its standard deviation [-]."""
        found = self.at(trace.t, shift, trace.channels)
        parts = [(found[name] - trace[name]) / trace.sigma(name) for name in trace.channels]
        return np.concatenate(parts)

    def best_shift(self, trace: Trace) -> float:
        """Shift with the least squares of the residuals [s]."""
        from scipy.optimize import minimize_scalar

        def misfit(shift: float) -> float:
            return float(np.square(self.residuals(trace, shift)).sum())

        step = self.period / SHIFTS
        tried = trace.t[0] + step * np.arange(SHIFTS)
        best = tried[int(np.argmin([misfit(shift) for shift in tried]))]
        found = minimize_scalar(misfit, bounds=(best - step, best + step), method="bounded")
        return float(found.x)


def cycle_of(result: Run | SteadyState) -> SimulatedCycle:
    """The last cycle of a result.

    Raises
    ------
    TraceError
        If there is none.
    """
    orbit = result.orbit
    if orbit is None:
        raise TraceError(f"no full cycle to compare with: {result.message}")
    return SimulatedCycle(orbit)


@checked(trace=a(Trace), result=a(Run, SteadyState))
def comparison(trace: Trace, result: Run | SteadyState) -> Comparison:
    """Compare a trace with the last cycle of a result, aligned in time.

    Parameters
    ----------
    trace : Trace
    result : Run or SteadyState

    Returns
    -------
    Comparison

    Raises
    ------
    TraceError
        If the result has no full cycle.
    """
    cycle = cycle_of(result)
    shift = cycle.best_shift(trace)
    simulated = cycle.at(trace.t, shift, trace.channels)
    rms = {
        name: float(np.sqrt(np.mean(np.square(simulated[name] - trace[name]))))
        for name in trace.channels
    }
    relative = {name: rms[name] / (float(np.ptp(trace[name])) or np.nan) for name in rms}
    return Comparison(trace, shift, simulated, rms, relative)


@checked(result=a(Run, SteadyState), count=whole(low=FEWEST), seed=whole(low=0))
def synthetic(
    result: Run | SteadyState, noise: Mapping[str, float], *, count: int = 150, seed: int = 0
) -> Trace:
    """Make up a trace of a simulated cycle with noise, to see what a rig could tell.

    Parameters
    ----------
    result : Run or SteadyState
    noise : mapping of str to float
        Standard deviations of the channels it is to have, in their SI units.
    count : int
        Number of instants.
    seed : int

    Returns
    -------
    Trace

    Raises
    ------
    TraceError
        If the result has no full cycle, or a channel is none.

    Examples
    --------
    >>> import saleg
    >>> steady = saleg.steady_state(saleg.machines.thesis_base())
    >>> synthetic(steady, {"x": 1e-4, "p_left": 5e4})
    <Trace 'synthetic': 150 instants of x, p_left>
    """
    cycle, generator = cycle_of(result), np.random.default_rng(seed)
    strange = [name for name in noise if name not in CHANNELS]
    if strange:
        raise TraceError(f"no channel {strange[0]!r}; there are {', '.join(CHANNELS)}")
    t = np.linspace(0.0, cycle.period, count, endpoint=False)
    exact = cycle.at(t, 0.0, list(noise))
    channels = {
        name: values + noise[name] * generator.normal(size=count) for name, values in exact.items()
    }
    return Trace(t, **channels, noise=noise, name="synthetic")
