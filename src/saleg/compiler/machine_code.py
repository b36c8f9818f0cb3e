"""What saleg knows of numba's inside.

It stands here, in ``run_at.py``, ``inner_functions.py``, ``linking.py`` and ``lanes`` only.

Numba promises none of it. Each is a short cut with a longer way round, taken by itself where numba
has changed:

- compiling before the first call, so that one process at a time does; else the call compiles;
- an entry point called without finding out the types of its arguments, which spares a twentieth of
  a millisecond; else numba's dispatcher is called;
- a function's address, so that the search for steady states is compiled once for all laws; else it
  is compiled into every kernel (:mod:`~saleg.compiler.search`);
- inner functions without machine code of their own; else each has its own, in half as much time
  again (:mod:`~saleg.compiler.inner_functions`);
- a kernel lowered without laws, and laws linked into it (:mod:`~saleg.compiler.linking`); else the
  laws are written into the kernel's text, which is lowered anew for every choice of them;
- numba's own imports without scipy's BLAS; else a start takes a quarter of a second longer;
- the folder numba keeps machine code in, to be looked at before anything is loaded; else none is
  kept.
"""

from __future__ import annotations

import pkgutil
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from typing import Any

#: What a call by address takes: here for the address, in ``run_at.py`` for the call.
ADDRESS_NEEDS = (
    "numba.core.compiler:CompileResult.library",
    "numba.core.compiler:CompileResult.fndesc",
    "numba.core.funcdesc:FunctionDescriptor.llvm_func_name",
    "numba.core.codegen:JITCodeLibrary.get_pointer_to_function",
    "numba.core.callconv:CPUCallConv.get_function_type",
    "numba.core.callconv:CPUCallConv.call_function",
)

#: What :mod:`~saleg.compiler.inner_functions` takes.
INNER_NEEDS = (
    "llvmlite.binding:Linkage.external",
    "numba.core.codegen:JITCodeLibrary._ensure_finalized",
    "numba.core.codegen:JITCodeLibrary._get_module_for_linking",
    "numba.core.codegen:JITCodeLibrary._raise_if_finalized",
    "numba.core.codegen:JITCodeLibrary._optimize_final_module",
    "numba.core.codegen:JITCodeLibrary._optimize_functions",
    "numba.core.codegen:JITCodeLibrary._finalize_final_module",
    "numba.core.codegen:JITCodeLibrary._finalize_dynamic_globals",
    "numba.core.codegen:JITCodeLibrary.enable_object_caching",
    "numba.core.codegen:JITCPUCodegen._module_pass_manager",
    "numba.core.compiler:CompilerBase.define_pipelines",
    "numba.core.compiler:DefaultPassBuilder.define_nopython_pipeline",
    "numba.core.compiler:Flags.values",
    "numba.core.types:Function",
    "numba.core.typing.context:BaseContext.resolve_function_type",
    "numba.core.typed_passes:AnnotateTypes",
    "numba.core.typed_passes:DumpParforDiagnostics",
    "numba.core.typed_passes:IRLegalization",
    "numba.core.typed_passes:NopythonRewrites",
    "numba.core.untyped_passes:FindLiterallyCalls",
    "numba.core.untyped_passes:InlineClosureLikes",
    "numba.core.untyped_passes:InlineInlinables",
    "numba.core.untyped_passes:LiteralPropagationSubPipelinePass",
    "numba.core.untyped_passes:LiteralUnroll",
    "numba.core.untyped_passes:WithLifting",
)

#: What :mod:`~saleg.compiler.linking` takes beside.
LINKING_NEEDS = (
    *INNER_NEEDS,
    *ADDRESS_NEEDS,
    "llvmlite.binding:create_new_module_pass_manager",
    "llvmlite.binding.newpassmanagers:ModulePassManager.add_instruction_combine_pass",
    "llvmlite.binding.newpassmanagers:ModulePassManager.add_simplify_cfg_pass",
    "llvmlite.binding.newpassmanagers:ModulePassManager.add_sroa_pass",
    "numba.core.base:BaseContext.add_linking_libs",
    "numba.core.base:BaseContext.get_function",
    "numba.core.base:BaseContext.make_tuple",
    "numba.core.base:BaseContext.push_code_library",
    "numba.core.callconv:CPUCallConv._get_arg_packer",
    "numba.core.callconv:CPUCallConv.return_status_propagate",
    "numba.core.cgutils:get_or_insert_function",
    "numba.core.codegen:JITCodeLibrary.add_ir_module",
    "numba.core.codegen:JITCodeLibrary.add_llvm_module",
    "numba.core.codegen:JITCodeLibrary.create_ir_module",
    "numba.core.codegen:JITCPUCodegen._pass_builder",
    "numba.core.compiler_lock:global_compiler_lock",
    "numba.core.types:NamedUniTuple",
)

#: Numba's types of some arguments.
Types = tuple[Any, ...]

_importing = threading.Lock()


def types_of(arguments: Sequence[Any]) -> Types:
    """Numba's types of some arguments."""
    from numba import typeof

    return tuple(typeof(argument) for argument in arguments)


def refusals() -> tuple[type[Exception], ...]:
    """Errors with which numba says that it cannot compile something."""
    from numba.core.errors import NumbaError, UnsupportedBytecodeError

    return NumbaError, UnsupportedBytecodeError


def inner_compiler() -> Any:
    """Compiler of inner functions; None, which stands for numba's own, where numba has changed."""
    if not _all_exist(INNER_NEEDS):
        return None
    from saleg.compiler.inner_functions import InnerCompiler

    return InnerCompiler


def entry_compiler() -> Any:
    """Compiler of entry points; None, which stands for numba's own, where numba has changed."""
    if not _all_exist(INNER_NEEDS):
        return None
    from saleg.compiler.inner_functions import EntryCompiler

    return EntryCompiler


def has_halves() -> bool:
    """Whether a kernel without laws can be lowered with this numba, and laws linked into it."""
    return _all_exist(LINKING_NEEDS)


def declared(slot: str, names: Mapping[str, Any]) -> Any:
    """A slot of a kernel without laws."""
    from saleg.compiler import linking

    return linking.declared(slot, names)


def linked(names: Mapping[str, Any], bitcode_for: Callable[[Any], bytes]) -> Any:
    """The integrator made of a kernel without laws and those of a module."""
    from saleg.compiler import linking

    return linking.linked(names, bitcode_for)


def lowered(kernel: Any, run: Any) -> bytes:
    """A kernel without laws as LLVM's bitcode, for arguments of some type."""
    from saleg.compiler import linking

    return linking.lowered(kernel, run)


def is_compiled(function: Any, types: Types) -> bool:
    """Whether a function is known to be compiled for arguments of some types."""
    return _result(function, types) is not None


def folder_of(path: Path) -> Path:
    """Folder where the machine code of a file is kept, made if need be.

    Raises
    ------
    PermissionError
        If there is no place for it.
    """
    import numba

    names: dict[str, Any] = {}
    exec(compile("def probe(): pass", str(path), "exec"), names)
    try:
        return Path(str(numba.njit(cache=True)(names["probe"]).stats.cache_path))
    except (RuntimeError, AttributeError) as error:
        raise PermissionError(str(error)) from None


def is_on_disk(function: Any, path: Path, folder: Path) -> bool:
    """Whether a folder of machine code seems to hold that of a function of a file."""
    return any(folder.glob(f"{path.stem}.{function.__name__}-*.nbi"))


def compile_for(function: Any, types: Types) -> None:
    """Compile a function for arguments of some types, or load its machine code."""
    compile_now = getattr(function, "compile", None)
    if compile_now is not None:
        import_arrays()
        compile_now(types)


def import_arrays() -> None:
    """Import what numba has for arrays, but for the BLAS of scipy, which no kernel calls.

    Numba asks whether it is there by importing it: a quarter of a second. A law that calls it makes
    numba ask again.
    """
    with _importing:
        if "numba.np.arraymath" in sys.modules or not _exists("numba.np.linalg:ensure_blas"):
            return
        from numba.np import linalg

        asked, linalg.ensure_blas = linalg.ensure_blas, lambda: None
        try:
            import_module("numba.np.arraymath")
        finally:
            linalg.ensure_blas = asked


def entry_point(function: Any, types: Types) -> Callable[..., Any]:
    """A function for arguments of these types only, which it does not check."""
    entry: Callable[..., Any] = getattr(_result(function, types), "entry_point", function)
    return entry


def has_addresses() -> bool:
    """Whether compiled functions can be called by their addresses with this numba."""
    return _all_exist(ADDRESS_NEEDS)


def address(function: Any, types: Types) -> int:
    """Address of a compiled function; 0 where there are no addresses."""
    if not has_addresses():
        return 0
    result = _result(function, types)
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))


def _result(function: Any, types: Types) -> Any:
    """What numba knows of a function compiled for some types; None if nothing."""
    return getattr(function, "overloads", {}).get(types)


@lru_cache(maxsize=8)
def _all_exist(names: tuple[str, ...]) -> bool:
    return all(map(_exists, names))


def _exists(name: str) -> bool:
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return False
    return True
