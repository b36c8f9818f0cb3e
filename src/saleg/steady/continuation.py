"""Branches of steady states: how they move with a parameter, through folds and past instability.

The unknowns are the state at a dead centre and the parameter together. Along the branch a step of
given length is predicted along the tangent and corrected by Newton's method on the return map
(pseudo-arclength continuation), so a fold is no obstacle.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.engine import Engine, check_engine
from saleg.engine.paths import unit_of
from saleg.errors import SalegError, shown
from saleg.kernel import layout
from saleg.kernel.vector import Z_CHAMBERS
from saleg.quantities import as_float, is_number, is_whole
from saleg.simulation.initial_state import State, prepare
from saleg.simulation.performance import UNITS as PERFORMANCE_UNITS
from saleg.steady.earlier_names import renamed_keywords
from saleg.steady.return_map import NoReturn, ReturnMap, step_tolerance
from saleg.steady.sealed_gas import (
    missing_entropy,
    missing_entropy_rates,
    with_sealed_charges,
)
from saleg.steady.solver import result_of, steady_state
from saleg.steady.stability import FINE, Stability, judged, own_multipliers
from saleg.steady.state import SteadyState
from saleg.steady.symmetry import repeats_itself

if TYPE_CHECKING:
    import pandas as pd

#: Corrector: iterations, the residual it must reach, and how far it may go.
MAX_CORRECTIONS = 8
CONVERGED = 1e-8
FARTHEST = 0.5
#: Multiplier of the map beyond which it is no smooth map any more.
TORN = 300.0
#: Why a disturbed orbit does not return, by the codes of the layout.
TROUBLES = {
    layout.HEAD_CONTACT: "the piston reaches a head",
    layout.STALLED: "the engine stalls",
    layout.STEP_FAILURE: "no step is small enough",
    layout.NO_DEAD_CENTRE: "the translator does not return",
}
#: Corrections with which a step counts as easy, so that the next may be longer.
EASY = 3


class NoBranch(SalegError, ValueError):
    """There is no steady state to begin a branch with, or the question makes no sense."""


@dataclass(frozen=True, eq=False)
class Point:
    """Steady state on a branch.

    Attributes
    ----------
    value : float
        Value of the parameter, in its SI unit.
    state : State
        State at the dead centre where the map begins.
    vector : ndarray
        The same as a vector.
    stability : Stability
    steady : SteadyState
    """

    value: float
    state: State = field(repr=False)
    vector: np.ndarray = field(repr=False)
    stability: Stability = field(repr=False)
    steady: SteadyState = field(repr=False)


@dataclass(frozen=True, eq=False)
class Branch:
    """Steady states along a parameter, in the order in which they were met.

    Attributes
    ----------
    engine : Engine
        Where it began.
    path : str
        Path of the parameter.
    points : list of Point
    ended : str
        Why it ends where it does.
    """

    engine: Engine
    path: str
    points: list[Point] = field(repr=False)
    ended: str

    @property
    def unit(self) -> str:
        """Unit of the parameter."""
        return unit_of(self.engine, self.path)

    @property
    def table(self) -> pd.DataFrame:
        """Table of the points, one row each: parameter, figures, stability; units in ``.attrs``."""
        import pandas as pd

        from saleg.simulation.shown_table import Table

        rows = [
            {
                self.path: point.value,
                "stable": point.stability.stable,
                "kind": point.stability.kind,
                "largest_multiplier": float(np.abs(point.stability.multipliers).max(initial=0.0)),
                **point.steady.quick_performance.to_dict(),
            }
            for point in self.points
        ]
        frame = pd.DataFrame(rows).drop(columns="adverse_work")
        units = {self.path: self.unit, **dict.fromkeys(frame.columns[1:4], "-")}
        units |= {name: PERFORMANCE_UNITS[name] for name in frame.columns[4:]}
        return Table.of(frame, units)

    @property
    def folds(self) -> list[float]:
        """Values at which the branch turns back, by a parabola through the nearest points."""
        values = np.array([point.value for point in self.points])
        ways = np.sign(np.diff(values))
        turns = np.flatnonzero(ways[1:] * ways[:-1] < 0.0) + 1
        return [self._extremum(values, int(i)) for i in turns]

    def _extremum(self, values: np.ndarray, i: int) -> float:
        """Extreme value of the parabola through three points, over the way in the vector."""
        a, b, c = (self.points[n].vector[:Z_CHAMBERS] for n in (i - 1, i, i + 1))
        way = np.array([-np.linalg.norm(b - a), 0.0, np.linalg.norm(c - b)])
        curve, slope, value = np.polyfit(way, values[i - 1 : i + 2], 2)
        return float(value - slope * slope / (4.0 * curve))

    @property
    def stability_changes(self) -> list[tuple[float, str]]:
        """Values at which stability is lost or won, and how, by linear interpolation."""
        found = []
        for a, b in itertools.pairwise(self.points):
            if a.stability.stable == b.stability.stable:
                continue
            unstable = b if a.stability.stable else a
            x, y = (math.log(_largest(point)) for point in (a, b))
            value = a.value - x * (b.value - a.value) / (y - x) if x != y else a.value
            found.append((float(value), unstable.stability.kind))
        return found

    def __repr__(self) -> str:
        name, count = self.engine.name, len(self.points)
        return f"<Branch of {name!r} along {self.path!r}: {count} steady states>"

    def _repr_html_(self) -> str:
        from saleg.display import branch_card

        return branch_card(self)

    def plot(self, figure: str = "stroke", ax: Any = None) -> Any:
        """Bifurcation diagram: see :func:`saleg.plotting.branches.bifurcation`."""
        from saleg.plotting.branches import bifurcation

        return bifurcation(self, figure, ax)


def _largest(point: Point) -> float:
    return float(np.abs(point.stability.multipliers).max(initial=1e-300))


@renamed_keywords(most="max_points")
def branch(
    engine: Engine,
    path: str,
    stop: float,
    *,
    step: float | None = None,
    max_points: int = 200,
) -> Branch:
    """Follow the steady state of an engine as one of its parameters changes.

    Parameters
    ----------
    engine : Engine
        Begins with the parameter's value there.
    path : str
        Path of the parameter, such as ``"alternator.load_constant"``.
    stop : float
        Value to go towards, in its SI unit. The branch ends when it gets there, when it comes back
        through a fold to where it began, or when the orbit is lost.
    step : float, optional
        Longest step in the parameter, in its SI unit; a fortieth of the way unless given.
    max_points : int
        Points after which it ends.

    Returns
    -------
    Branch

    Raises
    ------
    UnknownPath, InvalidEngine
        If there is no such parameter, or a value is out of range.
    NoBranch
        If there is no steady state to begin with.

    Examples
    --------
    >>> import saleg
    >>> base = saleg.machines.thesis_base().replace(**{"alternator.regulator_gain": 13.0})
    >>> found = saleg.steady.continuation.branch(base, "alternator.regulator_gain", 15.0, step=0.5)
    >>> [(round(value, 1), kind) for value, kind in found.stability_changes]
    [(13.9, 'quasi-periodic')]
    """
    check_engine(engine)
    start, end = engine.get(path), as_float(stop)
    if not is_number(start) or end is None or not math.isfinite(end) or end == start:
        raise NoBranch(f"cannot follow '{path}' from {shown(start)} to {shown(stop)}")
    longest = abs(end - start) / 40.0 if step is None else as_float(step)
    if longest is None or not 0.0 < longest < math.inf:
        raise NoBranch(f"step = {shown(step)}: must be a number > 0")
    if not is_whole(max_points, 2):
        raise NoBranch(f"max_points = {shown(max_points)}: must be a whole number >= 2")
    engine.replace(**{path: end}).validate()
    if not repeats_itself(engine):
        raise NoBranch("a law depends on time or counts charges: the engine never repeats itself")
    first = steady_state(engine, rtol=1e-9)
    if not first.found or first.replay is None:
        raise NoBranch(f"no steady state to begin with: {first.message}")
    follower = _Follower(first, path, float(start), end, longest)
    points: list[Point] = []
    for point in follower.points(first):
        points.append(point)
        if len(points) >= max_points:
            follower.ended = f"as many points as asked for ({max_points})"
            break
    return Branch(engine, path, points, follower.ended)


class _Follower:
    """Predictor and corrector; the parameter is measured from the start in units of the way."""

    def __init__(self, first: SteadyState, path: str, start: float, stop: float, longest: float):
        self.engine, self.path = first.engine, path
        self.start, self.way = start, stop - start
        self.longest = longest / abs(self.way)
        self.mirrored = first.mirrored
        self.steps = step_tolerance(first.engine, FINE)
        self.ended, self.trouble = "", 0

    def engine_at(self, s: float) -> Engine:
        """Engine a share `s` of the way along."""
        return self.engine.replace(**{self.path: self.start + s * self.way})

    def return_map(self, s: float, like: State) -> tuple[ReturnMap, State]:
        """Return map of that engine, and a state for its vectors, in the modes of another."""
        engine = self.engine_at(s)
        state = prepare(engine)
        for name in ("mode", "armed"):
            state.chambers[name] = like.chambers[name]
        state.engine["direction"] = like.engine["direction"]
        return ReturnMap.of(engine, state.copy(), self.steps, self.mirrored), state

    def residual(self, s: float, z: np.ndarray, like: State) -> np.ndarray:
        """Residual of the map: image of a vector less the vector.

        What the map conserves is to be what the engine there is given.
        """
        return_map, state = self.return_map(s, like)
        z = with_sealed_charges(return_map, state, z)
        residual = return_map.image(state, z) - z
        for n, missing in missing_entropy(return_map, state, z).items():
            residual[n] = missing
        return residual

    def points(self, first: SteadyState) -> Iterator[Point]:
        """Points of the branch, the first steady state included."""
        assert first.replay is not None
        like = first.replay.start
        s, z = 0.0, self.return_map(0.0, like)[0].vector(like)
        tangent = np.zeros(len(z) + 1)
        tangent[-1] = 1.0
        corrected = self.correct(s, z, tangent, like)
        if corrected is None:
            raise NoBranch("the steady state could not be refined to begin with")
        length = self.longest
        while True:
            s, z, like, tangent, jacobian, count = corrected
            if np.abs(np.linalg.eigvals(jacobian)).max() > TORN:
                self.ended = (
                    f"the orbit ends at {self.start + s * self.way:.6g}: there the least "
                    "disturbance changes what happens in a cycle, such as whether a charge lights"
                )
                return
            yield self.point(s, z, like, jacobian)
            if (s >= 1.0 - 1e-12 and tangent[-1] > 0.0) or (s <= 0.0 and tangent[-1] < 0.0):
                self.ended = "arrived" if s > 0.5 else "came back to where it began"
                return
            length = min(1.5 * length if count <= EASY else length, self.longest)
            corrected = None
            while corrected is None:
                corrected = self.advance(s, z, like, tangent, length)
                length = length if corrected is not None else 0.5 * length
                if length < 1e-5:
                    why = TROUBLES.get(self.trouble, "no neighbour was found")
                    self.ended = f"the orbit is lost near {self.start + s * self.way:.6g}: {why}"
                    return

    def advance(
        self, s: float, z: np.ndarray, like: State, tangent: np.ndarray, length: float
    ) -> Any:
        """Step along the tangent, cut where it would pass the end, and corrected."""
        step = length / max(abs(tangent[-1]), 0.05)
        fixed = tangent
        if tangent[-1] > 0.0 and s + step * tangent[-1] >= 1.0:
            step = (1.0 - s) / tangent[-1]
            fixed = np.zeros_like(tangent)  # land on the end itself
            fixed[-1] = 1.0
        guess = np.append(z, s) + step * tangent
        return self.correct(guess[-1], guess[:-1], fixed, like, tangent)

    def correct(
        self,
        s: float,
        z: np.ndarray,
        normal: np.ndarray,
        like: State,
        along: np.ndarray | None = None,
    ) -> Any:
        """Newton's method in the plane through the guess; None if it does not converge."""
        guess, u = np.append(z, s), np.append(z, s)
        try:
            for count in range(MAX_CORRECTIONS):
                return_map, state = self.return_map(u[-1], like)
                u[:-1] = with_sealed_charges(return_map, state, u[:-1])
                image = return_map.image(state, u[:-1])
                after = return_map.state
                if (after.chambers["mode"] != like.chambers["mode"]).any():
                    # An event has passed the dead centre: other entries of the vector count now.
                    like = self.settled(after, like)
                    u[:-1] = guess[:-1] = image
                    continue
                residual = self.residual(u[-1], u[:-1], like)
                matrix, jacobian = self.matrix(u, like, normal)
                error = float(np.abs(residual).max())
                if error < CONVERGED:
                    direction = np.zeros(len(u))
                    direction[-1] = 1.0
                    tangent = np.linalg.solve(
                        np.vstack([matrix[:-1], along if along is not None else normal]), direction
                    )
                    tangent /= np.linalg.norm(tangent)
                    return u[-1], u[:-1], like, tangent, jacobian, count
                right = np.append(-residual, -normal @ (u - guess))
                change = np.linalg.solve(matrix, right)
                if not np.abs(change).max() < FARTHEST:
                    return None
                u = u + change
        except NoReturn as error:
            self.trouble = error.code
            return None
        except (np.linalg.LinAlgError, SalegError):
            return None
        return None

    def settled(self, after: State, like: State) -> State:
        """The state before, with the modes of its image, which are those of the orbit itself."""
        kept = like.copy()
        for name in ("mode", "armed"):
            kept.chambers[name] = after.chambers[name]
        return kept

    def matrix(
        self, u: np.ndarray, like: State, normal: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Matrix of Newton's method, and the derivative of the map alone."""
        s, z = u[-1], u[:-1]
        return_map, state = self.return_map(s, like)
        jacobian = return_map.jacobian(state, z)
        low, high = max(s - 1e-5, 0.0), min(s + 1e-5, 1.0)  # neither may leave the allowed range
        by_parameter = self.residual(high, z, like) - self.residual(low, z, like)
        by_state = jacobian - np.eye(len(z))
        for n, rates in missing_entropy_rates(return_map, state, z).items():
            by_state[n] = rates
        top = np.column_stack([by_state, by_parameter / (high - low)])
        return np.vstack([top, normal]), jacobian

    def point(self, s: float, z: np.ndarray, like: State, jacobian: np.ndarray) -> Point:
        """Point of the branch with its stability and one cycle."""
        return_map, state = self.return_map(s, like)
        cycle = return_map.cycle(state, z)
        if cycle.code != layout.END_OF_TIME:
            raise NoReturn(cycle.code)
        steady = result_of(
            return_map, 0, return_map.evaluations, cycle.missed, "continuation", self.steps
        )
        period = float(steady.strokes["duration"].sum())
        stability = judged(own_multipliers(self.engine, jacobian), self.mirrored, period)
        return Point(float(self.start + s * self.way), state, z, stability, steady)
