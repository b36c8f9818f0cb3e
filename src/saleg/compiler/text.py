"""The text of a composed module: modules of the kernel as they stand, slots filled with laws.

Written anew are only the slots (:mod:`~saleg.compiler.slot_text`), what the laws need
(:mod:`~saleg.compiler.needs`), and the step of the adaptive pair (:mod:`~saleg.compiler.unrolled`).
"""

from __future__ import annotations

import ast
import hashlib
import pkgutil
from collections.abc import Sequence
from typing import Any

from saleg.compiler.needs import Needs
from saleg.compiler.slot_text import declared_slots, slots_text
from saleg.compiler.strength_reduction import EXPONENTIAL
from saleg.compiler.syntax import one_at_a_time
from saleg.compiler.unrolled import adaptive_step
from saleg.errors import LawError
from saleg.laws import Law

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
#: What laws are shown.
SHOWN = ("laws/arguments.py", "kernel/copies.py", "kernel/logarithms.py")
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
    "charges",
    "injection",
    "rows",
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
    "kernel/vector.py",
    "kernel/extrapolation.py",
    "kernel/orbit.py",
    "kernel/orbits.py",
    "kernel/differences.py",
    "kernel/lanes/group.py",
    "kernel/lanes/search.py",
    "compiler/run_at.py",
)
INTEGRATOR_WITH_SEARCH = (
    *INTEGRATOR,
    *("vector", "extrapolation", "orbit", "differences", "run_plainly"),
)
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
from saleg.compiler.lanes import functions
from saleg.compiler.lanes.storage import numbers_of, records_of, rows_of, tables_of
from saleg.compiler.lanes.values import lane_bits
from saleg.laws.choice import any_of, where

WIDTH = {width}
"""
#: Files of that text, and those that step such engines.
NUMBERS_OF_LANES = tuple(f"compiler/lanes/{name}.py" for name in ("values", "functions", "storage"))
#: Files that say how laws are linked into a kernel without any.
HALVES = ("compiler/linking.py", "kernel/slots.py")
STEPS_OF_LANES = ("compiler/run_at.py", "kernel/lanes/group.py", "compiler/lanes/advance.py")
#: The integrator of laws that are linked into a kernel without any.
LINKED = """\
integrate = LINKED(globals())


@cached
def run_on(run):
    return integrate(run)
"""
#: What a module is loaded with says whether it is kept, and how it is compiled.
CACHED = """\
cached = numba.njit(
    error_model="numpy",
    _nrt=False,
    nogil=True,
    no_cfunc_wrapper=True,
    cache=ON_DISK,
    pipeline_class=ENTRY,
)
"""


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
    choice = CHOICE if width == 1 else _lanes(width)
    parts = [*_header(), choice, *map(own_text, BEFORE_SLOTS)]
    parts += slots_text(classes, injected, "rhs" in modules)
    needs = Needs.of(classes, motored_pressure)
    parts += [_kernel_text(name, needs, width) for name in modules]
    if width > 1:
        parts += map(own_text, STEPS_OF_LANES)
    return _joined(parts)


@one_at_a_time
def compose_kernel(needs: Needs) -> str:
    """Text of the integrator without laws: its slots are declared."""
    parts = [*_header("cached = inline\n"), _digest(HALVES), CHOICE]
    parts += [*map(own_text, BEFORE_SLOTS), declared_slots()]
    return _joined([*parts, *(_kernel_text(name, needs, 1) for name in INTEGRATOR)])


@one_at_a_time
def compose_laws(
    classes: Sequence[type[Law]], kernel: str, injected: dict[str, Any] | None = None
) -> str:
    """Text of laws, and of the integrator they make with a kernel without laws.

    Parameters
    ----------
    classes, injected
        See :func:`compose`.
    kernel : str
        Digest of the kernel's text.
    """
    parts = [*_header(), f"# kernel: {kernel}", CHOICE, *map(own_text, SHOWN)]
    return _joined([*parts, *slots_text(classes, injected, eases=True), LINKED])


def _lanes(width: int) -> str:
    """What a module for several engines side by side begins with."""
    return _digest(NUMBERS_OF_LANES) + LANES.format(width=width)


def _digest(files: Sequence[str]) -> str:
    """Comment that tells texts apart by files that are not in them."""
    texts = "".join(map(own_text, files))
    return f"# {', '.join(files)}: {hashlib.sha256(texts.encode()).hexdigest()}\n"


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


def _header(cached: str = CACHED) -> list[str]:
    """What every composed module begins with; `cached` says what an entry point is."""
    parts = ["import math", "import numba", "import numpy as np", ""]
    parts += [f"from math import exp as {EXPONENTIAL}"]
    return [*parts, COMPILED_HEADER + cached]


def _joined(parts: Sequence[str]) -> str:
    """Text of a module of these parts."""
    text = "\n".join(parts) + "\n"
    _check_names(text)
    return text


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
