"""Power demanded over time."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from saleg.errors import InvalidController
from saleg.quantities import Problem, is_number, problems, series


@dataclass(frozen=True)
class Demand:
    """Power demanded over time: linear between the times, constant before and after.

    Parameters
    ----------
    times : tuple of float
        Never falling [s]; two equal ones make a step.
    powers : tuple of float
        Power at those times [W].

    Examples
    --------
    >>> Demand.step(2.0, 3900.0, 1900.0).times
    (2.0, 2.0)
    """

    times: tuple[float, ...] = series("s", never_falling=True)
    powers: tuple[float, ...] = series("W", low=0, length="times")

    @classmethod
    def step(cls, at: float, before: float, after: float) -> Demand:
        """A step at a time [s] from one power to another [W]."""
        return cls.of((at, at), (before, after))

    @classmethod
    def ramp(cls, begin: float, end: float, before: float, after: float) -> Demand:
        """A ramp between two times [s] from one power to another [W]."""
        return cls.of((begin, end), (before, after))

    @classmethod
    def of(cls, times: Sequence[float], powers: Sequence[float]) -> Demand:
        """A demand from arrays of times [s] and powers [W].

        Raises
        ------
        InvalidController
            If the numbers make no profile.
        """
        columns = []
        for name, values in (("times", times), ("powers", powers)):
            flat = list(np.ravel(np.asarray(values, dtype=object)))
            wrong = [value for value in flat if not is_number(value)]
            if wrong:
                raise InvalidController(
                    [Problem(f"demand.{name}", wrong[0], "-", "must be a number")]
                )
            columns.append(tuple(float(value) for value in flat))
        made = cls(*columns)
        found = problems(made, "demand")
        if found:
            raise InvalidController(found)
        return made

    @classmethod
    def read(cls, path: str | Path) -> Demand:
        """A demand from a CSV file of two columns, times [s] and powers [W].

        A first line of words is taken for a header.

        Raises
        ------
        InvalidController
            Naming the line that cannot be read.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            problem = Problem(str(path), str(error), "", "must be text in UTF-8")
            raise InvalidController([problem]) from None
        times, powers = [], []
        for number, row in enumerate(csv.reader(text.splitlines()), start=1):
            if not row:
                continue
            try:
                t, power = (float(value) for value in row)
            except ValueError:
                if number > 1:
                    where = f"{path}, line {number}"
                    raise InvalidController(
                        [Problem(where, ",".join(row), "", "must be two numbers")]
                    ) from None
                continue
            times.append(t)
            powers.append(power)
        return cls.of(times, powers)
