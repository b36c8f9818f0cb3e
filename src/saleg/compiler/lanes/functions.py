"""Elementary functions of numbers of lanes.

exp and log are written without branches, to within three units in the last place, for what
engines calculate with: numbers of ordinary size. Lanes with other numbers (infinite, not a number,
below the normal ones, not positive) are given to the function of the C library, one by one, and
only they, so that no lane sees what is in another. All other functions of :mod:`math` go that way.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from saleg.compiler.lanes.values import DOUBLE, INDEX, OPTIONS, WORD, Floats, call_llvm, constant
from saleg.compiler.lanes.values import _any_lane as any_lane
from saleg.compiler.lanes.values import _select as select

inline = njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, **OPTIONS)

#: Added to a number below 2^51 and taken away again it rounds to a whole number; 1.5 * 2^52.
ROUNDING = 6755399441055744.0
#: One over ln 2, and ln 2 in two parts, the first with zeros in its last bits.
PER_LN_2 = 1.4426950408889634
LN_2 = 6.93147180559945286227e-01
LN_2_HIGH = 6.93147180369123816490e-01
LN_2_LOW = 1.90821492927058770002e-10
#: Beyond it exp is left to the C library: results are infinite, zero or below the normal numbers.
MOST = 708.0
#: Normal numbers that are positive and finite.
LEAST_NORMAL = 2.2250738585072014e-308
GREATEST = 1.7976931348623157e308
#: Terms of the series of (exp(r) - 1 - r) / r^2 for r up to half of ln 2.
E0, E1, E2, E3, E4, E5, E6, E7, E8, E9, E10 = (1.0 / math.factorial(n) for n in range(2, 13))
#: Coefficients of ln((1 + s) / (1 - s)) in s^2, as in FreeBSD's e_log.c (Sun Microsystems, 1993).
L1, L2, L3, L4, L5, L6, L7 = (
    6.666666666666735130e-01,
    3.999999999940941908e-01,
    2.857142874366239149e-01,
    2.222219843214978396e-01,
    1.818357216161805012e-01,
    1.531383769920937332e-01,
    1.479819860511658591e-01,
)


@intrinsic
def fma(context, a, b, c):
    """``a b + c``, rounded once."""
    kind = next(one for one in (a, b, c) if isinstance(one, Floats))

    def generate(context, builder, called, arguments):
        values = [
            context.cast(builder, value, given, kind)
            for value, given in zip(arguments, called.args, strict=True)
        ]
        return call_llvm(builder, "fma", values)

    return kind(a, b, c), generate


@intrinsic
def times_power_of_two(context, x, rounded):
    """``x 2^n``, n in the last bits of what :data:`ROUNDING` was added to."""

    def generate(context, builder, called, arguments):
        width = called.return_type.width
        words = ir.VectorType(WORD, width)
        number, power = (builder.bitcast(value, words) for value in arguments)
        shifted = builder.shl(power, constant(52, width))
        return builder.bitcast(builder.add(number, shifted), ir.VectorType(DOUBLE, width))

    return x(x, rounded), generate


@intrinsic
def split(context, x):
    """Fraction from the root of a half to that of two, and power of two, of a normal number."""

    def generate(context, builder, called, arguments):
        width = called.args[0].width
        words, doubles = (ir.VectorType(element, width) for element in (WORD, DOUBLE))
        root_of_half = constant(0x3FE6A09E00000000, width)
        above = builder.sub(builder.bitcast(arguments[0], words), root_of_half)
        power = builder.lshr(builder.add(above, constant(1024 << 52, width)), constant(52, width))
        # As the last bits of 2^52 a whole number becomes a double by a subtraction.
        as_double = builder.bitcast(
            builder.or_(power, constant(0x4330000000000000, width)), doubles
        )
        power = builder.fsub(as_double, constant(2.0**52 + 1024.0, width))
        bits = builder.and_(above, constant(0x000FFFFFFFFFFFFF, width))
        fraction = builder.bitcast(builder.add(bits, root_of_half), doubles)
        return context.make_tuple(builder, called.return_type, [fraction, power])

    return types.UniTuple(x, 2)(x), generate


@inline
def usual_exp(x):
    """Exponential where the result is a normal number."""
    rounded = fma(x, PER_LN_2, ROUNDING)
    n = rounded - ROUNDING
    r = fma(n, -LN_2_LOW, fma(n, -LN_2_HIGH, x))
    r2 = r * r
    r4 = r2 * r2
    low = fma(fma(r, E3, E2), r2, fma(r, E1, E0))
    middle = fma(fma(r, E7, E6), r2, fma(r, E5, E4))
    high = fma(r2, E10, fma(r, E9, E8))
    series = fma(fma(high, r4, middle), r4, low)
    return times_power_of_two(fma(series, r2, 1.0 + r), rounded)


@inline
def usual_log(x):
    """Natural logarithm of a normal positive number.

    Few operations wait for each other: rows in lanes take 4 % less than with a form that is right
    to one unit.
    """
    fraction, power = split(x)
    s = (fraction - 1.0) / (fraction + 1.0)
    z = s * s
    z2 = z * z
    low = fma(fma(z, L4, L3), z2, fma(z, L2, L1))
    high = fma(z2, L7, fma(z, L6, L5))
    series = fma(high, z2 * z2, low)
    return fma(series, z * s, fma(power, LN_2, s + s))


def one_by_one(name: str) -> Any:
    """An intrinsic that gives lanes, one by one, to a function of :mod:`math` of as many numbers.

    Its first argument is a mask; lanes without a yes get zero.
    """
    function = getattr(math, name)

    def generate(context, builder, called, arguments):
        width = called.return_type.width
        number = types.float64
        signature = number(*[number] * (len(arguments) - 1))
        kind = context.typing_context.resolve_value_type(function)
        kind.get_call_type(context.typing_context, signature.args, {})
        calculate = context.get_function(kind, signature)
        mask, *values = arguments
        # Room in the function's entry: within a loop the stack would grow with every turn.
        result = cgutils.alloca_once(builder, ir.VectorType(DOUBLE, width))
        builder.store(constant(0.0, width), result)
        for lane in range(width):
            with builder.if_then(builder.extract_element(mask, INDEX(lane)), likely=False):
                each = [builder.extract_element(value, INDEX(lane)) for value in values]
                one = calculate(builder, each)
                filled = builder.insert_element(builder.load(result), one, INDEX(lane))
                builder.store(filled, result)
        return builder.load(result)

    if name == "pow":

        @intrinsic
        def call_two(context, mask, a, b):
            return Floats(mask.width)(mask, a, b), generate

        return call_two

    @intrinsic
    def call_one(context, mask, a):
        return Floats(mask.width)(mask, a), generate

    return call_one


exp_one_by_one = one_by_one("exp")
log_one_by_one = one_by_one("log")
pow_one_by_one = one_by_one("pow")


@inline
def lane_exp(x):
    """Exponential of any number."""
    usual = abs(x) <= MOST
    result = usual_exp(x)
    if any_lane(negated(usual)):
        result = select(usual, result, exp_one_by_one(negated(usual), x))
    return result


@inline
def lane_log(x):
    """Natural logarithm of any number; as compiled code has it, not a number if it has none."""
    usual = (x >= LEAST_NORMAL) & (x <= GREATEST)
    result = usual_log(x)
    if any_lane(negated(usual)):
        result = select(usual, result, log_one_by_one(negated(usual), x))
    return result


@inline
def lane_pow(x, y):
    """A power; a square is a product."""
    result = x * x
    other = y != 2.0
    if any_lane(other):
        exponent = y * usual_log(x)
        usual = (x >= LEAST_NORMAL) & (x <= GREATEST) & (abs(exponent) <= MOST)
        power = usual_exp(exponent)
        rest = other & negated(usual)
        if any_lane(rest):
            power = select(usual, power, pow_one_by_one(rest, x, y))
        result = select(other, power, result)
    return result


@intrinsic
def negated(context, mask):
    """No for yes, and yes for no."""
    return mask(mask), lambda context, builder, called, arguments: builder.not_(arguments[0])


@intrinsic
def in_all_lanes(context, x, like):
    """A number as one per lane of another's width."""

    def generate(context, builder, called, arguments):
        return context.cast(builder, arguments[0], called.args[0], called.return_type)

    return like(x, like), generate


@overload(math.exp, jit_options=OPTIONS)
def _exp(x):
    return (lambda x: lane_exp(x)) if isinstance(x, Floats) else None


@overload(math.log, jit_options=OPTIONS)
def _log(x):
    return (lambda x: lane_log(x)) if isinstance(x, Floats) else None


def whole_power(exponent: int) -> Callable[..., Any]:
    """A power with a known whole exponent, as products."""

    def power(x, y):
        result, square, rest = in_all_lanes(1.0, x), x, abs(exponent)
        while rest:
            if rest & 1:
                result = result * square
            rest >>= 1
            square = square * square
        return 1.0 / result if exponent < 0 else result

    return power


@overload(math.pow, jit_options=OPTIONS)
@overload(operator.pow, jit_options=OPTIONS, prefer_literal=True)
@overload(pow, jit_options=OPTIONS, prefer_literal=True)
def _pow(x, y):
    if isinstance(x, Floats) and isinstance(y, types.IntegerLiteral):
        return whole_power(y.literal_value)
    if isinstance(x, Floats) and isinstance(y, (types.Float, types.Integer, Floats)):
        return lambda x, y: lane_pow(x, in_all_lanes(y, x))
    if isinstance(x, types.Float) and isinstance(y, Floats):
        return lambda x, y: lane_pow(in_all_lanes(x, y), y)
    return None


def _left_to_the_library(name: str) -> None:
    """Let numba know a function of :mod:`math` of one number, calculated lane by lane."""
    call = one_by_one(name)

    @overload(getattr(math, name), jit_options=OPTIONS)
    def choose(x):
        return (lambda x: call(x == x, x) + unknown(x)) if isinstance(x, Floats) else None


@inline
def unknown(x):
    """Zero, and not a number where `x` is none."""
    return select(x == x, 0.0, x)


for _name in (
    *("sin", "cos", "tan", "asin", "acos", "atan"),
    *("sinh", "cosh", "tanh", "expm1", "log1p"),
):
    _left_to_the_library(_name)


def _as_in_math(of_numpy: Any, of_math: Any) -> None:
    """Let numba know a function of numpy that is one of :mod:`math`."""

    @overload(of_numpy, jit_options=OPTIONS)
    def choose(x):
        return (lambda x: of_math(x)) if isinstance(x, Floats) else None


for _name in ("exp", "log", "sqrt", "sin", "cos", "tan", "sinh", "cosh", "tanh", "expm1", "log1p"):
    _as_in_math(getattr(np, _name), getattr(math, _name))
for _name in ("sin", "cos", "tan"):
    _as_in_math(getattr(np, f"arc{_name}"), getattr(math, f"a{_name}"))
