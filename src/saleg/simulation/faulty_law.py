"""Which law gives no finite number: asked in Python where a start or a step has failed."""

from __future__ import annotations

import copy
import inspect
import math
import numbers
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.kernel import layout
from saleg.kernel.rhs import rhs
from saleg.laws import Actuators
from saleg.laws.base import ENGINE_SLOTS, Law

if TYPE_CHECKING:
    from saleg.engine import Engine

#: How far to look beyond the last state that was good, in natural periods.
AHEAD = (0.0, *(10.0**n for n in range(-12, -1)))
#: What a record holds of a law's answer at an event: field, slot and method.
OF_ENGINE = (("load_weight", "alternator"), ("friction_held", "friction"))
OF_CHAMBERS = (
    ("duration", "heat_release", "duration"),
    ("mass", "gas_exchange", "charge"),
    ("fuel", "gas_exchange", "charge"),
    ("air", "gas_exchange", "charge"),
    ("burnt", "gas_exchange", "charge"),
)


class Fault(Exception):
    """A method of a law that fails, or gives no finite number; says which."""


class _Asked:
    """A law whose methods, shown finite numbers, must give finite numbers."""

    def __init__(self, law: Law):
        self._law = law

    @property  # type: ignore[misc]
    def __class__(self) -> Any:  # it passes for the law
        return type(self._law)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._law, name)
        return partial(self._ask, name, value) if name in self._law.compiled else value

    def _ask(self, name: str, method: Callable[..., Any], *shown: Any) -> Any:
        owner = f"{type(self._law).__name__}.{name}"
        try:
            value = method(*shown)
        except Exception as error:
            raise Fault(f"{owner} fails: {type(error).__name__}: {error}") from error
        declared = _slot_method(self._law, name)
        wanted = declared.__annotations__.get("return")
        if wanted == "float" and not isinstance(value, (numbers.Real, np.bool_)):
            raise Fault(f"{owner} returns {value!r}; it must return a number")
        if _is_finite(shown) and not _is_finite(value):
            raise Fault(f"{owner} returns {value!r}{_at(declared, shown)}")
        return value


def asked(engine: Engine) -> Engine:
    """Copy of an engine whose laws raise a :class:`Fault`."""
    made = copy.copy(engine)
    for side in ("left", "right"):
        chamber = copy.copy(getattr(engine, side))
        for slot, law in chamber.laws.items():
            object.__setattr__(chamber, slot, _Asked(law))
        object.__setattr__(made, side, chamber)
    for slot in ENGINE_SLOTS:
        object.__setattr__(made, slot, _Asked(getattr(engine, slot)))
    object.__setattr__(made, "actuators", Actuators())
    return made


def fault_near(engine: Engine, E: Any, C: Any, y: np.ndarray) -> str:
    """Method of a law without a finite value at a state or a little after it; empty if none is.

    Parameters
    ----------
    engine : Engine
    E, C : records
        Of engine and chambers; they are written to.
    y : ndarray, shape (N_ALL,)
    """
    for name, slot in OF_ENGINE:
        if not math.isfinite(E[name]):
            return f"{type(getattr(engine, slot)).__name__}.at_dead_centre returned {E[name]}"
    for chamber, c in zip(engine.chambers, C, strict=True):
        for name, slot, method in OF_CHAMBERS:
            if slot in chamber.laws and not math.isfinite(c[name]):
                return f"{type(chamber.laws[slot]).__name__}.{method} returned {c[name]} ({name})"
    watched, period = asked(engine), 2.0 * math.pi * float(E.length_scale / E.speed_scale)
    slope = np.zeros(layout.N_ALL)
    for ahead in AHEAD:
        there, dy = y + ahead * period * slope, np.zeros(layout.N_ALL)
        try:
            with np.errstate(all="ignore"):
                rhs(watched, E, C, float(E.t) + ahead * period, there, dy, 0)
        except Fault as fault:
            return str(fault)
        except (ArithmeticError, ValueError):  # beyond what the equations know
            return ""
        slope = dy if ahead == 0.0 else slope
    return ""


def _is_finite(value: Any) -> bool:
    """Whether all numbers in a value, a tuple of them for instance, are finite."""
    if isinstance(value, tuple):
        return all(map(_is_finite, value))
    return not isinstance(value, (numbers.Real, np.bool_)) or math.isfinite(value)


def _slot_method(law: Law, name: str) -> Callable[..., Any]:
    """A method as the base class of the slot has it."""
    slot = next(base for base in type(law).__mro__ if "slot" in vars(base))
    method: Callable[..., Any] = getattr(slot, name)
    return method


def _at(method: Callable[..., Any], shown: tuple[Any, ...]) -> str:
    """Where a law was asked, in words: the first of the numbers it was shown, by name."""
    texts = []
    names = list(inspect.signature(method).parameters)[1:]
    for name, item in zip(names, shown, strict=True):
        if hasattr(item, "_asdict"):
            texts += [f"{inner} = {value:.6g}" for inner, value in item._asdict().items()]
        elif isinstance(item, numbers.Real):
            texts.append(f"{name} = {item:.6g}")
    return f" at {', '.join(texts[:6])}" if texts else ""
