"""Strokes between mirrored dead centres: what they gain, what balances them, what disturbs them.

With dead centres at -u and u the springs and the motored gas give back all they took, so a stroke
repeats itself where the fired gas gains exactly what the load takes. The next dead centre is a
function of the last one (:func:`saleg.fundamental.return_map`); its derivative at an equilibrium,
the multiplier, says whether a disturbance shrinks or grows from stroke to stroke.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from saleg.checks import a, checked
from saleg.errors import OutsideModel
from saleg.fundamental.checks import DEPTH, LEFT, SCALAR, require
from saleg.fundamental.history import from_depth
from saleg.fundamental.loads import ConstantLoad
from saleg.fundamental.system import System
from saleg.quantities import Problem

#: Step along the imaginary axis that gives derivatives without a difference, hence to rounding.
TINY = 1e-30


@checked(system=a(System))
def indicated_work(system: System, depth: Any) -> Any:
    """Work the gas gains in a stroke between mirrored dead centres, the load aside.

    Parameters
    ----------
    system : System
    depth : array_like
        Distance of both dead centres from the midpoint [-].

    Returns
    -------
    ndarray or float
        Work in k L^2 [-].

    Examples
    --------
    >>> work = indicated_work(System(pressure=0.5, heat=1.0), 0.8)
    >>> round(float(work), 6)  # isentropic, burnt at dead centre: that of the Otto cycle
    0.584756
    """
    require(depth=(depth, DEPTH))
    return gain(system, np.asarray(depth, dtype=float))


@checked(system=a(System), start=SCALAR)
def at_equilibrium(system: System, start: float) -> System:
    """Copy of a system whose load makes a dead centre an equilibrium (Eq. 32, generalised).

    Parameters
    ----------
    system : System
        Of its load only the kind and the shape count.
    start : float
        Left dead centre x_l* [-].

    Returns
    -------
    System
        With the amplitude, or the second-law efficiency, that balances the stroke.

    Raises
    ------
    OutsideModel
        If `start` is not between -1 and 0, or if the gas gains no work from there.

    Examples
    --------
    >>> balanced = at_equilibrium(System(pressure=0.5, heat=1.0), -0.8)
    >>> round(balanced.load.amplitude, 6)
    0.365473
    """
    require(start=(start, LEFT))
    depth = -start
    work = float(indicated_work(system, depth))
    if work < 0.0:
        allowed = "must be deep enough for the charge to burn and gain work"
        raise OutsideModel([Problem("start", start, "-", allowed)])
    return replace(system, load=system.load.balanced(system, depth, work))


@checked(system=a(System))
def multiplier(system: System, depth: Any) -> Any:
    """Change of the next depth with the last one, at an equilibrium.

    Parameters
    ----------
    system : System
    depth : array_like
        Depth of the equilibrium [-].

    Returns
    -------
    ndarray or float
        Multiplier of one stroke [-]; that of a cycle is its square.

    Examples
    --------
    >>> system = at_equilibrium(System(pressure=0.5, heat=1.0), -0.9)
    >>> bool(multiplier(system, 0.9) > 1.0)  # deep equilibria repel
    True
    """
    require(depth=(depth, DEPTH))
    depth = np.asarray(depth, dtype=float)
    # The end u' of a stroke from u is where K(u', u) = 0, hence du'/du = -K_u/K_u'. K_u' is the
    # acceleration of Eq. 26.
    by_start = np.imag(from_depth(system, depth + 1j * TINY).kinetic_energy(depth)) / TINY
    return -by_start / from_depth(system, depth).acceleration(depth)


def gain(system: System, depth: Any) -> Any:
    """:func:`indicated_work` for complex depths too, unchecked."""
    return from_depth(replace(system, load=ConstantLoad()), depth).kinetic_energy(depth)
