"""Many engines as one whose numbers are columns: the same tree, the same laws, a row per engine."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from saleg.engine.engine import Engine, lengths_fit
from saleg.laws.columns import Column, column, row_of
from saleg.quantities import Limits, Quantities


class Rows(NamedTuple):
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

    def row(self, n: int) -> Engine:
        """Engine of a row."""
        return changed(self.engine, lambda value: row_of(value, n))

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.places)

    def some(self, chosen: np.ndarray) -> Rows:
        """Some of the rows, by their numbers or by whether they are wanted."""

        def some_of(value: Any) -> Any:
            return value[chosen] if isinstance(value, Column) else value

        return Rows(changed(self.engine, some_of), self.places[chosen])


class _Unlike(Exception):
    """A tree that is no engine of plain numbers."""


class _Fields(NamedTuple):
    """Fields of a class: those that hold one number, and the others."""

    numbers: tuple[str, ...]
    others: tuple[str, ...]
    read: Callable[[Any], tuple[Any, ...]]


def rows_by_make(engines: Sequence[Any]) -> Iterator[Rows]:
    """Engines in lots of one make: alike in all but their numbers.

    What is no engine, or one with something that is no number where a number should be, is in none
    of them.
    """
    lots: dict[Any, tuple[list[int], list[list[float]]]] = {}
    for place, engine in enumerate(engines):
        numbers: list[Any] = []
        try:
            make = _read(engine, numbers) if isinstance(engine, Engine) else None
            if make is not None and set(map(type, numbers)) <= {float}:
                places, rows = lots.setdefault(make, ([], []))
                places.append(place)
                rows.append(numbers)
        except (_Unlike, TypeError):  # unhashable, for one
            continue
    for places, rows in lots.values():
        columns = map(column, np.array(rows).T)
        yield Rows(_written(engines[places[0]], columns), np.array(places))


def changed(engine: Engine, change: Callable[[Any], Any]) -> Engine:
    """Copy of an engine with all its numbers changed; chambers that are one stay one."""

    def copied(node: Any) -> Any:
        twin = copy.copy(node)
        fields = _fields_of(type(node))
        held = vars(twin)
        held.update((name, change(held[name])) for name in fields.numbers)
        held.update((name, copied(part)) for name, part in _parts(node, fields))
        return twin

    mirrored = engine.left is engine.right
    twin = copied(dataclasses.replace(engine, right=engine.left) if mirrored else engine)
    if mirrored:
        vars(twin)["right"] = twin.left
    return twin


def is_sound(rows: Rows) -> np.ndarray:
    """Whether the numbers of each row lie in their ranges and their lengths fit together.

    Kinds of parts, and series of numbers, are the same in all rows: of them any row says enough.
    """
    sound = np.full(rows.count, True) & lengths_fit(rows.engine)
    for limits, value in _quantities(rows.engine):
        sound &= np.isfinite(value) & limits.admits(value)
    return sound


def is_usual(rows: Rows) -> np.ndarray:
    """Whether nothing in each row is far from what has been built."""
    usual = np.full(rows.count, True)
    for limits, value in _quantities(rows.engine):
        if limits.usual:
            low, high = limits.usual
            usual &= (value == 0.0) | ((low <= value) & (value <= high))
    return usual


def _quantities(node: Any) -> Iterator[tuple[Limits, Any]]:
    """All numbers of a tree that have a range."""
    fields = _fields_of(type(node))
    for item in dataclasses.fields(node):
        if item.name in fields.numbers and "limits" in item.metadata:
            yield item.metadata["limits"], getattr(node, item.name)
    for _, part in _parts(node, fields):
        yield from _quantities(part)


def _read(node: Any, numbers: list[Any]) -> Any:
    """Class of a node and of all below it, with all that is no number; collects the numbers."""
    fields = _fields_of(type(node))
    numbers.extend(fields.read(node))
    names = fields.others
    if isinstance(node, Engine):
        left_out = ("name", "right") if node.is_mirrored else ("name",)
        names = tuple(name for name in names if name not in left_out)
    others = (getattr(node, name) for name in names)
    return type(node), names, *(_read(x, numbers) if dataclasses.is_dataclass(x) else x for x in others)


def _written(node: Any, columns: Iterator[Any]) -> Any:
    """Copy of a node with columns in the place of its numbers, in the order they are read."""
    twin = copy.copy(node)
    fields = _fields_of(type(node))
    held = vars(twin)
    held.update((name, next(columns)) for name in fields.numbers)
    mirrored = isinstance(node, Engine) and node.is_mirrored
    for name, part in _parts(node, fields):
        if not (mirrored and name == "right"):
            held[name] = _written(part, columns)
    if mirrored:
        held["right"] = held["left"]
    return twin


def _parts(node: Any, fields: _Fields) -> Iterable[tuple[str, Any]]:
    """Parts of a node by name."""
    others = ((name, getattr(node, name)) for name in fields.others)
    return [(name, part) for name, part in others if dataclasses.is_dataclass(part)]


@lru_cache(maxsize=256)
def _fields_of(kind: Any) -> _Fields:
    """Fields of a class of nodes.

    A class that does something of its own when an object is made may not be written to.
    """
    if getattr(kind, "__post_init__", None) not in (None, Quantities.__post_init__):
        raise _Unlike(kind)
    numbers, others = [], []
    for item in dataclasses.fields(kind):
        limits = item.metadata.get("limits")
        plain = limits is not None and limits.kind is float and "series" not in item.metadata
        own = limits is None and hasattr(kind, "compiled")  # a law's record holds numbers
        (numbers if plain or own else others).append(item.name)
    return _Fields(tuple(numbers), tuple(others), _reader(tuple(numbers)))


def _reader(names: tuple[str, ...]) -> Callable[[Any], tuple[Any, ...]]:
    """What takes some attributes of an object as a tuple."""
    if len(names) > 1:
        return attrgetter(*names)
    return lambda node: tuple(getattr(node, name) for name in names)
