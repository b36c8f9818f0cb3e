"""Which method of a law numba cannot compile: each by itself, where all together have failed."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

import numpy as np

from saleg.compiler import machine_code
from saleg.compiler.module import load
from saleg.compiler.records import Lengths, record_of_kind
from saleg.compiler.slips import shown
from saleg.compiler.slot_text import methods_text
from saleg.compiler.text import CHOICE, COMPILED_HEADER, own_text
from saleg.laws.base import Law
from saleg.laws.control.base import MEMORY

#: A law class with the lengths of its series.
Kind = tuple[type[Law], Lengths]


def diagnosed(laws: Sequence[Kind], error: Exception) -> str:
    """Law, method and reason of an error of numba's.

    Parameters
    ----------
    laws : sequence of Kind
        Those that are not the library's.
    error : Exception
        What it said of all together.
    """
    for law, lengths in laws:
        base: Any = next(base for base in law.__mro__ if "slot" in vars(base))
        for method in base.compiled:
            why = _trouble(law, lengths, method, base)
            if why:
                return f"{law.__name__}.{method} {why}"
    names = ", ".join(law.__name__ for law, _ in laws)
    which = "one of the laws" if len(laws) > 1 else "the law"
    return f"{which} {names} cannot be compiled: {_reason(error)}"


def _trouble(law: Any, lengths: Lengths, method: str, base: type[Law]) -> str:
    """What is wrong with one method; empty if nothing is."""
    injected: dict[str, Any] = {}
    definitions = methods_text(law, method, "one", base, injected)
    parts = ["import math", "import numba", "import numpy as np", COMPILED_HEADER, CHOICE]
    parts += [own_text("laws/arguments.py"), *definitions]
    module = load("\n".join(parts), "diagnosis", injected, keeps=False).module
    function = getattr(module, f"one_{method}")
    arguments = [np.zeros(1, record_of_kind(law, lengths))[0], *_shown(getattr(base, method))]
    try:
        machine_code.compile_for(function, machine_code.types_of(arguments))
    except machine_code.refusals() as error:
        return f"cannot be compiled: {_reason(error)}"
    (signature,) = function.nopython_signatures
    wanted = getattr(base, method).__annotations__.get("return")
    if wanted == "float" and not hasattr(signature.return_type, "bitwidth"):
        return f"returns {signature.return_type}; it must return a number"
    return ""


def _shown(wanted: Any) -> list[Any]:
    """Arguments of the types the kernel calls a method of a base class with."""
    found: list[Any] = []
    names = list(inspect.signature(wanted).parameters)[1:]
    for name, kind in zip(names, shown(wanted)[1:], strict=True):
        if kind is not None:
            found.append(kind(*[0.0] * len(kind._fields)))
        else:  # a part of a controller remembers an array
            found.append(np.zeros(MEMORY) if wanted.__annotations__[name] == "Any" else 0.0)
    return found


def _reason(error: Exception) -> str:
    """What numba says of the cause, without the chain of what it was doing."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    telling = [line for line in lines if not line.startswith(("Failed in", "During", "File", "<"))]
    return " ".join(telling[:2]) if telling else str(error)
