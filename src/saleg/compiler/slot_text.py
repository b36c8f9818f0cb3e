"""The slots as functions of a composed module (:mod:`saleg.kernel.slots` in plain Python)."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

from saleg.compiler.imported_text import NoSource
from saleg.compiler.module import without_source
from saleg.compiler.records import OTHER_SLOTS
from saleg.compiler.source import Borrowed, earlier_attributes
from saleg.compiler.syntax import one_at_a_time
from saleg.errors import LawError
from saleg.laws import Law
from saleg.laws.base import CHAMBER_SLOTS
from saleg.laws.contract import plain_function


def slots_text(
    classes: Sequence[type[Law]], injected: dict[str, Any] | None, eases: bool
) -> list[str]:
    """Functions of all slots."""
    n = len(CHAMBER_SLOTS)
    left, right, rest = classes[:n], classes[n : 2 * n], classes[2 * n :]
    parts = []
    for index, (name, base) in enumerate(CHAMBER_SLOTS.items()):
        parts += _chamber_slot(name, base, left[index], right[index], injected, eases)
    for (name, base), law in zip(OTHER_SLOTS.items(), rest, strict=True):
        parts += _engine_slot(name, base, law, injected)
    return parts


def declared_slots() -> str:
    """The same of laws that are not known yet (:mod:`~saleg.compiler.linking`)."""
    slots = {**CHAMBER_SLOTS, **OTHER_SLOTS}
    names = []
    for slot, base in slots.items():
        for method in base.compiled:
            names.append(f"{slot}_{method}")
            if slot in CHAMBER_SLOTS and method in base.at_every_step:
                names.append(f"{slot}_{method}_constants")
    return "\n".join(f'{name} = DECLARED("{name}", globals())' for name in names)


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
