"""Numbers of several engines side by side, as numba takes them: one value, W doubles.

The type :class:`Floats` is the vector ``<W x double>`` of LLVM with the arithmetic of a float, so a
function written for numbers compiles unchanged with it: a law takes it for p, T and V.
Comparisons give a :class:`Mask`, which has no truth value: what depends on it is written with
:func:`saleg.laws.where` and :func:`saleg.laws.any_of`.

No lane depends on its neighbours: every operation is that of each lane by itself, and nothing is
contracted to a fused multiply-add that is not written as one, so that the width does not matter
either.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from functools import partial, reduce
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import (
    intrinsic,
    lower_builtin,
    lower_cast,
    models,
    overload,
    register_model,
)

from saleg.compiler import machine_code
from saleg.laws import choice

DOUBLE, WORD, BIT, INDEX = ir.DoubleType(), ir.IntType(64), ir.IntType(1), ir.IntType(32)
#: What writes the instructions of a function.
Emit = Callable[..., Any]
#: How the functions here are compiled: as parts of those that call them.
OPTIONS: dict[str, Any] = {
    "forceinline": True,
    "error_model": "numpy",
    "_nrt": False,
    "pipeline_class": machine_code.inner_compiler(),
}
#: Types of numbers that are the same in all lanes.
NUMBERS = (types.Float, types.Integer, types.Boolean)


class _Lanes(types.Type):  # type: ignore[misc]
    """Something each lane has one of."""

    def __init__(self, width: int):
        self.width = width
        super().__init__(name=f"{type(self).__name__}({width})")

    @property
    def key(self) -> tuple[str, int]:
        return type(self).__name__, self.width

    #: Types of what is the same in all lanes that will do in its place.
    alike: tuple[Any, ...] = ()

    def unify(self, context: Any, other: Any) -> Any:
        """Beside one of all lanes: that one in each lane."""
        return self if isinstance(other, self.alike) else None

    def can_convert_from(self, context: Any, other: Any) -> Any:
        """One of all lanes will do."""
        return Conversion.safe if isinstance(other, self.alike) else None


class Floats(_Lanes):
    """A number per lane."""

    alike = NUMBERS


class Words(_Lanes):
    """A whole number per lane, good for comparisons with one."""


class Mask(_Lanes):
    """Yes or no per lane."""

    alike = (types.Boolean,)


def _model(kind: Any, element: ir.Type) -> None:
    """How a type is represented: a vector of some element."""

    def start(self: Any, manager: Any, kind: Any) -> None:
        vector = ir.VectorType(element, kind.width)
        models.PrimitiveModel.__init__(self, manager, kind, vector)

    model = type(f"{kind.__name__}Model", (models.PrimitiveModel,), {"__init__": start})
    register_model(kind)(model)


_model(Floats, DOUBLE)
_model(Words, WORD)
_model(Mask, BIT)


def splat(builder: Any, value: Any, width: int) -> Any:
    """A number in all lanes."""
    vector = ir.VectorType(value.type, width)
    nothing = ir.Constant(vector, ir.Undefined)
    first = builder.insert_element(nothing, value, INDEX(0))
    zeros = ir.Constant(ir.VectorType(INDEX, width), [0] * width)
    return builder.shuffle_vector(first, nothing, zeros)


def constant(value: float | int, width: int) -> ir.Constant:
    """A known number in all lanes."""
    element = DOUBLE if isinstance(value, float) else WORD
    return ir.Constant(ir.VectorType(element, width), [value] * width)


def widest(kinds: Sequence[Any]) -> Floats | None:
    """Type of what is calculated from some arguments; None if they are not numbers of lanes."""
    found = next((kind for kind in kinds if isinstance(kind, Floats)), None)
    fits = all(kind == found or isinstance(kind, NUMBERS) for kind in kinds)
    return found if fits else None


def call_llvm(builder: Any, name: str, arguments: Sequence[Any]) -> Any:
    """Call an intrinsic function of LLVM."""
    kind = arguments[0].type
    suffix = f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64"
    function = ir.FunctionType(kind, [kind] * len(arguments))
    intrinsic_of = cgutils.get_or_insert_function(builder.module, function, f"llvm.{name}.{suffix}")
    return builder.call(intrinsic_of, arguments)


@lower_cast(types.Float, Floats)
@lower_cast(types.Integer, Floats)
@lower_cast(types.Boolean, Floats)
def _cast(context: Any, builder: Any, given: Any, wanted: Any, value: Any) -> Any:
    return splat(builder, context.cast(builder, value, given, types.float64), wanted.width)


def register(
    functions: Sequence[Any], emit: Emit, counts: Sequence[int], result: Any = None
) -> None:
    """Let numba know functions of numbers of lanes.

    Parameters
    ----------
    functions : sequence of callable
        As Python has them.
    emit : callable
        Writes the instructions of one, given the builder and its arguments.
    counts : sequence of int
        Numbers of arguments; of more than two, the result of the first two is the next one's first.
    result : type, optional
        Kind of the result; numbers if it is not given.
    """

    def generic(self: Any, arguments: Any, keywords: Any) -> Any:
        kind = widest(arguments) if len(arguments) in counts and not keywords else None
        if kind is None:
            return None
        # Numbers of all lanes are cast to one per lane by the caller.
        return signature(result(kind.width) if result else kind, *[kind] * len(arguments))

    def lower(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
        if len(arguments) < 3:
            return emit(builder, *arguments)
        return reduce(partial(emit, builder), arguments)

    for function in functions:
        template = type("LanesTemplate", (AbstractTemplate,), {"generic": generic, "key": function})
        infer_global(function)(template)
        for count in counts:
            lower_builtin(function, *[Floats] * count)(lower)


def _compared(sign: str) -> Emit:
    compare = "fcmp_unordered" if sign == "!=" else "fcmp_ordered"
    return lambda builder, a, b: getattr(builder, compare)(sign, a, b)


def _least(builder: Any, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered("<", b, a), b, a)


def _greatest(builder: Any, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(">", b, a), b, a)


register((operator.add, operator.iadd), lambda builder, a, b: builder.fadd(a, b), [2])
register((operator.sub, operator.isub), lambda builder, a, b: builder.fsub(a, b), [2])
register((operator.mul, operator.imul), lambda builder, a, b: builder.fmul(a, b), [2])
register((operator.truediv, operator.itruediv), lambda builder, a, b: builder.fdiv(a, b), [2])
register((operator.neg,), lambda builder, a: builder.fneg(a), [1])
register((operator.pos,), lambda builder, a: a, [1])
register((abs, math.fabs), lambda builder, a: call_llvm(builder, "fabs", [a]), [1])
register((math.sqrt,), lambda builder, a: call_llvm(builder, "sqrt", [a]), [1])
register((math.copysign,), lambda builder, a, b: call_llvm(builder, "copysign", [a, b]), [2])
register((min,), _least, [2, 3, 4])
register((max,), _greatest, [2, 3, 4])
for _operator, _sign in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
    (operator.ne, "!="),
):
    register((_operator,), _compared(_sign), [2], Mask)


def _is_finite(builder: Any, a: Any) -> Any:
    infinite = constant(math.inf, a.type.count)
    return builder.fcmp_ordered("<", call_llvm(builder, "fabs", [a]), infinite)


register((math.isfinite,), _is_finite, [1], Mask)


def _between_masks(function: Any, name: str) -> None:
    """Register an operation of two masks; yes or no for all lanes will do for one."""

    def generic(self: Any, arguments: Any, keywords: Any) -> Any:
        kind = next((kind for kind in arguments if isinstance(kind, Mask)), None)
        fits = all(kind == one or isinstance(one, types.Boolean) for one in arguments)
        return signature(kind, kind, kind) if kind is not None and fits else None

    template = type("MaskTemplate", (AbstractTemplate,), {"generic": generic, "key": function})
    infer_global(function)(template)

    @lower_builtin(function, Mask, Mask)
    def lower(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
        return getattr(builder, name)(*arguments)


_between_masks(operator.and_, "and_")
_between_masks(operator.or_, "or_")


@lower_cast(types.Boolean, Mask)
def _cast_mask(context: Any, builder: Any, given: Any, wanted: Any, value: Any) -> Any:
    return splat(builder, builder.trunc(value, BIT), wanted.width)


def _compare_words(function: Any, sign: str) -> None:
    """Register a comparison of whole numbers of lanes with one for all."""

    def generic(self: Any, arguments: Any, keywords: Any) -> Any:
        whole = [isinstance(arguments[0], Words), isinstance(arguments[-1], types.Integer)]
        return signature(Mask(arguments[0].width), *arguments) if all(whole) else None

    template = type("WordsTemplate", (AbstractTemplate,), {"generic": generic, "key": function})
    infer_global(function)(template)

    @lower_builtin(function, Words, types.Integer)
    def lower(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
        words, one = arguments
        same = splat(
            builder, context.cast(builder, one, called.args[1], types.int64), words.type.count
        )
        return builder.icmp_signed(sign, words, same)


_compare_words(operator.eq, "==")
_compare_words(operator.ne, "!=")
_compare_words(operator.gt, ">")


def bits_of(builder: Any, mask: Any) -> Any:
    """A mask as a whole number, the first lane in its lowest bit."""
    return builder.bitcast(mask, ir.IntType(mask.type.count))


@intrinsic
def _any_lane(context, mask):
    """Whether any lane has a yes."""

    def generate(context, builder, called, arguments):
        bits = bits_of(builder, arguments[0])
        return builder.icmp_unsigned("!=", bits, bits.type(0))

    return types.boolean(mask), generate


@intrinsic
def _select(context, mask, a, b):
    """One of two numbers, or of two answers, per lane."""
    answers = all(isinstance(one, (Mask, types.Boolean)) for one in (a, b))
    kind = (Mask if answers else Floats)(mask.width)

    def generate(context, builder, called, arguments):
        chosen, *values = arguments
        first, second = (
            context.cast(builder, value, given, kind)
            for value, given in zip(values, called.args[1:], strict=True)
        )
        return builder.select(chosen, first, second)

    return kind(mask, a, b), generate


@intrinsic
def lane_bits(context, mask):
    """A mask as a whole number, the first lane in its lowest bit."""

    def generate(context, builder, called, arguments):
        return builder.zext(bits_of(builder, arguments[0]), WORD)

    return types.int64(mask), generate


@overload(choice.where, jit_options=OPTIONS)
def _where(mask, a, b):
    if isinstance(mask, Mask):
        return lambda mask, a, b: _select(mask, a, b)
    return lambda mask, a, b: a if mask else b


@overload(choice.any_of, jit_options=OPTIONS)
def _any_of(mask):
    if isinstance(mask, Mask):
        return lambda mask: _any_lane(mask)
    return lambda mask: bool(mask)
