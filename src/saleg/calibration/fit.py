"""Open parameters of an engine fitted to figures and traces by least squares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.calibration.alignment import SimulatedCycle, cycle_of
from saleg.calibration.result import Calibration
from saleg.calibration.traces import WORDS, Trace
from saleg.checks import a, checked, number
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.errors import SalegError, nearest
from saleg.quantities import as_float
from saleg.simulation.performance import UNITS
from saleg.steady.solver import check_tolerance, found_steady_state
from saleg.steady.state import SteadyState

if TYPE_CHECKING:
    import pandas as pd

#: Standard deviation of a figure over its value, where it is not said.
USUAL_DEVIATION = 0.01
#: Difference of a parameter for a derivative, over the width of its bounds; of a shift, over the
#: period.
DIFFERENCE, SHIFT_DIFFERENCE = 1e-3, 1e-5
#: How near to a bound a parameter is at it, over the width of the bounds.
AT_BOUND = 1e-6
#: Shifts stay within half a cycle of where they begin.
REACH = 0.5


class CalibrationError(SalegError, ValueError):
    """A calibration that cannot be done as asked."""


@checked(engine=a(Engine), confidence=number(low=0.5, high=1.0, open_high=True))
def calibrate(
    engine: Engine,
    bounds: Mapping[str, tuple[float, float]],
    *,
    figures: Mapping[str, float | tuple[float, float]] | None = None,
    traces: Trace | Sequence[Trace] = (),
    confidence: float = 0.95,
    rtol: float = 1e-8,
    max_steps: int = 60,
) -> Calibration:
    """Calibrate an engine: fit open parameters to measured figures and traces.

    Least squares of the differences between its steady state and what was measured, each over its
    standard deviation, within bounds (``scipy.optimize.least_squares``, trust region). Where the
    cycle begins in a trace is fitted too. Intervals come from the curvature at the end,
    ``s^2 (J^T J)^-1`` with s from the residuals, and Student's t.

    Parameters
    ----------
    engine : Engine
        Where the search begins; values beyond a bound begin at it.
    bounds : mapping of str to (float, float)
        Open parameters by path, and their bounds (SI).
    figures : mapping of str to float or (float, float), optional
        Measured figures by the names of :class:`saleg.Performance` (SI), with their standard
        deviations; a hundredth of the value where it is not given.
    traces : Trace or sequence of Trace
    confidence : float
        Of the intervals [-].
    rtol : float
        Tolerance of the steady states [-].
    max_steps : int
        Steps of the search.

    Returns
    -------
    Calibration

    Raises
    ------
    CalibrationError
        Naming what to change.
    UnknownPath
        If a path leads nowhere.

    Examples
    --------
    >>> import saleg
    >>> base = saleg.machines.thesis_base()
    >>> found = saleg.calibrate(
    ...     base.replace(**{"heat_transfer.a": 90.0}),
    ...     {"heat_transfer.a": (20.0, 200.0)},
    ...     figures={"efficiency": (0.3411, 0.001), "power": (22600.0, 50.0)},
    ... )
    >>> 60.0 < found.engine.get("heat_transfer.a") < 70.0
    True
    """
    from scipy.optimize import least_squares

    listed = (traces,) if isinstance(traces, Trace) else tuple(traces)
    fit = _Fit(engine, _bounds(engine, bounds), _figures(figures or {}), listed, rtol)
    start = fit.start()
    most = 1.0 + 1e-12
    solved = least_squares(
        fit.residuals,
        start,
        fit.jacobian,
        bounds=(
            np.r_[np.zeros(len(bounds)), start[len(bounds) :] - REACH],
            np.r_[np.full(len(bounds), most), start[len(bounds) :] + REACH],
        ),
        xtol=1e-8,
        ftol=1e-8,
        gtol=1e-8,
        max_nfev=int(max_steps),
    )
    return fit.result(solved, confidence)


class _Fit:
    """Residuals of an engine as functions of its parameters and of the shifts of the traces.

    Parameters count from 0 to 1 between their bounds, shifts in cycles.
    """

    def __init__(
        self,
        engine: Engine,
        bounds: dict[str, tuple[float, float]],
        figures: dict[str, tuple[float, float]],
        traces: tuple[Trace, ...],
        rtol: float,
    ):
        if not figures and not traces:
            raise CalibrationError("nothing was measured: give figures or traces")
        for trace in traces:
            if not isinstance(trace, Trace):
                raise CalibrationError(f"traces: must be of saleg.calibration.Trace, not {trace!r}")
        self.base, self.figures, self.traces = engine, figures, traces
        self.paths = list(bounds)
        self.low, self.high = np.array(list(bounds.values()), dtype=float).T
        self.rtol = check_tolerance(rtol)
        self._last: tuple[bytes, SteadyState] | None = None

    @property
    def count(self) -> int:
        """Number of open parameters."""
        return len(self.paths)

    def engine(self, point: np.ndarray) -> Engine:
        """Engine at a point."""
        values = self.low + np.clip(point[: self.count], 0.0, 1.0) * (self.high - self.low)
        return self.base.replace(**dict(zip(self.paths, values.tolist(), strict=True)))

    def steady(self, point: np.ndarray) -> SteadyState:
        """Steady state at a point; the last one is remembered."""
        key = point[: self.count].tobytes()
        if self._last is None or self._last[0] != key:
            self._last = key, found_steady_state(self.engine(point), self.rtol)
        return self._last[1]

    def start(self) -> np.ndarray:
        """Where the search begins."""
        given = np.array([float(self.base.get(path)) for path in self.paths])
        point = np.clip((given - self.low) / (self.high - self.low), 0.0, 1.0)
        steady = self.steady(point)
        if not steady.found:
            raise CalibrationError(f"no steady state to begin with: {steady.message}")
        if not self.traces:
            return point
        cycle = cycle_of(steady)
        self.period = cycle.period
        shifts = [cycle.best_shift(trace) / self.period for trace in self.traces]
        return np.r_[point, shifts]

    def residuals(self, point: np.ndarray) -> np.ndarray:
        """All residuals; NaN, from which the search turns back, without a steady state."""
        steady = self.steady(point)
        if not steady.found:
            return np.full(self.size, np.nan)
        return np.concatenate(list(self.parts(point, steady).values()))

    @property
    def size(self) -> int:
        """Number of residuals."""
        return len(self.figures) + sum(len(one.t) * len(one.channels) for one in self.traces)

    def parts(self, point: np.ndarray, steady: SteadyState) -> dict[str, np.ndarray]:
        """Residuals by figure and trace."""
        performance = steady.performance.to_dict()
        found = {
            name: np.array([(performance[name] - value) / deviation])
            for name, (value, deviation) in self.figures.items()
        }
        if self.traces:
            cycle = cycle_of(steady)
            for place, trace in enumerate(self.traces):
                shift = self.period * point[self.count + place]
                parts = np.split(cycle.residuals(trace, shift), len(trace.channels))
                for channel, part in zip(trace.channels, parts, strict=True):
                    found[f"{trace.name} {place + 1}: {WORDS[channel]}"] = part
        return found

    def jacobian(self, point: np.ndarray) -> np.ndarray:
        """Central differences; one-sided at a bound."""
        steady = self.steady(point)
        columns = []
        for place in range(self.count):
            ends = []
            for way in (1.0, -1.0):
                other = point.copy()
                other[place] = np.clip(other[place] + way * DIFFERENCE, 0.0, 1.0)
                ends.append((other[place], self.residuals(other)))
            (more, above), (less, below) = ends
            columns.append((above - below) / (more - less))
        self._last = point[: self.count].tobytes(), steady
        columns += self._shift_columns(point, steady)
        return np.stack(columns, axis=1)

    def _shift_columns(self, point: np.ndarray, steady: SteadyState) -> list[np.ndarray]:
        """Derivatives with respect to the shifts."""
        columns = []
        cycle: SimulatedCycle | None = cycle_of(steady) if self.traces else None
        before = len(self.figures)
        for place, trace in enumerate(self.traces):
            assert cycle is not None
            column, shift = np.zeros(self.size), point[self.count + place]
            ends = [
                cycle.residuals(trace, self.period * (shift + way * SHIFT_DIFFERENCE))
                for way in (1.0, -1.0)
            ]
            after = before + len(ends[0])
            column[before:after] = (ends[0] - ends[1]) / (2.0 * SHIFT_DIFFERENCE)
            columns.append(column)
            before = after
        return columns

    def result(self, solved: Any, confidence: float) -> Calibration:
        """Result of the search."""
        import pandas as pd

        point = solved.x
        steady = self.steady(point)
        covariance = _covariance(solved.jac, solved.fun)[: self.count, : self.count]
        width = self.high - self.low
        spread = np.sqrt(np.diag(covariance)) * width
        values = self.low + np.clip(point[: self.count], 0.0, 1.0) * width
        reach = _student(confidence, len(solved.fun) - len(point)) * spread
        table = pd.DataFrame(
            {
                "start": [float(self.base.get(path)) for path in self.paths],
                "value": values,
                "low": values - reach,
                "high": values + reach,
                "unit": [unit_of(self.base, path) for path in self.paths],
                "at_bound": np.minimum(point[: self.count], 1.0 - point[: self.count]) < AT_BOUND,
            },
            index=pd.Index(self.paths, name="parameter"),
        )
        scale = np.sqrt(np.diag(covariance))
        correlation = covariance / np.outer(scale, scale)
        ended = "found" if solved.success else "not converged"
        return Calibration(
            engine=steady.engine,
            steady=steady,
            table=table,
            correlation=_frame(correlation, self.paths),
            residuals=self.parts(point, steady),
            shifts=tuple(self._shifts(point)),
            confidence=confidence,
            converged=bool(solved.success),
            message=f"{self.count} parameters {ended} in {solved.nfev} steps",
        )

    def _shifts(self, point: np.ndarray) -> list[float]:
        return [self.period * float(shift) for shift in point[self.count :]]


def _covariance(jacobian: np.ndarray, residuals: np.ndarray) -> np.ndarray:
    """Covariance of the estimates; NaN where the residuals do not tell."""
    rows, columns = jacobian.shape
    unknown = np.full((columns, columns), np.nan)
    if rows <= columns or np.linalg.matrix_rank(jacobian) < columns:
        return unknown
    variance = float(np.square(residuals).sum()) / (rows - columns)
    return variance * np.linalg.inv(jacobian.T @ jacobian)


def _student(confidence: float, freedom: int) -> float:
    """Half width of an interval in standard errors."""
    from scipy.stats import t

    return float(t.ppf(0.5 + 0.5 * confidence, freedom)) if freedom > 0 else np.nan


def _frame(matrix: np.ndarray, names: list[str]) -> pd.DataFrame:
    import pandas as pd

    return pd.DataFrame(matrix, index=names, columns=names)


def _bounds(engine: Engine, bounds: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Bounds as numbers; wrong ones are refused."""
    if not bounds:
        raise CalibrationError("bounds: name at least one open parameter")
    found = {}
    for path, pair in bounds.items():
        if as_float(engine.get(path)) is None:
            raise CalibrationError(f"bounds of {path}: it is no number of the engine")
        ends = [as_float(end) for end in pair] if isinstance(pair, (tuple, list)) else []
        if len(ends) != 2 or ends[0] is None or ends[1] is None or not ends[0] < ends[1]:
            raise CalibrationError(f"bounds of {path} = {pair!r}: must be two numbers, rising")
        found[path] = (ends[0], ends[1])
    for end in (0, 1):
        engine.replace(**{path: pair[end] for path, pair in found.items()}).validate()
    return found


def _figures(figures: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Figures with their standard deviations; wrong ones are refused."""
    found = {}
    for name, given in figures.items():
        if name not in UNITS:
            raise CalibrationError(f"no figure {name!r}{nearest(name, UNITS)}")
        pair = given if isinstance(given, (tuple, list)) else (given, None)
        value = as_float(pair[0])
        usual = None if value is None else USUAL_DEVIATION * abs(value)
        deviation = usual if len(pair) < 2 or pair[1] is None else as_float(pair[1])
        if value is None or deviation is None or not deviation > 0.0:
            raise CalibrationError(f"{name} = {given!r}: must be a number, or it and its deviation")
        found[name] = (value, deviation)
    return found
