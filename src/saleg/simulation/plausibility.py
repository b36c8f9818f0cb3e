"""Limits of what is plausible for an engine, with their reasons, and figures beyond them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from saleg.engine import CombustionChamber, Engine
from saleg.simulation.indicators import both, summed


class Limit(NamedTuple):
    """Limit of what is plausible for a figure.

    Attributes
    ----------
    name : str
        Name of the figure.
    unit : str
        Unit of the limit.
    highest : float
        The limit [in that unit].
    reason : str
        Why it stands there.
    value : callable
        Takes the figures of a cycle by name, of one engine or of many, in SI; returns the figure
        in the unit of the limit.
    """

    name: str
    unit: str
    highest: float
    reason: str
    value: Callable[[Mapping[str, Any]], Any]


class Implausible(NamedTuple):
    """Figure beyond what is plausible.

    Attributes
    ----------
    name : str
        Name of the figure.
    value : float
        Its value [in the unit of the limit].
    limit : float
        The limit [in its unit].
    unit : str
        That unit.
    reason : str
        Why the limit stands there.
    """

    name: str
    value: float
    limit: float
    unit: str
    reason: str

    def __str__(self) -> str:
        """Figure and limit; the reason where there is no number to tell."""
        if np.isnan(self.limit):
            return self.reason
        number = f"{self.value:.4g} {self.unit}".removesuffix(" -")
        return f"{self.name} {number} (> {self.limit:g})"


PRESSURE = Limit(
    "peak pressure",
    "bar",
    400.0,
    "heads of series diesel engines hold some 250 bar, the thesis' designs reach 237 bar",
    lambda figures: figures["peak_pressure"] / 1e5,
)
#: Limits of figures, each a choice of ours well beyond what its reason names.
LIMITS = (
    PRESSURE,
    Limit(
        "compression ratio",
        "-",
        80.0,
        "the thesis' designs reach 30, free-piston simulations of natural gas 43",
        lambda figures: figures["compression_ratio"],
    ),
    Limit(
        "mean piston speed",
        "m/s",
        30.0,
        "racing engines reach 26 m/s, the thesis' designs 17 m/s",
        lambda figures: 2.0 * figures["stroke"] * figures["frequency"],
    ),
    Limit(
        "indicated efficiency",
        "-",
        0.6,
        "the largest marine two-strokes have some 0.55",
        lambda figures: figures["indicated_efficiency"],
    ),
    Limit(
        "steepest rise",
        "bar per degree of a cycle",
        20.0,
        "engines with homogeneous charge are kept below some 10, for noise and rings",
        lambda figures: figures["peak_pressure_rise"] / 1e5 / (360.0 * figures["frequency"]),
    ),
    Limit(
        "peak temperature",
        "K",
        3200.0,
        "dissociation, which no gas law here has, keeps burnt gas colder",
        lambda figures: figures["peak_temperature"],
    ),
)
HEATED_BY_WALLS = "more heat from the walls than from the fuel: the efficiency counts fuel only"


def implausible(
    engine: Engine, figures: Mapping[str, Any], strokes: np.ndarray
) -> tuple[Implausible, ...]:
    """Figures of a cycle beyond what is plausible.

    Parameters
    ----------
    engine : Engine
    figures : mapping of str to float
        Those of a :class:`.Performance`, by name.
    strokes : ndarray of STROKE_RECORD
        The cycle, empty where it is not known.

    Returns
    -------
    tuple of Implausible
        Empty for most engines, and where the figures are not known.
    """
    return tuple(
        Implausible(name, float(value), limit, unit, reason)
        for beyond, name, value, limit, unit, reason in _judged(engine, figures, strokes)
        if beyond
    )


def remarks_on(engine: Engine, figures: Mapping[str, Any], strokes: np.ndarray) -> list[str]:
    """Figures of a cycle beyond what is plausible, as text; see :func:`implausible`."""
    return [str(figure) for figure in implausible(engine, figures, strokes)]


def is_remarkable(engine: Engine, figures: Mapping[str, Any], strokes: np.ndarray) -> Any:
    """Whether there is a remark on each of many cycles; as :func:`.cycle_figures` has them."""
    return np.any([row[0] for row in _judged(engine, figures, strokes)], axis=0)


def _judged(
    engine: Engine, figures: Mapping[str, Any], strokes: np.ndarray
) -> Iterator[tuple[Any, str, Any, float, str, str]]:
    """Whether each figure is beyond its limit, and the fields of :class:`Implausible`."""
    arrays = {name: np.asarray(figure) for name, figure in figures.items()}
    for name, unit, limit, reason, value_of in LIMITS:
        with np.errstate(all="ignore"):
            value = value_of(arrays)
        yield value > limit, name, value, limit, unit, reason
    for side, chamber in enumerate(engine.chambers):
        if engine.has_combustion and not isinstance(chamber, CombustionChamber):
            peak = strokes["peak_pressure"][..., side].max(axis=-1, initial=0.0) / 1e5
            name = f"{PRESSURE.name} in the bounce chamber"
            yield peak > PRESSURE.highest, name, peak, PRESSURE.highest, "bar", PRESSURE.reason
    cycle = summed(strokes)
    released, gained = both(cycle["heat_released"]), -both(cycle["heat_lost"])
    heated = (gained > released) & (released > 0.0)
    yield heated, "heat from the walls", gained, np.nan, "J", HEATED_BY_WALLS
    for side, (here, there) in enumerate((("left", "right"), ("right", "left"))):
        fuelled = (cycle["fuel_energy"][..., side] > 0.0) & (released > 0.0)
        silent = fuelled & (cycle["heat_released"][..., side] <= 0.0)
        told = f"the {here} cylinder has fuel and does not fire, while the {there} one does"
        yield silent, f"heat in the {here} cylinder", 0.0, np.nan, "J", told
