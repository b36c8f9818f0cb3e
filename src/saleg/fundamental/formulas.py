"""The motion within a stroke as functions (Eq. 11, 14, 26, 28-30).

All quantities are dimensionless (Eq. 7-10, 27; see :class:`saleg.fundamental.Scales`): positions
in half strokes L, from -1 at the left head to 1 at the right one. Every argument may be an array;
they are broadcast.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.fundamental.checks import FINITE, GAMMA, NOT_NEGATIVE, POSITION, require


def acceleration(
    x: Any,
    start: Any,
    *,
    gamma: Any,
    pressure: Any,
    heat: Any = 0.0,
    force: Any = 0.0,
    direction: Any = 1.0,
) -> Any:
    """Acceleration of the translator in a stroke (Eq. 26 and 29; without heat and force Eq. 11).

    Eq. 29 is printed with the wrong sign: to the left is the mirror image of to the right.

    Parameters
    ----------
    x : array_like
        Position x* [-].
    start : array_like
        Dead centre at which the stroke begins, left (x_l*) or right (x_r*) [-].
    gamma : array_like
        Ratio of specific heats [-].
    pressure : array_like
        Midpoint pressure P_mp* [-] (Eq. 9).
    heat : array_like
        Heat Q_in* added at `start` [-] (Eq. 27).
    force : array_like
        Constant work force F_W* [-] (Eq. 27).
    direction : array_like
        1 for a stroke to the right, -1 for one to the left.

    Returns
    -------
    ndarray or float
        Acceleration a* [-], positive to the right.

    Raises
    ------
    OutsideModel
        Naming every argument outside the model.

    Examples
    --------
    >>> float(acceleration(0.5, -0.5, gamma=1.4, pressure=0.0))  # springs alone: -2 x
    -1.0
    """
    _require(x, start, gamma, pressure, heat, force)
    s, s0 = direction * np.asarray(x), direction * np.asarray(start)
    burnt = heat * (gamma - 1.0) * (1.0 + s0) ** (gamma - 1.0) / (1.0 + s) ** gamma
    motored = pressure * ((1.0 + s) ** -gamma - (1.0 - s) ** -gamma)
    return direction * (burnt + motored - 2.0 * s - force)


def kinetic_energy(
    x: Any,
    start: Any,
    *,
    gamma: Any,
    pressure: Any,
    heat: Any = 0.0,
    force: Any = 0.0,
    direction: Any = 1.0,
) -> Any:
    """Half the square of the velocity in a stroke (Eq. 28 and 30; without heat and force Eq. 14).

    Eq. 30 is printed with the wrong sign and would be negative; see :func:`acceleration`.

    Parameters
    ----------
    x, start, gamma, pressure, heat, force, direction : array_like
        As for :func:`acceleration`.

    Returns
    -------
    ndarray or float
        v*^2 / 2 [-]; negative where the translator does not come.

    Raises
    ------
    OutsideModel
        Naming every argument outside the model.

    Examples
    --------
    >>> float(kinetic_energy(0.0, -0.5, gamma=1.4, pressure=0.0))  # springs alone: x_l^2 - x^2
    0.25
    """
    _require(x, start, gamma, pressure, heat, force)
    s, s0 = direction * np.asarray(x), direction * np.asarray(start)
    burnt = heat * (1.0 - ((1.0 + s0) / (1.0 + s)) ** (gamma - 1.0))
    motored = pressure * (_motored_energy(s0, gamma) - _motored_energy(s, gamma))
    return burnt + motored + s0**2 - s**2 - force * (s - s0)


def _motored_energy(s: Any, gamma: Any) -> Any:
    """Energy stored in both gas springs, over P_mp*."""
    return ((1.0 + s) ** (1.0 - gamma) + (1.0 - s) ** (1.0 - gamma)) / (gamma - 1.0)


def _require(x: Any, start: Any, gamma: Any, pressure: Any, heat: Any, force: Any) -> None:
    require(
        x=(x, POSITION),
        start=(start, POSITION),
        gamma=(gamma, GAMMA),
        pressure=(pressure, NOT_NEGATIVE),
        heat=(heat, NOT_NEGATIVE),
        force=(force, FINITE),
    )
