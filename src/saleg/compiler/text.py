"""The text of a composed module: modules of the kernel as they stand, slots filled with laws.

Written anew are only the slots (:mod:`saleg.kernel.slots` in plain Python), each as a function that
calls the law of its side with the law's record, what the laws need (:mod:`~saleg.compiler.needs`),
and the step of the adaptive pair (:mod:`~saleg.compiler.unrolled`).
"""

from __future__ import annotations

import ast
import hashlib
import inspect
import pkgutil
import threading
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from saleg.compiler.imported_text import NoSource
from saleg.compiler.module import without_source
from saleg.compiler.needs import Needs
from saleg.compiler.records import OTHER_SLOTS
from saleg.compiler.source import Borrowed, earlier_attributes
from saleg.compiler.strength_reduction import EXPONENTIAL
from saleg.compiler.unrolled import adaptive_step
from saleg.errors import LawError
from saleg.laws import Law
from saleg.laws.base import CHAMBER_SLOTS
from saleg.laws.contract import plain_function

P = ParamSpec("P")
T = TypeVar("T")

#: What stands before the slots: the arguments laws are shown, then what of the kernel needs no law.
BEFORE_SLOTS = (
    "laws/arguments.py",
    "kernel/copies.py",
    "kernel/tuples.py",
    "kernel/logarithms.py",
    "kernel/layout.py",
    "kernel/state.py",
    "compiler/call_at.py",
)
#: Modules of the kernel that make up the integrator.
INTEGRATOR = (
    "needs",
    "flow",
    "breathing",
    "rhs",
    "general",
    "adaptive",
    "step",
    "events",
    "peaks",
    "control",
    "switch",
    "observe",
    "integrate",
)
#: Modules that make up the right-hand side of :mod:`saleg.reference`.
REFERENCE = ("needs", "flow", "plain_breathing", "plain_rhs")
#: The return map and the search for its fixed points: they use no law, and call the integrator by
#: its address. Where numba has no addresses it is compiled into them.
SEARCH = (
    "laws/arguments.py",
    "kernel/tuples.py",
    "kernel/layout.py",
    "kernel/state.py",
    "kernel/orbit.py",
    "kernel/orbits.py",
    "kernel/differences.py",
    "kernel/lanes/group.py",
    "kernel/lanes/search.py",
    "compiler/run_at.py",
)
INTEGRATOR_WITH_SEARCH = (*INTEGRATOR, "orbit", "differences", "run_plainly")
#: Many engines under commands: of the laws they call the actuators', and the integrator by its
#: address. Where numba has no addresses it is compiled into them.
PLANTS = ("needs", "flow", "breathing", "rhs", "control", "plants", "compiler/run_at.py")
INTEGRATOR_WITH_PLANTS = (*INTEGRATOR, "plants", "run_plainly")

#: What the marks of :mod:`saleg.kernel.jit` mean in a composed module. A function first met in one
#: that is folded into its callers would inherit that, if it were not told. Only entry points get
#: wrappers for Python, which halves the time to compile. Nothing in a kernel allocates, so nothing
#: need be counted (`_nrt`): counting references to the arrays took a third of the time. What
#: a module is loaded with says in `INNER` how those that are no entry points are compiled.
COMPILED_HEADER = """\
inline = numba.njit(
    forceinline=True,
    error_model="numpy",
    _nrt=False,
    no_cpython_wrapper=True,
    no_cfunc_wrapper=True,
    pipeline_class=INNER,
)
compiled = numba.njit(
    forceinline=False,
    error_model="numpy",
    _nrt=False,
    no_cpython_wrapper=True,
    no_cfunc_wrapper=True,
    pipeline_class=INNER,
)
"""
#: Choices (:mod:`saleg.laws.choice`) for one engine.
CHOICE = """\
@inline
def where(condition, a, b):
    return a if condition else b

@inline
def any_of(condition):
    return condition
"""
#: What a module for several engines side by side takes in, its text known by its digest.
LANES = """\
# Numbers of lanes: {digest}
from saleg.compiler.lanes import functions
from saleg.compiler.lanes.storage import numbers_of, records_of, rows_of, tables_of
from saleg.compiler.lanes.values import lane_bits
from saleg.laws.choice import any_of, where

WIDTH = {width}
"""
#: Files of that text, and those that step such engines.
NUMBERS_OF_LANES = ("values", "functions", "storage")
STEPS_OF_LANES = ("compiler/run_at.py", "kernel/lanes/group.py", "compiler/lanes/advance.py")
#: What a module is loaded with says whether it is kept.
CACHED = 'cached = numba.njit(error_model="numpy", _nrt=False, nogil=True, cache=ON_DISK)\n'


#: Held by whoever reads or writes syntax trees: Python 3.11 counts how deep it is in them for all
#: threads together, and fails with "AST constructor recursion depth mismatch".
SYNTAX = threading.RLock()


def one_at_a_time(function: Callable[P, T]) -> Callable[P, T]:
    """Make threads that call a function wait for each other."""

    @wraps(function)
    def call(*args: P.args, **given: P.kwargs) -> T:
        with SYNTAX:
            return function(*args, **given)

    return call


@one_at_a_time
def compose(
    classes: Sequence[type[Law]],
    modules: Sequence[str] = INTEGRATOR,
    *,
    motored_pressure: bool = False,
    injected: dict[str, Any] | None = None,
    width: int = 1,
) -> str:
    """Text of a composed module.

    Parameters
    ----------
    classes : sequence of type
        Classes of the laws, in the order of the record: left, right, engine, actuators,
        converter.
    modules : sequence of str
        Modules of the kernel.
    motored_pressure : bool
        Whether the motored pressure is integrated.
    injected : dict, optional
        Takes the methods whose source cannot be had, by the names the text calls them.
    width : int
        Engines that are stepped side by side; 1 for an integrator of one.

    Raises
    ------
    NoSource
        If there is such a method and no place for it.
    LawError
        If a law cannot be compiled.
    """
    n = len(CHAMBER_SLOTS)
    left, right, rest = classes[:n], classes[n : 2 * n], classes[2 * n :]
    choice = CHOICE if width == 1 else _lanes(width)
    parts = [*_header(), choice, *map(own_text, BEFORE_SLOTS)]
    eases = "rhs" in modules
    for index, (name, base) in enumerate(CHAMBER_SLOTS.items()):
        parts += _chamber_slot(name, base, left[index], right[index], injected, eases)
    for (name, base), law in zip(OTHER_SLOTS.items(), rest, strict=True):
        parts += _engine_slot(name, base, law, injected)
    needs = Needs.of(classes, motored_pressure)
    parts += [_kernel_text(name, needs, width) for name in modules]
    if width > 1:
        parts += map(own_text, STEPS_OF_LANES)
    return _joined(parts)


def _lanes(width: int) -> str:
    """What a module for several engines side by side begins with."""
    texts = "".join(own_text(f"compiler/lanes/{name}.py") for name in NUMBERS_OF_LANES)
    return LANES.format(digest=hashlib.sha256(texts.encode()).hexdigest(), width=width)


def _kernel_text(name: str, needs: Needs, width: int) -> str:
    """Text of a module of the kernel, or of what stands in its place."""
    if name == "needs":
        # Nobody commands engines that are stepped side by side.
        written = f"{needs.text}MOTORING_IS_POSSIBLE = {width == 1}\n"
    elif name == "adaptive":
        written = adaptive_step(needs.states, needs.kept, needs.sums)
    else:
        return own_text(name if "/" in name else f"kernel/{name}.py")
    return f"# --- kernel/{name}.py\n{written}"


@one_at_a_time
def compose_search() -> str:
    """Text of the return map and the search for its fixed points, which use no law."""
    return _joined([*_header(), *map(own_text, SEARCH)])


def _header() -> list[str]:
    """What every composed module begins with."""
    parts = ["import math", "import numba", "import numpy as np", ""]
    parts += [f"from math import exp as {EXPONENTIAL}"]
    return [*parts, COMPILED_HEADER + CACHED]


def _joined(parts: Sequence[str]) -> str:
    """Text of a module of these parts."""
    text = "\n".join(parts) + "\n"
    _check_names(text)
    return text


def _engine_slot(
    name: str, base: type[Law], law: type[Law], injected: dict[str, Any] | None
) -> list[str]:
    """Functions of one slot of the engine as a whole."""
    parts = []
    for method in base.compiled:
        parts += methods_text(law, method, f"engine_{name}", base, injected)
        arguments = ", ".join(_arguments(base, method))
        parts.append(
            f"@inline\ndef {name}_{method}(P, {arguments}):\n"
            f"    return engine_{name}_{method}(P.{name}, {arguments})\n"
        )
    return parts


def _chamber_slot(
    name: str,
    base: type[Law],
    left: type[Law],
    right: type[Law],
    injected: dict[str, Any] | None,
    eases: bool,
) -> list[str]:
    """Functions of one chamber slot; one set serves both sides where their laws are alike."""
    parts = []
    both = left is right
    names = ("both", "both") if both else ("left", "right")
    for method in base.compiled:
        easy = eases and method in base.at_every_step
        for place, law in (("both", left),) if both else (("left", left), ("right", right)):
            parts += methods_text(law, method, f"{place}_{name}", base, injected, easy)
        arguments = ", ".join(_arguments(base, method))
        if easy:
            parts.append(_by_side(f"{name}_{method}", name, f"{arguments}, aid", names))
            parts.append(_by_side(f"{name}_{method}_constants", name, arguments, names))
        else:
            parts.append(_by_side(f"{name}_{method}", name, arguments, names))
    return parts


def _by_side(function: str, slot: str, arguments: str, names: tuple[str, str]) -> str:
    """Text of a function that calls the law of the side it is asked for."""
    return (
        f"@inline\ndef {function}(P, side, {arguments}):\n"
        f"    if side == 0:\n"
        f"        return {names[0]}_{function}(P.left.{slot}, {arguments})\n"
        f"    return {names[1]}_{function}(P.right.{slot}, {arguments})\n"
    )


#: What stands for the eased form of a method without source.
NOT_EASED = """\
@inline
def {name}(self, gas, charge, aid):
    return {name}__plain(self, gas, charge)
@inline
def {name}_constants(self, gas, charge):
    return 0.0, 0.0, 0.0
"""


@one_at_a_time
def methods_text(
    law: type[Law],
    method: str,
    prefix: str,
    base: type[Law],
    injected: dict[str, Any] | None = None,
    eases: bool = False,
) -> list[str]:
    """Definitions needed for one method of a law, as a function ``{prefix}_{method}``."""
    owner = f"{law.__name__}.{method}"
    function = plain_function(getattr(law, method), owner)
    wanted = _arguments(base, method)
    if function.__code__.co_argcount != len(wanted) + 1:
        raise LawError(f"{owner} must take ({', '.join(['self', *wanted])})")
    borrowed = Borrowed(f"{prefix}_{method}__", owner, getattr(base, method))
    add = borrowed.add_eased_method if eases else borrowed.add_method
    try:
        add(law, function, f"{prefix}_{method}")
    except NoSource:
        if injected is None:
            raise
        injected[f"{prefix}_{method}{'__plain' if eases else ''}"] = without_source(
            function, earlier_attributes(law)
        )
        return [NOT_EASED.format(name=f"{prefix}_{method}")] if eases else []
    return borrowed.definitions


def _arguments(base: type[Law], method: str) -> list[str]:
    return list(inspect.signature(getattr(base, method)).parameters)[1:]


@one_at_a_time
def own_text(name: str) -> str:
    """Text of one of our modules without its docstring and its imports from this package."""
    text = (pkgutil.get_data("saleg", name) or b"").decode("utf-8").replace("\r\n", "\n")
    lines = text.splitlines()
    drop: set[int] = set()
    for index, node in enumerate(ast.parse(text).body):
        is_docstring = index == 0 and isinstance(node, ast.Expr)
        is_ours = isinstance(node, ast.ImportFrom) and (node.module or "").startswith("saleg")
        if is_docstring or is_ours:
            drop.update(range(node.lineno - 1, node.end_lineno or node.lineno))
    kept = [line for number, line in enumerate(lines) if number not in drop]
    return f"# --- {name}\n" + "\n".join(kept) + "\n"


def _check_names(text: str) -> None:
    """Refuse a module in which a name stands for two things: its parts share one namespace."""
    seen: set[str] = set()
    for node in ast.parse(text).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names = {node.name}
        elif isinstance(node, ast.Assign):
            names = {item.id for item in node.targets if isinstance(item, ast.Name)}
        else:
            continue
        if names & seen:
            raise LawError(f"two parts of the kernel define {', '.join(sorted(names & seen))}")
        seen |= names
