"""Exits of a run from the ranges its laws were made for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from saleg.engine import Engine
from saleg.kernel import layout
from saleg.laws import Law
from saleg.laws.base import Validity

#: Units of what a law may be valid for.
VALIDITY_UNITS = {
    "temperature": "K",
    "pressure": "Pa",
    "mean_piston_speed": "m/s",
    "equivalence_ratio": "-",
    "burnt_share": "-",
    "air_fuel_ratio": "-",
    "stroke_ratio": "-",
}
#: Part of what an ignition integral comes to from which on its law counts as at work: what is
#: added before, by cold gas, decides nothing.
FIRST_OF_INTEGRAL = 1e-3
COLUMNS = {
    "side": "-",
    "slot": "-",
    "law": "-",
    "quantity": "-",
    "unit": "-",
    "low": "as the quantity",
    "high": "as the quantity",
    "seen_low": "as the quantity",
    "seen_high": "as the quantity",
    "time_share": "-",
    "source": "-",
}


def range_exits(engine: Engine, strokes: np.ndarray, history: np.ndarray) -> list[dict[str, Any]]:
    """Every law that was asked outside its range over a cycle.

    Parameters
    ----------
    engine : Engine
    strokes : ndarray of STROKE_RECORD
        The cycle.
    history : ndarray of HISTORY_RECORD
        Its history.

    Returns
    -------
    list of dict
        For each law, side and quantity: the range, the values seen, and the share of the time the
        law was at work that it was outside. Keys are those of `COLUMNS`.
    """
    return list(_rows(engine, strokes, history))


def _rows(engine: Engine, strokes: np.ndarray, history: np.ndarray) -> Iterator[dict[str, Any]]:
    for side, (name, chamber) in enumerate(zip(("left", "right"), engine.chambers, strict=True)):
        for slot, law in chamber.laws.items():
            for validity in law.ranges:
                weights = _time_at_work(slot, history, side)
                values = _values(engine, strokes, history, side, validity.quantity)
                found = _exit(law, validity, np.broadcast_to(values, len(history)), weights)
                if found is not None:
                    yield {"side": name, "slot": slot, **found}


def _exit(
    law: Law, validity: Validity, values: np.ndarray, weights: np.ndarray
) -> dict[str, Any] | None:
    """Range of values a law met, if it left the one it was made for."""
    at_work = weights > 0.0
    if not at_work.any():
        return None
    outside = (values < validity.low) | (values > validity.high)
    share = float(weights[outside].sum() / weights.sum())
    if share == 0.0:
        return None
    return {
        "law": type(law).__name__,
        "quantity": validity.quantity,
        "unit": VALIDITY_UNITS[validity.quantity],
        "low": validity.low,
        "high": validity.high,
        "seen_low": float(values[at_work].min()),
        "seen_high": float(values[at_work].max()),
        "time_share": share,
        "source": validity.source,
    }


def _time_at_work(slot: str, history: np.ndarray, side: int) -> np.ndarray:
    """Time each row of a history stands for while a law is at work [s]."""
    closed = history["mode"][:, side] != layout.OPEN
    if slot == "ignition":
        integral = history["ignition"][:, side]
        least = FIRST_OF_INTEGRAL * min(float(integral.max(initial=0.0)), 1.0)
        closed &= (integral > least) & (integral < 1.0)
    return np.where(closed, _widths(history["t"]), 0.0)


def _widths(t: np.ndarray) -> np.ndarray:
    """Half the distance to the neighbours on both sides [s]."""
    if not len(t):
        return t
    gaps = np.diff(t, prepend=t[0], append=t[-1])
    return 0.5 * (gaps[:-1] + gaps[1:])


def _values(
    engine: Engine, strokes: np.ndarray, history: np.ndarray, side: int, quantity: str
) -> Any:
    """A quantity over the history, or one number for all of it."""
    if quantity == "temperature":
        return history["T"][:, side]
    if quantity == "pressure":
        return history["p"][:, side]
    if quantity == "mean_piston_speed":
        return float(
            np.abs(strokes["x_end"] - strokes["x_start"]).sum() / strokes["duration"].sum()
        )
    if quantity == "burnt_share":
        return history["burnt"][:, side] / history["mass"][:, side]
    if quantity == "stroke_ratio":
        inward = strokes["direction"] == (-1.0, 1.0)[side]
        return float(strokes["duration"][inward].sum() / strokes["duration"][~inward].sum())
    cylinder: Any = engine.chambers[side]
    if quantity == "equivalence_ratio":
        return float(cylinder.equivalence_ratio)
    if quantity == "air_fuel_ratio":
        return float(cylinder.fuel.air_fuel_ratio)
    raise ValueError(
        f"a law cannot be valid for '{quantity}': there are {', '.join(VALIDITY_UNITS)}"
    )
