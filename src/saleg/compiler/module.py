"""From the text of a module to a module: hashed, kept in the cache folder, executed."""

from __future__ import annotations

import hashlib
import inspect
import itertools
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from saleg.errors import LawError
from saleg.files.atomic import write_text
from saleg.files.lock import locked

_numbers = itertools.count()


class Loaded(NamedTuple):
    """A module that has been executed.

    Attributes
    ----------
    module : module
    lock : Path or None
        File that serialises compilation among processes; None if nothing is kept.
    """

    module: types.ModuleType
    lock: Path | None


def load(text: str, kind: str, folder: Path | None, names: dict[str, Any] | None = None) -> Loaded:
    """Execute the text of a module; a second process finds its machine code by the text.

    Parameters
    ----------
    text : str
    kind : str
        What it is of, for its name.
    folder : Path or None
        Where text and machine code are kept, under a hash of the text; None keeps nothing.
    names : dict, optional
        What the text finds defined.
    """
    if folder is None:
        number = next(_numbers)
        stem, filename = f"saleg_{kind}_{number}", f"<saleg {kind} {number}>"
        return Loaded(_execute(text, stem, filename, names), None)
    path = _free(folder / f"saleg_{kind}_{digest(text)}.py")
    lock = path.with_suffix(".lock")
    with locked(lock):
        if not path.is_file() or path.read_bytes() != text.encode():
            write_text(path, text, mode=0o600)
        return Loaded(_execute(text, path.stem, str(path), names), lock)


def _free(path: Path) -> Path:
    """A path, or one beside it if somebody has put a folder there or in place of its lock."""
    while path.is_dir() or path.with_suffix(".lock").is_dir():
        path = path.with_stem(f"{path.stem}_")
    return path


def digest(text: str) -> str:
    """Name of a text for this numba and this processor."""
    import llvmlite.binding
    import numba

    machine = f"{numba.__version__} {np.__version__} {llvmlite.binding.get_host_cpu_name()}"
    return hashlib.sha256(f"{machine}\n{text}".encode()).hexdigest()[:24]


def _execute(text: str, stem: str, filename: str, names: dict[str, Any] | None) -> types.ModuleType:
    """Run a text as a module; nothing but this very text is executed, whatever the file holds."""
    module = types.ModuleType(stem)
    module.__file__ = filename
    module.__dict__.update(names or {})
    sys.modules[stem] = module
    exec(compile(text, filename, "exec"), module.__dict__)
    return module


def without_source(
    function: Callable[..., Any], attributes: dict[str, str], seen: dict[int, Any] | None = None
) -> Any:
    """Compile a function from its bytecode, with those it uses, some attributes renamed."""
    import numba

    seen = {} if seen is None else seen
    if id(function) in seen:
        if seen[id(function)] is None:
            raise LawError(f"{function.__qualname__} calls itself; write it as a loop")
        return seen[id(function)]
    seen[id(function)] = None  # under way

    def compiled(value: Any) -> Any:
        is_function = isinstance(value, types.FunctionType)
        return without_source(value, attributes, seen) if is_function else value

    names = {
        name: compiled(value) for name, value in inspect.getclosurevars(function).globals.items()
    }
    cells = tuple(
        types.CellType(compiled(cell.cell_contents)) for cell in function.__closure__ or ()
    )
    code = function.__code__
    code = code.replace(co_names=tuple(attributes.get(name, name) for name in code.co_names))
    copy = types.FunctionType(code, names, function.__name__, function.__defaults__, cells)
    seen[id(function)] = numba.njit(forceinline=True, error_model="numpy", nogil=True)(copy)
    return seen[id(function)]
