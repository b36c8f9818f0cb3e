"""Identity of a sweep: values of objects, and a hash of the text of code that is not saleg's.

Two sweeps of the same identity have the same results, so that a folder can go on with one in
another process, and under another version of saleg.
"""

from __future__ import annotations

import dataclasses
import hashlib
import inspect
import sysconfig
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from saleg.compiler.imported_text import NoSource, block_of, content
from saleg.errors import SweepError

#: Methods a dataclass writes by itself, told by its fields.
WRITTEN = ("__init__", "__repr__", "__eq__", "__hash__", "__setattr__", "__delattr__")
#: Where code of others lies; its names will do.
INSTALLED = tuple(
    Path(sysconfig.get_path(name)).resolve() for name in ("stdlib", "purelib", "platlib")
)


def described(model: Any, name: str) -> dict[str, Any]:
    """Class, fields and, unless the class is saleg's, a hash of its code.

    Parameters
    ----------
    model : object
        A dataclass, or any object whose attributes are numbers, text, arrays, functions, or
        containers and objects of these.
    name : str
        What errors call it.

    Returns
    -------
    dict

    Raises
    ------
    SweepError
        If nothing would tell when the object changes.
    """
    try:
        return _object(model, name)
    except RecursionError:
        raise _unknown(name, model) from None


def own_code(node: Any, path: str = "") -> dict[str, str]:
    """Hashes of the classes in a tree of dataclasses that are not saleg's, by their paths."""
    found = {} if _is_ours(type(node)) else {path: code_hash(type(node), path)}
    for item in dataclasses.fields(node):
        value = getattr(node, item.name)
        if dataclasses.is_dataclass(value):
            found |= own_code(value, f"{path}.{item.name}".lstrip("."))
    return found


def code_hash(code: type | types.FunctionType, name: str) -> str:
    """Hash of a class or function and of all they use that is no installed package's."""
    return hashlib.sha256("\n".join(sorted(set(_texts(code, name, {})))).encode()).hexdigest()


def _object(model: Any, name: str) -> dict[str, Any]:
    kind = type(model)
    if dataclasses.is_dataclass(kind):
        held = {item.name: getattr(model, item.name) for item in dataclasses.fields(kind)}
    elif hasattr(model, "__dict__"):
        held = dict(vars(model))
    else:
        raise _unknown(name, model)
    fields = {key: _value(value, f"{name}.{key}") for key, value in held.items()}
    found: dict[str, Any] = {"model": kind.__qualname__, "fields": fields}
    return found if _is_ours(kind) else {**found, "code": code_hash(kind, name)}


def _value(value: Any, name: str) -> Any:
    """A value as plain data."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, (bool, int, float, complex, str, bytes)):
        return repr(value)
    if isinstance(value, (tuple, list)):
        return [_value(item, f"{name}[{n}]") for n, item in enumerate(value)]
    if isinstance(value, (set, frozenset)):
        return sorted(repr(_value(item, f"{name}{{}}")) for item in value)
    if isinstance(value, dict):
        return {repr(key): _value(item, f"{name}[{key!r}]") for key, item in value.items()}
    if isinstance(value, np.ndarray) and value.dtype != object:
        digest = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        return f"{value.dtype}{value.shape} {digest}"
    if isinstance(value, (type, types.FunctionType)):
        return code_hash(value, name)
    if isinstance(value, (types.ModuleType, types.BuiltinFunctionType, np.ufunc)):
        return value.__name__
    return _object(value, name)


def _unknown(name: str, value: Any) -> SweepError:
    return SweepError(
        f"{name} is a {type(value).__name__}: a folder could not tell when it changes; make it a "
        "dataclass of numbers, text and arrays, or work without a folder"
    )


def _texts(value: Any, name: str, seen: dict[int, Any]) -> Iterator[str]:
    """Texts of code and of all it uses, in any order; of what is no code, its value."""
    value = getattr(value, "py_func", value)
    if id(value) in seen:
        return
    seen[id(value)] = value
    if not isinstance(value, (type, types.FunctionType)):
        yield f"{name} = {_value(value, name)}"
    elif not _is_own(value):
        yield f"{value.__module__}.{value.__qualname__}"
    elif isinstance(value, type):
        for base in value.__mro__[1:]:
            yield from _texts(base, name, seen)
        for key, member in _members(value):
            yield from _texts(member, f"{name}.{key}", seen)
    else:
        yield _text(value)
        for used, part in _used(value):
            yield from _texts(part, f"'{used}' in {name}", seen)


def _members(kind: type) -> Iterator[tuple[str, Any]]:
    """Methods, properties and values of a class itself, but for what a dataclass writes."""
    for key, value in vars(kind).items():
        code = getattr(value, "__code__", None)
        is_written = code is None or code.co_filename == "<string>"
        if key.startswith("__") and not callable(value):
            continue
        if dataclasses.is_dataclass(kind) and key in WRITTEN and is_written:
            continue
        value = getattr(value, "fget", None) or getattr(value, "func", None) or value
        value = getattr(value, "__func__", value)
        if not isinstance(value, (types.MemberDescriptorType, types.GetSetDescriptorType)):
            yield key, value


def _used(function: types.FunctionType) -> Iterator[tuple[str, Any]]:
    """Globals and outer variables a function names."""
    waiting = [function.__code__]
    while waiting:
        code = waiting.pop()
        waiting += [item for item in code.co_consts if isinstance(item, types.CodeType)]
        for name in code.co_names:
            if name in function.__globals__:
                yield name, function.__globals__[name]
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        if name != "__class__":
            yield name, cell.cell_contents


def _text(function: types.FunctionType) -> str:
    """Text of a function; what its code does where that was typed in, or edited since."""
    try:
        return block_of(function)
    except NoSource:
        return repr(content(function.__code__))


def _is_ours(code: Any) -> bool:
    return str(code.__module__).partition(".")[0] == "saleg"


def _is_own(code: Any) -> bool:
    """Whether code is the user's: neither saleg's nor that of an installed package."""
    if _is_ours(code) or code.__module__ == "builtins":
        return False
    try:
        file = Path(inspect.getfile(code)).resolve()
    except (OSError, TypeError):
        return True
    return not any(file.is_relative_to(place) for place in INSTALLED)
