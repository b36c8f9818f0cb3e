"""Call of a controller by its address, as composed modules have it.

What is called so is compiled once, by itself: its caller neither repeats its machine code nor
depends on its text.
"""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def call_at(typing_context, address, numbers, memory, signals, commands):
    """Call a function of four pointers, everything given as addresses."""

    def generate(context, builder, signature, arguments):
        pointer = context.get_value_type(types.voidptr)
        kind = ir.FunctionType(ir.VoidType(), [pointer] * 4)
        function = builder.inttoptr(arguments[0], ir.PointerType(kind))
        builder.call(function, [builder.inttoptr(one, pointer) for one in arguments[1:]])
        return context.get_dummy_value()

    return types.void(*[types.int64] * 5), generate
