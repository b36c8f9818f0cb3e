"""The source of a law's method, made ready to stand in a composed module.

A method may use its own numbers (``self.a``), its arguments, module-level numbers and functions,
``math`` and ``np``. Everything it uses is found, checked and carried along under a name that
belongs to its slot alone.
"""

from __future__ import annotations

import ast
import builtins
import copy
import dataclasses
import inspect
import math
import numbers
import types
from collections.abc import Callable
from typing import Any

import numpy as np

from saleg.compiler.imported_text import found_text
from saleg.compiler.slips import check_own, check_returns, check_shown, check_statements, shown
from saleg.compiler.strength_reduction import eased
from saleg.errors import LawError
from saleg.laws import arguments, choice
from saleg.laws.base import Law
from saleg.laws.contract import plain_function
from saleg.laws.earlier_names import ATTRIBUTES

ALLOWED_BUILTINS = frozenset(
    {"abs", "bool", "float", "int", "len", "max", "min", "pow", "range", "round"}
)


def is_ours(law: type[Law]) -> bool:
    """Whether a law is one of the library's, which do not change while it is imported."""
    return law.__module__.startswith("saleg.laws.")


def fingerprint(law: type[Law]) -> tuple[object, ...]:
    """All that the text of a law's methods depends on: code, defaults, helpers, constants."""
    seen: dict[types.FunctionType, None] = {}
    found: list[object] = []
    waiting: list[Any] = [getattr(law, name) for name in law.compiled]
    while waiting:
        value = waiting.pop()
        value = getattr(value, "py_func", value)
        if not isinstance(value, types.FunctionType):
            found.append(_literal(value) or id(value))
        elif value not in seen:
            seen[value] = None
            found.append(value.__code__)
            waiting += value.__defaults__ or ()
            waiting += [cell.cell_contents for cell in value.__closure__ or ()]
            waiting += _globals_named(value.__code__, value.__globals__)
    return tuple(found)


def _globals_named(code: types.CodeType, names: dict[str, Any]) -> list[Any]:
    """Values of globals that some code, or code inside it, names."""
    found = [names[name] for name in code.co_names if name in names]
    for item in code.co_consts:
        if isinstance(item, types.CodeType):
            found += _globals_named(item, names)
    return found


class Borrowed:
    """Collects the definitions a composed module needs for the methods of its laws.

    Parameters
    ----------
    prefix : str
        Put before every carried name.
    owner : str
        How errors call the method, for instance ``"MyLaw.force"``.
    wanted : function, optional
        The method of the base class, which says what it is shown and must return.
    """

    def __init__(self, prefix: str, owner: str, wanted: Callable[..., Any] | None = None):
        self.prefix = prefix
        self.owner = owner
        self.wanted = wanted
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
        function = plain_function(method, self.owner)
        tree = _parsed(function, self.owner)
        check_own(law, tree, self.owner)
        if self.wanted is None:
            check_returns(tree, self.owner, "")
        else:
            check_shown(tree, shown(self.wanted), self.owner)
            check_returns(tree, self.owner, str(self.wanted.__annotations__.get("return", "")))
        self._attributes = earlier_attributes(law)
        return self._prepared(tree, function, name, own=tree.args.args[0].arg)

    def _emit(self, tree: ast.FunctionDef) -> None:
        self.definitions.append("@inline\n" + ast.unparse(tree))

    def _prepared(
        self, tree: ast.FunctionDef, function: types.FunctionType, name: str, own: str | None = None
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
        tree.args.defaults = [
            self._resolve(argument.arg, value)  # as they were bound, whatever they are called now
            for argument, value in zip(
                tree.args.args[::-1], (function.__defaults__ or ())[::-1], strict=False
            )
        ][::-1]
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
                owner = f"{self.owner} calls '{name}', which"
                tree = _parsed(value, owner)
                check_returns(tree, owner)
                self._emit(self._prepared(tree, value, self._carried[value]))
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


def _parsed(function: types.FunctionType, owner: str) -> ast.FunctionDef:
    """A function's tree, checked; `owner` is how errors call it."""
    found = found_text(function).tree
    if found is None:
        raise LawError(f"{owner} must be written with 'def'")
    if found.args.posonlyargs or found.args.kwonlyargs or found.args.vararg or found.args.kwarg:
        raise LawError(f"{owner} must take plain arguments only")
    check_statements(found, owner)
    return copy.deepcopy(found)


def earlier_attributes(law: type[Law]) -> dict[str, str]:
    """Attributes of what laws are shown by their earlier names, but for those a law has itself."""
    own = {item.name for item in dataclasses.fields(law)}  # type: ignore[arg-type]
    return {earlier: name for earlier, name in ATTRIBUTES.items() if earlier not in own}


def _globals_used(
    tree: ast.FunctionDef, function: Callable[..., Any], owner: str
) -> dict[str, Any]:
    """Names a function takes from outside itself, with their values."""
    local = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
    for node in ast.walk(tree):  # those of a comprehension or a function inside among them
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            local.add(node.id)
        elif isinstance(node, ast.FunctionDef) and node is not tree:
            local.add(node.name)
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
    """All nodes of a function but its annotations, decorators and defaults."""
    waiting: list[ast.AST] = list(tree.body)
    found = []
    while waiting:
        node = waiting.pop()
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
    if value in (choice.where, choice.any_of):
        return str(value.__name__)
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
