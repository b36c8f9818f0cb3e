"""What the text of a law must not hold, each refused by law, method and name."""

from __future__ import annotations

import ast
import dataclasses
import inspect
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from saleg.errors import LawError, nearest
from saleg.laws import arguments
from saleg.laws.base import Law

#: Statements of no use in a formula, and what they do.
REFUSED = {
    ast.Import: "imports a module inside; import it at the top of the file",
    ast.ImportFrom: "imports a name inside; import it at the top of the file",
    ast.Global: "declares a name global; a law changes nothing outside it",
    ast.Nonlocal: "declares a name nonlocal; a law changes nothing outside it",
    ast.Yield: "yields; a law returns",
    ast.YieldFrom: "yields; a law returns",
    ast.Try: "tries; compiled code has no errors to catch: ask before with 'if'",
    ast.TryStar: "tries; compiled code has no errors to catch: ask before with 'if'",
    ast.NamedExpr: "names a value within an expression (':='); assign it on a line before",
    ast.Delete: "deletes a name; leave it, or use another name",
    ast.Dict: "uses a dictionary; a law has numbers only: choose with 'if'",
    ast.DictComp: "uses a dictionary; a law has numbers only: choose with 'if'",
    ast.Set: "uses a set; write a tuple, as in (1.0, 2.0)",
    ast.SetComp: "uses a set; write a tuple, as in (1.0, 2.0)",
    ast.ListComp: "uses a list; write a tuple, as in (1.0, 2.0)",
    ast.GeneratorExp: "loops within an expression; write the loop",
    ast.With: "opens a context; a law may not",
    ast.ClassDef: "defines a class inside; a law may not",
}
#: Where text may stand: it is no value there.
TEXT_MAY_STAND = (ast.Raise, ast.Assert)


def check_statements(tree: ast.FunctionDef, owner: str) -> None:
    """Refuse statements that cannot be compiled, in a method or in a function it calls.

    Parameters
    ----------
    tree : ast.FunctionDef
    owner : str
        How errors call it.
    """
    for node in _value_nodes(tree):
        why = REFUSED.get(type(node))
        if why is not None:
            names = getattr(node, "names", ())
            what = ", ".join(getattr(item, "name", item) for item in names)
            raise LawError(f"{owner} {why}{f': {what}' if what else ''}")
        if isinstance(node, ast.List) and isinstance(node.ctx, ast.Load):
            raise LawError(f"{owner} uses a list; write a tuple, as in (1.0, 2.0)")
        if isinstance(node, ast.Starred) and not isinstance(node.ctx, ast.Load):
            raise LawError(f"{owner} gathers values with '*'; name each of them")
        if "random" in (getattr(node, "attr", ""), getattr(node, "id", "")):
            raise LawError(f"{owner} draws random numbers; a law gives one number for one state")
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            raise LawError(
                f"{owner} assigns to '{ast.unparse(node)}'; a law keeps nothing between two calls: "
                "use a local name"
            )
        if isinstance(node, ast.JoinedStr) or (
            isinstance(node, ast.Constant) and isinstance(node.value, (str, bytes))
        ):
            raise LawError(f"{owner} uses the text {ast.unparse(node)}; a law has numbers only")


def check_returns(tree: ast.FunctionDef, owner: str, kind: str | None = None) -> None:
    """Refuse a method that may end without a value, or returns a tuple where a number is wanted.

    Parameters
    ----------
    tree : ast.FunctionDef
    owner : str
        How errors call it.
    kind : str, optional
        What a method must return, as its base class has it; not given for a function it calls,
        which may return nothing at all.
    """
    values = [node.value for node in ast.walk(tree) if isinstance(node, ast.Return)]
    if kind is None and all(map(_is_nothing, values)):
        return
    if _goes_on(tree.body) or any(map(_is_nothing, values)):
        raise LawError(
            f"{owner} returns nothing where a branch ends without 'return'; every branch must "
            "return a value"
        )
    for value in values:
        if kind == "float" and isinstance(value, (ast.Tuple, ast.List, ast.Dict, ast.Set)):
            what = type(value).__name__.lower()
            raise LawError(f"{owner} returns a {what}, {ast.unparse(value)}; it must be a number")


def check_own(law: type[Law], tree: ast.FunctionDef, owner: str) -> None:
    """A law's record holds its numbers only: refuse anything else asked of ``self``."""
    fields = {item.name for item in dataclasses.fields(law)}  # type: ignore[arg-type]
    fields.update(law.derived)
    own = tree.args.args[0].arg
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and not isinstance(node.ctx, ast.Load):
            held = node.value
            if isinstance(held, ast.Attribute) and _is_name(held.value, own):
                raise LawError(f"{owner} assigns to '{ast.unparse(node)}', which cannot change")
        if not (isinstance(node, ast.Attribute) and _is_name(node.value, own)):
            continue
        if node.attr not in fields:
            what = "calls its method" if callable(getattr(law, node.attr, None)) else "uses"
            raise LawError(
                f"{owner} {what} '{own}.{node.attr}'; compiled, a law has only its own numbers "
                f"({', '.join(sorted(fields)) or 'none'}): use a module-level function"
            )


def check_shown(tree: ast.FunctionDef, kinds: Sequence[Any], owner: str) -> None:
    """Refuse attributes that what a law is shown does not have.

    Parameters
    ----------
    tree : ast.FunctionDef
    kinds : sequence of type or None
        Class of each argument, as :func:`shown` has it.
    owner : str
    """
    known = dict(zip([item.arg for item in tree.args.args], kinds, strict=False))
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            known.pop(node.id, None)
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)):
            continue
        kind = known.get(node.value.id)
        if kind is not None and not hasattr(kind, node.attr):
            raise LawError(
                f"{owner} uses '{node.value.id}.{node.attr}', which is not there; "
                f"{kind.__name__} has {', '.join(kind._fields)}{nearest(node.attr, kind._fields)}"
            )


def shown(method: Callable[..., Any]) -> list[Any]:
    """Class of each argument of a method of a base class; None for ``self`` and for numbers."""
    wanted = inspect.signature(method).parameters.values()
    return [getattr(arguments, str(item.annotation), None) for item in wanted]


def _value_nodes(tree: ast.FunctionDef) -> Iterator[ast.AST]:
    """Nodes of a function's body but docstrings, annotations and what errors say."""
    waiting: list[ast.AST] = list(tree.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, TEXT_MAY_STAND):
            continue
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        yield node
        left_out = (getattr(node, "annotation", None), getattr(node, "returns", None))
        waiting += [child for child in ast.iter_child_nodes(node) if child not in left_out]


def _goes_on(body: list[ast.stmt]) -> bool:
    """Whether some statements may end without returning."""
    last = body[-1]
    if isinstance(last, (ast.Return, ast.Raise)):
        return False
    if isinstance(last, ast.If):
        return not last.orelse or _goes_on(last.body) or _goes_on(last.orelse)
    if isinstance(last, ast.Match):
        ends = isinstance(last.cases[-1].pattern, ast.MatchAs) and not last.cases[-1].guard
        return not ends or any(_goes_on(case.body) for case in last.cases)
    if isinstance(last, ast.While):
        forever = isinstance(last.test, ast.Constant) and bool(last.test.value)
        return not forever or _breaks(last.body)
    return True


def _breaks(body: Sequence[ast.AST]) -> bool:
    """Whether some statements break out of the loop they stand in."""
    for node in body:
        if isinstance(node, ast.Break):
            return True
        inner = isinstance(node, (ast.For, ast.While))
        if not inner and _breaks(list(ast.iter_child_nodes(node))):
            return True
    return False


def _is_nothing(value: ast.expr | None) -> bool:
    return value is None or (isinstance(value, ast.Constant) and value.value is None)


def _is_name(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name
