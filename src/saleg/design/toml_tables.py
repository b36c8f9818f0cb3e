"""Parts of TOML files about many designs: what they replace something of, and named numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from saleg.design.designs import Design
from saleg.engine import Engine
from saleg.errors import SalegError, nearest
from saleg.machines import catalogue
from saleg.quantities import is_number


class WrongTable(SalegError):
    """Something in a file that makes no sense; who reads the file adds its name."""


def base_of(settings: Mapping[str, Any]) -> Design | Engine:
    """The machine named, or the designs of Chapter 4."""
    if "machine" not in settings:
        return Design()
    name = settings["machine"]
    if not isinstance(name, str) or name not in catalogue():
        raise WrongTable(f"no machine {name!r}{nearest(str(name), catalogue())}")
    return catalogue()[name]()


def with_fixed(base: Design | Engine, fixed: Mapping[str, float]) -> Design | Engine:
    """The same with the values of ``[fixed]``."""
    return base.replace(fixed) if isinstance(base, Design) else base.replace(**fixed)


def fixed_of(tables: Mapping[str, Any]) -> dict[str, float]:
    """Values of ``[fixed]`` by name."""
    given = table_of(tables, "fixed")
    refuse_dotted(given)
    wrong = [name for name, value in given.items() if not is_number(value)]
    if wrong:
        raise WrongTable(f"fixed.{wrong[0]} = {given[wrong[0]]!r}: must be a number")
    return {name: float(value) for name, value in given.items()}


def table_of(tables: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A table by name; empty if it is not there."""
    held = tables.get(name, {})
    if not isinstance(held, dict):
        raise WrongTable(f"{name} = {held!r}: must be a table")
    return held


def refuse_dotted(table: Mapping[str, Any], but: Iterable[str] = ()) -> None:
    """Refuse dotted keys without quotes, which are tables; tables with keys of `but` are meant."""
    for name, held in table.items():
        if isinstance(held, dict) and held and not set(held) & set(but):
            path = f"{name}.{next(iter(held))}"
            raise WrongTable(f'{path}: a dotted name must be quoted: "{path}" = ...')


def refuse_unknown(table: Mapping[str, Any], known: Iterable[str], where: str = "") -> None:
    """Refuse keys that mean nothing."""
    names = list(known)
    for key in table:
        if key not in names:
            hint = nearest(key, names) or f"; there are {', '.join(names)}"
            raise WrongTable(f"{where}{key}: unknown key{hint}")
