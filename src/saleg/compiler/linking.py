"""The two halves of an integrator: a kernel that knows no law, and the laws linked into it.

What laws take and return is known beforehand, so numba can type and lower the kernel without them.
What comes out is hardly optimised and serves all laws. Those of an engine are lowered by themselves
and linked into it, and all is optimised as one: the machine code is as if they had stood in the
kernel's text.

This is numba's inside: :mod:`~saleg.compiler.machine_code` asks whether all of it is there.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from llvmlite import binding, ir
from numba import from_dtype, types
from numba.core import cgutils
from numba.core.compiler_lock import global_compiler_lock
from numba.extending import intrinsic

from saleg.compiler.inner_functions import InnerLibrary
from saleg.kernel import slots

#: What the numbers of the laws are to the kernel: a record it does not look into.
NUMBERS = from_dtype(np.dtype([("nothing", np.float64)]))
#: What the names of laws begin with where the halves meet, and the name of the kernel there.
PREFIX = "saleg_law_"
ENTRY = "saleg_kernel"


def signature_of(slot: str, names: Mapping[str, Any], numbers: Any = NUMBERS) -> Any:
    """Numba's types of what a slot takes and returns.

    Parameters
    ----------
    slot : str
        Name of its function in :mod:`saleg.kernel.slots`.
    names : mapping
        Where the named tuples of :mod:`saleg.laws.arguments` are found, by their names.
    numbers : numba type
        Record of the numbers of all laws.
    """
    kinds = {"float": types.float64, "int": types.int64, "Any": numbers}

    def kind_of(annotation: Any) -> Any:
        text = getattr(annotation, "__name__", "") or str(annotation)
        text = str(annotation) if "[" in str(annotation) else text
        if text.startswith("tuple["):
            return types.UniTuple(types.float64, text.count("float"))
        name = text.removesuffix(" | None").rpartition(".")[2]
        if name in kinds:
            return kinds[name]
        return types.NamedUniTuple(types.float64, len(names[name]._fields), names[name])

    found = {name: kind_of(kind) for name, kind in getattr(slots, slot).__annotations__.items()}
    return found.pop("return")(*found.values())


def declared(slot: str, names: Mapping[str, Any]) -> Any:
    """A slot whose law is not known yet, as the kernel calls it."""
    wanted = signature_of(slot, names)

    def call(typing_context: Any, *given: Any) -> Any:
        return wanted.return_type(*given), generate

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        values = [
            _cast(context, builder, *item)
            for item in zip(arguments, signature.args, wanted.args, strict=True)
        ]
        kind = context.call_conv.get_function_type(wanted.return_type, wanted.args)
        function = cgutils.get_or_insert_function(builder.module, kind, PREFIX + slot)
        return _called(context, builder, function, wanted, values)

    parameters = list(inspect.signature(call).parameters.values())[:1]
    parameters += inspect.signature(getattr(slots, slot)).parameters.values()
    plain = [one.replace(default=inspect.Parameter.empty) for one in parameters]
    call.__signature__ = inspect.Signature(plain)  # type: ignore[attr-defined]
    return intrinsic(call)


def _called(context: Any, builder: Any, function: Any, signature: Any, values: Any) -> Any:
    """Call a function as numba calls its own; a failure is handed on."""
    kind, convention = signature.return_type, context.call_conv
    status, value = convention.call_function(builder, function, kind, signature.args, values)
    with cgutils.if_unlikely(builder, status.is_error):
        convention.return_status_propagate(builder, status)
    return value


def _cast(context: Any, builder: Any, value: Any, given: Any, wanted: Any) -> Any:
    """A number as a number of another type; a tuple, named or not, number by number."""
    if isinstance(wanted, (types.Number, types.Record)):
        return context.cast(builder, value, given, wanted)
    parts = zip(cgutils.unpack_tuple(builder, value), given, wanted, strict=True)
    items = [context.cast(builder, *part) for part in parts]
    return context.make_tuple(builder, wanted, items)


def without_laws(run: Any) -> Any:
    """Type of the integrator's arguments as the kernel takes them, of those for certain laws."""
    fields = zip(run.fields, run.types, strict=True)
    kinds = [kind.copy(dtype=NUMBERS) if name == "laws" else kind for name, kind in fields]
    return types.NamedTuple(kinds, run.instance_class)


def lowered(kernel: Any, run: Any) -> bytes:
    """The kernel without laws as LLVM's bitcode, for arguments of some type."""
    kernel.compile((run,))
    found = kernel.overloads[(run,)]
    with global_compiler_lock:
        module = found.library._get_module_for_linking().clone()
    # All but the entry is its own affair: two kernels in one process share no function, and numba
    # looks for no environment of a module that is not there next time.
    for item in (*module.functions, *module.global_variables):
        if not item.is_declaration:
            item.linkage = "internal"
    entry = module.get_function(found.fndesc.llvm_func_name)
    entry.name, entry.linkage = ENTRY, "external"
    _simplify(module, found.library._codegen._pass_builder())
    bitcode: bytes = module.as_bitcode()
    return bitcode


def _simplify(module: Any, builder: Any) -> None:
    """Keep numbers in registers instead of memory, once for all laws; half as much is left."""
    passes = binding.create_new_module_pass_manager()
    passes.add_sroa_pass()
    passes.add_instruction_combine_pass()
    passes.add_simplify_cfg_pass()
    passes.run(module, builder)


def linked(names: Mapping[str, Any], bitcode_for: Callable[[Any], bytes]) -> Any:
    """The integrator made of a kernel without laws and those of a module.

    Parameters
    ----------
    names : mapping
        Of the module of the laws, with a function for each slot.
    bitcode_for : function
        Gives the kernel for arguments of some type.
    """

    def integrate(typing_context: Any, run: Any) -> Any:
        bitcode = bitcode_for(without_laws(run))
        numbers = run.types[run.fields.index("laws")].dtype
        laws = {}
        for slot in _slots_called(bitcode):
            wanted = signature_of(slot, names, numbers)
            function = typing_context.resolve_value_type(names[slot])
            found = typing_context.resolve_function_type(function, wanted.args, {})
            laws[slot] = function, found, wanted

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            library = _library(context, bitcode, laws)
            kind = context.call_conv.get_function_type(signature.return_type, signature.args)
            function = cgutils.get_or_insert_function(builder.module, kind, ENTRY)
            code = _called(context, builder, function, signature, arguments)
            context.add_linking_libs([library])
            return code

        return types.int64(run), generate

    return intrinsic(integrate)


def _slots_called(bitcode: bytes) -> list[str]:
    """Slots a kernel calls."""
    functions = binding.parse_bitcode(bitcode).functions
    return [one.name.removeprefix(PREFIX) for one in functions if one.name.startswith(PREFIX)]


def _library(context: Any, bitcode: bytes, laws: Mapping[str, Any]) -> InnerLibrary:
    """A kernel and its laws, linked; outside of it nothing is seen but the kernel's entry."""
    library = InnerLibrary(context.codegen(), ENTRY)
    module = library.create_ir_module("laws")
    with context.push_code_library(library):
        for slot, law in laws.items():
            _define(context, module, slot, *law)
    library.add_llvm_module(binding.parse_bitcode(bitcode))
    library.add_ir_module(module)
    for function in library._get_module_for_linking().functions:
        if function.name.startswith(PREFIX):
            function.linkage = "internal"
    return library


def _define(
    context: Any, module: ir.Module, slot: str, function: Any, found: Any, wanted: Any
) -> None:
    """Define what the kernel calls for a slot: it calls the law."""
    convention = context.call_conv
    kernel_side = wanted.replace(args=(NUMBERS, *wanted.args[1:]))
    kind = convention.get_function_type(kernel_side.return_type, kernel_side.args)
    outer = ir.Function(module, kind, PREFIX + slot)
    outer.attributes.add("alwaysinline")
    builder = ir.IRBuilder(outer.append_basic_block("entry"))
    packer = convention._get_arg_packer(kernel_side.args)
    numbers, *values = packer.from_arguments(builder, convention.get_arguments(outer))
    numbers = builder.bitcast(numbers, context.get_value_type(wanted.args[0]))
    value = context.get_function(function, found)(builder, [numbers, *values])
    value = _cast(context, builder, value, found.return_type, wanted.return_type)
    convention.return_value(builder, value)
