"""Figures of a cycle that take more than a sum: combustion timing, adverse work, repeatability."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.columns import Column
from saleg.engine import Chamber, CombustionChamber, Engine
from saleg.kernel.control import NEAREST

if TYPE_CHECKING:
    from saleg.laws import HeatRelease

#: Points of the quadrature of adverse work, over the square root of the distance from dead centre.
ADVERSE_POINTS = 2001
#: Cycles whose changes of the compression ratio, each against the one before, are averaged.
CR_CYCLES = 10


def summed(strokes: np.ndarray) -> Any:
    """Every quantity of some strokes, summed over them; over those of each of many runs.

    Parameters
    ----------
    strokes : ndarray of STROKE_RECORD, shape (k,) or (n, k)

    Returns
    -------
    ndarray of STROKE_RECORD, shape () or (n,)
    """
    length = strokes.dtype.itemsize // 8
    numbers = strokes.view(np.float64).reshape(*strokes.shape, length)
    return numbers.sum(axis=-2).view(strokes.dtype)[..., 0]


def both(values: np.ndarray) -> Any:
    """Sum of the values of both sides."""
    return values[..., 0] + values[..., 1]


class Timing(NamedTuple):
    """Combustion timing, the mean of the cylinders that fired.

    Attributes
    ----------
    start : float
        Time of the start of combustion before dead centre [s].
    start_position : float
        Distance of the piston from its dead centre at that moment [m].
    centre : float
        Time after dead centre at which half of the heat is released [s], negative before it.
    """

    start: Any
    start_position: Any
    centre: Any


def timing(engine: Engine, strokes: np.ndarray) -> Timing:
    """Combustion timing over the strokes of a cycle, or of each of many; NaN without combustion."""
    count = np.zeros(strokes.shape[:-1])
    sums = np.zeros((3, *strokes.shape[:-1]))
    burns = [isinstance(chamber, CombustionChamber) for chamber in engine.chambers]
    laws: list[Any] = [getattr(chamber, "heat_release", None) for chamber in engine.chambers]
    halves = {id(law): half_burnt_of(law) for law in laws if law is not None}
    for side, chamber in enumerate(engine.chambers):
        if not burns[side]:
            continue
        sign = 1.0 - 2.0 * side
        ignition = strokes["ignition_time"][..., side]
        # What is lit at a dead centre, or after it, is lit in the stroke that leaves it.
        leaves = sign * strokes["direction"] > 0.0
        dead_centre = strokes["t"] - np.where(leaves, strokes["duration"], 0.0)
        before = dead_centre - ignition
        end = sign * np.where(leaves, strokes["x_start"], strokes["x_end"])
        position = strokes["ignition_height"][..., side] - (of_strokes(chamber.half_stroke) + end)
        half = of_strokes(halves[id(laws[side])])
        centre = half * strokes["combustion_duration"][..., side] - before
        fired = ignition >= 0.0
        sums += np.where(fired, (before, position, centre), 0.0).sum(axis=-1)
        count += fired.sum(axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return Timing(*(sums / count))


def of_strokes(value: Any) -> Any:
    """A number of an engine, or of each of many, beside the numbers of strokes."""
    return np.asarray(value)[:, None] if np.ndim(value) else value


def half_burnt_of(law: Any) -> Any:
    """The same as :func:`half_burnt`, of a law of columns row by row."""
    columns = {name: value for name, value in vars(law).items() if isinstance(value, Column)}
    if not columns:
        return half_burnt(law)
    rows = list(zip(*(values.tolist() for values in columns.values()), strict=True))
    laws = {row: replace(law, **dict(zip(columns, row, strict=True))) for row in rows}
    halves = {row: half_burnt(one) for row, one in laws.items()}
    return np.array([halves[row] for row in rows])


def half_burnt(law: HeatRelease) -> float:
    """Share of the combustion duration after which half of the released heat is out [-]."""
    half = 0.5 * law.burnt_fraction(1.0)
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if law.burnt_fraction(middle) < half:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def adverse_work(engine: Engine, rows: np.ndarray) -> float:
    """Work of the inverted part of both p-V loops, where expansion runs below compression [J].

    Around dead centre a charge that burns early and cools pushes harder on the way in than on the
    way out. Both branches are interpolated in the square root of the distance from dead centre, in
    which they are smooth.

    Parameters
    ----------
    engine : Engine
    rows : ndarray of HISTORY_RECORD
        History of one cycle from left dead centre to left dead centre.

    Returns
    -------
    float
    """
    turn = int(np.argmax(rows["x"]))
    total = 0.0
    for side, chamber in enumerate(engine.chambers):
        if not isinstance(chamber, CombustionChamber):
            continue
        to_right, to_left = rows[: turn + 1], rows[turn:]
        inward, outward = (to_right, to_left) if side == 1 else (to_left, to_right)
        total += _inverted_work(chamber, inward[::-1], outward, side)
    return total


def _inverted_work(chamber: Chamber, inward: np.ndarray, outward: np.ndarray, side: int) -> float:
    """Integral of compression over expansion pressure, where it is higher [J].

    Both branches begin at dead centre and go outward.
    """
    nearest = max(float(_height(chamber, rows, side)[0]) for rows in (inward, outward))
    compression = _Branch(chamber, inward, side, nearest, -1.0)
    expansion = _Branch(chamber, outward, side, nearest, 1.0)
    if min(len(compression.w), len(expansion.w)) < 2:
        return 0.0  # the ports never closed
    grid = np.linspace(0.0, min(compression.w[-1], expansion.w[-1]), ADVERSE_POINTS)
    excess = np.maximum(compression(grid) - expansion(grid), 0.0)
    return float(np.trapezoid(excess * chamber.area * 2.0 * grid, grid))


def _height(chamber: Chamber, rows: np.ndarray, side: int) -> np.ndarray:
    return chamber.half_stroke + (1.0 if side == 0 else -1.0) * rows["x"]


class _Branch:
    """Pressure of the closed chamber along one branch, by cubic pieces in w = sqrt(h - h_tdc)."""

    def __init__(self, chamber: Chamber, rows: np.ndarray, side: int, nearest: float, time: float):
        height = _height(chamber, rows, side)
        beyond = height - nearest
        # The far dead centre of a chamber that stays closed is left out: there dp/dw is infinite.
        moving = (rows["v"] != 0.0) | (beyond < 1e-12)
        rows = rows[(rows["mode"][:, side] > 0) & (beyond >= -1e-12) & moving]
        self.w = np.sqrt(np.maximum(_height(chamber, rows, side) - nearest, 0.0))
        self.p = rows["p"][:, side]
        with np.errstate(divide="ignore", invalid="ignore"):
            speed = np.abs(rows["v"]) / (2.0 * self.w)
        speed = np.where(self.w > 1e-7, speed, np.sqrt(0.5 * np.abs(rows["a"])))
        self.slope = rows["p_rate"][:, side] / (time * speed)

    def __call__(self, w: np.ndarray) -> np.ndarray:
        i = np.clip(np.searchsorted(self.w, w, side="right") - 1, 0, len(self.w) - 2)
        length = self.w[i + 1] - self.w[i]
        u = np.clip((w - self.w[i]) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
        rest = 1.0 - u
        start = (1.0 + 2.0 * u) * self.p[i] + u * length * self.slope[i]
        end = (3.0 - 2.0 * u) * self.p[i + 1] - rest * length * self.slope[i + 1]
        return rest * rest * start + u * u * end


def full_cycles(strokes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First and second strokes of all full cycles, left dead centre to left dead centre."""
    direction = strokes["direction"]
    starts = np.flatnonzero((direction[:-1] > 0.0) & (direction[1:] < 0.0))
    return strokes[starts], strokes[starts + 1]


def beyond_ports(engine: Engine, strokes: np.ndarray) -> np.ndarray:
    """Whether each stroke ended with the ports of a cylinder open."""
    left, right = (
        getattr(chamber, "port_closing", math.inf) - chamber.half_stroke
        for chamber in engine.chambers
    )
    return np.asarray((strokes["x_end"] > left) | (-strokes["x_end"] > right))


def stroke_compression_ratios(engine: Engine, strokes: np.ndarray) -> np.ndarray:
    """Geometric compression ratio of every stroke, between its dead centres [-]."""
    return np.asarray(compression_ratio(engine, *_ends(strokes)), dtype=float)


def own_compression_ratios(engine: Engine, side: int, strokes: np.ndarray) -> np.ndarray:
    """The same of the left (0) or right (1) chamber alone [-]."""
    return np.asarray(own_compression_ratio(engine, side, *_ends(strokes)), dtype=float)


def _ends(strokes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Left and right dead centre of every stroke [m]."""
    start, end = strokes["x_start"], strokes["x_end"]
    return np.minimum(start, end), np.maximum(start, end)


def cycle_compression_ratios(engine: Engine, strokes: np.ndarray) -> np.ndarray:
    """Geometric compression ratio of every full cycle, between its outermost positions [-]."""
    out, back = full_cycles(strokes)
    return compression_ratio(engine, np.minimum(out["x_start"], back["x_end"]), out["x_end"])


def compression_ratio(engine: Engine, low: Any, high: Any) -> Any:
    """Geometric compression ratio between two positions, of the cylinders together [-].

    Their greatest volumes over their least: ``(L + S/2) / (L - S/2)`` for two that are alike, and
    for a single cylinder its own. Without a cylinder, of both chambers.

    Parameters
    ----------
    engine : Engine
    low, high : float or ndarray
        Dead centres [m]; heads end the way.

    Returns
    -------
    float or ndarray
    """
    greatest, least = 0.0, 0.0
    for side, chamber in enumerate(engine.chambers):
        if isinstance(chamber, CombustionChamber) or not engine.has_combustion:
            far, near = _clearances(engine, side, low, high)
            greatest = greatest + chamber.area * far
            least = least + chamber.area * near
    return greatest / least


def own_compression_ratio(engine: Engine, side: int, low: Any, high: Any) -> Any:
    """Geometric compression ratio of the left (0) or right (1) chamber alone [-].

    Between two positions as in :func:`compression_ratio`.
    """
    far, near = _clearances(engine, side, low, high)
    return far / near


def _clearances(engine: Engine, side: int, low: Any, high: Any) -> tuple[Any, Any]:
    """Greatest and least clearance of a chamber between two positions [m]; heads end the way."""
    left, right = engine.chambers
    low = np.maximum(low, -NEAREST * left.half_stroke)
    high = np.minimum(high, NEAREST * right.half_stroke)
    far, near = (high, low) if side == 0 else (-low, -high)
    length = engine.chambers[side].half_stroke
    return length + far, length + near


def closure(engine: Engine, cycle: np.ndarray) -> Any:
    """Change of the left dead centre over a cycle, or each of many, in half strokes (Eq. 68)."""
    change = np.abs(cycle["x_end"][..., -1] - cycle["x_start"][..., -2])
    return change / (0.5 * engine.maximum_stroke)


def repeatability(engine: Engine, strokes: np.ndarray) -> tuple[float, float]:
    """Repeatability of the last cycle: change against those before it, as the thesis measures it.

    Parameters
    ----------
    engine : Engine
    strokes : ndarray of STROKE_RECORD
        Strokes of a run up to the end of its last full cycle.

    Returns
    -------
    stability : float
        Change of the left dead centre over the cycle, in half strokes [-] (Eq. 68).
    cr_change : float
        Mean magnitude of the change of the compression ratio from cycle to cycle, over the last
        ten changes [-]; NaN for a single cycle.
    """
    stability = float(closure(engine, strokes[-2:]))
    changes = np.abs(np.diff(cycle_compression_ratios(engine, strokes)))[-CR_CYCLES:]
    return stability, float(changes.mean()) if len(changes) else math.nan
