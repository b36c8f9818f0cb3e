"""Published machine nearest to an engine, and what of a result it supports."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from saleg.engine import CombustionChamber, Engine
from saleg.errors import UnknownPath
from saleg.machines import PUBLISHED, PublishedMachine
from saleg.simulation.performance import Performance

#: Ratio of two numbers up to which machines count as alike: at 1.5 a volume differs by 3.4 and a
#: piston speed by 2.2, beyond which correlations of heat transfer and friction are no longer those
#: that were tried.
ALIKE = 1.5
#: Relative difference of heating values and air-fuel ratios up to which two fuels are the same.
SAME_FUEL = 0.05
#: Deviation up to which a figure counts as supported by a machine.
SUPPORTED = 0.10


@dataclass(frozen=True)
class NearestMachine:
    """Published machine nearest to an engine.

    Attributes
    ----------
    name : str
        Name in :data:`saleg.machines.PUBLISHED`.
    is_measured : bool
        Whether its results were measured; else its source simulated them.
    is_it : bool
        Whether the engine is that machine, within the ranges of what its source leaves open.
    differences : tuple of str
        In what the engine or its result is not like it; empty if it can support the result.
    deviations : dict of str to float
        From each of its published results [-], but those used to set the engine: of this result
        where the engine is that machine, else of our engine of it.
    here : dict of str to float
        The same of this result, whatever the engine; at one setting of the machine only.
    """

    name: str
    is_measured: bool
    is_it: bool
    differences: tuple[str, ...]
    deviations: dict[str, float]
    here: dict[str, float] = field(compare=False)

    @property
    def supported(self) -> tuple[str, ...]:
        """Published results met within 10 %; none if engine or result is not like it."""
        if self.differences:
            return ()
        return tuple(name for name, off in self.deviations.items() if abs(off) <= SUPPORTED)

    @property
    def kind(self) -> str:
        """Where its results come from."""
        return "measured" if self.is_measured else "simulated by its source"

    @property
    def whose(self) -> str:
        """Whose the deviations are."""
        return "this result" if self.is_it else "our engine of it"

    def __str__(self) -> str:
        """The machine and what it supports, or why it does not."""
        if self.differences:
            told = "; ".join(self.differences)
            return (
                f"supported by no published machine; nearest is {self.name} ({self.kind}): {told}"
            )
        supported = ", ".join(self.supported) or "nothing"
        results = _in_per_cent(self.deviations) or "nothing published for it"
        told = f"supports {supported}; {self.whose}: {results}"
        if not self.is_it and self.here:
            told += (
                f"; this result beside what is published of the machine: {_in_per_cent(self.here)}"
            )
        return f"nearest published machine {self.name} ({self.kind}) {told}"


def _in_per_cent(deviations: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {100.0 * off:+.1f} %" for name, off in deviations.items())


class _Number(NamedTuple):
    """A number that makes a machine like another one; NaN where it is not known."""

    name: str
    unit: str
    factor: float
    of: Any


_NUMBERS = (
    _Number("bore", "mm", 1e3, lambda engine, cylinder: cylinder.bore),
    _Number("stroke", "mm", 1e3, lambda engine, _: engine.maximum_stroke),
    _Number("moving mass", "kg", 1.0, lambda engine, _: engine.translator.mass),
    _Number("equivalence ratio", "", 1.0, lambda _, cylinder: cylinder.equivalence_ratio),
    _Number("charge", "bar", 1e-5, lambda _, cylinder: cylinder.reference_state.pressure),
    _Number(
        "load",
        "N s/m",
        1.0,
        lambda engine, _: getattr(engine.alternator, "load_constant", math.nan),
    ),
)


def nearest_machine(
    engine: Engine, performance: Performance, strokes: np.ndarray
) -> NearestMachine | None:
    """Published machine nearest to an engine; None for one that burns nothing.

    Parameters
    ----------
    engine : Engine
    performance : Performance
    strokes : ndarray of STROKE_RECORD
        The cycle, empty where it is not known.
    """
    if not engine.has_combustion:
        return None
    name = min(PUBLISHED, key=lambda key: _distance(engine, performance, PUBLISHED[key]))
    machine = PUBLISHED[name]
    seen = _as_machine(engine, machine)
    differences = list(_differences(engine, performance, machine) if seen is None else ())
    if not float(strokes["heat_released"].sum()) > 0.0 or not performance.frequency > 0.0:
        differences.append("this one does not run on fuel")
    elif seen is not None:
        differences += _not_held(performance, machine)
    here = _results(_engine_of(name) if seen is None else seen, performance, machine)
    deviations = _judged(machine) if seen is None else here
    return NearestMachine(
        name, machine.is_measured, seen is not None, tuple(differences), deviations, here
    )


@cache
def _engine_of(name: str) -> Engine:
    """Engine of a published machine, built once."""
    return PUBLISHED[name].engine()


def _cylinders(engine: Engine) -> list[Any]:
    return [one for one in engine.chambers if isinstance(one, CombustionChamber)]


def _as_machine(engine: Engine, machine: PublishedMachine) -> Engine | None:
    """The engine, or its mirror image, if it is the machine but for what its source leaves open."""
    mirrored = dataclasses.replace(engine, left=engine.right, right=engine.left)
    return next((one for one in (engine, mirrored) if _is_machine(one, machine)), None)


def _is_machine(engine: Engine, machine: PublishedMachine) -> bool:
    paths = {one.path for one in machine.open_quantities}
    paths |= {one.held_by for one in machine.held}
    for one in machine.published:
        paths |= {*one.at, *(one.over or {})}
    try:
        values = {path: engine.get(path) for path in paths}
    except UnknownPath:
        return False
    inside = all(one.low <= values[one.path] <= one.high for one in machine.open_quantities)
    ours = _engine_of(machine.name).replace(**values, name=engine.name, start=engine.start)
    return inside and ours == engine


def _judged(machine: PublishedMachine) -> dict[str, float]:
    """Deviations of our engine of a machine, but of what was used to set it."""
    kept, held = machine.deviations(), {one.label for one in machine.held}
    return {label: off for label, off in kept.items() if label not in held}


def _results(
    engine: Engine, performance: Performance, machine: PublishedMachine
) -> dict[str, float]:
    """Deviations of a result of the machine itself from what is published for its numbers."""
    return {
        one.label: one.deviation(getattr(performance, one.figure))
        for one in machine.published
        if not one.held_by and one.over is None and _stands_at(engine, one.at)
    }


def _stands_at(engine: Engine, numbers: Mapping[str, float]) -> bool:
    return all(engine.get(path) == value for path, value in numbers.items())


def _not_held(performance: Performance, machine: PublishedMachine) -> Iterator[str]:
    """Published results the engine was to be set to, and misses."""
    for one in machine.held:
        off = one.deviation(getattr(performance, one.figure))
        if not abs(off) <= SUPPORTED:
            yield f"{one.label} {100.0 * off:+.0f} % from its, which the engine is to be set to"


def _distance(engine: Engine, performance: Performance, machine: PublishedMachine) -> float:
    """Sum of the logarithms of all ratios, and one for each difference of kind; the worse side."""
    other = _engine_of(machine.name)
    frequency = abs(_logarithm(_frequency_ratio(performance, machine)))
    return frequency + max(
        sum(abs(_logarithm(ratio)) for _, ratio in _ratios(engine, one, other))
        + len(list(_kinds(engine, one, other)))
        for one in _cylinders(engine)
    )


def _logarithm(ratio: float) -> float:
    return math.log(ratio) if ratio > 0.0 else math.inf


def _differences(
    engine: Engine, performance: Performance, machine: PublishedMachine
) -> Iterator[str]:
    """In what an engine is not like a machine, on either side."""
    other = _engine_of(machine.name)
    told = (text for one in _cylinders(engine) for text in _unlike(engine, one, other))
    yield from dict.fromkeys(told)
    if not _is_alike(_frequency_ratio(performance, machine)):
        range_of = " to ".join(f"{value:.4g}" for value in sorted(machine.frequencies))
        yield f"frequency {performance.frequency:.4g} Hz (its {range_of} Hz)"


def _unlike(engine: Engine, cylinder: Any, other: Engine) -> Iterator[str]:
    """In what one cylinder of an engine is not like those of a machine."""
    for (name, unit, factor, of), ratio in _ratios(engine, cylinder, other):
        if not _is_alike(ratio):
            here, there = factor * of(engine, cylinder), factor * of(other, _cylinders(other)[0])
            yield f"{name} {here:.4g} (its {there:.4g}) {unit}".rstrip()
    yield from _kinds(engine, cylinder, other)


def _ratios(engine: Engine, cylinder: Any, other: Engine) -> Iterator[tuple[_Number, float]]:
    """All numbers known of both, and their ratios."""
    for number in _NUMBERS:
        here, there = number.of(engine, cylinder), number.of(other, _cylinders(other)[0])
        if not (math.isnan(here) or math.isnan(there)):
            yield number, here / there if there > 0.0 else math.inf


def _kinds(engine: Engine, cylinder: Any, other: Engine) -> Iterator[str]:
    """Differences of kind: cylinders, fuel, ignition."""
    theirs = _cylinders(other)
    count, its = len(_cylinders(engine)), len(theirs)
    if count != its:
        yield f"cylinders {count} (its {its})"
    if not _same_fuel(cylinder.fuel, theirs[0].fuel):
        yield "another fuel"
    here, there = _ignition(cylinder), _ignition(theirs[0])
    if here != there:
        yield f"{here} (its {there})"


def _ignition(cylinder: Any) -> str:
    return "spark or injection" if cylinder.ignition.is_timed else "auto-ignition"


def _is_alike(ratio: float) -> bool:
    return 1.0 / ALIKE <= ratio <= ALIKE


def _frequency_ratio(performance: Performance, machine: PublishedMachine) -> float:
    """Ratio of a frequency to the nearest published; 1 within them, or where one is not known."""
    frequency, others = performance.frequency, machine.frequencies
    if not others or not frequency > 0.0:
        return 1.0
    return frequency / min(max(frequency, min(others)), max(others))


def _same_fuel(one: Any, other: Any) -> bool:
    ratios = (
        one.lower_heating_value / other.lower_heating_value,
        one.air_fuel_ratio / other.air_fuel_ratio,
    )
    return all(abs(ratio - 1.0) <= SAME_FUEL for ratio in ratios)
