"""Published machines: what their sources print, and what they leave open."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any

from saleg.engine import Engine


@dataclass(frozen=True)
class Published:
    """A published result of a machine.

    Parameters
    ----------
    figure : str
        Name of a figure of :class:`saleg.Performance`.
    value : float
        Its value [in the SI unit of the figure]; with `over`, the ratio of two [-].
    at : mapping of str to float
        Numbers of the engine for which it is published, by path, where they differ.
    over : mapping of str to float, optional
        Numbers of the engine whose figure the ratio is taken over.
    held_by : str
        Path of what the source leaves open and the value was used to set; empty for a result to be
        met.
    """

    figure: str
    value: float
    at: Mapping[str, float] = field(default_factory=dict)
    over: Mapping[str, float] | None = None
    held_by: str = ""

    @property
    def label(self) -> str:
        """Name of the result, unique within a machine."""
        name = self.figure.replace("_", " ")
        if self.at:
            name += f" at {_words(self.at)}"
        return name if self.over is None else f"{name} over that at {_words(self.over)}"

    def deviation(self, ours: float) -> float:
        """Deviation of our value [-], over the published one."""
        return ours / self.value - 1.0


@dataclass(frozen=True)
class OpenQuantity:
    """A number a source leaves open, as assumed and as far as it may plausibly be otherwise.

    Parameters
    ----------
    path : str
        Where it stands in the engine.
    low, high : float
        Ends of its plausible range [in the unit of the field].
    why : str
        Reason for the value assumed.
    """

    path: str
    low: float
    high: float
    why: str


@dataclass(frozen=True)
class PublishedMachine:
    """A published machine: its engine, what is given, what is open, and what was found.

    Parameters
    ----------
    name : str
        Name in the catalogue.
    title : str
        What it is.
    source : str
        Where it is published.
    is_measured : bool
        Whether the results were measured; else its source simulated them.
    engine : callable
        Returns the engine.
    given : tuple of str
        What the source gives, in words.
    open_quantities : tuple of OpenQuantity
        What it leaves open.
    published : tuple of Published
        Its results.
    """

    name: str
    title: str
    source: str
    is_measured: bool
    engine: Callable[[], Engine]
    given: tuple[str, ...]
    open_quantities: tuple[OpenQuantity, ...]
    published: tuple[Published, ...]

    @property
    def held(self) -> tuple[Published, ...]:
        """Results that were used to set what the source leaves open."""
        return tuple(item for item in self.published if item.held_by)

    @property
    def frequencies(self) -> tuple[float, ...]:
        """Published frequencies [Hz]."""
        return tuple(
            item.value for item in self.published if item.figure == "frequency" and not item.over
        )

    def deviations(self) -> dict[str, float]:
        """Deviations of our results by label [-], as kept when the documentation was written."""
        kept = _kept()
        return {
            item.label: item.deviation(kept[self.name, item.label])
            for item in self.published
            if (self.name, item.label) in kept
        }


@cache
def _kept() -> dict[tuple[str, str], float]:
    """Our values, by machine and label; written by ``examples/machines/write_page.py``."""
    file = resources.files("saleg.machines").joinpath("ours.csv")
    with file.open(encoding="utf-8") as lines:
        rows: Any = csv.DictReader(lines)
        return {(row["machine"], row["result"]): float(row["ours"]) for row in rows}


def _words(numbers: Mapping[str, float]) -> str:
    """Paths and numbers, as ``springs.stiffness 14700``."""
    return ", ".join(f"{path} {value:g}" for path, value in numbers.items())
