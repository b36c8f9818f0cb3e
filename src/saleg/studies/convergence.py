"""Numerical studies: how results depend on step, solver and stop time (3.6.2, Tables 2-4).

Each returns one row per setting, with its cost: seconds of waiting for a kernel that is compiled
and loaded. Its ``.attrs`` hold ``units``, and as ``engine`` the TOML text of the engine studied.
Beside them an emulation of lagging cylinder blocks, which shows where an error like the thesis'
comes from.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.checks import POSITIVE, SERIES, Check, a, checked, each, whole
from saleg.compiler.compiled_engine import compiled_engine
from saleg.engine import Engine, check_engine
from saleg.errors import SalegError, shown
from saleg.kernel import layout
from saleg.kernel.tableaus import FIXED_STEP
from saleg.quantities import is_number
from saleg.simulation.course import options_record
from saleg.simulation.initial_state import prepare
from saleg.simulation.integration import simulate
from saleg.simulation.outcome import outcome_of
from saleg.simulation.records import Records
from saleg.simulation.run import Run
from saleg.simulation.settings import Settings, SettingsError

if TYPE_CHECKING:
    import pandas as pd

#: Steps of Table 2, stop times of Table 4 [s].
TABLE_2_STEPS = (1e-4, 5e-5, 1e-5, 5e-6, 1e-6, 5e-7)
TABLE_4_TIMES = (1.0, 1.5, 2.0, 2.5, 3.0, 3.5)

#: Columns of every study, with units.
UNITS = {
    "step": "s",
    "order": "-",
    "rtol": "-",
    "stop_time": "s",
    "delay": "steps",
    "status": "-",
    "peak_pressure": "Pa",
    "stroke": "m",
    "efficiency": "-",
    "power": "W",
    "frequency": "Hz",
    "evaluations": "-",
    "cost": "s",
    "method": "-",
    "error": "-",
}
FIGURES = ("peak_pressure", "stroke", "efficiency", "power", "frequency")
#: Time simulated [s] before the clock of a study starts, so that no cost includes compilation.
WARM_UP = 1e-3


class StudyError(SalegError, ValueError):
    """A study that cannot be made, or not be set beside the thesis."""


ORDERS = each(whole(1), "whole numbers")
#: Of numbers that are checked one by one, where each is used.
LIST = each(Check(lambda item: item, ""), "numbers")


@checked(engine=a(Engine), steps=SERIES, duration=POSITIVE)
def step_size_study(
    engine: Engine,
    steps: Iterable[float] = TABLE_2_STEPS,
    *,
    duration: float = 3.5,
    order: int = 4,
) -> pd.DataFrame:
    """Steady results against the fixed step, as Table 2.

    Parameters
    ----------
    engine : Engine
    steps : iterable of float
        Fixed steps [s].
    duration : float
        Time simulated [s].
    order : int
        Order of the method.

    Returns
    -------
    DataFrame
        One row per step, in SI units.

    Examples
    --------
    >>> import saleg
    >>> table = step_size_study(saleg.machines.thesis_base(), [5e-5, 1e-5], duration=0.5)
    >>> bool(abs(table["efficiency"].diff().iloc[1]) < 1e-6)
    True
    """
    settings = [{"step": step, "order": order} for step in steps]
    cases = [(given, duration, given) for given in settings]
    return _study(simulate, engine, ["step", "order"], cases)


@checked(engine=a(Engine), orders=ORDERS, step=POSITIVE, duration=POSITIVE)
def solver_study(
    engine: Engine,
    orders: Iterable[int] = tuple(FIXED_STEP),
    *,
    step: float = 5e-6,
    duration: float = 3.5,
) -> pd.DataFrame:
    """Steady results against the order of the fixed-step method, as Table 3.

    Parameters
    ----------
    engine : Engine
    orders : iterable of int
        Orders of the fixed-step methods.
    step : float
        Fixed step [s].
    duration : float
        Time simulated [s].

    Returns
    -------
    DataFrame
        One row per order.
    """
    settings = [{"order": order, "step": step} for order in orders]
    cases = [(given, duration, given) for given in settings]
    return _study(simulate, engine, ["order", "step"], cases)


@checked(engine=a(Engine), orders=ORDERS, steps=SERIES, tolerances=SERIES, duration=POSITIVE)
def work_precision(
    engine: Engine,
    *,
    orders: Iterable[int] = tuple(FIXED_STEP),
    steps: Iterable[float] = (1e-4, 5e-5, 2e-5, 1e-5, 5e-6),
    tolerances: Iterable[float] = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9),
    duration: float = 1.0,
) -> pd.DataFrame:
    """Error against cost, for the fixed-step methods and the adaptive one.

    Parameters
    ----------
    engine : Engine
    orders, steps : iterable
        Orders and steps [s] of the fixed-step runs, every one with every other.
    tolerances : iterable of float
        Relative tolerances of the adaptive runs.
    duration : float
        Time simulated [s].

    Returns
    -------
    DataFrame
        One row per run: method, setting, right-hand sides, cost [s] and error, the greatest
        relative deviation of the figures from a run at 1e-12. Figures that have no relative
        deviation are left out: those that run does not define (the efficiency of an engine
        without fuel) or finds to be zero.

    Raises
    ------
    StudyError
        If no figure is left, as for an engine that stalls.
    """
    exact = simulate(engine, duration, rtol=1e-12)
    wanted = {name: getattr(exact.performance, name) for name in FIGURES}
    compared = {name: value for name, value in wanted.items() if math.isfinite(value) and value}
    if not compared:
        raise StudyError(f"nothing to compare: the run has no figures ({exact.message})")
    steps = list(steps)
    tables = {
        f"order {order}": step_size_study(engine, steps, duration=duration, order=order)
        for order in orders
    }
    tables["adaptive"] = tolerance_study(engine, tolerances, duration=duration)
    import pandas as pd

    table = pd.concat(tables, names=["method"]).reset_index(level=0).reset_index(drop=True)
    deviations = [(table[name] / value - 1.0).abs() for name, value in compared.items()]
    table["error"] = pd.concat(deviations, axis=1).max(axis=1, skipna=False)
    return _described(table, engine)


@checked(engine=a(Engine), times=SERIES)
def stop_time_study(
    engine: Engine,
    times: Iterable[float] = TABLE_4_TIMES,
    **settings: Any,
) -> pd.DataFrame:
    """Results of the last cycle against the time simulated, as Table 4.

    Parameters
    ----------
    engine : Engine
    times : iterable of float
        Times simulated [s].
    **settings
        Handed to :func:`saleg.simulate`.

    Returns
    -------
    DataFrame
        One row per time.
    """
    cases = [({"stop_time": stop}, stop, settings) for stop in times]
    return _study(simulate, engine, ["stop_time"], cases)


@checked(engine=a(Engine), tolerances=SERIES, duration=POSITIVE)
def tolerance_study(
    engine: Engine, tolerances: Iterable[float], *, duration: float = 1.0
) -> pd.DataFrame:
    """Results against the tolerance of the adaptive method.

    Parameters
    ----------
    engine : Engine
    tolerances : iterable of float
        Relative tolerances.
    duration : float
        Time simulated [s].

    Returns
    -------
    DataFrame
        One row per tolerance.
    """
    settings = [{"rtol": rtol} for rtol in tolerances]
    return _study(simulate, engine, ["rtol"], [(given, duration, given) for given in settings])


@checked(engine=a(Engine), steps=LIST, delays=LIST, duration=POSITIVE)
def delay_study(
    engine: Engine,
    steps: Sequence[float] = (1e-6, 2e-6, 5e-6, 1e-5),
    delays: Sequence[int] = (0, 1, 2, 3, 4),
    *,
    duration: float = 1.5,
) -> pd.DataFrame:
    """Steady results when the translator feels the gas force some steps late.

    A delay of n steps of length h acts as a lag of n h: it adds a spurious work per cycle
    proportional to n h, so efficiency grows in proportion to the step whatever the order of the
    solver, as in Tables 2 and 3.

    Parameters
    ----------
    engine : Engine
    steps : sequence of float
        Fixed steps [s].
    delays : sequence of int
        Delays in steps.
    duration : float
        Time simulated [s].

    Returns
    -------
    DataFrame
        One row per step and delay.
    """
    settings = [{"step": step, "delay": delay} for step in steps for delay in delays]
    cases = [(given, duration, given) for given in settings]
    return _study(delayed, engine, ["step", "delay"], cases)


def delayed(engine: Engine, duration: float, *, step: float, delay: int = 0) -> Run:
    """Simulate with the cylinder blocks lagging behind, for :func:`delay_study`.

    Heun's method on a grid; modes change at grid points only, and the translator feels the gas
    force of `delay` steps ago. With no delay only the rounding of the events is left.

    Parameters
    ----------
    engine : Engine
    duration : float
        Time simulated [s].
    step : float
        Fixed step [s].
    delay : int
        Delay in steps.

    Returns
    -------
    Run
        Peaks are those at grid points; there is no history.

    Raises
    ------
    SettingsError
        If duration, step or delay make no sense.
    """
    for name, value in (("duration", duration), ("step", step), ("delay", delay)):
        if not is_number(value) or not math.isfinite(value):
            raise SettingsError(f"{name} = {shown(value)}: must be a number")
    if not 0.0 < step < duration:
        raise SettingsError(f"step = {step!r}: must be > 0 and < duration ({duration:g} s)")
    if delay < 0 or delay != int(delay):
        raise SettingsError(f"delay = {shown(delay)}: must be a number of whole steps")
    check_engine(engine)
    if any(chamber.states for chamber in engine.chambers):
        raise SettingsError("delayed: only for chambers that own no states beside pressure")
    (kernel, P, control), state = compiled_engine(engine, modules=DELAYED), prepare(engine)
    records = Records(False, None)
    options = options_record(Settings(duration, step=step), duration)
    forces = np.full(int(delay) + 1, _gas_force(state))
    work = tuple(np.zeros(layout.N_ALL) for _ in range(3))
    tables, code = records.tables, layout.BUFFER_FULL
    while code == layout.BUFFER_FULL:
        code = kernel.call(
            "run_delayed",
            P,
            state.engine,
            state.chambers,
            state.y,
            state.peaks,
            int(delay),
            forces,
            options,
            tables,
            work,
            control,
        )
        records.make_room()
    strokes = records.kept_strokes.joined()
    status, message = outcome_of(engine, code, state, strokes, conserves=False)
    return Run(
        engine=engine,
        status=status,
        message=message,
        duration=float(state.engine["t"][0]),
        strokes=strokes,
        event_rows=records.kept_events.joined(),
        history_rows=None,
        evaluations=int(state.engine["evaluations"][0]),
        steps=int(state.engine["steps"][0]),
        settings={"method": "delayed", "step": step, "delay": int(delay)},
    )


#: Modules of the kernel the emulation is composed of.
DELAYED = (
    *("needs", "flow", "breathing", "rhs", "general", "adaptive", "step", "events", "peaks"),
    *("control", "charges", "rows", "switch", "delayed"),
)


def _gas_force(state: Any) -> float:
    """Gas force on the translator at the start [N]."""
    total = 0.0
    for side, c in enumerate(state.chambers):
        if c["mode"] == layout.OPEN:
            pressure = c["intake_pressure"]
        else:
            height = c["half_stroke"] + c["sign"] * state.y[layout.X]
            ln_p = state.y[layout.THETA + side] - layout.G0 * np.log(height / c["half_stroke"])
            pressure = np.exp(ln_p)
        total += c["sign"] * c["area"] * pressure
    return float(total)


#: Labels of a row, time to simulate [s], settings of the run.
Case = tuple[Mapping[str, Any], float, Mapping[str, Any]]


def _study(
    run: Callable[..., Run], engine: Engine, labels: Sequence[str], cases: Sequence[Case]
) -> pd.DataFrame:
    """One row per case, once the kernel is warm."""
    import pandas as pd

    run(engine, WARM_UP, step=0.1 * WARM_UP)
    rows = [
        {**names, **_figures(run, engine, duration, settings)}
        for names, duration, settings in cases
    ]
    columns = [*labels, "status", *FIGURES, "evaluations", "cost"]
    return _described(pd.DataFrame(rows, columns=columns), engine)


def _figures(
    run: Callable[..., Run], engine: Engine, duration: float, settings: Mapping[str, Any]
) -> dict[str, Any]:
    """Status, figures and cost of a run."""
    begin = time.perf_counter()
    result = run(engine, duration, **settings)
    cost = time.perf_counter() - begin
    return {
        "status": str(result.status),
        **{name: getattr(result.performance, name) for name in FIGURES},
        "evaluations": result.evaluations,
        "cost": cost,
    }


def _described(table: pd.DataFrame, engine: Engine) -> pd.DataFrame:
    """The table, with its units and the engine it is of."""
    table.attrs["units"] = {str(name): UNITS[str(name)] for name in table}
    table.attrs["engine"] = engine.to_toml()
    return table
