"""Validity of a result: laws outside their ranges, implausible figures, the nearest machine."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.engine import Engine
from saleg.simulation.nearest import NearestMachine, nearest_machine
from saleg.simulation.performance import Performance
from saleg.simulation.plausibility import Implausible, implausible

if TYPE_CHECKING:
    import pandas as pd


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
    beyond = implausible(engine, vars(performance), strokes)
    return ValidityReport(tuple(exits), beyond, nearest_machine(engine, performance, strokes))
