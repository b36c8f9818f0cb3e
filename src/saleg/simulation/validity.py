"""Validity of a result: laws outside their ranges, implausible figures, the nearest machine."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.engine import CombustionChamber, Engine
from saleg.laws import SparkAfterDelay, SparkAtClearance
from saleg.machines import PUBLISHED, PublishedMachine
from saleg.simulation.performance import Performance
from saleg.simulation.plausibility import Implausible, implausible

if TYPE_CHECKING:
    import pandas as pd

#: Ratio of lengths and frequencies up to which two machines count as alike: at 1.5 a volume
#: differs by 3.4 and a piston speed by 2.2, beyond which correlations of heat transfer and
#: friction are no longer those that were tried.
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
    differences : tuple of str
        In what the engine is not like it; empty if it is within what the machine can support.
    deviations : dict of str to float
        Our deviation from each of its published results [-].
    """

    name: str
    is_measured: bool
    differences: tuple[str, ...]
    deviations: dict[str, float]

    @property
    def supported(self) -> tuple[str, ...]:
        """Published results that ours meet within 10 %; none if the engine is not like it."""
        if self.differences:
            return ()
        return tuple(name for name, off in self.deviations.items() if abs(off) <= SUPPORTED)

    def __str__(self) -> str:
        """The machine and what it supports, or why it does not."""
        kind = "measured" if self.is_measured else "simulated by its source"
        if self.differences:
            return f"supported by no published machine; nearest is {self.name} ({kind}): " + (
                "; ".join(self.differences)
            )
        results = ", ".join(f"{name} {100.0 * off:+.1f} %" for name, off in self.deviations.items())
        supported = ", ".join(self.supported) or "nothing"
        return f"nearest published machine {self.name} ({kind}) supports {supported}; ours: " + (
            results
        )


@dataclass(frozen=True)
class ValidityReport:
    """What speaks against a result, and what supports it.

    Attributes
    ----------
    range_exits : tuple of dict
        Laws outside the range they were made for, as ``run.range_exits`` has them.
    implausible : tuple
        Figures beyond what is plausible, each with its limit and the reason for it.
    nearest : NearestMachine or None
        The nearest published machine; None for an engine that burns nothing.
    """

    range_exits: tuple[dict[str, Any], ...]
    implausible: tuple[Implausible, ...]
    nearest: NearestMachine | None

    @property
    def table(self) -> pd.DataFrame:
        """A row for each finding: kind, what, value, limits, unit and reason."""
        import pandas as pd

        columns = ("kind", "what", "seen", "limit", "unit", "reason")
        return pd.DataFrame(list(self._rows()), columns=columns)

    def _rows(self) -> Iterator[tuple[str, str, str, str, str, str]]:
        for exit in self.range_exits:
            yield (
                "law outside its range",
                f"{exit['side']} {exit['law']}: {exit['quantity'].replace('_', ' ')}",
                f"{exit['seen_low']:.4g} to {exit['seen_high']:.4g}",
                f"{exit['low']:g} to {exit['high']:g}",
                exit["unit"],
                exit["source"],
            )
        for name, value, limit, unit, reason in self.implausible:
            yield "implausible figure", name, f"{value:.4g}", f"{limit:g}", unit, reason
        if self.nearest is not None:
            supported = ", ".join(self.nearest.supported) or "nothing"
            yield "support", self.nearest.name, supported, "", "", str(self.nearest)

    def __str__(self) -> str:
        """One line for each finding."""
        lines = [
            f"outside its range: {what}, {seen} (made for {limit}) {unit}; {reason}"
            for kind, what, seen, limit, unit, reason in self._rows()
            if kind == "law outside its range"
        ]
        lines += [
            f"implausible: {figure}" + ("" if math.isnan(figure.limit) else f"; {figure.reason}")
            for figure in self.implausible
        ]
        if self.nearest is not None:
            lines.append(str(self.nearest))
        return "\n".join(lines)


class _Facts(NamedTuple):
    """What makes a machine like another one."""

    bore: float
    maximum_stroke: float
    frequencies: Sequence[float]
    fuel: tuple[float, float]
    ignition: str


def validity_of(
    engine: Engine,
    performance: Performance,
    strokes: np.ndarray,
    exits: Sequence[dict[str, Any]],
) -> ValidityReport:
    """Validity of a result.

    Parameters
    ----------
    engine : Engine
    performance : Performance
    strokes : ndarray of STROKE_RECORD
        The cycle, empty where it is not known.
    exits : sequence of dict
        Exits of laws from their ranges.
    """
    beyond = implausible(engine, performance, strokes)
    return ValidityReport(tuple(exits), beyond, _nearest(engine, performance.frequency))


def _nearest(engine: Engine, frequency: float) -> NearestMachine | None:
    if not engine.has_combustion:
        return None
    facts = _facts(engine, (frequency,) if frequency > 0.0 else ())
    others = {
        name: _facts(machine.engine(), machine.frequencies) for name, machine in PUBLISHED.items()
    }
    name = min(others, key=lambda key: _distance(facts, others[key]))
    machine: PublishedMachine = PUBLISHED[name]
    differences = tuple(_differences(facts, others[name]))
    return NearestMachine(name, machine.is_measured, differences, machine.deviations())


def _facts(engine: Engine, frequencies: Sequence[float]) -> _Facts:
    cylinder = next(one for one in engine.chambers if isinstance(one, CombustionChamber))
    fuel = cylinder.fuel
    timed = isinstance(cylinder.ignition, SparkAtClearance | SparkAfterDelay)
    return _Facts(
        cylinder.bore,
        engine.maximum_stroke,
        frequencies,
        (fuel.lower_heating_value, fuel.air_fuel_ratio),
        "spark or injection" if timed else "auto-ignition",
    )


def _distance(one: _Facts, other: _Facts) -> float:
    """Sum of the logarithms of all ratios, and one for a fuel or an ignition of another kind."""
    ratios = [one.bore / other.bore, one.maximum_stroke / other.maximum_stroke]
    ratios.append(_ratio(one.frequencies, other.frequencies))
    kinds = [one.ignition != other.ignition, not _same_fuel(one, other)]
    return sum(abs(math.log(ratio)) for ratio in ratios) + sum(kinds)


def _differences(one: _Facts, other: _Facts) -> Iterator[str]:
    """In what an engine is not like a machine."""
    lengths = {"bore": (one.bore, other.bore), "stroke": (one.maximum_stroke, other.maximum_stroke)}
    for name, (here, there) in lengths.items():
        if not _is_alike(here / there):
            yield f"{name} {1e3 * here:.4g} mm (its {1e3 * there:.4g} mm)"
    if not _is_alike(_ratio(one.frequencies, other.frequencies)):
        range_of = " to ".join(f"{value:.4g}" for value in sorted(other.frequencies))
        yield f"frequency {one.frequencies[0]:.4g} Hz (its {range_of} Hz)"
    if not _same_fuel(one, other):
        yield "another fuel"
    if one.ignition != other.ignition:
        yield f"{one.ignition} (its {other.ignition})"


def _is_alike(ratio: float) -> bool:
    return 1.0 / ALIKE <= ratio <= ALIKE


def _ratio(frequencies: Sequence[float], others: Sequence[float]) -> float:
    """Ratio of a frequency to the nearest of a range; 1 within it, or where one is not known."""
    if not frequencies or not others:
        return 1.0
    return frequencies[0] / min(max(frequencies[0], min(others)), max(others))


def _same_fuel(one: _Facts, other: _Facts) -> bool:
    pairs = zip(one.fuel, other.fuel, strict=True)
    return all(abs(here / there - 1.0) <= SAME_FUEL for here, there in pairs)
