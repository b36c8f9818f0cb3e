"""Controllers compiled by themselves: the kernel asks them through a pointer.

So a new controller costs a second to compile, not a new kernel. The text of its module is composed
like that of a kernel and kept beside it.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

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
from saleg.kernel.tuples import Control
from saleg.laws.arguments import Commands, Signals
from saleg.laws.control.base import CONTROL_SLOTS

if TYPE_CHECKING:
    from saleg.compiler.records import Lengths
    from saleg.engine.controller import Controller
    from saleg.laws import Law

ENTRY = """\
_pointer = numba.types.CPointer(numba.types.float64)


@numba.cfunc(
    numba.types.void(_pointer, _pointer, _pointer, _pointer), error_model="numpy", cache=ON_DISK
)
def entry(numbers_at, held_at, signals_at, commands_at):
{body}
"""


def control_of(controller: Controller) -> Control:
    """What the kernel needs of a controller made of laws.

    Raises
    ------
    LawError
        If a part cannot be compiled, naming it.
    """
    if plain.is_wanted():
        room = nobody()
        return room._replace(address=plain.plain_function(controller, room))
    laws = list(controller.laws.values())
    classes: tuple[Any, ...] = tuple(map(type, laws))
    state = tuple(fingerprint(law) for law in dict.fromkeys(classes) if not is_ours(law))
    found = _load(classes, lengths_of_all(laws), state)
    return _with_room(int(found.address), np.array(numbers_of(laws), np.float64))


def nobody() -> Control:
    """What the kernel is handed where nobody commands: it never calls it."""
    return _with_room(0, np.zeros(1))


def _with_room(address: int, numbers: np.ndarray) -> Control:
    commands = np.full(2 * len(Commands._fields), np.nan).view(layout.COMMANDS_RECORD)
    return Control(
        address=address,
        numbers=numbers,
        memory=np.zeros(layout.CONTROL_PARTS * layout.MEMORY),
        signals=np.zeros(1, layout.SIGNALS_RECORD),
        commands=commands,
    )


@lru_cache(maxsize=128)
def _load(
    classes: tuple[type[Law], ...], lengths: tuple[Lengths, ...], state: tuple[object, ...]
) -> Any:
    """Compiled function of a choice of law classes in a certain state."""
    kinds = dict.fromkeys(zip(classes, lengths, strict=True))
    injected: dict[str, Any] = {}
    try:
        text = _text(classes, lengths)
    except NoSource as error:
        warn_if_edited(error)
        text = _text(classes, lengths, injected)
    try:
        # What is compiled from bytecode is not kept: the text does not say all of it.
        return load(text, "controller", injected, keeps=not injected).module.entry
    except machine_code.refusals() as error:
        own = [kind for kind in kinds if not is_ours(kind[0])]
        raise LawError(diagnosed(own, error)) from error


def _text(
    classes: tuple[type[Law], ...],
    lengths: tuple[Lengths, ...],
    injected: dict[str, Any] | None = None,
) -> str:
    """Text of a controller's module."""
    parts = ["import math", "from collections import namedtuple", "import numba"]
    parts += ["import numpy as np", COMPILED_HEADER, CHOICE, own_text("laws/arguments.py")]
    places, first = [], 0
    for (slot, base), law, long in zip(CONTROL_SLOTS.items(), classes, lengths, strict=True):
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
    parts.append(f"all_numbers = namedtuple('all_numbers', {list(CONTROL_SLOTS)})")
    parts.append(own_text("kernel/decide.py"))
    parts.append(ENTRY.format(body=_body(places, first)))
    return "\n".join(parts) + "\n"


def _values(names: tuple[str, ...], long: dict[str, int], first: int) -> tuple[list[str], int]:
    """Expressions for the numbers of a law within the array of all, and where the next begin."""
    values = []
    for name in names:
        count = long.get(name)
        values.append(f"p[{first}]" if count is None else f"p[{first}:{first + count}]")
        first += 1 if count is None else count
    return values, first if names else first + 1


def _body(places: list[str], count: int) -> str:
    """Lines of the compiled function: numbers into named tuples, commands into their array."""
    signals = ", ".join(f"s[{n}]" for n in range(len(Signals._fields)))
    lines = [
        f"p = numba.carray(numbers_at, ({count},))",
        f"h = numba.carray(held_at, ({layout.CONTROL_PARTS}, {layout.MEMORY}))",
        f"s = numba.carray(signals_at, ({len(Signals._fields)},))",
        f"c = numba.carray(commands_at, ({len(Commands._fields)},))",
        f"wanted = decide(all_numbers({', '.join(places)}), h, Signals({signals}))",
        *(f"c[{n}] = wanted.{name}" for n, name in enumerate(Commands._fields)),
    ]
    return "\n".join(f"    {line}" for line in lines)
