"""Records and arrays of several engines side by side in memory, as numba takes them.

A record of n numbers of 8 bytes is kept for W engines as n rows of W: a number of all of them
stands together. :class:`Records` is such a record, with the fields of the record of one engine,
:class:`Rows` an array of such records or of numbers. So ``C[side].area`` and ``y[X] = v`` mean for
W engines what they mean for one.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import (
    AbstractTemplate,
    AttributeTemplate,
    infer_getattr,
    infer_global,
    signature,
)
from numba.extending import (
    intrinsic,
    lower_builtin,
    lower_getattr_generic,
    lower_setattr_generic,
    models,
    register_model,
)

from saleg.compiler.lanes.values import DOUBLE, WORD, Floats, Words

#: Length of a number [bytes].
SIZE = 8


class Records(types.Type):  # type: ignore[misc]
    """A record of each of several engines."""

    def __init__(self, record: Any, width: int):
        self.record = record
        self.width = width
        super().__init__(name=f"Records({record}, {width})")

    @property
    def length(self) -> int:
        """Numbers in a record."""
        return int(self.record.size) // SIZE


class Rows(types.Type):  # type: ignore[misc]
    """An array of each of several engines; its elements are numbers, records or arrays."""

    def __init__(self, element: Any, count: int):
        self.element = element
        self.count = count
        self.width = element.width
        super().__init__(name=f"Rows({element}, {count})")

    @property
    def length(self) -> int:
        """Numbers in an array."""
        return self.count * length_of(self.element)


def length_of(kind: Any) -> int:
    """Numbers in an element."""
    return 1 if isinstance(kind, (Floats, Words)) else int(kind.length)


@register_model(Records)
@register_model(Rows)
class _PointerModel(models.PrimitiveModel):  # type: ignore[misc]
    """The address of its first number."""

    def __init__(self, manager: Any, kind: Any):
        super().__init__(manager, kind, DOUBLE.as_pointer())


def element_of(kind: Any, width: int) -> Any:
    """Type for lanes of a field of a record."""
    if isinstance(kind, types.Record):
        return Records(kind, width)
    if isinstance(kind, types.NestedArray):
        return Rows(element_of(kind.dtype, width), kind.shape[0])
    return Words(width) if isinstance(kind, types.Integer) else Floats(width)


def _load(builder: Any, kind: Any, place: Any) -> Any:
    """An element: a number is read, of all else the place is given."""
    if not isinstance(kind, (Floats, Words)):
        return place
    vector = ir.VectorType(WORD if isinstance(kind, Words) else DOUBLE, kind.width)
    value = builder.load(builder.bitcast(place, vector.as_pointer()))
    value.align = SIZE
    return value


def _store(builder: Any, value: Any, place: Any) -> None:
    builder.store(value, builder.bitcast(place, value.type.as_pointer())).align = SIZE


@infer_getattr
class _RecordsAttribute(AttributeTemplate):  # type: ignore[misc]
    key = Records

    def generic_resolve(self, kind: Any, name: str) -> Any:
        """Type of a field."""
        field = kind.record.fields.get(name)
        return None if field is None else element_of(field.type, kind.width)


def _place_of(builder: Any, kind: Any, value: Any, name: str) -> Any:
    rows = kind.record.offset(name) // SIZE
    return builder.gep(value, [WORD(rows * kind.width)])


@lower_getattr_generic(Records)
def _get_field(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    element = element_of(kind.record.typeof(name), kind.width)
    return _load(builder, element, _place_of(builder, kind, value, name))


@lower_setattr_generic(Records)
def _set_field(context: Any, builder: Any, called: Any, arguments: Any, name: str) -> None:
    _store(builder, arguments[1], _place_of(builder, called.args[0], arguments[0], name))


def _element_at(kind: Any, indices: int) -> Any:
    """Type of an element with so many indices."""
    for _ in range(indices):
        kind = kind.element
    return kind


@infer_global(operator.getitem)
class _GetItem(AbstractTemplate):  # type: ignore[misc]
    def generic(self, arguments: Any, keywords: Any) -> Any:
        """Type of an element."""
        kind, index = arguments
        if not isinstance(kind, Rows):
            return None
        if isinstance(index, types.Integer):
            return signature(kind.element, kind, types.intp)
        if isinstance(index, types.UniTuple):
            return signature(
                _element_at(kind, index.count), kind, types.UniTuple(types.intp, index.count)
            )
        return None


@infer_global(operator.setitem)
class _SetItem(AbstractTemplate):  # type: ignore[misc]
    def generic(self, arguments: Any, keywords: Any) -> Any:
        """Only numbers are written."""
        kind, index, _ = arguments
        if not isinstance(kind, Rows) or not isinstance(index, types.Integer):
            return None
        return signature(types.none, kind, types.intp, kind.element)


def _row(builder: Any, kind: Any, value: Any, index: Any) -> Any:
    stride = length_of(kind.element) * kind.width
    return builder.gep(value, [builder.mul(index, WORD(stride))])


@lower_builtin(operator.getitem, Rows, types.Integer)
def _get_one(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    kind = called.args[0]
    return _load(builder, kind.element, _row(builder, kind, *arguments))


@lower_builtin(operator.getitem, Rows, types.UniTuple)
def _get_inner(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    kind, indices = called.args
    place, given = arguments
    for n in range(indices.count):
        place = _row(builder, kind, place, builder.extract_value(given, n))
        kind = kind.element
    return _load(builder, kind, place)


@lower_builtin(operator.setitem, Rows, types.Integer, Floats)
def _set_one(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    place, index, value = arguments
    _store(builder, value, _row(builder, called.args[0], place, index))
    return context.get_dummy_value()


@infer_global(len)
class _Length(AbstractTemplate):  # type: ignore[misc]
    def generic(self, arguments: Any, keywords: Any) -> Any:
        """A length is known."""
        (kind,) = arguments
        return signature(types.intp, kind) if isinstance(kind, Rows) else None


@lower_builtin(len, Rows)
def _length(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    return WORD(called.args[0].count)


def _address(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(data, DOUBLE.as_pointer())


@intrinsic(prefer_literal=True)
def records_of(context, room, like, width):
    """The record of W engines kept in an array of numbers, like an array of records of one."""
    kind = Records(like.dtype, width.literal_value)

    def generate(context, builder, called, arguments):
        return _address(context, builder, called.args[0], arguments[0])

    return kind(room, like, width), generate


@intrinsic(prefer_literal=True)
def rows_of(context, room, like, count, width):
    """Records of W engines, so many for each."""
    kind = Rows(Records(like.dtype, width.literal_value), count.literal_value)

    def generate(context, builder, called, arguments):
        return _address(context, builder, called.args[0], arguments[0])

    return kind(room, like, count, width), generate


@intrinsic(prefer_literal=True)
def numbers_of(context, room, count, width):
    """An array of so many numbers of W engines."""
    kind = Rows(Floats(width.literal_value), count.literal_value)

    def generate(context, builder, called, arguments):
        return _address(context, builder, called.args[0], arguments[0])

    return kind(room, count, width), generate


@intrinsic(prefer_literal=True)
def tables_of(context, room, rows, count, width):
    """Several arrays of so many numbers of W engines."""
    inner = Rows(Floats(width.literal_value), count.literal_value)
    kind = Rows(inner, rows.literal_value)

    def generate(context, builder, called, arguments):
        return _address(context, builder, called.args[0], arguments[0])

    return kind(room, rows, count, width), generate
