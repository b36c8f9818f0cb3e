"""Cyclic variability: how far cycles scatter over long runs with seeded draws."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.batch.many import batch_table
from saleg.batch.table import Row, rows_of
from saleg.checks import POSITIVE, a, checked, number, whole
from saleg.compiler.compiled_engine import kernel_for
from saleg.engine import CombustionChamber, Engine, check_engine
from saleg.errors import Problem, WrongArguments
from saleg.laws import CyclicVariability
from saleg.simulation.indicators import cycle_compression_ratios, full_cycles
from saleg.simulation.initial_state import prepare
from saleg.simulation.integration import integrate
from saleg.simulation.settings import Settings
from saleg.status import Status

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

#: Columns of a study and their units.
VARIABILITY_UNITS = {
    "seed": "-",
    "status": "-",
    "message": "-",
    "cycles": "-",
    "ended_early": "-",
    "mean_imep": "Pa",
    "cov_imep": "-",
    "cov_work": "-",
    "dead_centre_left": "m",
    "dead_centre_right": "m",
    "compression_ratio": "-",
    "compression_ratio_scatter": "-",
    "power": "W",
}
#: What ends a run before its time.
EARLY = (Status.STALLED, Status.HEAD_CONTACT)
#: Fewest cycles after the settling time from which a scatter is told.
FEWEST = 3


@checked(
    engine=a(Engine),
    seeds=whole(1, 1_000_000),
    duration=POSITIVE,
    settling=number(low=0.0),
    workers=whole(1).optional,
)
def variability(
    engine: Engine,
    seeds: int = 20,
    duration: float = 5.0,
    *,
    settling: float = 1.0,
    executor: Executor | None = None,
    workers: int | None = None,
    **settings: Any,
) -> pd.DataFrame:
    """Scatter of the cycles of an engine over long runs, one for each seed.

    Parameters
    ----------
    engine : Engine
        With :class:`saleg.laws.CyclicVariability` in its slot ``scatter``; its seed is the first.
    seeds : int
        How many runs, with seeds that count up [-].
    duration : float
        Time of each run [s].
    settling : float
        Time from the start that is not counted [s].
    executor, workers
        As for :func:`saleg.simulate_many`.
    **settings
        Further settings of :func:`saleg.simulate`.

    Returns
    -------
    DataFrame
        One row per seed: how many full cycles counted; whether the run ended early, stalled or at
        a head; mean and coefficient of variation of the indicated mean effective pressure over the
        cycles of all cylinders, and of the indicated work of whole cycles; standard deviations
        of the dead centres on either side; mean and standard deviation of the compression ratio;
        mean power. Units in ``.attrs``.

    Raises
    ------
    WrongArguments
        Naming every wrong argument.
    InvalidEngine

    Examples
    --------
    >>> import saleg
    >>> from saleg.laws import CyclicVariability
    >>> engine = saleg.machines.thesis_transient().replace(scatter=CyclicVariability(fuel=0.03))
    >>> table = variability(engine, seeds=2, duration=2.0)
    >>> bool((table["cov_imep"] > 0.01).all())
    True
    """
    check_engine(engine)
    law = engine.scatter
    if not isinstance(law, CyclicVariability):
        wanted = "must have CyclicVariability in its slot scatter"
        raise WrongArguments([Problem("engine", engine, "", wanted)], "arguments of variability()")
    known = Settings.of(duration, settings)
    engines = [
        engine.replace(scatter=dataclasses.replace(law, seed=law.seed + n)) for n in range(seeds)
    ]
    row_of = partial(_row, settings=known, settling=settling)
    return batch_table(
        partial(rows_of, row_of), engines, VARIABILITY_UNITS, kernel_for, executor, workers, 1
    )


def _row(engine: Engine, settings: Settings, settling: float) -> Row:
    """Row of one run."""
    run = integrate(engine, prepare(engine), settings)
    seed = engine.scatter.seed  # type: ignore[attr-defined]
    row: Row = dict.fromkeys(VARIABILITY_UNITS, np.nan)
    row |= {"seed": float(seed), "status": str(run.status), "message": run.message}
    row |= scatter_of(engine, run.strokes[run.strokes["t"] > settling])
    row["ended_early"] = run.status in EARLY
    return row


def scatter_of(engine: Engine, strokes: np.ndarray) -> Row:
    """Scatter of the full cycles among some strokes."""
    out, back = full_cycles(strokes)
    found: Row = {"cycles": float(len(out))}
    if len(out) < FEWEST:
        return found
    work = out["gas_work"] + back["gas_work"]
    swept = 0.5 * (np.abs(out["x_end"] - out["x_start"]) + np.abs(back["x_end"] - back["x_start"]))
    burns = [isinstance(chamber, CombustionChamber) for chamber in engine.chambers]
    areas = np.array([chamber.area for chamber in engine.chambers])
    pressures = (work / (areas * swept[:, np.newaxis]))[:, burns]
    ratios = cycle_compression_ratios(engine, strokes)
    time = (out["duration"] + back["duration"]).sum()
    return found | {
        "mean_imep": float(pressures.mean()),
        "cov_imep": float(_variation(pressures).mean()),
        "cov_work": float(_variation(work.sum(axis=1))),
        "dead_centre_left": float(back["x_end"].std(ddof=1)),
        "dead_centre_right": float(out["x_end"].std(ddof=1)),
        "compression_ratio": float(ratios.mean()),
        "compression_ratio_scatter": float(ratios.std(ddof=1)),
        "power": float((out["electrical_energy"] + back["electrical_energy"]).sum() / time),
    }


def _variation(values: np.ndarray) -> Any:
    """Coefficient of variation of each column."""
    return values.std(axis=0, ddof=1) / np.abs(values.mean(axis=0))
