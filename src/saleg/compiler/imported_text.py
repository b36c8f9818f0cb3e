"""The text of a function as it was imported.

A file can be edited, and a module reloaded, after a function was made: the lines at its place are
then another function's, or another state of its own. So a text counts only if it compiles to the
very code the function runs.
"""

from __future__ import annotations
import __future__

import ast
import inspect
import linecache
import types
import warnings
from collections.abc import Iterator
from functools import lru_cache
from tokenize import TokenError
from typing import Any, NamedTuple

from saleg.errors import SalegWarning

#: Of a function's flags, those a compiler takes: what its file imported from ``__future__``.
FUTURE = ~inspect.CO_NESTED & sum(
    getattr(__future__, name).compiler_flag for name in __future__.all_feature_names
)
#: A notebook's cell may await.
AWAIT = ast.PyCF_ALLOW_TOP_LEVEL_AWAIT


class NoSource(Exception):
    """The text of a function cannot be had: it was typed into a plain interpreter, or edited.

    Attributes
    ----------
    is_edited : bool
        Whether there is a text, but of other code.
    """

    def __init__(self, function: types.FunctionType, is_edited: bool):
        code = function.__code__
        place = f"{function.__qualname__} ({code.co_filename}, line {code.co_firstlineno})"
        why = "is not the code that was imported" if is_edited else "cannot be had"
        super().__init__(f"the text of {place} {why}")
        self.is_edited = is_edited


class Found(NamedTuple):
    """Where the text of a function stands.

    Attributes
    ----------
    lines : list of str
        The whole file.
    first : int
        Line the function begins on, decorators included, from 1.
    tree : ast.FunctionDef or None
        The function, not to be changed; None for a lambda.
    """

    lines: list[str]
    first: int
    tree: ast.FunctionDef | None


def found_text(function: types.FunctionType) -> Found:
    """Text of a function.

    Raises
    ------
    NoSource
        If no text of its file is that of its code.
    """
    wanted = content(function.__code__)
    is_edited = False
    for lines in _texts(function):
        is_edited = is_edited or bool(lines)
        found = _search("".join(lines), function.__code__, wanted)
        if found is not None:
            return Found(lines, *found)
    raise NoSource(function, is_edited)


def block_of(function: types.FunctionType) -> str:
    """Lines of a function, decorators and comments included.

    Raises
    ------
    NoSource
    """
    found = found_text(function)
    try:
        return "".join(inspect.getblock(found.lines[found.first - 1 :]))
    except (TokenError, SyntaxError):  # a lambda in the middle of an expression
        raise NoSource(function, is_edited=False) from None


def warn_if_edited(error: NoSource) -> None:
    """Say that the code of a law that was imported runs, not the text in its file.

    Warns
    -----
    SalegWarning
    """
    if error.is_edited:
        warnings.warn(
            f"{error}; what was imported runs, compiled anew in every process: reload its module, "
            "and make the law anew, to run the text as it stands",
            SalegWarning,
            stacklevel=2,
        )


def content(code: types.CodeType) -> tuple[Any, ...]:
    """What a piece of code does, wherever it stands: equal if and only if the code is."""
    return (
        code.co_name,
        code.co_code,
        code.co_exceptiontable,
        code.co_flags,
        (code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount),
        (code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars),
        tuple(map(_constant, code.co_consts)),
    )


def _constant(value: Any) -> Any:
    """A constant of some code, told from those it equals (1, 1.0 and True; 0.0 and -0.0)."""
    if isinstance(value, types.CodeType):
        return content(value)
    if isinstance(value, tuple):
        return tuple(map(_constant, value))
    if isinstance(value, frozenset):
        return tuple(sorted(map(repr, value)))
    return repr(value)


def _texts(function: types.FunctionType) -> Iterator[list[str]]:
    """Lines the file of a function may have had: as Python remembers them, and as they are now."""
    file = function.__code__.co_filename
    yield linecache.getlines(file, function.__globals__)
    linecache.checkcache(file)
    yield linecache.getlines(file, function.__globals__)
    try:
        yield inspect.findsource(function.__code__)[0]  # knows what was typed, from Python 3.13 on
    except (OSError, TypeError, IndexError):
        return


def _search(
    text: str, code: types.CodeType, wanted: tuple[Any, ...]
) -> tuple[int, ast.FunctionDef | None] | None:
    """First line and tree of a function in a text; of several that are alike, the nearest."""
    flags = code.co_flags & FUTURE
    for parts in (_parts(text, flags, False), _parts(text, flags, True)):
        alike = [part for part in parts.get(code.co_name, ()) if content(part) == wanted]
        if alike:
            best = min(
                alike,
                key=lambda part: (
                    part.co_qualname != code.co_qualname,
                    abs(part.co_firstlineno - code.co_firstlineno),
                ),
            )
            return best.co_firstlineno, _trees(text, flags).get((best.co_firstlineno, best.co_name))
    return None


@lru_cache(maxsize=128)
def _parts(text: str, flags: int, each: bool) -> dict[str, list[types.CodeType]]:
    """All code in a text by name.

    A file is compiled as a whole, a notebook's cell (`each`) statement by statement: calls of what
    is imported beside them are other code then.
    """
    tree = _tree(text, flags)
    modules = [ast.Module([node], []) for node in tree.body] if each else [tree]
    try:
        waiting = [
            compile(module, "<text>", "exec", flags | AWAIT, dont_inherit=True)
            for module in modules
        ]
    except SyntaxError:  # found only as code is made: a 'return' outside a function
        return {}
    parts: dict[str, list[types.CodeType]] = {}
    while waiting:
        code = waiting.pop()
        parts.setdefault(code.co_name, []).append(code)
        waiting += [item for item in code.co_consts if isinstance(item, types.CodeType)]
    return parts


@lru_cache(maxsize=128)
def _trees(text: str, flags: int) -> dict[tuple[int, str], ast.FunctionDef]:
    """Functions in a text by first line, decorators included, and name."""
    return {
        (min([node.lineno, *(item.lineno for item in node.decorator_list)]), node.name): node
        for node in ast.walk(_tree(text, flags))
        if isinstance(node, ast.FunctionDef)
    }


@lru_cache(maxsize=128)
def _tree(text: str, flags: int) -> ast.Module:
    """Tree of a text; an empty one of a text that is none, half edited for instance."""
    try:
        kind = flags | AWAIT | ast.PyCF_ONLY_AST
        tree: ast.Module = compile(text, "<text>", "exec", kind, dont_inherit=True)
    except (SyntaxError, ValueError):
        return ast.Module([], [])
    return tree
