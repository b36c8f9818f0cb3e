"""Experiments of Chapter 5 without a demand, each a function of an engine.

Those that begin at rest bring the engine up by motored resonance first, as the dissertation does.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.checks import FLAG, NUMBER, ONE_OR_MORE, POSITIVE, a, checked, each, whole
from saleg.control.running import motor_returns, simulate, simulate_many
from saleg.engine import Engine, check_controller, check_engine
from saleg.engine.controller import Controller
from saleg.engine.start import AtRest
from saleg.laws.control.fuel import FuelCut
from saleg.laws.control.load import ScaledLoad
from saleg.laws.control.motor import ResonanceSearch, SteadyMotor
from saleg.laws.control.state_logic import AlwaysMotored, CompressionThreshold
from saleg.simulation.indicators import stroke_compression_ratios
from saleg.simulation.run import Run
from saleg.simulation.settings import SettingsError

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

#: Time a motored engine is given to settle [s]; its amplitude decays within about one second.
SETTLING = 15.0
#: Base frequency of a rapid start-up (Fig. 106) [Hz].
RAPID = 38.0
#: Strokes of a cut that does not end.
FOR_EVER = 1e12
#: How near the steady compression ratio an engine has recovered, relatively.
RECOVERED = 0.02


@checked(engine=a(Engine), frequencies=ONE_OR_MORE, amplitudes=ONE_OR_MORE, duration=POSITIVE)
def motored(
    engine: Engine,
    frequencies: Sequence[float],
    amplitudes: Sequence[float],
    *,
    duration: float = SETTLING,
    executor: Executor | None = None,
) -> pd.DataFrame:
    """Motor an engine at frequencies and amplitudes until it settles (Fig. 94, 95).

    Parameters
    ----------
    engine : Engine
    frequencies, amplitudes : sequence of float
        Frequency [Hz] and amplitude [N] of each run; a single one goes with all of the others.
    duration : float
        Time each is given [s].
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.

    Returns
    -------
    DataFrame
        One row per run: ``motor_frequency``, ``motor_amplitude``, ``stroke``,
        ``relative_stroke`` (over the maximum), ``compression_ratio``, ``opens_ports`` when
        settled, ``opened_ports`` at any time, ``status``, ``message``. Units in ``.attrs``.
    """
    import pandas as pd

    given = np.atleast_1d(frequencies), np.atleast_1d(amplitudes)
    counts = [len(values) for values in given]
    if counts[0] != counts[1] and 1 not in counts:
        raise SettingsError(
            f"{counts[0]} frequencies and {counts[1]} amplitudes: must be as many, or a single one "
            "of either"
        )
    pairs = np.broadcast_arrays(*given)
    check_engine(engine)
    at_rest = engine.replace(start=AtRest())
    controllers = [
        Controller(
            state_logic=AlwaysMotored(),
            motor_control=SteadyMotor(frequency=float(f), amplitude=float(a)),
        )
        for f, a in zip(*pairs, strict=True)
    ]
    table = simulate_many(
        [(at_rest, controller) for controller in controllers],
        duration,
        executor=executor,
        rtol=1e-6,
    )
    frame = pd.DataFrame(
        {
            "motor_frequency": pairs[0],
            "motor_amplitude": pairs[1],
            "stroke": table.stroke,
            "relative_stroke": table.stroke / engine.maximum_stroke,
            "compression_ratio": table.compression_ratio,
            "opens_ports": table.opens_ports > 0.0,
            "opened_ports": table.opened_ports > 0.0,
            "status": table.status,
            "message": table.message,
        }
    )
    units = {"motor_frequency": "Hz", "motor_amplitude": "N", "stroke": "m"}
    frame.attrs["units"] = {name: units.get(name, "-") for name in frame.columns}
    return frame


@checked(
    engine=a(Engine),
    base_frequency=NUMBER,
    duration=POSITIVE,
    controller=a(Controller).optional,
)
def start_up(
    engine: Engine,
    base_frequency: float = 30.0,
    *,
    duration: float = 3.5,
    controller: Controller | None = None,
    **settings: Any,
) -> Run:
    """Start an engine from rest by motored resonance (5.1, Fig. 97-99).

    Parameters
    ----------
    engine : Engine
        Begins at rest at the midpoint, whatever its own start.
    base_frequency : float
        Frequency the motor begins with [Hz]; below resonance, or it never starts.
    duration : float
        Time to simulate [s].
    controller : Controller, optional
        Its state logic, amplitude and gains; those of the dissertation unless given.
    **settings
        Further settings of :func:`saleg.control.simulate`.

    Returns
    -------
    Run
        ``saleg.control.fired_at(run)`` says when the threshold was passed.

    Examples
    --------
    >>> import saleg
    >>> run = saleg.control.start_up(saleg.machines.thesis_transient(), 38.0, duration=1.5)
    >>> round(saleg.control.fired_at(run), 2)
    0.49
    """
    chosen = Controller() if controller is None else controller
    check_controller(chosen)
    search = chosen.motor_control
    if isinstance(search, ResonanceSearch):
        chosen = replace(chosen, motor_control=replace(search, base_frequency=base_frequency))
    return _from_rest(engine, chosen, duration, settings)


def rapid_start(**parts: Any) -> Controller:
    """Controller that starts an engine up rapidly, with other parts of its own.

    Parameters
    ----------
    **parts
        Fields of :class:`saleg.Controller`.

    Returns
    -------
    Controller
    """
    return Controller(**{"motor_control": ResonanceSearch(base_frequency=RAPID), **parts})


def _from_rest(engine: Engine, controller: Controller, duration: float, settings: Any) -> Run:
    """Run that begins at rest at the midpoint, whatever the engine's own start."""
    check_engine(engine)
    return simulate(engine.replace(start=AtRest()), controller, duration, **settings)


@checked(engine=a(Engine), at=NUMBER, duration=POSITIVE)
def fuel_cut(engine: Engine, *, at: float = 1.5, duration: float = 3.0, **settings: Any) -> Run:
    """Start an engine up, run it and cut its fuel for good: it rings down (Fig. 106).

    Parameters
    ----------
    engine : Engine
    at : float
        When the fuel is cut [s].
    duration : float
        Time to simulate [s].
    **settings
        Further settings of :func:`saleg.control.simulate`.

    Returns
    -------
    Run
    """
    controller = rapid_start(
        state_logic=CompressionThreshold(latched=1.0),
        fuel_control=FuelCut(at=at, strokes=FOR_EVER),
    )
    return _from_rest(engine, controller, duration, settings)


@checked(
    engine=a(Engine),
    begin=NUMBER,
    end=NUMBER,
    factor=NUMBER,
    duration=POSITIVE,
    late_ignition=FLAG,
)
def overload(
    engine: Engine,
    *,
    begin: float = 2.0,
    end: float = 4.0,
    factor: float = 6.0,
    duration: float = 8.0,
    late_ignition: bool = True,
    **settings: Any,
) -> Run:
    """Start an engine up and load it ever more until it misfires and rings down (Fig. 107).

    Parameters
    ----------
    engine : Engine
    begin, end : float
        When the load begins and ends to rise [s].
    factor : float
        What the regulated load is multiplied with at last [-].
    duration : float
        Time to simulate [s].
    late_ignition : bool
        Whether fuel that missed its dead centre may ignite later; the dissertation's does, once
        the ports stay closed and the walls heat the charge.
    **settings
        Further settings of :func:`saleg.control.simulate`.

    Returns
    -------
    Run
    """
    controller = rapid_start(
        state_logic=CompressionThreshold(latched=1.0),
        load_control=ScaledLoad(times=(begin, end), factors=(1.0, factor)),
    )
    changed = engine.replace(start=AtRest(), late_ignition=float(late_ignition))
    return simulate(changed, controller, duration, **settings)


@checked(engine=a(Engine), strokes=whole(1), at=NUMBER, motor=FLAG, duration=POSITIVE)
def misfire(
    engine: Engine,
    *,
    strokes: int = 1,
    at: float = 1.5,
    motor: bool = True,
    duration: float = 3.0,
    **settings: Any,
) -> Run:
    """Start an engine up, cut its fuel for some strokes and see whether it recovers (Fig. 108).

    Parameters
    ----------
    engine : Engine
    strokes : int
        Strokes in a row that compose their charge without fuel.
    at : float
        When the cut begins, at the next dead centre [s].
    motor : bool
        Whether the motor comes back below the threshold.
    duration : float
        Time to simulate [s].
    **settings
        Further settings of :func:`saleg.control.simulate`.

    Returns
    -------
    Run
        :func:`recovery_time` says how long it took.
    """
    if not duration > at:
        raise SettingsError(f"duration = {duration!r}: must be > at ({at:g} s)")
    controller = rapid_start(
        state_logic=CompressionThreshold(latched=0.0 if motor else 1.0),
        fuel_control=FuelCut(at=at, strokes=float(strokes)),
    )
    return _from_rest(engine, controller, duration, settings)


@checked(run=a(Run), at=NUMBER)
def recovery_time(run: Run, at: float) -> float:
    """Time from a disturbance until the compression ratio stays where it was before.

    Parameters
    ----------
    run : Run
    at : float
        When the disturbance began [s].

    Returns
    -------
    float
        Time until the compression ratio is within 2 % of the one before, for good [s]; NaN if it
        does not get there.
    """
    t = run.strokes["t"]
    ratio = stroke_compression_ratios(run.engine, run.strokes)
    before = np.flatnonzero(t <= at)
    if not len(before) or not t[-1] > at:
        return math.nan
    away = np.abs(ratio / ratio[before[-1]] - 1.0) > RECOVERED
    if away[-1]:
        return math.nan
    last = np.flatnonzero(away & (t > at))
    return float(t[last[-1] + 1] - at) if len(last) else 0.0


@checked(
    engine=a(Engine), strokes=each(whole(1), "whole numbers >= 1"), at=NUMBER, duration=POSITIVE
)
def misfires(
    engine: Engine,
    strokes: Sequence[int],
    *,
    at: float = 1.5,
    duration: float = 4.0,
    **settings: Any,
) -> pd.DataFrame:
    """Strokes without fuel an engine survives, with the motor and without it (5.3).

    Parameters
    ----------
    engine : Engine
    strokes : sequence of int
        Numbers of strokes without fuel.
    at, duration : float
        As for :func:`misfire` [s].
    **settings
        Further settings of :func:`saleg.control.simulate`.

    Returns
    -------
    DataFrame
        ``strokes``, ``motor``, ``survives``, ``recovery_time`` [s], ``least_compression_ratio``,
        ``motor_returns``. Units in ``.attrs``.
    """
    import pandas as pd

    rows = []
    for motor in (True, False):
        for count in strokes:
            run = misfire(engine, strokes=count, at=at, motor=motor, duration=duration, **settings)
            ratios = run.dead_centres.compression_ratio[run.dead_centres.t > at]
            took = recovery_time(run, at)
            rows.append(
                {
                    "strokes": count,
                    "motor": motor,
                    "survives": not math.isnan(took),
                    "recovery_time": took,
                    "least_compression_ratio": float(ratios.min()),
                    "motor_returns": motor_returns(run),
                }
            )
    frame = pd.DataFrame(rows)
    frame.attrs["units"] = {name: "s" if name == "recovery_time" else "-" for name in frame}
    return frame
