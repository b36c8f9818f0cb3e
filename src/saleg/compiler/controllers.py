"""Controllers compiled by themselves: the kernel asks them through pointers.

So a new controller costs a second to compile, not a new kernel. The text of its module is composed
like that of a kernel and kept beside it.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.compiler import machine_code, plain
from saleg.compiler.diagnosis import diagnosed
from saleg.compiler.imported_text import NoSource, warn_if_edited
from saleg.compiler.module import load
from saleg.compiler.records import lengths_of_all, names_of, numbers_of
from saleg.compiler.slot_text import methods_text
from saleg.compiler.source import fingerprint, is_ours
from saleg.compiler.text import CHOICE, COMPILED_HEADER, own_text
from saleg.errors import LawError
from saleg.kernel import layout
from saleg.kernel.tuples import Control, Sampling
from saleg.laws.arguments import Commands, ForceCommand, Instant, Signals
from saleg.laws.control.base import CONTROL_SLOTS, SAMPLED_SLOTS

if TYPE_CHECKING:
    from saleg.compiler.records import Lengths
    from saleg.engine.controller import Controller
    from saleg.laws import Law

ENTRY = """\
_pointer = numba.types.CPointer(numba.types.float64)


@numba.cfunc(
    numba.types.void(_pointer, _pointer, _pointer, _pointer), error_model="numpy", cache=ON_DISK
)
def entry(numbers_at, held_at, shown_at, wanted_at):
{body}
"""


class Asked(NamedTuple):
    """Parts of a controller that are asked together.

    Attributes
    ----------
    slots : tuple of (str, law class)
        Their slots, in the order of their numbers and memories.
    file : str
        File of the function that asks them.
    function : str
        Its name.
    shown, wanted : type
        Named tuples of what they are shown and what they ask for.
    memory : int
        Numbers that each may keep.
    """

    slots: tuple[tuple[str, type[Law]], ...]
    file: str
    function: str
    shown: Any
    wanted: Any
    memory: int


AT_DEAD_CENTRES = Asked(
    tuple(CONTROL_SLOTS.items()), "kernel/decide.py", "decide", Signals, Commands, layout.MEMORY
)
AT_SAMPLES = Asked(
    tuple(SAMPLED_SLOTS.items()),
    "kernel/sampled.py",
    "sample",
    Instant,
    ForceCommand,
    layout.SAMPLE_MEMORY,
)


def control_of(controller: Controller, *, asks: bool = True) -> Control:
    """What the kernel needs of a controller made of laws.

    Parameters
    ----------
    controller : Controller
    asks : bool
        Whether the kernel asks its laws at dead centres; those that act at samples it always asks.

    Raises
    ------
    LawError
        If a part cannot be compiled, naming it.
    """
    room = nobody()._replace(sampling=_sampling_of(controller))
    if not asks:
        return room
    if plain.is_wanted():
        return room._replace(address=plain.plain_function(controller, room))
    address, numbers = _function(AT_DEAD_CENTRES, list(controller.laws.values()))
    return room._replace(address=address, numbers=numbers)


def _sampling_of(controller: Controller) -> Sampling:
    """What the kernel needs of the parts of a controller that act at samples."""
    room = _no_sampling()
    laws = list(controller.sampled_laws.values())
    if not laws:
        return room
    if plain.is_wanted():
        return room._replace(address=plain.plain_sample(controller, room))
    address, numbers = _function(AT_SAMPLES, laws)
    return room._replace(address=address, numbers=numbers)


def _function(asked: Asked, laws: list[Law]) -> tuple[int, np.ndarray]:
    """Address of the compiled function of some laws, and their numbers."""
    classes: tuple[Any, ...] = tuple(map(type, laws))
    state = tuple(fingerprint(law) for law in dict.fromkeys(classes) if not is_ours(law))
    found = _load(asked, classes, lengths_of_all(laws), state)
    return int(found.address), np.array(numbers_of(laws), np.float64)


def nobody() -> Control:
    """What the kernel is handed where nobody commands: it never calls it."""
    commands = np.full(2 * len(Commands._fields), np.nan).view(layout.COMMANDS_RECORD)
    return Control(
        address=0,
        numbers=np.zeros(1),
        memory=np.zeros(layout.CONTROL_PARTS * layout.MEMORY),
        signals=np.zeros(1, layout.SIGNALS_RECORD),
        commands=commands,
        sampling=_no_sampling(),
    )


def _no_sampling() -> Sampling:
    """What the kernel is handed where nobody acts at samples: it never calls it."""
    return Sampling(
        address=0,
        numbers=np.zeros(1),
        memory=np.zeros(layout.SAMPLED_PARTS * layout.SAMPLE_MEMORY),
        instant=np.zeros(1, layout.INSTANT_RECORD),
        wanted=np.zeros(1, layout.FORCE_RECORD),
    )


@lru_cache(maxsize=128)
def _load(
    asked: Asked,
    classes: tuple[type[Law], ...],
    lengths: tuple[Lengths, ...],
    state: tuple[object, ...],
) -> Any:
    """Compiled function of a choice of law classes in a certain state."""
    kinds = dict.fromkeys(zip(classes, lengths, strict=True))
    injected: dict[str, Any] = {}
    try:
        text = _text(asked, classes, lengths)
    except NoSource as error:
        warn_if_edited(error)
        text = _text(asked, classes, lengths, injected)
    try:
        # What is compiled from bytecode is not kept: the text does not say all of it.
        return load(text, "controller", injected, keeps=not injected).module.entry
    except machine_code.refusals() as error:
        own = [kind for kind in kinds if not is_ours(kind[0])]
        raise LawError(diagnosed(own, error)) from error


def _text(
    asked: Asked,
    classes: tuple[type[Law], ...],
    lengths: tuple[Lengths, ...],
    injected: dict[str, Any] | None = None,
) -> str:
    """Text of a controller's module."""
    parts = ["import math", "from collections import namedtuple", "import numba"]
    parts += ["import numpy as np", COMPILED_HEADER, CHOICE, own_text("laws/arguments.py")]
    places, first = [], 0
    for (slot, base), law, long in zip(asked.slots, classes, lengths, strict=True):
        (method,) = base.compiled
        parts += methods_text(law, method, f"control_{slot}", base, injected)
        parts.append(
            f"@inline\ndef {slot}_{method}(P, held, signals):\n"
            f"    return control_{slot}_{method}(P.{slot}, held, signals)\n"
        )
        kind: Any = law
        names = names_of(kind)
        values, first = _values(names, dict(long), first)
        parts.append(f"{slot}_numbers = namedtuple('{slot}_numbers', {list(names)})")
        places.append(f"{slot}_numbers({', '.join(values)})")
    parts.append(f"all_numbers = namedtuple('all_numbers', {[slot for slot, _ in asked.slots]})")
    parts.append(own_text(asked.file))
    parts.append(ENTRY.format(body=_body(asked, places, first)))
    return "\n".join(parts) + "\n"


def _values(names: tuple[str, ...], long: dict[str, int], first: int) -> tuple[list[str], int]:
    """Expressions for the numbers of a law within the array of all, and where the next begin."""
    values = []
    for name in names:
        count = long.get(name)
        values.append(f"p[{first}]" if count is None else f"p[{first}:{first + count}]")
        first += 1 if count is None else count
    return values, first if names else first + 1


def _body(asked: Asked, places: list[str], count: int) -> str:
    """Lines of the compiled function: numbers into named tuples, what is wanted into its array."""
    shown, wanted = asked.shown, asked.wanted
    measured = ", ".join(f"s[{n}]" for n in range(len(shown._fields)))
    numbers = f"all_numbers({', '.join(places)})"
    lines = [
        f"p = numba.carray(numbers_at, ({count},))",
        f"h = numba.carray(held_at, ({len(asked.slots)}, {asked.memory}))",
        f"s = numba.carray(shown_at, ({len(shown._fields)},))",
        f"c = numba.carray(wanted_at, ({len(wanted._fields)},))",
        f"wanted = {asked.function}({numbers}, h, {shown.__name__}({measured}))",
        *(f"c[{n}] = wanted.{name}" for n, name in enumerate(wanted._fields)),
    ]
    return "\n".join(f"    {line}" for line in lines)
