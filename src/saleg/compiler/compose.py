"""Composer: joins the kernel's modules with the laws of an engine into one compiled module.

The text of the kernel is taken as it stands; only the slots are written anew, with the source of
the chosen laws. The whole text is hashed, kept in the cache folder and imported from there, so
that a second process finds the machine code, and an edited law, helper or constant makes another
text and hence another module.
"""

from __future__ import annotations

import ast
import dataclasses
import hashlib
import inspect
import itertools
import sys
import types
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from functools import lru_cache
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.compiler.cache import kept, locked, usable_folder
from saleg.compiler.source import Borrowed, NoSource, check_law, fingerprint
from saleg.compiler.strength_reduction import EXPONENTIAL
from saleg.errors import LawError
from saleg.kernel import jit
from saleg.laws import Actuators, CFRIgnition, InstantExchange, Law, NoMisfires, Wiebe
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS
from saleg.laws.control.base import CONTROL_SLOTS, ActuatorLaw

if TYPE_CHECKING:
    from saleg.engine import Chamber, Engine
    from saleg.engine.controller import Controller

PACKAGE = Path(__file__).resolve().parent.parent
BEFORE_SLOTS = ("laws/arguments.py", "kernel/aid.py", "kernel/layout.py", "kernel/call_at.py")
INTEGRATOR = (
    "rhs",
    "step",
    "events",
    "peaks",
    "control",
    "switch",
    "observe",
    "integrate",
    "orbit",
)

#: What fills the combustion slots of a bounce chamber; never called, since it never lights.
IDLE_LAWS: dict[str, Law] = {
    "heat_release": Wiebe(),
    "ignition": CFRIgnition(),
    "gas_exchange": InstantExchange(),
    "misfires": NoMisfires(),
}

#: What stands before an engine that nobody commands.
IDLE_ACTUATORS = Actuators()
#: Slots of the engine as a whole as the kernel has them.
KERNEL_SLOTS: dict[str, type[Law]] = {**ENGINE_SLOTS, ActuatorLaw.slot: ActuatorLaw}

#: Lengths of the series of numbers a law has, by name.
Lengths = tuple[tuple[str, int], ...]

_numbers = itertools.count()


class Kernel:
    """Compiled kernel for one choice of laws.

    Parameters
    ----------
    module : module
        The composed module.
    lock : Path or None
        File that serialises compilation among processes.
    laws : sequence of str
        Names of the laws in it, for errors.
    """

    def __init__(self, module: types.ModuleType, lock: Path | None, laws: Sequence[str] = ()):
        self.module = module
        self._lock = lock
        self._laws = laws
        # An entry point is always called with the same types: its machine code is kept, which saves
        # finding out what they are, a twentieth of a millisecond.
        self._entries: dict[str, Callable[..., Any]] = {}
        self._addresses: dict[str, int] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self.module, name)

    def call(self, name: str, *arguments: Any) -> Any:
        """Call an entry point; the first call compiles it, one process at a time."""
        entry = self._entries.get(name)
        if entry is None:
            entry = self._entries[name] = self._made(name, arguments).entry_point
        return entry(*arguments)

    def address(self, name: str, arguments: tuple[Any, ...]) -> int:
        """Address of an entry point for arguments of these types, compiled if need be."""
        if name not in self._addresses:
            made = self._made(name, arguments)
            symbol = made.fndesc.llvm_func_name
            self._addresses[name] = int(made.library.get_pointer_to_function(symbol))
        return self._addresses[name]

    def _made(self, name: str, arguments: tuple[Any, ...]) -> Any:
        """Machine code of an entry point for arguments of these types."""
        from numba import typeof

        function = getattr(self.module, name)
        signature = tuple(typeof(argument) for argument in arguments)
        if signature not in function.overloads:
            with locked(self._lock) if self._lock else nullcontext():
                self._compile(function, signature)
        return function.overloads[signature]

    def _compile(self, function: Any, signature: tuple[Any, ...]) -> None:
        """Compile an entry point or load it; what is damaged on disk is compiled afresh."""
        from numba.core.errors import NumbaError

        try:
            function.compile(signature)
        except NumbaError as error:
            raise LawError(
                f"the laws {', '.join(self._laws)} cannot be compiled: {_reason(error)}"
            ) from error
        except Exception:
            if self._lock is None:
                raise
            for damaged in self._lock.parent.glob(f"__pycache__/{self._lock.stem}*"):
                damaged.unlink(missing_ok=True)
            function.compile(signature)


def _reason(error: Exception) -> str:
    """What numba says of the cause, without the chain of what it was doing."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    telling = [line for line in lines if not line.startswith(("Failed in", "During", "File", "<"))]
    return " ".join(telling[:2]) if telling else str(error)


def slots_of(chamber: Chamber) -> dict[str, Law]:
    """Laws of a chamber by slot."""
    return {name: getattr(chamber, name, IDLE_LAWS.get(name)) for name in CHAMBER_SLOTS}  # type: ignore[misc]


def needs_motored_pressure(engine: Engine) -> bool:
    """Whether a law of the engine looks at the motored pressure."""
    chambers: tuple[Any, Any] = engine.chambers
    return any(side.heat_transfer.needs_motored_pressure for side in chambers)


def check_laws(engine: Engine, controller: Controller | None = None) -> None:
    """Refuse laws that cannot become part of a kernel, before any of them is called.

    Raises
    ------
    LawError
        Naming law and method.
    """
    laws = _all_laws(engine, None)
    if controller is not None:
        laws += [getattr(controller, name) for name in (*CONTROL_SLOTS, ActuatorLaw.slot)]
    for kind in _classes(laws):
        check_law(kind)


def kernel_for(
    engine: Engine,
    modules: tuple[str, ...] = INTEGRATOR,
    actuators: ActuatorLaw | None = None,
) -> Kernel:
    """Compiled kernel for the laws of an engine and the actuators before it.

    Composed once per choice of laws, and anew when a law, or a helper or constant it uses, has
    been changed in this process, as in a notebook.
    """
    laws = _all_laws(engine, actuators)
    known = _known(_classes(laws))
    state = tuple(fingerprint(law) for law in known.own)
    return _load(known.classes, modules, known.lengths or _all_lengths(laws), state)


class Known(NamedTuple):
    """What follows from the classes of some laws, whatever their numbers.

    Attributes
    ----------
    classes : tuple of type
        The classes, in the order of the record.
    own : tuple of type
        Those among them that are not the library's.
    lengths : tuple of Lengths
        Lengths of all series; empty if there are any, since they vary.
    readers : tuple of callable
        What takes the numbers of each law.
    """

    classes: tuple[Any, ...]
    own: tuple[Any, ...]
    lengths: tuple[Lengths, ...]
    readers: tuple[Callable[[Law], Any], ...]


@lru_cache(maxsize=256)
def _known(classes: tuple[Any, ...]) -> Known:
    """What follows from some classes."""
    varies = any(_series_names(law) for law in classes)
    own = tuple(law for law in dict.fromkeys(classes) if not is_ours(law))
    lengths = () if varies else ((),) * len(classes)
    return Known(classes, own, lengths, tuple(_reader(law) for law in classes))


def _classes(laws: Sequence[Law]) -> tuple[Any, ...]:
    return tuple(map(type, laws))


def _all_lengths(laws: Sequence[Law]) -> tuple[Lengths, ...]:
    return tuple(map(lengths_of, laws))


def _all_laws(engine: Engine, actuators: ActuatorLaw | None) -> list[Law]:
    """Laws of an engine in the order of its record."""
    laws = [law for chamber in engine.chambers for law in slots_of(chamber).values()]
    laws += [getattr(engine, name) for name in ENGINE_SLOTS]
    return [*laws, actuators or IDLE_ACTUATORS]


def is_ours(law: type[Law]) -> bool:
    """Whether a law is one of the library's, which do not change while it is imported."""
    return law.__module__.startswith("saleg.laws.")


def parameters(engine: Engine, actuators: ActuatorLaw | None = None) -> np.ndarray:
    """All numbers of the laws of an engine and its actuators as an array of one record."""
    laws = _all_laws(engine, actuators)
    known = _known(_classes(laws))
    record = _record_of_all(known.classes, known.lengths or _all_lengths(laws))
    return np.array(numbers_of(laws), np.float64).view(record)


def numbers_of(laws: Sequence[Law]) -> list[float]:
    """Numbers of some laws in the order of their records."""
    known = _known(_classes(laws))
    pairs = zip(known.readers, laws, strict=True)
    flat = [value for read, law in pairs for value in read(law) or (0.0,)]
    if known.lengths:
        return flat
    return [
        number
        for value in flat
        for number in (value if isinstance(value, (tuple, list)) else (value,))
    ]


@lru_cache(maxsize=256)
def _record_of_all(classes: tuple[Any, ...], lengths: tuple[Lengths, ...]) -> np.dtype:
    """Record of all laws: left and right hold a record for each slot, the engine's follow."""
    records = [_record(law, length) for law, length in zip(classes, lengths, strict=True)]
    n = len(CHAMBER_SLOTS)
    sides = [list(zip(CHAMBER_SLOTS, records[i : i + n], strict=True)) for i in (0, n)]
    rest = list(zip(KERNEL_SLOTS, records[2 * n :], strict=True))
    return np.dtype([("left", sides[0]), ("right", sides[1]), *rest])


@lru_cache(maxsize=256)
def names_of(law: Any) -> tuple[str, ...]:
    """Names of the numbers of a law class, in the order of its record."""
    return tuple(item.name for item in dataclasses.fields(law))


@lru_cache(maxsize=256)
def _series_names(law: Any) -> tuple[str, ...]:
    """Fields of a law class that hold a series of numbers."""
    return tuple(item.name for item in dataclasses.fields(law) if "series" in item.metadata)


@lru_cache(maxsize=256)
def _reader(law: Any) -> Callable[[Law], Any]:
    """What takes all numbers of a law of some class at once."""
    names = names_of(law)
    return (
        attrgetter(*names) if len(names) > 1 else lambda one: tuple(getattr(one, n) for n in names)
    )


def record_of(law: Law) -> np.dtype:
    """Record that holds the numbers of a law; a series of numbers is an array in it."""
    kind: Any = type(law)
    return _record(kind, lengths_of(law))


@lru_cache(maxsize=256)
def _record(law: Any, lengths: Lengths) -> np.dtype:
    long = dict(lengths)
    items = [
        (name, np.float64, (long[name],)) if name in long else (name, np.float64)
        for name in names_of(law)
    ]
    return np.dtype(items or [("nothing", np.float64)])


def lengths_of(law: Law) -> Lengths:
    """How many numbers there are in each series of a law."""
    kind: Any = type(law)
    return tuple((name, len(getattr(law, name))) for name in _series_names(kind))


@lru_cache(maxsize=128)
def _load(
    classes: tuple[type[Law], ...],
    modules: tuple[str, ...],
    lengths: tuple[Lengths, ...],
    state: tuple[object, ...],
) -> Kernel:
    """Compose, keep and import the kernel for a choice of law classes in a certain state."""
    n = len(CHAMBER_SLOTS)
    left, right, rest = classes[:n], classes[n : 2 * n], classes[2 * n :]
    own = [law.__name__ for law in dict.fromkeys(classes) if not is_ours(law)]
    try:
        text = compose(left, right, rest, modules)
    except NoSource:
        return _load_from_memory(left, right, rest, modules, own)
    text = f"# Lengths of the laws' series: {[dict(item) for item in lengths]}\n{text}"
    folder = usable_folder()
    path = None if folder is None else folder / f"saleg_kernel_{digest(text)}.py"
    if path is None or not kept(path, text):
        return Kernel(execute(_in_memory(text), f"<saleg kernel {next(_numbers)}>"), None, own)
    return Kernel(execute(text, str(path)), path.with_suffix(".lock"), own)


def compose(
    left: Sequence[type[Law]],
    right: Sequence[type[Law]],
    rest: Sequence[type[Law]],
    modules: Sequence[str] = INTEGRATOR,
    injected: dict[str, Any] | None = None,
) -> str:
    """Text of the composed module for the law classes of each place, in the order of the slots.

    `rest` are the laws of the engine as a whole, its actuators last.
    """
    parts = ["import math", "import numba", "import numpy as np", ""]
    parts += [f"from math import exp as {EXPONENTIAL}"]
    parts += [jit.COMPILED_HEADER + jit.CACHED_ON_DISK]
    parts += [own_text(name) for name in BEFORE_SLOTS]
    eases = "rhs" in modules
    for index, (name, base) in enumerate(CHAMBER_SLOTS.items()):
        parts += _chamber_slot(name, base, left[index], right[index], injected, eases)
    for (name, base), law in zip(KERNEL_SLOTS.items(), rest, strict=True):
        for method in base.compiled:
            parts += methods_text(law, method, f"engine_{name}", base, injected)
            arguments = ", ".join(_arguments(base, method))
            parts.append(
                f"@inline\ndef {name}_{method}(P, {arguments}):\n"
                f"    return engine_{name}_{method}(P.{name}, {arguments})\n"
            )
    parts += [own_text(f"kernel/{name}.py") for name in modules]
    text = "\n".join(parts) + "\n"
    _check_names(text)
    return text


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


def methods_text(
    law: type[Law],
    method: str,
    prefix: str,
    base: type[Law],
    injected: dict[str, Any] | None = None,
    eases: bool = False,
) -> list[str]:
    """Definitions needed for one method of a law, as a function ``{prefix}_{method}``."""
    function = getattr(law, method)
    owner = f"{law.__name__}.{method}"
    given = list(inspect.signature(function).parameters)[1:]
    wanted = _arguments(base, method)
    if len(given) != len(wanted):
        raise LawError(f"{owner} must take ({', '.join(['self', *wanted])})")
    borrowed = Borrowed(f"{prefix}_{method}__", owner)
    add = borrowed.add_eased_method if eases else borrowed.add_method
    try:
        add(law, function, f"{prefix}_{method}")
    except NoSource:
        if injected is None:
            raise
        injected[f"{prefix}_{method}{'__plain' if eases else ''}"] = _jitted(function)
        return [NOT_EASED.format(name=f"{prefix}_{method}")] if eases else []
    return borrowed.definitions


def _arguments(base: type[Law], method: str) -> list[str]:
    return list(inspect.signature(getattr(base, method)).parameters)[1:]


def own_text(name: str) -> str:
    """Text of one of our modules without its docstring and its imports from this package."""
    text = (PACKAGE / name).read_text(encoding="utf-8")
    lines = text.splitlines()
    drop: set[int] = set()
    for index, node in enumerate(ast.parse(text).body):
        is_docstring = index == 0 and isinstance(node, ast.Expr)
        is_ours = isinstance(node, ast.ImportFrom) and (node.module or "").startswith("saleg")
        if is_docstring or is_ours:
            drop.update(range(node.lineno - 1, node.end_lineno or node.lineno))
    kept = [line for number, line in enumerate(lines) if number not in drop]
    return f"# --- {name}\n" + "\n".join(kept) + "\n"


def digest(text: str) -> str:
    """Name of a text for this numba and this processor."""
    import llvmlite.binding
    import numba

    machine = f"{numba.__version__} {np.__version__} {llvmlite.binding.get_host_cpu_name()}"
    return hashlib.sha256(f"{machine}\n{text}".encode()).hexdigest()[:24]


def execute(text: str, filename: str, names: dict[str, Any] | None = None) -> types.ModuleType:
    """Run a module text under the given file name; nothing but this very text is executed."""
    stem = Path(filename).stem if filename.endswith(".py") else f"saleg_kernel_{id(text):x}"
    module = types.ModuleType(stem)
    module.__file__ = filename
    module.__dict__.update(names or {})
    sys.modules[stem] = module
    exec(compile(text, filename, "exec"), module.__dict__)
    return module


def _in_memory(text: str) -> str:
    return text.replace(jit.CACHED_ON_DISK, jit.CACHED_IN_MEMORY)


def _load_from_memory(
    left: Sequence[type[Law]],
    right: Sequence[type[Law]],
    rest: Sequence[type[Law]],
    modules: Sequence[str],
    own: Sequence[str],
) -> Kernel:
    """Kernel for laws whose source cannot be had: compiled from their bytecode, not kept."""
    injected: dict[str, Any] = {}
    text = _in_memory(compose(left, right, rest, modules, injected))
    return Kernel(execute(text, f"<saleg kernel {next(_numbers)}>", injected), None, own)


def _jitted(function: Callable[..., Any], seen: dict[int, Any] | None = None) -> Any:
    """Compile a function without source, and the functions it uses."""
    import numba

    seen = {} if seen is None else seen
    if id(function) in seen:
        return seen[id(function)]
    names = {
        name: _jitted(value, seen) if isinstance(value, types.FunctionType) else value
        for name, value in inspect.getclosurevars(function).globals.items()
    }
    copy = types.FunctionType(
        function.__code__, names, function.__name__, function.__defaults__, function.__closure__
    )
    seen[id(function)] = numba.njit(forceinline=True, error_model="numpy", nogil=True)(copy)
    return seen[id(function)]
