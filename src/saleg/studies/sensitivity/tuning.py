"""Laws made comparable: one number tuned until a figure of the steady run is as wanted."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

from saleg.checks import FUNCTION, NUMBER, TEXT, a, checked
from saleg.design import Design
from saleg.engine import Engine
from saleg.errors import SalegError
from saleg.simulation.run import Run
from saleg.studies.sensitivity.settle import is_stable, settle

#: An engine or a design: what is given comes back changed.
Subject = TypeVar("Subject", Engine, Design)

MAX_TRIES = 30
#: Relative deviation of a tuned figure that is left.
CLOSE = 1e-6


class TuningError(SalegError, ArithmeticError):
    """A figure that cannot be tuned to what is wanted."""


@checked(run=a(Run))
def heat_transfer_share(run: Run) -> float:
    """Heat lost to the walls in the last cycle over the fresh fuel energy [-].

    Parameters
    ----------
    run : Run

    Returns
    -------
    float
        NaN without fuel.
    """
    return run.energy.heat_transfer / run.energy.fuel if _burns(run) and run.energy else math.nan


@checked(run=a(Run))
def friction_work(run: Run) -> float:
    """Work of friction in the last cycle [J].

    Parameters
    ----------
    run : Run

    Returns
    -------
    float
        NaN without a full cycle.
    """
    return run.energy.friction if run.energy else math.nan


def _burns(run: Run) -> bool:
    return run.energy is not None and run.energy.fuel > 0.0


@checked(engine=a(Engine, Design), path=TEXT, figure=FUNCTION, wanted=NUMBER)
def tune(engine: Subject, path: str, figure: Callable[[Run], float], wanted: float) -> Subject:
    """Find the engine or design whose steady state has a figure as wanted, by one of its numbers.

    The number is scaled by what the figure falls short until the two agree to 1e-6; that serves
    figures that grow about in proportion to it, as a heat loss does with the scale of its law.

    Parameters
    ----------
    engine : Engine or Design
    path : str
        Dotted path of the number.
    figure : callable
        From a :class:`saleg.Run` to the figure, such as :func:`heat_transfer_share`.
    wanted : float
        What the figure is to be, in its SI unit.

    Returns
    -------
    Engine or Design

    Raises
    ------
    TuningError
        If the engine gets unstable on the way, the figure is not positive, or it does not follow
        the number.

    Examples
    --------
    >>> import saleg
    >>> base = saleg.machines.thesis_base()
    >>> warm = tune(base, "heat_transfer.a", heat_transfer_share, 0.16)
    >>> round(warm.get("heat_transfer.a"), 1)
    91.6
    """
    for _ in range(MAX_TRIES):
        run = settle(engine)
        found = figure(run)
        if not (is_stable(run) and found > 0.0 and wanted > 0.0):
            raise TuningError(
                f"cannot tune {path} = {engine.get(path):g}: the figure is {found:g} where "
                f"{wanted:g} is wanted, and the run ended {run.status} ({run.message})"
            )
        if abs(found / wanted - 1.0) < CLOSE:
            return engine
        engine = engine.replace(**{path: engine.get(path) * wanted / found})
    raise TuningError(f"{path} does not bring the figure to {wanted:g}: still {found:g}")


@checked(engine=a(Engine, Design))
def fix_load(engine: Subject) -> Subject:
    """The engine or design with its load fixed where the stroke regulator settled.

    The regulator masks what a change does to the motion: without it, the load constant stays that
    of the steady state.

    Parameters
    ----------
    engine : Engine or Design
        With an alternator that has a `load_constant` and a `regulator_gain`.

    Returns
    -------
    Engine or Design
        With the same steady state.

    Raises
    ------
    TuningError
        If the engine has no steady state.
    UnknownPath
        If its alternator has no load constant to fix.

    Examples
    --------
    >>> import saleg
    >>> fixed = fix_load(saleg.machines.thesis_base())
    >>> fixed.get("alternator.regulator_gain"), round(fixed.get("alternator.load_constant"), 2)
    (0.0, 74.25)
    """
    run = settle(engine)
    if not is_stable(run):
        raise TuningError(f"no steady state whose load could be fixed: {run.message}")
    weight = float(run.strokes["load_weight"][-1])
    constant = engine.get("alternator.load_constant")
    return engine.replace(
        **{"alternator.regulator_gain": 0.0, "alternator.load_constant": weight * constant}
    )
