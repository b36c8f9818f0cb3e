"""Numbers of an engine by path, with unit, range, value and meaning, as they can be set."""

from __future__ import annotations

import dataclasses
import inspect
import re
import textwrap
from collections.abc import Iterator
from typing import Any, NamedTuple

from saleg.engine import Engine
from saleg.quantities import Limits

#: Widest column of meanings.
WIDTH = 60


class Parameter(NamedTuple):
    """A number of an engine, as text."""

    path: str
    value: str
    unit: str
    allowed: str
    meaning: str


def parameters_of(engine: Engine) -> Iterator[Parameter]:
    """All numbers of an engine; of both sides together where they are alike."""
    yield from _below(engine.translator, "translator")
    if engine.is_mirrored:
        yield from _below(engine.left, "")
    else:
        yield from _below(engine.left, "left")
        yield from _below(engine.right, "right")
    for slot in ("springs", "friction", "alternator", "start"):
        yield from _below(getattr(engine, slot), slot)


def table_of(engine: Engine) -> str:
    """Table of the parameters of an engine, for a terminal."""
    rows = [Parameter("path", "value", "unit", "allowed", "meaning"), *parameters_of(engine)]
    widths = [max(len(row[place]) for row in rows) for place in range(4)]
    lines = []
    for row in rows:
        first = "  ".join(f"{cell:<{width}}" for cell, width in zip(row[:4], widths, strict=True))
        meaning = textwrap.shorten(row.meaning, WIDTH, placeholder=" ...")
        lines.append(f"{first}  {meaning}".rstrip())
    return "\n".join(lines)


def _below(node: Any, path: str) -> Iterator[Parameter]:
    for item in dataclasses.fields(node):
        value, where = getattr(node, item.name), f"{path}.{item.name}" if path else item.name
        limits = item.metadata.get("limits")
        if limits is not None:
            shown = value if isinstance(value, tuple) else (value,)
            text = f"{len(shown)} numbers" if len(shown) > 3 else ", ".join(f"{n:g}" for n in shown)
            yield Parameter(where, text, limits.unit, _allowed(limits), meaning_of(node, item.name))
        elif dataclasses.is_dataclass(value):
            yield from _below(value, where)


def _allowed(limits: Limits) -> str:
    """Allowed range, and what has been built if that is known."""
    usual = f"(usual {limits.usual[0]:g} to {limits.usual[1]:g})" if limits.usual else ""
    return f"{limits} {usual}".strip() or "any"


def meaning_of(node: Any, name: str) -> str:
    """What a docstring says of a field: its first sentence, unit apart."""
    for kind in type(node).__mro__:
        text = inspect.cleandoc(vars(kind).get("__doc__") or "")
        for names, description in re.findall(
            r"^(\w[\w, ]*) : [^\n]*\n((?: +[^\n]*\n?)+)", text, re.M
        ):
            if name in names.split(", "):
                flat = re.sub(r":\w+:`~?([^`]*)`", r"\1", " ".join(description.split()))
                return re.split(r"\.(?: (?=[A-Z])|$)", re.sub(r"\s*\[[^\]]*\]", "", flat))[0]
    return ""
