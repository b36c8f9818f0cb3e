"""Reading and changing an engine by dotted paths."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

from saleg.engine.chambers import Chamber, CombustionChamber
from saleg.errors import PathsClash, UnknownPath, nearest, shown

#: An engine: a tree of dataclasses with a left and a right chamber.
Tree = TypeVar("Tree")

#: Names people use, and where they lead. Below the line: within a chamber.
ENGINE_ALIASES = {
    "moving_mass": "translator.mass",
    "spring": "springs",
}
CHAMBER_ALIASES = {
    "egr": "gas_exchange.egr",
}

#: What is told of an engine first, by path; a chamber may lack some.
MAIN_INPUTS = (
    "bore",
    "half_stroke",
    "port_closing",
    "moving_mass",
    "spring.stiffness",
    "intake.pressure",
    "intake.temperature",
    "pressure",
    "temperature",
    "equivalence_ratio",
    "egr",
    "wall_temperature",
    "friction.coefficient",
    "alternator.load_constant",
)


def get(engine: Any, path: str) -> Any:
    """Value at a dotted path; of a mirrored engine's cylinder, the left one's.

    Where only one chamber is a cylinder, it is the cylinder's.

    Raises
    ------
    UnknownPath
        With the nearest existing names.
    """
    value: Any = engine
    targets = _targets(engine, path)
    if len({repr(_walk(engine, target)) for target in targets}) > 1:
        raise UnknownPath(f"'{path}' differs between left and right: ask for 'left.{path}'")
    for name in targets[0]:
        value = getattr(value, name)
    return value


def unit_of(engine: Any, path: str) -> str:
    """Unit of the number at a dotted path; "-" for pure numbers, laws and parts.

    Raises
    ------
    UnknownPath
        With the nearest existing names.

    Examples
    --------
    >>> import saleg
    >>> unit_of(saleg.machines.thesis_base(), "intake.pressure")
    'Pa'
    """
    *parents, name = _targets(engine, path)[0]
    node = _walk(engine, tuple(parents))
    limits = {item.name: item.metadata.get("limits") for item in dataclasses.fields(node)}[name]
    return limits.unit if limits is not None else "-"


def replace(engine: Tree, changes: Mapping[str, Any]) -> Tree:
    """Copy of an engine with the values at some dotted paths replaced.

    Raises
    ------
    UnknownPath
        With the nearest existing names, and what is wrong with the values of the other paths.
    PathsClash
        If two paths lead to one place.
    """
    given: Any = engine
    unknown = []
    named: dict[tuple[str, ...], str] = {}
    # Whole parts first, so that a law and one of its numbers can be changed in one call.
    for path in sorted(changes, key=_depth):
        try:
            found = claimed(named, engine, path)
        except UnknownPath as error:
            unknown.append(str(error))
            continue
        for target in found:
            engine = with_value(engine, target, changes[path])
    if unknown:
        raise UnknownPath("\n".join([*unknown, *_worse(given, engine)]))
    return engine


def _worse(before: Any, engine: Any) -> list[str]:
    """What is wrong with an engine that was not wrong before some changes."""
    known = {str(problem) for problem in before.problems()}
    return [text for text in map(str, engine.problems()) if text not in known]


def claimed(named: dict[tuple[str, ...], str], engine: Any, path: str) -> list[tuple[str, ...]]:
    """Places a path leads to, noted in `named`; refused if another path has led there before.

    Raises
    ------
    UnknownPath
    PathsClash
    """
    found = _targets(engine, path)
    for target in found:
        if named.setdefault(target, path) != path:
            raise PathsClash(
                f"'{named[target]}' and '{path}' are the same in this engine: give one of them"
            )
    return found


def _depth(path: str) -> int:
    """How deep below the engine or its chambers a path leads."""
    if not isinstance(path, str):
        return 0
    side, _, rest = path.partition(".")
    path = rest if side in ("left", "right") and rest else path
    return len(_expand(path, {**ENGINE_ALIASES, **CHAMBER_ALIASES}))


def known_paths(engine: Any) -> list[str]:
    """Every path of an engine that leads to a number or a law, aliases first."""
    return list(dict.fromkeys(_all_paths(engine)))


def _targets(engine: Any, path: str) -> list[tuple[str, ...]]:
    """Attribute chains a path stands for: one, or two for a path of both chambers."""
    if not isinstance(path, str):
        raise UnknownPath(f"a path is text such as 'intake.pressure', not {shown(path)}")
    first, dot, rest = path.partition(".")
    if dot and first in ("left", "right"):
        candidates = [(first, *_expand(rest, CHAMBER_ALIASES))]
    elif first in {item.name for item in dataclasses.fields(engine)} | set(ENGINE_ALIASES):
        candidates = [_expand(path, ENGINE_ALIASES)]
    else:
        chain = _expand(path, CHAMBER_ALIASES)
        candidates = [("left", *chain), ("right", *chain)]
    found = [chain for chain in candidates if exists(engine, chain)]
    if not found:
        raise UnknownPath(_suggestion(engine, path))
    return _of_cylinders(engine, found)


def _of_cylinders(engine: Any, found: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Of a path in both chambers only that in the cylinder, where but one of them is one."""
    if len(found) == 2:
        burns = [isinstance(getattr(engine, chain[0]), CombustionChamber) for chain in found]
        chambers = all(isinstance(getattr(engine, chain[0]), Chamber) for chain in found)
        if chambers and any(burns):
            return [chain for chain, is_cylinder in zip(found, burns, strict=True) if is_cylinder]
    return found


def _expand(path: str, aliases: Mapping[str, str]) -> tuple[str, ...]:
    first, dot, rest = path.partition(".")
    return tuple((aliases.get(first, first) + dot + rest).split("."))


def exists(node: Any, chain: tuple[str, ...]) -> bool:
    """Whether a chain of fields leads anywhere in a tree of dataclasses."""
    for name in chain:
        if not dataclasses.is_dataclass(node):
            return False
        if name not in {item.name for item in dataclasses.fields(node)}:
            return False
        node = getattr(node, name)
    return True


def _walk(node: Any, chain: tuple[str, ...]) -> Any:
    for name in chain:
        node = getattr(node, name)
    return node


def with_value(node: Any, chain: tuple[str, ...], value: Any) -> Any:
    """Copy of a tree of dataclasses with the value at the end of a chain of fields replaced."""
    if not chain:
        return value
    changed = with_value(getattr(node, chain[0]), chain[1:], value)
    return dataclasses.replace(node, **{chain[0]: changed})


def _suggestion(engine: Any, path: str) -> str:
    return f"no '{path}' in this engine{nearest(path, known_paths(engine))}"


def _all_paths(engine: Any) -> Iterator[str]:
    chambers = list(_below(engine.left)) + list(_below(engine.right))
    yield "moving_mass"
    yield from (f"spring.{name}" for name in _below(engine.springs))
    for alias, target in CHAMBER_ALIASES.items():
        if target in chambers:
            yield alias
    yield from chambers
    yield from (path for path in _below(engine) if not path.startswith(("left", "right")))
    yield from (path for path in _below(engine) if path.startswith(("left", "right")))


def _below(node: Any) -> Iterator[str]:
    """Names of the fields of a dataclass and, dotted, of all below them."""
    for item in dataclasses.fields(node):
        yield item.name
        value = getattr(node, item.name)
        if dataclasses.is_dataclass(value):
            yield from (f"{item.name}.{name}" for name in _below(value))
