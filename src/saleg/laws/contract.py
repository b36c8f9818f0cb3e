"""What a class must be to serve as a law."""

from __future__ import annotations

import dataclasses
import inspect
import types
from collections.abc import Iterable
from functools import lru_cache
from typing import Any

from saleg.errors import LawError
from saleg.laws.base import GasProperties, Law
from saleg.laws.frame import FixedFrame
from saleg.laws.leaks import NoLeak
from saleg.laws.supply import Plenum
from saleg.laws.walls import FixedWall

#: States a law may ask for.
STATES = ("contents", "wall_temperature", "crankcase", "frame")
#: Laws that ask for none, the method by which others change a state, and that state.
NEEDED: tuple[tuple[type[Law], str, str], ...] = (
    (NoLeak, "area", "contents"),
    (FixedWall, "temperature_rate", "wall_temperature"),
    (Plenum, "volume", "crankcase"),
    (FixedFrame, "acceleration", "frame"),
)


def check_laws(laws: Iterable[Law]) -> None:
    """Refuse laws that cannot be compiled, before any of them is called.

    Raises
    ------
    LawError
        Naming law and method.
    """
    for law in laws:
        kind: Any = type(law)
        check_law(kind)


@lru_cache(maxsize=1024)
def check_law(law: type[Law]) -> None:
    """Refuse a law class that cannot be compiled.

    Raises
    ------
    LawError
        Naming law and method.
    """
    if not dataclasses.is_dataclass(law):
        raise LawError(f"{law.__name__} must be a frozen dataclass: put @dataclass(frozen=True)")
    if issubclass(law, GasProperties):
        names = {item.name for item in dataclasses.fields(law)}
        if "gas_constant" not in names:
            raise LawError(f"{law.__name__} needs a field 'gas_constant' [J/kg/K]")
    _check_states(law)
    bases = [base for base in law.__mro__ if "slot" in vars(base)]
    for name in law.compiled:
        method = getattr(law, name)
        if name not in law.optional and any(vars(base).get(name) is method for base in bases):
            raise LawError(f"{law.__name__}.{name} is missing: a {law.slot} law has that method")
        plain = (inspect.Parameter.POSITIONAL_OR_KEYWORD,)
        function = plain_function(method, f"{law.__name__}.{name}")
        for parameter in inspect.signature(function, follow_wrapped=False).parameters.values():
            if parameter.kind not in plain:
                raise LawError(f"{law.__name__}.{name}: '{parameter}' must be a plain argument")


def _check_states(law: type[Law]) -> None:
    """Refuse a law that asks for no state there is, or lets gas or heat pass without a state."""
    unknown = [name for name in law.states if name not in STATES]
    if unknown:
        known = ", ".join(STATES)
        raise LawError(f"{law.__name__}.states = {law.states!r}: there are {known}")
    for idle, method, state in NEEDED:
        own = getattr(law, method, None)
        if law.slot == idle.slot and own is not getattr(idle, method) and state not in law.states:
            raise LawError(
                f"{law.__name__}.{method} acts on a state, which the law has to ask "
                f'for: states: ClassVar = ("{state}",)'
            )


def plain_function(method: Any, owner: str) -> types.FunctionType:
    """A method as the function that runs, one jitted already among them."""
    function = getattr(method, "py_func", method)
    if not isinstance(function, types.FunctionType):
        raise LawError(
            f"{owner} is a {type(method).__name__}; a law's method is a plain function: leave out "
            "its decorator"
        )
    return function
