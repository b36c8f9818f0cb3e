"""How the inner functions of a composed module are compiled: as parts of their entry point.

Numba optimises every function by itself with all it calls, and makes machine code of it, before it
does so again for each of its callers. Of the functions of a composed module only the entry points
are ever called from outside: the others are handed on as they are, and optimised and turned into
machine code once, with the entry point they end in. Together with the passes left out that spares
a third of the time to compile, at the same speed of what comes out.

This is numba's inside: :mod:`~saleg.compiler.machine_code` asks whether all of it is there.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from types import CodeType, SimpleNamespace
from typing import Any

from llvmlite.binding import Linkage
from numba.core import typed_passes, types, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags

#: Passes for what laws and kernel do not have: contexts, functions to be inlined before their types
#: are known, loops over tuples of mixed types, expressions of whole arrays, parallel loops; what
#: frees objects that nobody counts; comments.
NEEDLESS = frozenset(
    {
        untyped_passes.WithLifting,
        untyped_passes.InlineInlinables,
        untyped_passes.FindLiterallyCalls,
        untyped_passes.LiteralUnroll,
        untyped_passes.LiteralPropagationSubPipelinePass,
        typed_passes.NopythonRewrites,
        typed_passes.IRLegalization,
        typed_passes.AnnotateTypes,
        typed_passes.DumpParforDiagnostics,
    }
)
#: What functions within a function need beside.
FOR_CLOSURES = untyped_passes.InlineClosureLikes


class InnerLibrary(JITCodeLibrary):
    """Code of an inner function: handed on as it is, no machine code of its own.

    What it calls is linked to it once its entry point asks for it, not into each of its callers.
    """

    def finalize(self) -> None:
        """Nothing is linked and nothing optimised yet."""
        self._raise_if_finalized()
        self._finalize_final_module()

    def _get_module_for_linking(self) -> Any:
        """Module of the function and all it calls, callers first: else unused ones are dropped."""
        self._ensure_finalized()
        if self._shared_module is None:
            self._shared_module = self._final_module.clone()
            for library in self._all_called({self}):
                inner = isinstance(library, InnerLibrary)
                module = library._final_module if inner else library._get_module_for_linking()
                self._shared_module.link_in(module, preserve=True)
            for function in self._shared_module.functions:
                if not function.is_declaration and function.linkage == Linkage.external:
                    function.linkage = "linkonce_odr"
        return self._shared_module

    def _all_called(self, seen: set[Any]) -> Iterator[Any]:
        """Libraries of all functions called from here, and by those."""
        for library in self._linking_libraries:
            if library not in seen:
                seen.add(library)
                yield library
                if isinstance(library, InnerLibrary):
                    yield from library._all_called(seen)

    @property
    def codegen(self) -> Any:
        """What numba asks to fill in the address of the environment, which is not there."""
        return _NoEnvironment()

    def get_pointer_to_function(self, name: str) -> int:
        """No address: there is no machine code."""
        return 0

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _NoEnvironment:
    """Takes the environment of a function, which only its machine code would need."""

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing."""


class QuickFlags(Flags):
    """Flags compared by those that are set; numba compares all of them at every operation."""

    def __eq__(self, other: object) -> bool:
        return type(other) is QuickFlags and self._values == other._values

    def __hash__(self) -> int:
        return hash(tuple(self._values))


class QuickArguments(tuple[Any, ...]):
    """Types of arguments; numba writes them out, records and all, for every pass."""

    def __str__(self) -> str:
        return f"{len(self)} arguments"


class QuickTyping:
    """Typing of calls that remembers builtin functions by what they are called with.

    Numba tries all it knows of an operator anew every time it meets one.

    Parameters
    ----------
    context : numba's typing context
        All else is left to it.
    """

    def __init__(self, context: Any):
        self._context = context
        self._known: dict[Any, Any] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_function_type(self, function: Any, arguments: Any, named: Any) -> Any:
        """Signature of a call."""
        if named or not isinstance(function, types.Function):
            return self._context.resolve_function_type(function, arguments, named)
        call = function, tuple(arguments)
        if call not in self._known:
            self._known[call] = self._context.resolve_function_type(function, arguments, named)
        return self._known[call]


@lru_cache(maxsize=4)
def quick_typing(context: Any) -> QuickTyping:
    """The same typing context, with what it knows of calls."""
    return QuickTyping(context)


class InnerCompiler(CompilerBase):
    """Compiler of an inner function."""

    def __init__(self, *arguments: Any):
        super().__init__(*arguments)
        state = self.state
        state.typingctx = quick_typing(state.typingctx)
        state.args = QuickArguments(state.args)
        state.flags = QuickFlags(state.flags)

    def define_pipelines(self) -> list[Any]:
        """Passes of numba's own, but for the needless ones."""
        state = self.state
        if state.library is None:
            state.library = InnerLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        has_closures = any(isinstance(one, CodeType) for one in state.func_id.code.co_consts)
        return [quick_passes(state.flags, has_closures)]


@lru_cache(maxsize=16)
def quick_passes(flags: QuickFlags, has_closures: bool) -> Any:
    """Passes of numba's own for functions compiled with some flags, but for the needless ones."""
    passes = DefaultPassBuilder.define_nopython_pipeline(SimpleNamespace(func_ir=None, flags=flags))
    needless = NEEDLESS if has_closures else NEEDLESS | {FOR_CLOSURES}
    passes.passes = [item for item in passes.passes if item[0] not in needless]
    return passes


class EntryLibrary(JITCodeLibrary):
    """Code of an entry point: optimised once.

    Numba does so twice, at first to bring counts of references together; there are none.
    """

    def _optimize_final_module(self) -> None:
        manager, builder = self._codegen._module_pass_manager()
        manager.run(self._final_module, builder)


class EntryCompiler(CompilerBase):
    """Compiler of an entry point."""

    def define_pipelines(self) -> list[Any]:
        """Passes of numba's own."""
        state = self.state
        if state.library is None:
            state.library = EntryLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
        return [DefaultPassBuilder.define_nopython_pipeline(state)]
