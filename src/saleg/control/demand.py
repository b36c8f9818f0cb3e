"""Power demanded over time."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from saleg.errors import ControllerError, InvalidController
from saleg.files.reading import read_text
from saleg.files.units import UNITS, UnitError, head_of, to_si
from saleg.laws.usual import POWER, TIME
from saleg.quantities import Problem, Quantities, problems, series

#: What a head may end in to be read as a unit, or refused as none of its quantity.
LIKE_UNITS = {unit.casefold() for si_unit in ("s", "W") for unit in (si_unit, *UNITS[si_unit])}
LIKE_UNITS |= {"seconds", "minutes", "hours", "watts"}
TIME_HEADS, POWER_HEADS = ("t", "time", "times"), ("p", "power", "powers")


@dataclass(frozen=True)
class Demand(Quantities):
    """Power demanded over time: linear between the times, constant before and after.

    Parameters
    ----------
    times : tuple of float
        Never falling [s]; two equal ones make a step.
    powers : tuple of float
        Power at those times [W].

    Raises
    ------
    InvalidController
        If the numbers make no profile.

    Examples
    --------
    >>> Demand.step(2.0, 3900.0, 1900.0).times
    (2.0, 2.0)
    """

    times: tuple[float, ...] = series("s", never_falling=True, usual=TIME)
    powers: tuple[float, ...] = series("W", low=0, length="times", usual=POWER)

    def __post_init__(self) -> None:
        """Check both series."""
        super().__post_init__()
        found = problems(self, "demand")
        if found:
            raise InvalidController(found)

    @classmethod
    def step(cls, at: float, before: float, after: float) -> Demand:
        """A step at a time [s] from one power to another [W]."""
        return cls((at, at), (before, after))

    @classmethod
    def ramp(cls, begin: float, end: float, before: float, after: float) -> Demand:
        """A ramp between two times [s] from one power to another [W]."""
        return cls((begin, end), (before, after))

    @classmethod
    def of(cls, times: Sequence[float], powers: Sequence[float]) -> Demand:
        """A demand from arrays of times [s] and powers [W].

        Raises
        ------
        InvalidController
            If the numbers make no profile.
        """
        return cls(*(tuple(np.ravel(np.asarray(item, dtype=object))) for item in (times, powers)))

    @classmethod
    def read(cls, path: str | Path) -> Demand:
        """A demand from a CSV file of two columns, times and powers.

        A first line of words is their heads, each with its unit in brackets if it is not that of
        SI, such as ``time [min],power [kW]``.

        Raises
        ------
        ControllerError
            If the file cannot be read.
        InvalidController
            Naming every line, and every unit, that cannot be read.
        """
        lines = enumerate(read_text(path, ControllerError).splitlines(), start=1)
        table = [(number, _cells(line)) for number, line in lines if line.strip()]
        wrong: list[Problem] = []
        scales = [1.0, 1.0]
        if table and not any(map(_is_number, table[0][1])):
            number, heads = table.pop(0)
            scales = _scales(f"{path}, line {number}", heads, wrong)
        rows = []
        for number, cells in table:
            if len(cells) == 2 and all(map(_is_number, cells)):
                rows.append([float(c) * scale for c, scale in zip(cells, scales, strict=True)])
            else:
                where = f"{path}, line {number}"
                wrong.append(Problem(where, ",".join(cells), "", "must be two numbers"))
        if wrong:
            raise InvalidController(wrong)
        return cls.of([row[0] for row in rows], [row[1] for row in rows])


def _cells(line: str) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(",")]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _scales(where: str, heads: list[str], wrong: list[Problem]) -> list[float]:
    """Factors from the units of two heads to SI; what cannot be read is noted."""
    if len(heads) != 2:
        wrong.append(Problem(where, ",".join(heads), "", "must be heads of times and powers"))
        return [1.0, 1.0]
    scales = []
    names = [head_of(head)[0].casefold() for head in heads]
    if names[0] in POWER_HEADS and names[1] in TIME_HEADS:
        wrong.append(Problem(where, ",".join(heads), "", "must be times, then powers"))
    for head, si_unit in zip(heads, ("s", "W"), strict=True):
        try:
            name, unit = head_of(head)
            if set(name) & set("[]()"):
                raise UnitError("has a bracket without its other half")
            last = re.split(r"[\s_/]+", name)[-1]  # as in "P_kW"
            is_one = last.casefold() in LIKE_UNITS
            scales.append(to_si(unit or last * is_one, si_unit)[0])
        except UnitError as error:
            wrong.append(Problem(where, head, "", str(error)))
            scales.append(1.0)
    return scales
