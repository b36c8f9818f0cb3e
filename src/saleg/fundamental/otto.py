"""Heat, work and compression ratio at equilibrium as functions (Eq. 31-34)."""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.fundamental.checks import FINITE, GAMMA, NOT_NEGATIVE, POSITION, require


def otto_efficiency(left: Any, right: Any, *, gamma: Any) -> Any:
    """Efficiency of the Otto cycle between two dead centres, in brackets in Eq. 31.

    Parameters
    ----------
    left, right : array_like
        Dead centres x_l* and x_r* [-].
    gamma : array_like
        Ratio of specific heats [-].

    Returns
    -------
    ndarray or float
        Efficiency [-].

    Examples
    --------
    >>> round(float(otto_efficiency(-0.8, 0.8, gamma=1.4)), 6)  # 1 - 9**-0.4
    0.584756
    """
    require(left=(left, POSITION), right=(right, POSITION), gamma=(gamma, GAMMA))
    return 1.0 - ((1.0 + np.asarray(left)) / (1.0 + np.asarray(right))) ** (gamma - 1.0)


def equilibrium_force(left: Any, right: Any = None, *, gamma: Any, heat: Any) -> Any:
    """Constant work force that takes out what the Otto cycle gains (Eq. 31, 32).

    With ``right = -left`` it makes the stroke repeat itself. Whether the engine returns there
    after a disturbance is another question: see :func:`saleg.fundamental.multiplier`.

    Parameters
    ----------
    left : array_like
        Left dead centre x_l* [-].
    right : array_like, optional
        Right dead centre x_r* [-]; the mirror image of the left one unless given (Eq. 32).
    gamma : array_like
        Ratio of specific heats [-].
    heat : array_like
        Heat Q_in* of a stroke [-].

    Returns
    -------
    ndarray or float
        Work force F_W* [-].

    Examples
    --------
    >>> round(float(equilibrium_force(-0.8, gamma=1.4, heat=1.0)), 6)
    0.365473
    """
    require(left=(left, POSITION), heat=(heat, NOT_NEGATIVE))
    right = -np.asarray(left) if right is None else np.asarray(right)
    efficiency = otto_efficiency(left, right, gamma=gamma)
    return heat * efficiency / (right - np.asarray(left))


def cosine_amplitude(force: Any, left: Any, right: Any) -> Any:
    """Amplitude A of ``A cos(pi x*/2)`` that takes the work of a constant force (Eq. 33, 34).

    Parameters
    ----------
    force : array_like
        Constant work force F_W* [-].
    left, right : array_like
        Dead centres x_l* and x_r* [-].

    Returns
    -------
    ndarray or float
        Amplitude [-].

    Examples
    --------
    >>> round(float(cosine_amplitude(1.0, -1.0 + 1e-9, 1.0 - 1e-9)), 6)  # pi/2 over all the length
    1.570796
    """
    require(force=(force, FINITE), left=(left, POSITION), right=(right, POSITION))
    left, right = np.asarray(left), np.asarray(right)
    sines = np.sin(0.5 * np.pi * right) - np.sin(0.5 * np.pi * left)
    return 0.5 * np.pi * force * (right - left) / sines


def compression_ratio(left: Any, right: Any) -> Any:
    """Geometric compression ratio of a stroke S between two dead centres, (2 + S*) / (2 - S*).

    Parameters
    ----------
    left, right : array_like
        Dead centres [-], in either order.

    Returns
    -------
    ndarray or float
        Compression ratio [-], the thesis' ``(L + S/2) / (L - S/2)``.

    Examples
    --------
    >>> float(compression_ratio(-0.5, 0.5))
    3.0
    """
    require(left=(left, POSITION), right=(right, POSITION))
    stroke = np.abs(np.asarray(right) - np.asarray(left))
    return (2.0 + stroke) / (2.0 - stroke)
