"""Physical quantities as dataclass fields: a unit and an allowed range beside every number."""

from __future__ import annotations

import dataclasses
import itertools
import math
import reprlib
from functools import lru_cache
from typing import Any, NamedTuple


def quantity(
    unit: str,
    *,
    default: Any = dataclasses.MISSING,
    low: float = -math.inf,
    high: float = math.inf,
    open_low: bool = False,
    open_high: bool = False,
) -> Any:
    """Declare a dataclass field that holds one number with a unit and an allowed range.

    Parameters
    ----------
    unit : str
        SI unit as people write it, ``"-"`` for a pure number.
    default : float, optional
        Default value; the field is required without one.
    low, high : float
        Allowed range.
    open_low, open_high : bool
        Whether the end itself is excluded.

    Returns
    -------
    dataclasses.Field
        To be used as the right-hand side of an annotated class attribute.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Rod:
    ...     length: float = quantity("m", low=0, open_low=True)
    >>> problems(Rod(-1.0), "rod")[0].path
    'rod.length'
    """
    limits = Limits(unit, float(low), float(high), open_low, open_high)
    return dataclasses.field(default=default, metadata={"limits": limits})


def series(
    unit: str,
    *,
    default: Any = dataclasses.MISSING,
    low: float = -math.inf,
    high: float = math.inf,
    rising: bool = False,
    never_falling: bool = False,
    ends: tuple[float, float] | None = None,
    at_least: int = 1,
    length: str = "",
) -> Any:
    """Declare a dataclass field that holds some numbers of one unit, as a tuple.

    Parameters
    ----------
    unit : str
        SI unit as people write it.
    default : tuple of float, optional
        Default values; the field is required without.
    low, high : float
        Allowed range of every number.
    rising : bool
        Whether every number must be greater than the one before.
    never_falling : bool
        Whether none may be less than the one before.
    ends : (float, float), optional
        What the first and the last must be.
    at_least : int
        Fewest numbers.
    length : str
        Name of the fields that say how many numbers there must be: one series, or several
        joined by ``*`` for a table over all their combinations.

    Returns
    -------
    dataclasses.Field
        To be used as the right-hand side of an annotated class attribute.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Profile:
    ...     x: tuple[float, ...] = series("m", rising=True)
    >>> str(problems(Profile((0.0, 2.0, 1.0)))[0])
    'x = (0.0, 2.0, 1.0) [m]: every number must be greater than the one before'
    """
    limits = Limits(unit, float(low), float(high), False, False)
    shape = Shape(rising, never_falling, ends, at_least, length)
    return dataclasses.field(default=default, metadata={"limits": limits, "series": shape})


class Shape(NamedTuple):
    """How many numbers a series has, and in which order."""

    rising: bool
    never_falling: bool
    ends: tuple[float, float] | None
    at_least: int
    length: str


class Limits(NamedTuple):
    """Unit and allowed range of one quantity."""

    unit: str
    low: float
    high: float
    open_low: bool
    open_high: bool

    def __str__(self) -> str:
        above = f"{'>' if self.open_low else '>='} {self.low:g}"
        below = f"{'<' if self.open_high else '<='} {self.high:g}"
        return " and ".join(
            text for text, end in ((above, self.low), (below, self.high)) if not math.isinf(end)
        )

    def wanted(self, kind: str = "") -> str:
        """What a wrong value should have been."""
        allowed = str(self)
        return " ".join(f"must be {kind or (not allowed) * 'a finite number'} {allowed}".split())

    def admits(self, value: float) -> bool:
        """Whether a finite number lies in the range."""
        over = value > self.low or (value == self.low and not self.open_low)
        under = value < self.high or (value == self.high and not self.open_high)
        return over and under


class Problem(NamedTuple):
    """One wrong field: where, what stands there, and what may."""

    path: str
    value: Any
    unit: str
    allowed: str

    def __str__(self) -> str:
        unit = "" if self.unit in ("", "-") else f" [{self.unit}]"
        shown = reprlib.repr(self.value)
        return f"{self.path} = {shown}{unit}: {self.allowed}"


def is_number(value: Any) -> bool:
    """Whether a value is a plain real number (a bool is not)."""
    if isinstance(value, (bool, str, bytes)):
        return False
    try:
        float(value)
    except (TypeError, ValueError, OverflowError):
        return False
    return getattr(value, "ndim", 0) == 0


@lru_cache(maxsize=1024)
def _fields(kind: Any) -> tuple[dataclasses.Field[Any], ...]:
    return dataclasses.fields(kind)


def problems(node: Any, path: str = "") -> list[Problem]:
    """List every field of a dataclass tree that is not a number within its allowed range.

    Parameters
    ----------
    node : dataclass instance
        Root of the tree; fields declared with :func:`quantity` are checked, dataclasses are
        descended into.
    path : str
        Dotted path of the root, put before every field name.

    Returns
    -------
    list of Problem
        Empty when everything is well.
    """
    found: list[Problem] = []
    kind: Any = type(node)
    for field in _fields(kind):
        value = getattr(node, field.name)
        limits = field.metadata.get("limits")
        if limits is not None and type(value) is float and limits.low < value < limits.high:
            continue  # by far the most
        where = f"{path}.{field.name}" if path else field.name
        if "series" in field.metadata:
            found.extend(_series_problems(node, field, where))
        elif limits is not None:
            if not is_number(value):
                found.append(Problem(where, value, limits.unit, limits.wanted("a number")))
            elif not math.isfinite(value) or not limits.admits(float(value)):
                need = "" if math.isfinite(value) else "a finite number"
                found.append(Problem(where, value, limits.unit, limits.wanted(need)))
        elif dataclasses.is_dataclass(value) and not isinstance(value, type):
            found.extend(problems(value, where))
        elif hasattr(node, "compiled") and not is_number(value):  # a law's record holds numbers
            found.append(Problem(where, value, "", "must be a number: a law holds numbers only"))
    return found


def _series_problems(node: Any, field: dataclasses.Field[Any], where: str) -> list[Problem]:
    """What is wrong with a field declared with :func:`series`."""
    limits, shape = field.metadata["limits"], field.metadata["series"]
    values = getattr(node, field.name)

    def wrong(allowed: str) -> list[Problem]:
        return [Problem(where, values, limits.unit, allowed)]

    if not isinstance(values, tuple) or not all(is_number(value) for value in values):
        return wrong("must be a tuple of numbers")
    if not all(math.isfinite(value) and limits.admits(float(value)) for value in values):
        return wrong(f"every number {limits.wanted()}")
    if len(values) < shape.at_least:
        return wrong(f"must have at least {shape.at_least} numbers")
    if shape.rising and any(a >= b for a, b in itertools.pairwise(values)):
        return wrong("every number must be greater than the one before")
    if shape.never_falling and any(a > b for a, b in itertools.pairwise(values)):
        return wrong("no number may be less than the one before")
    if shape.ends is not None and values[0] != shape.ends[0]:
        return wrong(f"must begin at {shape.ends[0]:g}")
    if shape.ends is not None and values[-1] != shape.ends[1]:
        return wrong(f"must end at {shape.ends[1]:g}")
    if shape.length:
        others = [getattr(node, name) for name in shape.length.split("*")]
        if not all(isinstance(other, (tuple, list)) for other in others):
            return []
        count = math.prod(len(other) for other in others)
        if len(values) != count:
            return wrong(f"must have {count} numbers, to go with {shape.length}")
    return []
