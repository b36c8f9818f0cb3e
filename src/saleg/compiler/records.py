"""The numbers of laws as records: what ``self`` is in compiled code.

A law's record has one field per number, by its name; a series of numbers is an array in it, so its
length is part of the type. The record of an engine holds those of its laws by slot.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from functools import lru_cache
from operator import attrgetter
from typing import Any

import numpy as np

from saleg.laws import Law
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS
from saleg.laws.control.base import ActuatorLaw, ConverterLaw

#: Slots beside those of the chambers, in the order of the record; actuators and converter are last.
OTHER_SLOTS: dict[str, type[Law]] = {
    **ENGINE_SLOTS,
    ActuatorLaw.slot: ActuatorLaw,
    ConverterLaw.slot: ConverterLaw,
}

#: Lengths of the series of numbers a law has, by name.
Lengths = tuple[tuple[str, int], ...]


@lru_cache(maxsize=256)
def names_of(law: Any) -> tuple[str, ...]:
    """Names of the numbers of a law class, in the order of its record."""
    return (*(item.name for item in dataclasses.fields(law)), *law.derived)


def lengths_of(law: Law) -> Lengths:
    """How many numbers there are in each series of a law."""
    kind: Any = type(law)
    return tuple((name, len(getattr(law, name))) for name in _series_names(kind))


def lengths_of_all(laws: Sequence[Law]) -> tuple[Lengths, ...]:
    """The same of several laws."""
    if _have_series(tuple(map(type, laws))):
        return tuple(map(lengths_of, laws))
    return ((),) * len(laws)


def record_of(law: Law) -> np.dtype:
    """Record that holds the numbers of a law."""
    kind: Any = type(law)
    return record_of_kind(kind, lengths_of(law))


def numbers_of(laws: Sequence[Law]) -> list[float]:
    """Numbers of some laws in the order of their records."""
    classes: tuple[Any, ...] = tuple(map(type, laws))
    pairs = zip(_readers(classes), laws, strict=True)
    flat = [value for read, law in pairs for value in read(law) or (0.0,)]
    if not _have_series(classes):
        return flat
    return [
        number
        for value in flat
        for number in (value if isinstance(value, (tuple, list)) else (value,))
    ]


def parameters(laws: Sequence[Law]) -> np.ndarray:
    """Numbers of the laws of an engine as an array of one record.

    Parameters
    ----------
    laws : sequence of Law
        Left, right, engine, actuators, converter.
    """
    classes: tuple[Any, ...] = tuple(map(type, laws))
    record = _record_of_all(classes, lengths_of_all(laws))
    return np.array(numbers_of(laws), np.float64).view(record)


@lru_cache(maxsize=256)
def _record_of_all(classes: tuple[Any, ...], lengths: tuple[Lengths, ...]) -> np.dtype:
    """Record of an engine: left and right hold a record for each slot, the others follow."""
    records = [record_of_kind(law, length) for law, length in zip(classes, lengths, strict=True)]
    n = len(CHAMBER_SLOTS)
    sides = [list(zip(CHAMBER_SLOTS, records[i : i + n], strict=True)) for i in (0, n)]
    rest = list(zip(OTHER_SLOTS, records[2 * n :], strict=True))
    return np.dtype([("left", sides[0]), ("right", sides[1]), *rest])


@lru_cache(maxsize=256)
def record_of_kind(law: Any, lengths: Lengths) -> np.dtype:
    """Record that holds the numbers of a law of some class."""
    long = dict(lengths)
    items = [
        (name, np.float64, (long[name],)) if name in long else (name, np.float64)
        for name in names_of(law)
    ]
    return np.dtype(items or [("nothing", np.float64)])


@lru_cache(maxsize=256)
def _have_series(classes: tuple[Any, ...]) -> bool:
    """Whether any of some law classes holds a series of numbers."""
    return any(_series_names(law) for law in classes)


@lru_cache(maxsize=256)
def _series_names(law: Any) -> tuple[str, ...]:
    """What of a law class holds a series of numbers."""
    fields = [item.name for item in dataclasses.fields(law) if "series" in item.metadata]
    return (*fields, *law.derived)


@lru_cache(maxsize=256)
def _readers(classes: tuple[Any, ...]) -> tuple[Callable[[Law], Any], ...]:
    """What takes all numbers of each law at once."""
    return tuple(map(_reader, classes))


@lru_cache(maxsize=256)
def _reader(law: Any) -> Callable[[Law], Any]:
    """What takes all numbers of a law of some class at once."""
    names = names_of(law)
    return (
        attrgetter(*names) if len(names) > 1 else lambda one: tuple(getattr(one, n) for n in names)
    )
