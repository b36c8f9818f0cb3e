"""Maps of steady operation: what power and compression ratio an engine settles at (5.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count, islice
from typing import TYPE_CHECKING

import numpy as np

from saleg.batch.many import steady_states
from saleg.checks import SOME, TEXT, a, checked
from saleg.engine import Engine
from saleg.engine.paths import unit_of
from saleg.errors import InvalidController
from saleg.quantities import Problem
from saleg.simulation.initial_state import prepare
from saleg.status import Status

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

#: Steps of the maps that go to where orbits end: intake temperature [K], equivalence ratio [-].
TEMPERATURE_STEP, RATIO_STEP = 10.0, -0.025
#: Values of such a map that are tried at a time.
AT_ONCE = 8


@dataclass(frozen=True, eq=False)
class OperatingMap:
    """Steady states over one quantity (Fig. 101, 104).

    Attributes
    ----------
    path : str
        The quantity varied.
    table : DataFrame
        One row per value, in order: the value under its path, status, performance, multipliers.

    Its properties are the part of it a controller can go by; they raise an
    :class:`saleg.errors.InvalidController` if fewer than two stable steady states are known.
    """

    path: str
    table: pd.DataFrame

    @property
    def powers(self) -> tuple[float, ...]:
        """Powers of the stable steady states, rising [W]."""
        return tuple(self._usable().power.tolist())

    @property
    def compression_ratios(self) -> tuple[float, ...]:
        """Compression ratios that go with :attr:`powers` [-]."""
        return tuple(self._usable().compression_ratio.tolist())

    @property
    def lowest(self) -> float:
        """Least value of the quantity among them, in its SI unit."""
        return float(self._usable()[self.path].min())

    @property
    def highest(self) -> float:
        """Greatest value of the quantity among them, in its SI unit."""
        return float(self._usable()[self.path].max())

    def _usable(self) -> pd.DataFrame:
        """Rows a controller can go by: stable steady states with power, by rising power."""
        good = self.table[_stable(self.table)]
        good = good.sort_values("power").drop_duplicates("power")
        if len(good) < 2:
            wrong = f"{len(good)} stable steady states"
            raise InvalidController([Problem(self.path, wrong, "", "a map needs at least two")])
        return good


def _stable(table: pd.DataFrame) -> pd.Series:
    """Which rows are stable steady states with power."""
    return (table.status == str(Status.STEADY)) & table.stable


@checked(engine=a(Engine), path=TEXT, values=SOME)
def operating_map(
    engine: Engine,
    path: str,
    values: Sequence[float],
    *,
    executor: Executor | None = None,
) -> OperatingMap:
    """Steady states of an engine over one quantity (Fig. 101, 104).

    Parameters
    ----------
    engine : Engine
    path : str
        Dotted path, ``"intake.temperature"`` or ``"equivalence_ratio"`` in the dissertation.
    values : sequence of float
        Values of the quantity (SI).
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.

    Returns
    -------
    OperatingMap

    Examples
    --------
    >>> import saleg
    >>> engine = saleg.machines.thesis_transient()
    >>> known = saleg.control.operating_map(engine, "intake.temperature", (263.0, 370.0))
    >>> [round(ratio, 1) for ratio in known.compression_ratios]
    [13.7, 17.9]
    """
    engines = [engine.replace(**{path: float(value)}) for value in values]
    table = steady_states(engines, multipliers=True, executor=executor)
    units = {path: unit_of(engine, path), **table.attrs["units"]}
    table.insert(0, path, np.asarray(values, dtype=float))
    table.attrs["units"] = units
    return OperatingMap(path, table)


@checked(engine=a(Engine))
def intake_map(engine: Engine, *, executor: Executor | None = None) -> OperatingMap:
    """Map over the intake temperature, from that of the engine up to where orbits end (Fig. 101).

    Parameters
    ----------
    engine : Engine
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.

    Returns
    -------
    OperatingMap
        In steps of 10 K; its last row is the first without a stable orbit that delivers power.

    Examples
    --------
    >>> import saleg
    >>> known = saleg.control.intake_map(saleg.machines.thesis_transient())
    >>> known.highest, known.table.status.iloc[-1]
    (543.0, 'idling')
    """
    rated = float(prepare(engine).engine["rated_intake_temperature"][0])
    return _to_the_end(engine, "intake.temperature", rated, TEMPERATURE_STEP, executor)


@checked(engine=a(Engine))
def fuel_map(engine: Engine, *, executor: Executor | None = None) -> OperatingMap:
    """Map over the equivalence ratio, from that of the engine down to where orbits end (Fig. 104).

    Parameters
    ----------
    engine : Engine
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.

    Returns
    -------
    OperatingMap
        In steps of 0.025; its last row is the first without a stable orbit that delivers power.
    """
    rated = float(prepare(engine).engine["rated_equivalence_ratio"][0])
    return _to_the_end(engine, "equivalence_ratio", rated, RATIO_STEP, executor)


def _to_the_end(
    engine: Engine, path: str, begin: float, step: float, executor: Executor | None
) -> OperatingMap:
    """Map in even steps to where the stable orbits end; beyond its range a value is invalid."""
    import pandas as pd

    parts: list[pd.DataFrame] = []
    steps = count()
    while not parts or _stable(parts[-1]).all():
        some = [begin + step * n for n in islice(steps, AT_ONCE)]
        parts.append(operating_map(engine, path, some, executor=executor).table)
    table = pd.concat(parts, ignore_index=True)
    table.attrs["units"] = parts[0].attrs["units"]
    lost = int((~_stable(table)).to_numpy().argmax())
    return OperatingMap(path, table.iloc[: lost + 1])


@checked(engine=a(Engine), temperatures=SOME, ratios=SOME)
def operating_grid(
    engine: Engine,
    temperatures: Sequence[float],
    ratios: Sequence[float],
    *,
    executor: Executor | None = None,
) -> pd.DataFrame:
    """Steady states over intake temperature and equivalence ratio (Fig. 105).

    Parameters
    ----------
    engine : Engine
    temperatures : sequence of float
        Intake temperatures [K].
    ratios : sequence of float
        Equivalence ratios [-].
    executor : concurrent.futures.Executor, optional
        Who does the work; threads of this process unless given.

    Returns
    -------
    DataFrame
        One row per pair, with both in front: status, performance, multipliers.
    """
    pairs = [(float(T), float(phi)) for T in temperatures for phi in ratios]
    engines = [
        engine.replace(**{"intake.temperature": T, "equivalence_ratio": phi}) for T, phi in pairs
    ]
    table = steady_states(engines, multipliers=True, executor=executor)
    units = {"intake.temperature": "K", "equivalence_ratio": "-", **table.attrs["units"]}
    table.insert(0, "equivalence_ratio", [phi for _, phi in pairs])
    table.insert(0, "intake.temperature", [T for T, _ in pairs])
    table.attrs["units"] = units
    return table
