"""The one place where a sensitivity study comes to a steady state: of an engine, or of a design."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from saleg.checks import a, checked
from saleg.design import Design, InvalidDesign, solve
from saleg.engine import Engine
from saleg.errors import InvalidEngine, StartError
from saleg.kernel import layout
from saleg.simulation.integration import simulate
from saleg.simulation.run import Run
from saleg.status import Status

#: Times to simulate [s]; the next is tried where a run is not steady at the end of the one before.
SETTLING_TIMES = (3.0, 12.0)
#: A burn rate that jumps lets steps differ from cycle to cycle: looser, their errors hide a steady
#: state.
TOLERANCE = 1e-9
#: The same of the loop of a design, whose mass must agree to it too.
LOOP_TOLERANCE = 1e-8
#: Cycles whose records are kept: those its outcome depends on.
KEPT_CYCLES = 20


@checked(subject=a(Engine, Design))
def settle(subject: Engine | Design) -> Run:
    """Steady run of an engine, or of a design with the mass of its components.

    An engine holds its mass and its friction and is simulated from its own start, until it is
    steady or for long enough to say that it will not be. A design is solved for: the mass of its
    components, and friction where it follows from the orbit, belong to the orbit that is returned.

    Parameters
    ----------
    subject : Engine or Design

    Returns
    -------
    Run
        Always with a status; ``invalid`` if the engine cannot be run, ``unsteady`` with the figures
        of the orbit if that of a design is unstable.

    Examples
    --------
    >>> import saleg
    >>> run = settle(saleg.machines.thesis_base())
    >>> is_stable(run), round(run.performance.compression_ratio, 1)
    (True, 19.7)
    >>> round(settle(saleg.design.Design()).performance.moving_mass, 2)
    2.38
    """
    try:
        return _designed(subject) if isinstance(subject, Design) else _simulated(subject)
    except (InvalidEngine, InvalidDesign, StartError) as error:
        return _never_ran(without_loop(subject), error)


def without_loop(subject: Engine | Design) -> Engine:
    """The engine itself, or that of a design with the mass of its laws' engine."""
    if isinstance(subject, Design):
        return subject.engine(subject.laws.translator.mass)
    return subject


def _simulated(engine: Engine) -> Run:
    """Run of an engine from its own start."""
    for duration in SETTLING_TIMES:
        run = simulate(engine, duration, rtol=TOLERANCE, keep_cycles=KEPT_CYCLES)
        if run.status is not Status.COMPLETED:
            break
    return run


def _designed(design: Design) -> Run:
    """Orbit of a design as a run of one cycle; the simulation that found none otherwise."""
    found = solve(design, rtol=LOOP_TOLERANCE)
    orbit = found.orbit
    if orbit is None:
        assert found.fallback is not None
        return replace(found.fallback, status=found.status, message=found.message)
    status, message = found.status, found.message
    if not found.stable:
        status = Status.UNSTEADY
        message = f"no engine stays on this orbit ({found.stability.kind}): {message}"
    strokes = np.concatenate([found.strokes, found.strokes])  # the cycle before was the same
    return replace(orbit, status=status, message=message, strokes=strokes, replay=lambda: orbit)


@checked(run=a(Run))
def is_stable(run: Run) -> bool:
    """Whether a run reached a steady state in which the engine delivers power.

    Parameters
    ----------
    run : Run

    Returns
    -------
    bool
    """
    return run.status is Status.STEADY


def _never_ran(engine: Engine, error: Exception) -> Run:
    """A run of no length, in place of one that cannot be made."""
    return Run(
        engine=engine,
        status=Status.INVALID,
        message=str(error),
        duration=0.0,
        strokes=np.zeros(0, layout.STROKE_RECORD),
        event_rows=np.zeros(0, layout.EVENT_RECORD),
        history_rows=None,
    )
