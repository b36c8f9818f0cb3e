"""An alternator along a given motion, as on a test bench."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from saleg.checks import NUMBER, SERIES, a, checked, number
from saleg.errors import SalegError
from saleg.laws.arguments import Motion
from saleg.laws.base import Alternator
from saleg.simulation.initial_state import current_scale

if TYPE_CHECKING:
    import pandas as pd
    from scipy.interpolate import CubicSpline

#: Tolerance of the current.
RTOL = 1e-10
UNITS = {
    "t": "s",
    "x": "m",
    "v": "m/s",
    "force": "N",
    "electrical_power": "W",
    "current": "A",
    "voltage": "V",
}


class MotionError(SalegError, ValueError):
    """A motion no alternator can be taken along."""


@checked(alternator=a(Alternator), t=SERIES, x=SERIES, load_weight=number(low=0.0), current=NUMBER)
def prescribed_motion(
    alternator: Alternator, t: object, x: object, *, load_weight: float = 1.0, current: float = 0.0
) -> pd.DataFrame:
    """Force, power, current and voltage of an alternator along a measured motion.

    The position is interpolated by cubics, so that its velocity is smooth. The current of a law
    that has one is integrated along it (LSODA, to 1e-10).

    Parameters
    ----------
    alternator : Alternator
        Any law; nothing regulates it.
    t : array_like, shape (n,)
        Times, rising, at least four [s].
    x : array_like, shape (n,)
        Positions from the midpoint [m].
    load_weight : float
        Load weight W [-], the same all along.
    current : float
        Current at the first time [A].

    Returns
    -------
    DataFrame
        One row per time: ``t``, ``x``, ``v``, ``force`` against positive velocity,
        ``electrical_power`` and, of a law that has a current, ``current`` and ``voltage``, that of
        its terminals; units in ``.attrs["units"]``.

    Raises
    ------
    MotionError
        If times and positions make no motion, or the current cannot be integrated.

    Examples
    --------
    >>> import numpy as np
    >>> from saleg.laws import CircuitAlternator
    >>> t = np.linspace(0.0, 0.5, 2001)
    >>> bench = prescribed_motion(CircuitAlternator(), t, 0.04 * np.sin(2.0 * np.pi * 40.0 * t))
    >>> round(float(bench.current.tail(1000).max()), 2)
    14.07
    """
    import pandas as pd

    times, positions = np.asarray(t, float), np.asarray(x, float)
    position = _smooth(times, positions)
    velocities = position(times, 1)
    directions = _directions(velocities)
    law, weight = alternator, load_weight
    has_current = type(law).current_rate is not Alternator.current_rate
    currents = np.zeros_like(times)
    if has_current:
        currents = _currents(law, weight, times, position, current)
    motions = [
        Motion(*map(float, row))
        for row in zip(times, positions, velocities, directions, currents, strict=True)
    ]
    table = pd.DataFrame({"t": times, "x": positions, "v": velocities})
    table["force"] = [law.force(weight, motion) for motion in motions]
    table["electrical_power"] = [law.electrical_power(weight, motion) for motion in motions]
    if has_current:
        table["current"] = currents
        table["voltage"] = _voltages(law, weight, motions)
    table.attrs["units"] = {str(name): UNITS[str(name)] for name in table}
    return table


def _smooth(times: np.ndarray, positions: np.ndarray) -> CubicSpline:
    """Position over time."""
    from scipy.interpolate import CubicSpline

    if times.shape != positions.shape or len(times) < 4:
        raise MotionError(
            f"t and x must be as many, at least four: there are {len(times)} and {len(positions)}"
        )
    if not (np.diff(times) > 0.0).all():
        raise MotionError("t must rise")
    return CubicSpline(times, positions)


def _directions(velocities: np.ndarray) -> np.ndarray:
    """Direction of motion; that before where it stands still, 0 before the first movement."""
    signs = np.sign(velocities)
    latest = np.maximum.accumulate(np.where(signs != 0.0, np.arange(len(signs)), 0))
    return signs[latest]


def _currents(
    law: Alternator, weight: float, times: np.ndarray, position: CubicSpline, current: float
) -> np.ndarray:
    """Current at some times, integrated along a motion."""
    from scipy.integrate import solve_ivp

    velocity = position.derivative()

    def rate(time: float, state: np.ndarray) -> float:
        v = float(velocity(time))
        return law.current_rate(
            weight, Motion(time, float(position(time)), v, np.sign(v), float(state[0]))
        )

    fastest = float(np.abs(velocity(times)).max())
    solution = solve_ivp(
        rate,
        (times[0], times[-1]),
        [current],
        method="LSODA",
        t_eval=times,
        rtol=RTOL,
        atol=RTOL * max(current_scale(law, weight, fastest), abs(current)),
        max_step=float(np.diff(times).max()),
    )
    if not solution.success:
        raise MotionError(f"the current cannot be integrated: {solution.message}")
    return np.asarray(solution.y[0], float)


def _voltages(law: Alternator, weight: float, motions: list[Motion]) -> np.ndarray:
    """Voltage of the terminals, power over current; at no current, what a very small one shows."""
    least = 1e-9 * max(max(abs(motion.current) for motion in motions), 1e-300)
    found = []
    for motion in motions:
        seen = motion if abs(motion.current) > least else motion._replace(current=least)
        found.append(law.electrical_power(weight, seen) / seen.current)
    return np.array(found)
