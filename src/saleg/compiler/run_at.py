"""Call of the integrator by its address, as the composed search for fixed points has it.

Only machine_code.py and this file know numba's inside. Where numba has changed,
kernel/run_plainly.py stands in its place, and the integrator is compiled into its caller. The
integrator's own arguments hold a record of laws where the caller's hold numbers: to the machine
both are an array's address.
"""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def run_at(typing_context, address, run):
    """Call the integrator with its arguments; returns its code."""

    def generate(context, builder, signature, arguments):
        kind = context.call_conv.get_function_type(types.int64, [run])
        function = builder.inttoptr(arguments[0], ir.PointerType(kind))
        _, code = context.call_conv.call_function(
            builder, function, types.int64, [run], [arguments[1]]
        )
        return code

    return types.int64(types.int64, run), generate
