"""Definitions that composed modules of one process have in common, executed and compiled once.

Two choices of laws share most of their text. Numba keeps what it has typed and lowered with the
function object, so a module takes over the functions, classes and constants of an earlier one that
would come out the same: those whose text, and that of all they use, is the same to the letter.
Entry points are always a module's own, for their machine code is kept under its name.

Only kernels without laws (:mod:`~saleg.compiler.linking`) are composed so: what is kept of them
names no module, where numba would look for an earlier one in the next process; and a law's function
compiled for one record would serve another that begins alike.

A module-level statement that only changes what another defines is executed for each module, on the
shared object too, and a name that stands in a text is not seen: the kernel has neither.
"""

from __future__ import annotations

import ast
import dis
import hashlib
import threading
from collections.abc import Iterable, Iterator
from types import CodeType, ModuleType
from typing import Any

#: The mark of entry points (:mod:`saleg.kernel.jit`).
ENTRY_MARK = "cached"

_lock = threading.Lock()
_known: dict[str, Any] = {}
#: Modules that are not in `_known` yet: a process that needs no second one is spared the parsing.
_waiting: list[tuple[str, ModuleType, frozenset[str]]] = []
#: What modules were given: it is told apart by identity, so none of it may make room for another.
_given: list[Any] = []


def execute(text: str, module: ModuleType) -> None:
    """Execute the text of a module, but for what an earlier module has.

    Parameters
    ----------
    text : str
    module : module
        Its file is named in tracebacks; what stands in it is found by the text.
    """
    given = frozenset(name for name in vars(module) if not name.startswith("__"))
    # One at a time: of each definition there is one object, to which all that use it refer.
    with _lock:
        if _known or _waiting:
            _remember_waiting()
            _execute_new(text, module, given)
        else:
            exec(compile(text, str(module.__file__), "exec"), vars(module))
        _waiting.append((text, module, given))


def _execute_new(text: str, module: ModuleType, given: Iterable[str]) -> None:
    """Execute statement by statement what is not known."""
    tree = ast.parse(text)
    digests = _digests(tree, text, {name: vars(module)[name] for name in given})
    for statement in tree.body:
        code = compile(ast.Module([statement], []), str(module.__file__), "exec")
        names = _defined(code)
        found = [digests.get(name, "") for name in names]
        if found and all(one in _known for one in found):
            vars(module).update((name, _known[one]) for name, one in zip(names, found, strict=True))
        else:
            exec(code, vars(module))


def _remember_waiting() -> None:
    """Put what executed modules define among what is known."""
    while _waiting:
        text, module, given = _waiting.pop()
        names = {name: vars(module)[name] for name in given}
        for name, digest in _digests(ast.parse(text), text, names).items():
            _known.setdefault(digest, vars(module)[name])


def _digests(tree: ast.Module, text: str, given: dict[str, Any]) -> dict[str, str]:
    """Digest of each name's definitions and of all they use; none of what is a module's own."""
    lines = text.splitlines()
    own: dict[str, str] = {}
    used: dict[str, set[str]] = {}
    classes = {one.name for one in tree.body if isinstance(one, ast.ClassDef)}
    for statement in tree.body:
        code = compile(ast.Module([statement], []), "", "exec")
        uses = set(_used(code))
        uses |= classes if "globals" in uses else set()
        for name in _defined(code):
            own[name] = own.get(name, "") + _source(statement, lines)
            used.setdefault(name, set()).update(uses)
    _given.extend(given.values())
    own |= {name: str(id(value)) for name, value in given.items() if name not in own}
    closures = {name: sorted(_closure(name, own, used)) for name in used}
    return {
        name: _hash([name, *(part for one in closure for part in (one, own[one]))])
        for name, closure in closures.items()
        if ENTRY_MARK not in closure or name == ENTRY_MARK
    }


def _hash(parts: list[str]) -> str:
    """Digest of some texts."""
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def _used(code: CodeType) -> Iterator[str]:
    """Names of a module that some code may use; those of attributes are among them."""
    yield from code.co_names
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _used(inner)


def _closure(name: str, own: dict[str, str], used: dict[str, set[str]]) -> set[str]:
    """A name and all names its definitions use, and so on."""
    found, waiting = {name}, [name]
    while waiting:
        more = {one for one in used.get(waiting.pop(), ()) if one in own} - found
        found |= more
        waiting += more
    return found


def _source(statement: ast.stmt, lines: list[str]) -> str:
    """Text of a statement, with its decorators."""
    decorators: list[ast.expr] = getattr(statement, "decorator_list", [])
    first = min([statement.lineno, *(one.lineno for one in decorators)])
    return "\n".join(lines[first - 1 : statement.end_lineno])


def _defined(code: CodeType) -> list[str]:
    """Names a statement of a module defines."""
    found = [one.argval for one in dis.get_instructions(code) if one.opname == "STORE_NAME"]
    return list(dict.fromkeys(found))
