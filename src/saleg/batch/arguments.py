"""Checks of the arguments that functions of many engines have in common."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial
from typing import Any

import numpy as np

from saleg.batch.workers import checks_of_workers
from saleg.engine import Engine
from saleg.errors import raise_together, shown
from saleg.simulation.settings import SettingsError, check_flag
from saleg.steady.solver import Effort, check_effort, check_tolerance


def check_search(
    rtol: float,
    effort: Effort,
    executor: Executor | None,
    workers: int | None,
    chunk: int | None,
    *others: Callable[[], None],
    **flags: Any,
) -> None:
    """Refuse wrong arguments of many searches, and what other checks refuse, all at once.

    Raises
    ------
    SettingsError
    """
    checks: list[Callable[[], Any]] = [
        *others,
        partial(check_tolerance, rtol),
        partial(check_effort, effort),
        *(partial(check_flag, name, value) for name, value in flags.items()),
        *checks_of_workers(executor, workers, 1 if chunk is None else chunk),
    ]
    raise_together(SettingsError, checks)


def check_engines(engines: Any) -> None:
    """Refuse what is no list of engines, nor the like.

    Raises
    ------
    SettingsError
    """
    names = isinstance(engines, (str, bytes, dict, Engine))
    if names or not np.iterable(engines):
        raise SettingsError(f"engines = {shown(engines)}: must be a list of engines, or the like")
