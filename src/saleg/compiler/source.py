"""The source of a law's method, made ready to stand in a composed module.

A method may use its own numbers (``self.a``), its arguments, module-level numbers and functions,
``math`` and ``np``. Everything it uses is found, checked and carried along under a name that
belongs to its slot alone.
"""

from __future__ import annotations

import ast
import builtins
import dataclasses
import inspect
import math
import numbers
import textwrap
import types
from collections.abc import Callable
from typing import Any

import numpy as np

from saleg.compiler.strength_reduction import eased
from saleg.errors import LawError
from saleg.laws import arguments
from saleg.laws.base import Law
from saleg.laws.earlier_names import ATTRIBUTES

ALLOWED_BUILTINS = frozenset(
    {"abs", "bool", "float", "int", "len", "max", "min", "pow", "range", "round"}
)


class NoSource(Exception):
    """The text of a method cannot be had (it was typed into a plain interpreter)."""


def is_ours(law: type[Law]) -> bool:
    """Whether a law is one of the library's, which do not change while it is imported."""
    return law.__module__.startswith("saleg.laws.")


def fingerprint(law: type[Law]) -> tuple[object, ...]:
    """All that the text of a law's methods depends on: code, helpers, constants."""
    seen: dict[types.FunctionType, None] = {}
    found: list[object] = []
    waiting: list[Any] = [getattr(law, name) for name in law.compiled]
    while waiting:
        function = waiting.pop()
        if not isinstance(function, types.FunctionType) or function in seen:
            continue
        seen[function] = None
        found.append(function.__code__)
        cells = [cell.cell_contents for cell in function.__closure__ or ()]
        names = [name for name in function.__code__.co_names if name in function.__globals__]
        for value in [*cells, *(function.__globals__[name] for name in names)]:
            value = getattr(value, "py_func", value)
            if isinstance(value, types.FunctionType):
                waiting.append(value)
            else:
                found.append(_literal(value) or id(value))
    return tuple(found)


class Borrowed:
    """Collects the definitions a composed module needs for the methods of its laws.

    Parameters
    ----------
    prefix : str
        Put before every carried name.
    owner : str
        How errors call the method, for instance ``"MyLaw.force"``.
    """

    def __init__(self, prefix: str, owner: str):
        self.prefix = prefix
        self.owner = owner
        self.definitions: list[str] = []
        self._carried: dict[object, str] = {}
        self._numbers: dict[str, float] = {}
        self._attributes: dict[str, str] = {}

    def add_method(self, law: type[Law], method: Callable[..., Any], name: str) -> None:
        """Add a method of a law as a function `name` whose first argument is the law's record."""
        self._emit(self._method(law, method, name))

    def add_eased_method(self, law: type[Law], method: Callable[..., Any], name: str) -> None:
        """Add a method with its formula eased, and the function of its constants."""
        for part in eased(self._method(law, method, name), self._numbers):
            self._emit(part)

    def _method(self, law: type[Law], method: Callable[..., Any], name: str) -> ast.FunctionDef:
        """A method checked and prepared."""
        tree = _parse(method)
        _check_self(law, tree, self.owner)
        self._attributes = earlier_attributes(law)
        return self._prepared(tree, method, name, own=tree.args.args[0].arg)

    def _emit(self, tree: ast.FunctionDef) -> None:
        self.definitions.append("@inline\n" + ast.unparse(tree))

    def _prepared(
        self, tree: ast.FunctionDef, function: Callable[..., Any], name: str, own: str | None = None
    ) -> ast.FunctionDef:
        """A function under another name, with all it uses carried along.

        `own` is the name a method has for its law, whose attributes are never renamed.
        """
        renames = {
            used: self._resolve(used, value)
            for used, value in _globals_used(tree, function, self.owner).items()
        }
        tree = _Renamer(renames, ATTRIBUTES if own else self._attributes, own).visit(tree)
        tree.name = name
        tree.returns = None
        tree.decorator_list = []
        for argument in (*tree.args.posonlyargs, *tree.args.args, *tree.args.kwonlyargs):
            argument.annotation = None
        plain: ast.FunctionDef = _Unannotated().visit(tree)
        return ast.fix_missing_locations(plain)

    def _resolve(self, name: str, value: Any) -> ast.expr:
        """Expression that stands for a global the method uses."""
        known = _library_name(name, value)
        if known is not None:
            return ast.parse(known, mode="eval").body
        value = getattr(value, "py_func", value)  # a function somebody has jitted already
        if isinstance(value, types.FunctionType):
            if value not in self._carried:
                self._carried[value] = self._new_name(value.__name__)
                self._emit(self._prepared(_parse(value), value, self._carried[value]))
            return ast.Name(self._carried[value], ast.Load())
        literal = _literal(value)
        if literal is None:
            raise LawError(
                f"{self.owner} uses '{name}', a {type(value).__name__}; a law may use only "
                "numbers, tuples of numbers, module-level functions, math and np"
            )
        # By name and value: constants of one name from two modules must not mix.
        if (name, literal) not in self._carried:
            self._carried[name, literal] = self._new_name(name)
            if isinstance(value, numbers.Real):
                self._numbers[self._carried[name, literal]] = float(value)
            self.definitions.append(f"{self._carried[name, literal]} = {literal}")
        return ast.Name(self._carried[name, literal], ast.Load())

    def _new_name(self, name: str) -> str:
        """Name under which something is carried; no two things share one."""
        taken = set(self._carried.values())
        carried, count = f"{self.prefix}{name}", 1
        while carried in taken:
            count += 1
            carried = f"{self.prefix}{name}_{count}"
        return carried


class _Unannotated(ast.NodeTransformer):
    """Annotated assignments become plain ones; bare annotations vanish."""

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST | None:
        if node.value is None:
            return None
        return ast.Assign([node.target], node.value)


class _Renamer(ast.NodeTransformer):
    """Gives the globals a function uses, and attributes with an earlier name, their names here."""

    def __init__(
        self, renames: dict[str, ast.expr], attributes: dict[str, str], own: str | None = None
    ):
        self.renames = renames
        self.attributes = attributes
        self.own = own

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return self.renames.get(node.id, node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        if isinstance(node.value, ast.Name) and node.value.id == self.own:
            return node
        self.generic_visit(node)
        node.attr = self.attributes.get(node.attr, node.attr)
        return node


def _parse(function: Callable[..., Any]) -> ast.FunctionDef:
    try:
        text = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError) as error:
        raise NoSource(str(error)) from None
    tree = ast.parse(text).body[0]
    if not isinstance(tree, ast.FunctionDef):
        raise LawError(f"{function.__qualname__} must be written with 'def'")
    if tree.args.posonlyargs or tree.args.kwonlyargs or tree.args.vararg or tree.args.kwarg:
        raise LawError(f"{function.__qualname__} must take plain arguments only")
    return tree


def _check_self(law: type[Law], tree: ast.FunctionDef, owner: str) -> None:
    """A law's record holds its numbers only: refuse anything else asked of ``self``."""
    fields = {item.name for item in dataclasses.fields(law)}  # type: ignore[arg-type]
    own = tree.args.args[0].arg
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)):
            continue
        if node.value.id == own and node.attr not in fields:
            what = "calls its method" if callable(getattr(law, node.attr, None)) else "uses"
            raise LawError(
                f"{owner} {what} '{own}.{node.attr}'; compiled, a law has only its own numbers "
                f"({', '.join(sorted(fields)) or 'none'}): use a module-level function"
            )


def earlier_attributes(law: type[Law]) -> dict[str, str]:
    """Attributes of what laws are shown by their earlier names, but for those a law has itself."""
    own = {item.name for item in dataclasses.fields(law)}  # type: ignore[arg-type]
    return {earlier: name for earlier, name in ATTRIBUTES.items() if earlier not in own}


def _globals_used(
    tree: ast.FunctionDef, function: Callable[..., Any], owner: str
) -> dict[str, Any]:
    """Names a function takes from outside itself, with their values."""
    local = set(function.__code__.co_varnames) | set(function.__code__.co_cellvars)
    for node in ast.walk(tree):  # a comprehension's own variables
        if isinstance(node, ast.comprehension):
            local |= {item.id for item in ast.walk(node.target) if isinstance(item, ast.Name)}
    closure = inspect.getclosurevars(function)
    used = {}
    for node in _body_nodes(tree):
        if not isinstance(node, ast.Name) or node.id in local:
            continue
        if node.id in closure.nonlocals:
            used[node.id] = closure.nonlocals[node.id]
        elif node.id in function.__globals__:
            used[node.id] = function.__globals__[node.id]
        elif hasattr(builtins, node.id):
            if node.id not in ALLOWED_BUILTINS:
                raise LawError(f"{owner} uses the built-in '{node.id}', which a law may not")
        else:
            raise LawError(f"{owner} uses '{node.id}', which is not defined")
    return used


def _body_nodes(tree: ast.FunctionDef) -> list[ast.AST]:
    """All nodes of a function but its annotations and decorators."""
    waiting: list[ast.AST | None] = [*tree.body, *tree.args.defaults, *tree.args.kw_defaults]
    found = []
    while waiting:
        node = waiting.pop()
        if node is None:
            continue
        found.append(node)
        children = list(ast.iter_child_nodes(node))
        if isinstance(node, ast.AnnAssign):
            children.remove(node.annotation)
        waiting += children
    return found


def _library_name(name: str, value: Any) -> str | None:
    """``math``, ``np``, a function or constant of theirs, or what laws are shown, by its name."""
    if value is math or value is np:
        return "math" if value is math else "np"
    if isinstance(value, type) and value.__module__ == arguments.__name__:
        return value.__name__
    if callable(value):
        for module, prefix in ((math, "math"), (np, "np")):
            own = getattr(value, "__name__", name)
            if getattr(module, own, None) is value:
                return f"{prefix}.{own}"
    return None


def _literal(value: Any) -> str | None:
    """A number or tuple of numbers as source text."""
    if isinstance(value, tuple):
        items = [_literal(item) for item in value]
        if not items or any(item is None for item in items):
            return None
        return "(" + ", ".join(str(item) for item in items) + ",)"
    if isinstance(value, (bool, np.bool_)):
        return repr(bool(value))
    if isinstance(value, numbers.Integral):
        return repr(int(value))
    if isinstance(value, numbers.Real):
        number = float(value)
        if math.isfinite(number):
            return repr(number)
        return "math.nan" if math.isnan(number) else f"{'-' if number < 0 else ''}math.inf"
    return None
