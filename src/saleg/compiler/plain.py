"""The kernel without compilation, for debuggers and coverage: ``NUMBA_DISABLE_JIT=1``.

So it runs too where the package is installed without its source.

Nothing is composed. The modules of :mod:`saleg.kernel` run as they stand in their files, and a law
is the method its author wrote, so that a breakpoint in either is met. Some thousand times slower.
"""

from __future__ import annotations

import pkgutil
import types
import warnings
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np

from saleg import columns
from saleg.compiler.kernel import Kernel
from saleg.compiler.records import OTHER_SLOTS
from saleg.compiler.text import own_text
from saleg.kernel import layout
from saleg.kernel.decide import decide
from saleg.kernel.sampled import sample
from saleg.kernel.tuples import Control, Sampling
from saleg.laws import Law
from saleg.laws.arguments import Instant, Signals
from saleg.laws.base import CHAMBER_SLOTS
from saleg.laws.choice import any_of, where

#: What sets up a run, as text.
COLUMNS = (
    "laws/arguments.py",
    "kernel/copies.py",
    "kernel/logarithms.py",
    "kernel/layout.py",
    "kernel/state.py",
    "kernel/slots.py",
    "kernel/needs.py",
    "kernel/flow.py",
    "kernel/breathing.py",
    "kernel/rhs.py",
    "kernel/events.py",
    "kernel/charges.py",
)


def is_wanted() -> bool:
    """Whether nothing can be compiled, or numba is told to compile nothing."""
    import numba

    config: Any = numba.config
    return bool(config.DISABLE_JIT) or not _has_source()


@lru_cache
def _has_source() -> bool:
    """Whether the text of the kernel is there; said once if it is not."""
    try:
        return bool(pkgutil.get_data("saleg", "kernel/rhs.py"))
    except OSError:
        warnings.warn(
            "saleg is installed without its source (.py), so nothing is compiled and all takes "
            "some thousand times longer",
            RuntimeWarning,
            stacklevel=2,
        )
        return False


class PlainKernel(Kernel):
    """Modules of the kernel as Python.

    Parameters
    ----------
    modules : sequence of str
        Their names.
    """

    def __init__(self, modules: Sequence[str]):
        joined = types.ModuleType("saleg.kernel (plain)")
        for name in modules:
            joined.__dict__.update(vars(import_module(f"saleg.kernel.{name}")))
        super().__init__(joined, None)

    def function(self, name: str) -> Callable[..., Any]:
        """An entry point for arguments of any types."""
        return partial(self.call, name)

    def call(self, name: str, *arguments: Any) -> Any:
        """Call an entry point; like compiled code it is silent on overflow."""
        with np.errstate(all="ignore"):
            return getattr(self.module, name)(*map(_with_fields, arguments))

    def address(self, name: str, arguments: tuple[Any, ...]) -> int:
        """No address: in Python the kernel calls its functions by name."""
        return 0


@lru_cache(maxsize=8)
def plain_kernel(modules: tuple[str, ...]) -> PlainKernel:
    """Kernel of some modules."""
    return PlainKernel(modules)


@lru_cache(maxsize=1)
def on_columns() -> SimpleNamespace:
    """Functions of the kernel, by name, that take columns in the place of numbers.

    The same text as everywhere; only the elementary functions are those of
    :mod:`saleg.columns`.
    """
    names: dict[str, Any] = {"__name__": "saleg.kernel (columns)"}
    names |= dict.fromkeys(("inline", "compiled", "cached"), lambda function: function)
    names |= {"any_of": any_of, "where": where}
    for name in COLUMNS:
        exec(compile(own_text(name), name, "exec"), names)
    names |= {name: getattr(columns, name) for name in ("exp", "log", "sin")}
    return SimpleNamespace(**names)


def plain_laws(laws: Sequence[Law]) -> list[SimpleNamespace]:
    """Laws in the place of their numbers: left, right, engine, actuators, converter."""
    n = len(CHAMBER_SLOTS)
    left, right = (dict(zip(CHAMBER_SLOTS, laws[i : i + n], strict=True)) for i in (0, n))
    rest = dict(zip(OTHER_SLOTS, laws[2 * n :], strict=True))
    return [SimpleNamespace(left=SimpleNamespace(**left), right=SimpleNamespace(**right), **rest)]


def plain_function(controller: Any, room: Control) -> Callable[..., None]:
    """What stands in the place of the address of a controller's function."""

    def entry(*_addresses: int) -> None:
        memory = room.memory.reshape(layout.CONTROL_PARTS, layout.MEMORY)
        room.commands[0] = decide(controller, memory, Signals(*room.signals[0].tolist()))

    return entry


def plain_sample(controller: Any, room: Sampling) -> Callable[..., None]:
    """What stands in the place of the address of its parts that act at samples."""

    def entry(*_addresses: int) -> None:
        memory = room.memory.reshape(layout.SAMPLED_PARTS, layout.SAMPLE_MEMORY)
        room.wanted[0] = sample(controller, memory, Instant(*room.instant[0].tolist()))

    return entry


class _Fields(np.void):  # type: ignore[misc]
    """A record with its fields as attributes.

    ``np.recarray`` will not do: its fields that are arrays cannot be written to, and one named
    ``T`` is taken for a transpose.
    """

    def __getattribute__(self, name: str) -> Any:
        try:
            return self[name]
        except ValueError:
            return super().__getattribute__(name)

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value


def _with_fields(argument: Any) -> Any:
    """An argument whose records have their fields as attributes, as in compiled code."""
    if isinstance(argument, tuple):
        items = map(_with_fields, argument)
        return argument._make(items) if hasattr(argument, "_make") else tuple(items)
    if isinstance(argument, np.ndarray) and argument.dtype.names:
        return argument.view(np.dtype((_Fields, argument.dtype)))
    return argument
