"""Physical quantities as dataclass fields: a unit and an allowed range beside every number."""

from __future__ import annotations

import dataclasses
import itertools
import math
from decimal import Decimal
from functools import lru_cache
from numbers import Integral, Real
from typing import Any, NamedTuple

from saleg.errors import Problem as Problem
from saleg.errors import WrongQuantity, shown

__all__ = ["Quantities", "problems", "quantity", "series", "unusual"]


class Quantities:
    """Base of dataclasses of quantities: numbers become floats at the door, exactly.

    So an engine given a ``Decimal`` or a ``float32`` equals its twin given the same value as a
    float, and gives the same results. What is no real number stays, for :func:`problems` to name.
    """

    def __post_init__(self) -> None:
        """Turn every number, and every number of a tuple, into a float."""
        own: Any = type(self)
        for field in fields_of(own):
            value = getattr(self, field.name)
            kind = type(value)
            if kind is not float and not hasattr(kind, "__dataclass_fields__"):
                limits = field.metadata.get("limits")
                whole = limits is not None and limits.kind is int
                object.__setattr__(self, field.name, _whole(value) if whole else _plain(value))


def quantity(
    unit: str,
    *,
    default: Any = dataclasses.MISSING,
    low: float = -math.inf,
    high: float = math.inf,
    open_low: bool = False,
    open_high: bool = False,
    usual: tuple[float, float] | None = None,
    whole: bool = False,
) -> Any:
    """Declare a dataclass field that holds one number with a unit and an allowed range.

    Parameters
    ----------
    unit : str
        SI unit as people write it, ``"-"`` for a pure number.
    default : float, optional
        Default value, in that unit; the field is required without one.
    low, high : float
        Allowed range, in that unit.
    open_low, open_high : bool
        Whether the end itself is excluded.
    usual : (float, float), optional
        Range of what has been built, generously; see :func:`unusual`. 0 is never unusual.
    whole : bool
        Whether it must be a whole number, which stays an int.

    Returns
    -------
    dataclasses.Field
        To be used as the right-hand side of an annotated class attribute.

    Raises
    ------
    WrongQuantity
        If the unit is not one line of text.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Rod:
    ...     length: float = quantity("m", low=0, open_low=True, usual=(0.01, 3.0))
    >>> problems(Rod(-1.0), "rod")[0].path
    'rod.length'
    >>> str(unusual(Rod(250.0))[0])
    'length = 250.0 [m]: usually 0.01 to 3; it would be 0.25 if given in mm, 2.5 if given in cm'
    """
    ends = float(low), float(high), open_low, open_high
    limits = Limits(_checked_unit(unit), *ends, usual, int if whole else float)
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
    usual: tuple[float, float] | None = None,
) -> Any:
    """Declare a dataclass field that holds some numbers of one unit, as a tuple.

    Parameters
    ----------
    unit : str
        SI unit as people write it.
    default : tuple of float, optional
        Default values; the field is required without.
    low, high : float
        Allowed range of every number, in that unit.
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
    usual : (float, float), optional
        Range of what has been built, generously; see :func:`unusual`. 0 is never unusual.

    Returns
    -------
    dataclasses.Field
        To be used as the right-hand side of an annotated class attribute.

    Raises
    ------
    WrongQuantity
        If the unit is not one line of text.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Profile:
    ...     x: tuple[float, ...] = series("m", rising=True)
    >>> str(problems(Profile((0.0, 2.0, 1.0)))[0])
    'x = (0.0, 2.0, 1.0) [m]: every number must be greater than the one before'
    """
    limits = Limits(_checked_unit(unit), float(low), float(high), False, False, usual)
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
    usual: tuple[float, float] | None = None
    kind: type = float

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

    def admits(self, value: Any) -> Any:
        """Whether a finite number, or each of an array, lies in the range."""
        over = (value > self.low) | ((value == self.low) & (not self.open_low))
        under = (value < self.high) | ((value == self.high) & (not self.open_high))
        return over & under


def _checked_unit(unit: Any) -> str:
    if not isinstance(unit, str) or not unit.isprintable():
        raise WrongQuantity(f"unit = {shown(unit)}: must be one line of text, such as 'N/m'")
    return unit


def is_number(value: Any) -> bool:
    """Whether a value is a real number: no bool, no text, nothing complex."""
    return as_float(value) is not None


def as_float(value: Any) -> float | None:
    """A real number of any type as a float, exactly; None for anything else.

    Examples
    --------
    >>> from decimal import Decimal
    >>> as_float(Decimal("0.25")), as_float(True), as_float("0.25")
    (0.25, None, None)
    """
    if type(value) is float:
        return value
    value = _unpacked(value)
    if isinstance(value, bool) or not isinstance(value, (Real, Decimal)):
        return None
    try:
        return float(value)
    except (ValueError, OverflowError):
        return None


def is_whole(value: Any, low: float = -math.inf, high: float = math.inf) -> bool:
    """Whether a value is a whole number (a bool is not) of a range, ends included."""
    value = _whole(value)
    return type(value) is int and low <= value <= high


def _unpacked(value: Any) -> Any:
    """The Python number in a number or an array without dimensions of numpy and its like."""
    if hasattr(value, "mask"):  # a masked number is none
        return value
    try:
        return value.item() if getattr(value, "ndim", None) == 0 else value
    except Exception:  # not of that kind
        return value


def _whole(value: Any) -> Any:
    """A whole number of any type as an int; anything else as it is."""
    plain = _unpacked(value)
    return int(plain) if isinstance(plain, Integral) and not isinstance(plain, bool) else value


def _plain(value: Any) -> Any:
    """A number, or the numbers of a tuple, as floats; anything else as it is."""
    if type(value) is tuple:
        return tuple(_plain(item) for item in value)
    number = as_float(value)
    return value if number is None else number


@lru_cache(maxsize=1024)
def fields_of(kind: Any) -> tuple[dataclasses.Field[Any], ...]:
    """Fields of a dataclass, found once: they are asked for at every check of an engine."""
    return dataclasses.fields(kind)


@lru_cache(maxsize=1024)
def _with_limits(kind: Any) -> tuple[tuple[dataclasses.Field[Any], Any, bool], ...]:
    """Fields of a class with their limits, and whether each holds one number."""
    found = [(field, field.metadata.get("limits")) for field in fields_of(kind)]
    return tuple(
        (field, limits, limits is not None and "series" not in field.metadata)
        for field, limits in found
    )


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
    for field, limits, plain in _with_limits(kind):
        value = getattr(node, field.name)
        if plain and type(value) is limits.kind and limits.low < value < limits.high:
            continue  # by far the most
        where = f"{path}.{field.name}" if path else field.name
        if "series" in field.metadata:
            found.extend(_series_problems(node, field, where))
        elif limits is not None:
            if not (is_number(value) if limits.kind is float else is_whole(value)):
                wanted = "a number" if limits.kind is float else "a whole number"
                found.append(Problem(where, value, limits.unit, limits.wanted(wanted)))
            elif not _is_finite(value) or not limits.admits(value):
                need = "" if _is_finite(value) else "a finite number"
                found.append(Problem(where, value, limits.unit, limits.wanted(need)))
        elif dataclasses.is_dataclass(value) and not isinstance(value, type):
            found.extend(problems(value, where))
        elif hasattr(node, "compiled") and not is_number(value):  # a law's record holds numbers
            found.append(Problem(where, value, "", "must be a number: a law holds numbers only"))
    return found


def _is_finite(value: Any) -> bool:
    """Whether a number is finite; whole numbers are, however many digits they have."""
    return isinstance(value, int) or math.isfinite(value)


#: Units a number may have been given in by mistake, the likeliest first: factor and offset to SI.
GIVEN_IN = {
    "m": (("mm", 1e-3, 0.0), ("cm", 1e-2, 0.0), ("inch", 0.0254, 0.0)),
    "kg": (("g", 1e-3, 0.0),),
    "s": (("ms", 1e-3, 0.0), ("us", 1e-6, 0.0)),
    "K": (("degC", 1.0, 273.15),),
    "Pa": (("bar", 1e5, 0.0), ("kPa", 1e3, 0.0), ("MPa", 1e6, 0.0)),
    "N": (("kN", 1e3, 0.0),),
    "N s/m": (("kN s/m", 1e3, 0.0),),
    "N/m": (("kN/m", 1e3, 0.0), ("N/mm", 1e3, 0.0)),
    "J/kg": (("MJ/kg", 1e6, 0.0), ("kJ/kg", 1e3, 0.0)),
    "H": (("mH", 1e-3, 0.0), ("uH", 1e-6, 0.0)),
    "J/kg/K": (("kJ/kg/K", 1e3, 0.0),),
    "cal/mol": (("kcal/mol", 1e3, 0.0), ("kJ/mol", 1e3 / 4.184, 0.0), ("J/mol", 1 / 4.184, 0.0)),
    "W": (("kW", 1e3, 0.0), ("MW", 1e6, 0.0)),
    "Hz": (("1/min", 1.0 / 60.0, 0.0),),
}


def unusual(node: Any, path: str = "") -> list[Problem]:
    """List every number of a dataclass tree that is allowed but far from what has been built.

    Parameters
    ----------
    node : dataclass instance
        Root of the tree, without :func:`problems`.
    path : str
        Dotted path of the root, put before every field name.

    Returns
    -------
    list of Problem
        Each with the usual range and, if one fits, the unit the number may have been given in.
    """
    found: list[Problem] = []
    kind: Any = type(node)
    for name, limits in _with_usual_range(kind):
        value = getattr(node, name)
        if limits is not None and type(value) is float and is_usual(value, limits):
            continue  # by far the most
        where = f"{path}.{name}" if path else name
        if limits is None:
            parts = dataclasses.is_dataclass(value) and not isinstance(value, type)
            found.extend(unusual(value, where) if parts else ())
            continue
        values = value if isinstance(value, tuple) else (value,)
        numbers = [number for number in values if isinstance(number, (int, float))]
        odd = [number for number in numbers if not is_usual(number, limits)]
        # A slip of units is one of all numbers; 0 is the same in all.
        if odd and len(odd) == sum(number != 0.0 for number in numbers):
            found.append(Problem(where, value, limits.unit, _usual_text(odd[0], limits)))
    return found


def unusual_number(name: str, value: float, unit: str, usual: tuple[float, float]) -> str:
    """What is unusual about a number that stands by itself; empty if nothing is.

    Parameters
    ----------
    name, unit : str
    value : float
    usual : (float, float)
        Range of what has been built, generously.
    """
    limits = Limits(unit, -math.inf, math.inf, False, False, usual)
    if is_usual(value, limits):
        return ""
    return str(Problem(name, value, unit, _usual_text(value, limits)))


def is_usual(value: Any, limits: Limits) -> Any:
    """Whether a number, or each of an array, is usual: 0 is, and any without a usual range."""
    low, high = limits.usual or (-math.inf, math.inf)
    return (value == 0.0) | ((low <= value) & (value <= high))


@lru_cache(maxsize=1024)
def _with_usual_range(kind: Any) -> tuple[tuple[str, Any], ...]:
    """Fields with a usual range, and that; None for fields that may be dataclasses with some."""
    limits = [(field.name, field.metadata.get("limits")) for field in fields_of(kind)]
    return tuple((name, found) for name, found in limits if found is None or found.usual)


def _usual_text(value: float, limits: Limits) -> str:
    low, high = limits.usual or (0.0, 0.0)
    text = f"usually {low:g} to {high:g}"
    likely = [
        f"{factor * value + offset:g} if given in {unit}"
        for unit, factor, offset in GIVEN_IN.get(limits.unit, ())
        if low <= factor * value + offset <= high
    ]
    return f"{text}; it would be {', '.join(likely)}" if likely else text


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
