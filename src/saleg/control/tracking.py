"""Tracking within the stroke of the trajectory that a steady state has."""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.checks import a, checked
from saleg.laws.control.position_sensor import PositionSensor
from saleg.laws.control.tracking import TrajectoryTracking
from saleg.steady.state import NoSteadyState, SteadyState

#: Positions of a reference, closest at its dead centres.
POINTS = 101
#: Greatest correction, over the greatest force of the alternator in the reference.
STRENGTH = 3.0


@checked(steady=a(SteadyState), sensor=a(PositionSensor).optional)
def trajectory_tracking(
    steady: SteadyState, sensor: PositionSensor | None = None, **settings: Any
) -> TrajectoryTracking:
    """Tracking of the trajectory of a steady state, as the ``force_control`` of a controller.

    Parameters
    ----------
    steady : SteadyState
        With the motion to track.
    sensor : PositionSensor, optional
        The sensor it will read: its delay is foreseen. A :class:`saleg.laws.PositionSensor` with
        its default values unless given.
    **settings
        Fields of :class:`saleg.laws.TrajectoryTracking` to be other than their defaults. Unless
        given, `limit` is three times the greatest force of the alternator in the steady state.

    Returns
    -------
    TrajectoryTracking

    Raises
    ------
    NoSteadyState
        If there is no motion to track.

    Examples
    --------
    >>> import saleg
    >>> from saleg import control, laws
    >>> engine = saleg.machines.thesis_transient()
    >>> tracking = control.trajectory_tracking(saleg.steady_state(engine))
    >>> controller = saleg.Controller(state_logic=laws.NeverMotored(), force_control=tracking)
    >>> run = control.simulate(engine, controller, 1.0)
    >>> round(run.performance.compression_ratio, 2)
    17.87
    """
    orbit = steady.orbit
    if orbit is None or orbit.history_rows is None:
        raise NoSteadyState(f"no steady state to track: {steady.message}")
    rows, mass = orbit.history_rows, steady.moving_mass
    x = rows["x"]
    turn = int(x.argmax())
    angle = np.linspace(0.0, np.pi, POINTS)
    positions = 0.5 * (x[0] + x[turn]) - 0.5 * (x[turn] - x[0]) * np.cos(angle)
    series: dict[str, Any] = {"positions": positions}
    for way, part in (("right", rows[: turn + 1]), ("left", rows[turn:][::-1])):
        known = {
            "energies": 0.5 * mass * part["v"] ** 2,
            "resultants": mass * part["a"],
            "forces": -part["alternator_force"],
        }
        for name, values in known.items():
            series[f"{name}_{way}"] = np.interp(positions, part["x"], values)
    seen = sensor or PositionSensor()
    foreseen = {
        "limit": STRENGTH * float(np.abs(rows["alternator_force"]).max()),
        "delay": (seen.delay + 0.5) * seen.sample_time,
    }
    plain = {name: tuple(map(float, values)) for name, values in series.items()}
    return TrajectoryTracking(**{"mass": mass, **plain, **foreseen, **settings})
