"""Kernels: the entry points of a composed module, compiled when first called."""

from __future__ import annotations

import logging
import signal
import types
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import Any

from saleg.compiler import machine_code
from saleg.compiler.cache import Kept
from saleg.compiler.diagnosis import Kind, diagnosed
from saleg.errors import LawError
from saleg.files.lock import locked
from saleg.files.signals import held_off

log = logging.getLogger(__name__)
#: What is logged before something is compiled that is not on disk.
COMPILING = "compiling the equations for this choice of laws: once, up to 20 s"


class Kernel:
    """Compiled kernel for one choice of laws.

    Parameters
    ----------
    module : module
        The composed module.
    kept : Kept or None
        Where its text and machine code are on disk; None if nothing is kept.
    laws : sequence of Kind
        Each class in it that is not the library's, for errors.
    """

    def __init__(self, module: types.ModuleType, kept: Kept | None, laws: Sequence[Kind] = ()):
        self.module = module
        self._kept = kept
        self._laws = laws
        # An entry point is always called with the same types: what they are is found out once.
        self._entries: dict[str, Callable[..., Any]] = {}
        self._addresses: dict[str, int] = {}

    def function(self, name: str) -> Callable[..., Any]:
        """An entry point for arguments of any types."""
        function: Callable[..., Any] = getattr(self.module, name)
        return function

    def call(self, name: str, *arguments: Any) -> Any:
        """Call an entry point; the first call compiles it, one process at a time."""
        entry = self._entries.get(name)
        if entry is None:
            function, kinds = self._compiled(name, arguments)
            entry = self._entries[name] = machine_code.entry_point(function, kinds)
        return entry(*arguments)

    def address(self, name: str, arguments: tuple[Any, ...]) -> int:
        """Address of an entry point for arguments of these types, compiled if need be."""
        if name not in self._addresses:
            self._addresses[name] = machine_code.address(*self._compiled(name, arguments))
        return self._addresses[name]

    def is_kept(self, name: str) -> bool:
        """Whether machine code of an entry point is there: in this process, or on disk."""
        if name in self._entries or name in self._addresses:
            return True
        return self._kept is not None and self._kept.has_code(name)

    def _compiled(
        self, name: str, arguments: tuple[Any, ...]
    ) -> tuple[Callable[..., Any], machine_code.Types]:
        """An entry point, compiled for arguments of these types, and the types."""
        function, kinds = self.function(name), machine_code.types_of(arguments)
        if not machine_code.is_compiled(function, kinds):
            # The compiler calls back into Python and swallows the exit that SIGTERM asks for there.
            held = held_off(signal.SIGTERM)
            with held, locked(self._kept.lock) if self._kept else nullcontext():
                self._compile(function, kinds)
        return function, kinds

    def _compile(self, function: Callable[..., Any], kinds: machine_code.Types) -> None:
        """Compile an entry point or load it; what is damaged on disk is compiled afresh."""

        def compile_now() -> None:
            machine_code.compile_for(function, kinds)

        kept = self._kept
        if kept is None or not machine_code.is_on_disk(function, kept.path, kept.code):
            log.info(COMPILING)
        try:
            if self._kept is None:
                compile_now()
            else:
                self._kept.mended(compile_now)
        except machine_code.refusals() as error:
            raise LawError(diagnosed(self._laws, error)) from error
