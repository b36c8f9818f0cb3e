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

from saleg.compiler import definitions, machine_code
from saleg.compiler.cache import Kept, usable_folder, warn_of_no_cache
from saleg.errors import LawError
from saleg.files.atomic import write_text
from saleg.files.lock import locked

_numbers = itertools.count()

#: What the text of a kernel without laws finds defined.
DECLARED = "DECLARED"


class Loaded(NamedTuple):
    """A module that has been executed.

    Attributes
    ----------
    module : module
    kept : Kept or None
        Where its text and machine code are; None if nothing is kept.
    """

    module: types.ModuleType
    kept: Kept | None


def load(
    text: str, kind: str, names: dict[str, Any] | None = None, *, keeps: bool = True
) -> Loaded:
    """Execute the text of a module; a second process finds its machine code by the text.

    Parameters
    ----------
    text : str
        Finds in ``ON_DISK`` whether its machine code is to be kept, in ``ENTRY`` the compiler of
        entry points, and in ``INNER`` that of other functions.
    kind : str
        What it is of, for its name.
    names : dict, optional
        What the text finds defined.
    keeps : bool
        Whether text and machine code are kept in the cache folder, under a hash of the text.

    Warns
    -----
    RuntimeWarning
        If they cannot be kept, or what is kept cannot be trusted; all goes on in memory.
    """
    folder = usable_folder() if keeps else None
    if folder is not None:
        try:
            return _load_kept(text, kind, folder, names or {})
        except OSError as error:
            warn_of_no_cache(f"{folder}: {error.strerror or error}")
    number = next(_numbers)
    stem, filename = f"saleg_{kind}_{number}", f"<saleg {kind} {number}>"
    return Loaded(_execute(text, stem, filename, {**(names or {}), "ON_DISK": False}), None)


def _load_kept(text: str, kind: str, folder: Path, names: dict[str, Any]) -> Loaded:
    """Execute a module from the cache folder; what is damaged there is made afresh."""
    path = _free(folder / f"saleg_{kind}_{digest(text)}.py")
    with locked(path.with_suffix(".lock")):
        if not path.is_file() or path.read_bytes() != text.encode():
            write_text(path, text, mode=0o600)
        kept = Kept(path, machine_code.folder_of(path))
        kept.check()
        names = {**names, "ON_DISK": True}
        module = kept.mended(lambda: _execute(text, path.stem, str(path), names))
        return Loaded(module, kept)


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
    compilers = {"INNER": machine_code.inner_compiler(), "ENTRY": machine_code.entry_compiler()}
    module.__dict__.update(names or {}, **compilers)
    sys.modules[stem] = module
    if DECLARED in (names or {}):
        definitions.execute(text, module)
    else:
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
