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


def plain_function(method: Any, owner: str) -> types.FunctionType:
    """A method as the function that runs, one jitted already among them."""
    function = getattr(method, "py_func", method)
    if not isinstance(function, types.FunctionType):
        raise LawError(
            f"{owner} is a {type(method).__name__}; a law's method is a plain function: leave out "
            "its decorator"
        )
    return function
