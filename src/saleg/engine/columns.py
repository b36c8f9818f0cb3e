"""Many engines as one whose numbers are columns: the same tree, the same laws, a row per engine."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache, reduce
from operator import and_, attrgetter
from typing import Any, NamedTuple

import numpy as np

from saleg import quantities
from saleg.columns import Column, column, row_of
from saleg.engine.charge_gas import is_gas_of_charge
from saleg.engine.engine import Engine
from saleg.engine.limits import lengths_fit, windows_fit
from saleg.quantities import Limits, Quantities


@dataclasses.dataclass(frozen=True, eq=False)
class Rows:
    """Engines of one make as one engine.

    Attributes
    ----------
    engine : Engine
        Its numbers are columns, or floats that are the same for all.
    places : ndarray of int
        Where each row stood among the engines.
    """

    engine: Engine
    places: np.ndarray

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.places)

    @cached_property
    def first(self) -> Engine:
        """Engine of the first row: what is not a number is the same in all."""
        return self.row(0)

    def row(self, n: int) -> Engine:
        """Engine of a row."""
        return _changed(self.engine, lambda value: row_of(value, n))

    def some(self, chosen: np.ndarray) -> Rows:
        """Some of the rows, by their numbers or by whether they are wanted."""
        if chosen.dtype == bool and chosen.all():
            return self

        def some_of(value: Any) -> Any:
            return value[chosen] if isinstance(value, Column) else value

        return Rows(_changed(self.engine, some_of), self.places[chosen])

    def numbers(self) -> np.ndarray:
        """Numbers that are not the same for all, shape (n, k)."""
        held: list[np.ndarray] = []

        def noted(value: Any) -> Any:
            if isinstance(value, Column):
                held.append(np.asarray(value))
            return value

        _changed(self.engine, noted)
        return np.array(held).reshape(len(held), self.count).T


class _Unlike(Exception):
    """A tree that is no engine of plain numbers."""


class _Fields(NamedTuple):
    """Fields of a class: those that hold one number, the ranges of some, and all others."""

    numbers: tuple[str, ...]
    limits: tuple[tuple[str, Limits], ...]
    others: tuple[str, ...]


class _Make:
    """What engines of one make have in common: all but their numbers.

    Parameters
    ----------
    engine : Engine
        One of them.
    """

    def __init__(self, engine: Engine):
        numbers: list[str] = []
        others: list[str] = []
        _collect(engine, "", _left_out(engine), numbers, others)
        self._read_numbers, self._read_others = attrgetter(*numbers), attrgetter(*others)
        self._others = self._read_others(engine)
        self._types = tuple(map(type, self._others))
        self._plain = tuple(n for n, x in enumerate(self._others) if not _is_part(x))
        self._left_out = _left_out(engine)
        self.engine, self.places, self.numbers = engine, list[int](), list[tuple[float, ...]]()

    def takes(self, engine: Engine, place: int) -> bool:
        """Take an engine that is of this make; whether it is."""
        try:
            others = self._read_others(engine)
        except AttributeError:
            return False
        if tuple(map(type, others)) != self._types or _left_out(engine) != self._left_out:
            return False
        if any(others[n] != self._others[n] for n in self._plain):
            return False
        numbers = self._read_numbers(engine)
        if set(map(type, numbers)) == {float}:
            self.places.append(place)
            self.numbers.append(numbers)
        return True

    def rows(self) -> Rows:
        """All engines taken, as one of columns."""
        columns = map(column, np.array(self.numbers).T)
        return Rows(_changed(self.engine, lambda _: next(columns)), np.array(self.places))


def rows_by_make(engines: Sequence[Any]) -> list[Rows]:
    """Engines in lots of one make: alike in all but their numbers.

    What is no engine, or one with something that is no number where a number should be, is in none
    of them.
    """
    makes: list[_Make] = []
    for place, engine in enumerate(engines):
        try:
            if isinstance(engine, Engine) and not any(m.takes(engine, place) for m in makes):
                makes.append(_Make(engine))
                makes[-1].takes(engine, place)
        except Exception:  # numpy arrays and the like: whoever solves it by itself will say
            continue
    return [make.rows() for make in makes if make.places]


def rows_of_columns(engine: Engine, values: Mapping[str, np.ndarray]) -> list[Rows]:
    """Engines that are one with some numbers replaced: those with chambers alike, and the others.

    Parameters
    ----------
    engine : Engine
    values : mapping of str to ndarray, shape (n,)
        Numbers of each (SI) by dotted path, as for :meth:`.Engine.replace`.

    Returns
    -------
    list of Rows
        None where a part of a user's does something of its own with its numbers.
    """
    count = len(next(iter(values.values())))
    try:
        _Make(engine)
        whole = engine.replace(**{path: column(numbers) for path, numbers in values.items()})
    except Exception:  # whoever solves them one by one will say
        return []
    alike = np.full(count, np.asarray(_alike(whole.left, whole.right)))
    mirrored = Rows(dataclasses.replace(whole, right=whole.left), np.arange(count)).some(alike)
    other = Rows(whole, np.arange(count)).some(~alike)
    return [rows for rows in (mirrored, other) if rows.count]


def _alike(one: Any, other: Any) -> Any:
    """Whether two parts are equal; of columns, in each row."""
    if one is other or not _is_part(one):
        return (one is other) | (one == other)
    if type(one) is not type(other):
        return False
    names = (item.name for item in dataclasses.fields(one))
    return reduce(and_, (_alike(getattr(one, n), getattr(other, n)) for n in names))


def is_sound(rows: Rows) -> np.ndarray:
    """Whether the numbers of each row lie in their ranges and their lengths fit together.

    Kinds of parts, and series of numbers, are the same in all rows: of them any row says enough.
    """
    return are_in_range(rows.engine, rows.count) & np.asarray(lengths_fit(rows.engine))


def are_in_range(tree: Any, count: int) -> np.ndarray:
    """Whether all numbers of a tree of columns lie in their ranges, row by row."""
    sound = np.full(count, True)
    for value, limits in _quantities(tree):
        sound &= limits.admits(value) & (abs(value) < np.inf)
    return sound


def is_usual(rows: Rows) -> np.ndarray:
    """Whether nothing in each row is far from what has been built."""
    of_series = [problem for problem in rows.first.unusual() if isinstance(problem.value, tuple)]
    usual = np.full(rows.count, not of_series)
    for value, limits in _quantities(rows.engine):
        if limits.usual:
            usual &= quantities.is_usual(value, limits)
    for chamber in rows.engine.chambers:
        usual &= windows_fit(chamber)
        usual &= is_gas_of_charge(chamber)
    return usual


def _changed(engine: Engine, change: Callable[[Any], Any]) -> Engine:
    """Copy of an engine with all its numbers changed; chambers that are one stay one.

    The numbers are met in the order in which a make reads them.
    """
    left_out = _left_out(engine)

    def copied(node: Any) -> Any:
        twin = object.__new__(type(node))
        held, fields = vars(twin), _fields(node)
        held.update(vars(node))
        for name in fields.numbers:
            held[name] = change(held[name])
        for name in fields.others:
            if _is_part(held[name]) and not (node is engine and name in left_out):
                held[name] = copied(held[name])
        return twin

    twin = copied(engine)
    if "right" in left_out:
        vars(twin)["right"] = twin.left
    return twin


def _collect(
    node: Any, path: str, left_out: tuple[str, ...], numbers: list[str], others: list[str]
) -> None:
    """Collect the dotted names of all numbers of a tree, and of all else."""
    fields = _fields(node)
    numbers += [path + name for name in fields.numbers]
    for name in fields.others:
        if name not in left_out:
            others.append(path + name)
            if _is_part(getattr(node, name)):
                _collect(getattr(node, name), f"{path}{name}.", (), numbers, others)


def _left_out(engine: Engine) -> tuple[str, ...]:
    """What of an engine is not its own: its name, and a right chamber that is like the left."""
    alike = engine.right is engine.left or engine.is_mirrored
    return ("name", "right") if alike else ("name",)


def _quantities(node: Any) -> Iterator[tuple[Any, Limits]]:
    """All numbers of a tree that have a range; those of a mirrored engine's chambers once."""
    fields = _fields(node)
    held = vars(node)
    for name, limits in fields.limits:
        yield held[name], limits
    left = held.get("left")
    for name in fields.others:
        if _is_part(held[name]) and not (name == "right" and held[name] is left):
            yield from _quantities(held[name])


def _is_part(value: Any) -> bool:
    return hasattr(value, "__dataclass_fields__")


def _fields(node: Any) -> _Fields:
    kind: Any = type(node)
    return _fields_of(kind)


@lru_cache(maxsize=256)
def _fields_of(kind: Any) -> _Fields:
    """Fields of a class of nodes.

    A class that does something of its own when an object is made may not be written to.
    """
    harmless = (None, Quantities.__post_init__, Engine.__post_init__)
    if getattr(kind, "__post_init__", None) not in harmless:
        raise _Unlike(kind)
    numbers: list[str] = []
    ranges: list[tuple[str, Limits]] = []
    others: list[str] = []
    for item in dataclasses.fields(kind):
        limits = item.metadata.get("limits")
        plain = limits is not None and limits.kind is float and "series" not in item.metadata
        own = limits is None and hasattr(kind, "compiled")  # a law's record holds numbers
        (numbers if plain or own else others).append(item.name)
        if limits is not None and plain:
            ranges.append((item.name, limits))
    return _Fields(tuple(numbers), tuple(ranges), tuple(others))
