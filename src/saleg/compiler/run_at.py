"""Call of the integrator by its address, as composed modules have it.

Only machine_code.py and this file know numba's inside. Where numba has changed, the composed module
has kernel/run_plainly.py in its place, and the integrator is compiled into its caller.
"""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def run_at(typing_context, address, run):
    """Call the integrator with a tuple of its arguments; returns its code."""
    given = list(run)

    def generate(context, builder, signature, arguments):
        kind = context.call_conv.get_function_type(types.int64, given)
        function = builder.inttoptr(arguments[0], ir.PointerType(kind))
        values = [builder.extract_value(arguments[1], n) for n in range(len(given))]
        _, code = context.call_conv.call_function(builder, function, types.int64, given, values)
        return code

    return types.int64(types.int64, run), generate
