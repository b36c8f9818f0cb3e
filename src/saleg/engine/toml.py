"""Engines as TOML files: a small writer, and a reader that names every wrong key at once.

Only numbers and text are ever read; a law is looked up by name among those of :mod:`saleg.laws`,
:mod:`saleg.engine.start`, those installed packages offer and those handed in; a file imports none.
"""

from __future__ import annotations

import dataclasses
import json
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from saleg import laws as exported
from saleg.engine import start as starts
from saleg.engine.chambers import (
    BounceChamber,
    Cylinder,
    Fuel,
    Intake,
    OpenEnd,
    SealedCylinder,
    Translator,
)
from saleg.engine.engine import Engine
from saleg.engine.start import Start
from saleg.errors import EngineFileError, InvalidEngine, SalegError, nearest, shown
from saleg.files.entry_points import offered
from saleg.files.reading import read_text
from saleg.laws import (
    CompleteCombustion,
    FixedFrame,
    FixedWall,
    Law,
    NoLeak,
    NoScatter,
    Plenum,
    PortMixing,
)
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS, FlowExchange
from saleg.quantities import is_number

#: Slots by name, with the base class of what fills them.
SLOTS: dict[str, type] = {**CHAMBER_SLOTS, **ENGINE_SLOTS, "start": Start}
#: Classes that laws derive from, and no laws themselves.
BASES = (*SLOTS.values(), FlowExchange)
#: Laws a file does not name: what stands in their slots if nothing is said.
UNSAID = (
    NoLeak,
    FixedWall,
    Plenum,
    CompleteCombustion,
    FixedFrame,
    NoScatter,
    PortMixing,
)
#: Numbers that came later: a file names them only where they are not the default, so that folders
#: of sweeps begun before still know their engine.
LATER = ("back_area", "back_pressure", "burnt_shares")
LATER_OF_LAWS = ("air_fuel_ratio", "equivalence_ratio", "burnt_share")
CHAMBERS: dict[str, type] = {
    kind.__name__: kind for kind in (Cylinder, SealedCylinder, BounceChamber, OpenEnd)
}
PARTS: dict[str, type] = {"translator": Translator, "intake": Intake, "fuel": Fuel}
SIDES = ("cylinder", "left", "right")
#: Keys of a table that say which class it stands for.
LAW, KIND = "law", "kind"


def laws_by_slot(own: Iterable[type] = ()) -> dict[str, dict[str, type]]:
    """Laws (and starts) a file may name, by slot and name.

    Parameters
    ----------
    own : iterable of Law or Start classes, optional
        Classes that come on top of those of the library.

    Returns
    -------
    dict of str to dict of str to type

    Examples
    --------
    >>> "Hohenberg" in laws_by_slot()["heat_transfer"]
    True
    """
    candidates = [getattr(exported, name) for name in exported.__all__] + list(
        vars(starts).values()
    )
    found: dict[str, dict[str, type]] = {slot: {} for slot in SLOTS}
    for law in [*candidates, *offered("saleg.laws").values(), *own]:
        for slot, base in SLOTS.items():
            if isinstance(law, type) and issubclass(law, base) and law not in BASES:
                found[slot][law.__name__] = law
    return found


def checked_laws(laws: Any, error: type[SalegError]) -> list[type]:
    """Classes of a user's own laws.

    Raises
    ------
    SalegError
        Of the type `error`, if they are none.
    """
    listed = list(laws) if isinstance(laws, Iterable) and not isinstance(laws, str) else [laws]
    wrong = [law for law in listed if not isinstance(law, type)]
    if wrong:
        raise error(f"laws = {shown(laws)}: must be a list of classes of laws")
    return listed


def to_toml(engine: Engine) -> str:
    """Write an engine as TOML text, every number exactly, its unit in a comment behind it.

    Parameters
    ----------
    engine : Engine
        A valid engine.

    Returns
    -------
    str
        Text from which :func:`read_toml` makes an equal engine.

    Raises
    ------
    InvalidEngine
        If the engine could not be read back.
    """
    engine.validate()
    lines = [f"name = {_quoted(str(engine.name))}"]
    lines += _table("translator", engine.translator)
    if engine.is_mirrored:
        lines += _table("cylinder", engine.left)
    else:
        lines += _table("left", engine.left) + _table("right", engine.right)
    for slot in (*ENGINE_SLOTS, "start"):
        part = getattr(engine, slot)
        lines += [] if type(part) in UNSAID else _table(slot, part)
    return "\n".join(lines) + "\n"


def read_toml(path: str | Path, laws: Sequence[type] = ()) -> Engine:
    """Read an engine file as :func:`to_toml` writes it; what is left out takes its default.

    Parameters
    ----------
    path : str or Path
        The file.
    laws : sequence of Law or Start classes, optional
        Classes of your own that the file may name.

    Returns
    -------
    Engine

    Raises
    ------
    EngineFileError
        Naming the file and every wrong key.
    InvalidEngine
        Naming the file and every value out of range.
    """
    reader = _Reader(laws_by_slot(checked_laws(laws, EngineFileError)))
    engine = reader.engine(parsed(path))
    if reader.wrong or engine is None:
        raise EngineFileError(f"{path}:\n" + "\n".join(f"  {text}" for text in reader.wrong))
    try:
        engine.validate()
    except InvalidEngine as error:
        error.args = (f"{path}: {error}",)
        raise
    return engine


def parsed(path: str | Path) -> dict[str, Any]:
    """Tables of a TOML file; raises EngineFileError if it is none."""
    text = read_text(path, EngineFileError)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise EngineFileError(f"{path} is not a TOML file: {error}") from None


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _table(path: str, node: Any) -> list[str]:
    """Lines of one table and, below it, of the tables in it."""
    lines, below = ["", f"[{path}]"], []
    later = LATER + (LATER_OF_LAWS if isinstance(node, Law) else ())
    if not isinstance(node, tuple(PARTS.values())):
        word = KIND if isinstance(node, tuple(CHAMBERS.values())) else LAW
        lines.append(f"{word} = {_quoted(type(node).__name__)}")
    for item in dataclasses.fields(node):
        value = getattr(node, item.name)
        if type(value) in UNSAID or (item.name in later and value == item.default):
            continue
        if dataclasses.is_dataclass(value):
            below += _table(f"{path}.{item.name}", value)
        else:
            limits = item.metadata.get("limits")
            whole = limits is not None and limits.kind is int
            text = repr(value) if whole else _number_text(value)
            lines.append(f"{item.name} = {text}{_unit_comment(item)}")
    return lines + below


def _number_text(value: Any) -> str:
    """A number, or a series of them, as TOML."""
    if isinstance(value, tuple):
        return f"[{', '.join(repr(float(item)) for item in value)}]"
    return repr(float(value))


def _unit_comment(item: dataclasses.Field[Any]) -> str:
    limits = item.metadata.get("limits")
    return f"  # {limits.unit}" if limits else ""


class _Reader:
    """Turns nested tables into an engine, and collects what is wrong on the way.

    Its methods return None for what could not be made; `wrong` then says why.
    """

    def __init__(self, laws: Mapping[str, Mapping[str, type]]):
        self.laws = laws
        self.wrong: list[str] = []

    def engine(self, tables: dict[str, Any]) -> Engine | None:
        """Engine from a whole file."""
        slots = [*ENGINE_SLOTS, "start"]
        self._unknown(tables, ["name", "translator", *SIDES, *slots], "")
        values = {slot: self._law(tables[slot], slot, slot) for slot in slots if slot in tables}
        values["translator"] = self._part(tables.get("translator", {}), Translator, "translator")
        values |= self._chambers(tables)
        name = tables.get("name", "engine")
        if not isinstance(name, str):
            self.wrong.append(f"name = {name!r}: must be text")
        return None if self.wrong else Engine(name=name, **values)

    def _chambers(self, tables: dict[str, Any]) -> dict[str, Any]:
        given = [side for side in SIDES if side in tables]
        if given not in (["cylinder"], ["left", "right"]):
            shown = ", ".join(f"[{side}]" for side in given) or "none"
            self.wrong.append(f"needs [cylinder] for both sides or [left] and [right]; has {shown}")
        made = {side: self._chamber(tables[side], side) for side in given}
        if "cylinder" in made:
            return {"left": made["cylinder"], "right": made["cylinder"]}
        return made

    def _chamber(self, table: Any, path: str) -> Any:
        if not self._is_table(table, path):
            return None
        default = "Cylinder" if path == "cylinder" else None
        kind = self._chosen(table, KIND, CHAMBERS, path, default)
        return None if kind is None else self._filled(kind, table, path, KIND)

    def _law(self, table: Any, path: str, slot: str) -> Any:
        if not self._is_table(table, path):
            return None
        law = self._chosen(table, LAW, self.laws[slot], path, None)
        return None if law is None else self._filled(law, table, path, LAW)

    def _part(self, table: Any, kind: type, path: str) -> Any:
        return self._filled(kind, table, path, "") if self._is_table(table, path) else None

    def _chosen(
        self, table: dict[str, Any], word: str, known: Mapping[str, type], path: str, default: Any
    ) -> type | None:
        """Class a table names under the key `word`."""
        name = table.get(word, default)
        if isinstance(name, str) and name in known:
            return known[name]
        names = ", ".join(known)
        if name is None:
            self.wrong.append(f"{path}.{word}: missing; one of {names}")
            return None
        if not isinstance(name, str):
            self.wrong.append(f"{path}.{word} = {name!r}: must be text; one of {names}")
            return None
        slot = next((slot for slot, laws in self.laws.items() if name in laws), None)
        hint = nearest(name, known) or f"; there are {names}"
        if word == LAW and slot is not None:
            hint = f": it fills {slot}; here may stand {names}"
        self.wrong.append(f"{path}.{word} = {name!r}: no such {word}{hint}")
        return None

    def _filled(self, kind: type, table: dict[str, Any], path: str, word: str) -> Any:
        """Instance of a dataclass from a table."""
        items = {item.name: item for item in dataclasses.fields(kind)}
        self._unknown(table, [*items, *([word] if word else [])], path)
        before, values = len(self.wrong), {}
        for name, item in items.items():
            where = f"{path}.{name}"
            if name in table:
                values[name] = self._value(table[name], where, item, word == KIND)
            elif item.default is item.default_factory is dataclasses.MISSING:
                limits = item.metadata.get("limits")
                self.wrong.append(f"{where}: missing" + (f" [{limits.unit}]" if limits else ""))
        return kind(**values) if len(self.wrong) == before else None

    def _value(self, value: Any, path: str, item: dataclasses.Field[Any], in_chamber: bool) -> Any:
        if in_chamber and item.name in CHAMBER_SLOTS:
            return self._law(value, path, item.name)
        if in_chamber and item.name in PARTS:
            return self._part(value, PARTS[item.name], path)
        if "series" in item.metadata:
            if isinstance(value, list) and all(is_number(number) for number in value):
                return tuple(float(number) for number in value)
            self.wrong.append(f"{path} = {_short(value)}: must be a list of numbers")
            return None
        if not is_number(value):
            self.wrong.append(f"{path} = {_short(value)}: must be a number")
            return None
        limits = item.metadata.get("limits")
        return float(value) if limits is None or limits.kind is float else value

    def _is_table(self, value: Any, path: str) -> bool:
        if isinstance(value, dict):
            return True
        self.wrong.append(f"{path} = {_short(value)}: must be a table")
        return False

    def _unknown(self, table: dict[str, Any], known: list[str], path: str) -> None:
        for key in table:
            if key not in known:
                where = f"{path}.{key}" if path else key
                hint = nearest(key, known) or f"; there are {', '.join(known)}"
                self.wrong.append(f"{where}: unknown key{hint}")


def _short(value: Any) -> str:
    shown = repr(value)
    return shown if len(shown) < 60 else shown[:57] + "..."
