"""Load and fuel with which an engine gives less power at the same dead centres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from saleg.checks import ONE_OR_MORE, a, checked
from saleg.engine import Engine
from saleg.errors import SalegError
from saleg.steady.linear import LinearModel
from saleg.steady.solver import steady_state
from saleg.steady.state import SteadyState

#: Corrections of load and fuel after which a point is given up, and the deviations from dead centre
#: and power at which it is found, over their values.
MAX_CORRECTIONS = 12
CLOSE = 1e-6
#: Numbers of the engine that are corrected, and longest correction of either, over its value.
BY = ("alternator.load_constant", "equivalence_ratio")
FARTHEST = 0.2


class NoOperatingLine(SalegError, ValueError):
    """There is no steady state at a power with the dead centres wanted."""


@dataclass(frozen=True, eq=False)
class OperatingLine:
    """Steady states of one dead centre over their powers.

    Attributes
    ----------
    powers : ndarray
        Mean electrical power, rising [W].
    load_weights : ndarray
        Load weight [-].
    equivalence_ratios : ndarray
        Equivalence ratio [-].
    steady : list of SteadyState
        The steady states, of the engine with its load fixed at those load weights.
    models : list of LinearModel
        Their linear models by load weight and equivalence ratio, with the default outputs.
    """

    powers: np.ndarray
    load_weights: np.ndarray
    equivalence_ratios: np.ndarray
    steady: list[SteadyState]
    models: list[LinearModel]


@checked(engine=a(Engine), powers=ONE_OR_MORE)
def operating_line(engine: Engine, powers: Sequence[float]) -> OperatingLine:
    """Steady states of an engine at some powers with the dead centres it has now.

    Newton's method on load and fuel; how dead centre and power change with them is read off the
    linear model of each steady state on the way.

    Parameters
    ----------
    engine : Engine
        Its own steady state has the dead centres to keep.
    powers : sequence of float
        Mean electrical powers [W].

    Returns
    -------
    OperatingLine

    Raises
    ------
    NoOperatingLine
        Naming the power that cannot be had.

    Examples
    --------
    >>> import saleg
    >>> line = saleg.control.operating_line(saleg.machines.thesis_transient(), [3000.0])
    >>> round(line.steady[0].performance.compression_ratio, 2)
    17.87
    """
    known = steady_state(engine)
    rated = known.linear(())
    weight = float(known.strokes["load_weight"].mean())
    constant = float(engine.get("alternator.load_constant"))
    fixed = engine.replace(
        **{"alternator.regulator_gain": 0.0, "alternator.load_constant": weight * constant}
    )
    goal = rated.output_values[rated.outputs.index("dead_centre")]
    points, begin = {}, fixed
    for power in sorted({float(power) for power in np.atleast_1d(powers)}, reverse=True):
        points[power] = _point(begin, goal, power)
        begin = points[power].engine
    found = [points[power] for power in sorted(points)]
    return OperatingLine(
        powers=np.array(sorted(points)),
        load_weights=np.array([point.engine.get(BY[0]) / constant for point in found]),
        equivalence_ratios=np.array([point.engine.get(BY[1]) for point in found]),
        steady=found,
        models=[_model(point, point.engine.get(BY[0]) / constant) for point in found],
    )


def _model(steady: SteadyState, weight: float) -> LinearModel:
    """Linear model by the load weight of the engine itself, not of that with its load fixed."""
    model = steady.linear(("load_weight", "equivalence_ratio"))
    unit = np.array([weight, 1.0])
    return replace(model, B=model.B / unit, input_values=model.input_values * unit)


def _point(engine: Engine, dead_centre: float, power: float) -> SteadyState:
    """Steady state with a dead centre [m] and a power [W], from an engine near it."""
    goal = np.array([dead_centre, power])
    for _ in range(MAX_CORRECTIONS):
        steady = steady_state(engine, rtol=1e-8)
        if not steady.found:
            break
        model = steady.linear(BY, ("dead_centre", "power"))
        missing = goal - model.output_values
        if (np.abs(missing) < CLOSE * goal).all():
            return steady
        gains = model.C @ np.linalg.solve(np.eye(len(model.A)) - model.A, model.B)
        change = np.linalg.solve(gains, missing) / model.input_values
        change *= min(1.0, FARTHEST / np.abs(change).max())
        values = model.input_values * (1.0 + change)
        engine = engine.replace(**dict(zip(BY, values.tolist(), strict=True)))
    raise NoOperatingLine(f"no steady state of {power:g} W with a dead centre of {dead_centre:g} m")
