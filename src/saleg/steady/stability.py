"""Stability of a steady state: multipliers of its return map, and what they mean."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from saleg.engine import Engine
from saleg.simulation.course import Replay
from saleg.simulation.run import read_only
from saleg.steady.entries import sealed_entries
from saleg.steady.return_map import NoReturn, ReturnMap, step_tolerance

#: Tolerance of the integrator for differences of the map, which magnify its error.
FINE = 1e-11
#: The same for multipliers, and the difference on either side: they are good to some 1e-6.
TOLERANCE = 1e-10
DIFFERENCE = 3e-5
#: Distance from one of a multiplier of what is conserved, above the noise of the differences.
CONSERVED = 1e-5
#: Multipliers of the map below this are noise.
LEAST = 1e-6
#: Angle of a multiplier from the real axis below which it counts as real [rad].
REAL = 1e-3


@dataclass(frozen=True, eq=False)
class Stability:
    """Multipliers of a cycle and what they mean.

    Attributes
    ----------
    multipliers : ndarray of complex
        Factors by which small disturbances grow from one cycle to the next, the largest first [-];
        read-only.
    kind : str
        "stable", or how stability is lost: "fold" (a real multiplier beyond +1), "asymmetric"
        (left and right grow apart), "period doubling" (beyond -1), "quasi-periodic" (a complex
        pair: rhythmic stability, the orbit beats), "no return" (the least disturbance stalls the
        engine or drives it into a head; the multiplier is infinite).
    beat_period : float
        Time in which the phase of the leading pair comes round [s]; infinite if it is real.
    time_constant : float
        Time in which the slowest disturbance falls (rises, if negative) by a factor e [s].
    """

    multipliers: np.ndarray
    kind: str
    beat_period: float
    time_constant: float

    def __post_init__(self) -> None:
        """Show the multipliers, but let nobody write to them."""
        object.__setattr__(self, "multipliers", read_only(self.multipliers))

    def _repr_html_(self) -> str:
        from saleg.display import stability_card

        return stability_card(self)

    @property
    def stable(self) -> bool:
        """Whether all disturbances die away."""
        return self.kind == "stable"


def stability(replay: Replay, mirrored: bool, period: float) -> Stability:
    """Stability of a steady state: what the multipliers of its return map say.

    Parameters
    ----------
    replay : Replay
        The cycle of the steady state.
    mirrored : bool
        Whether its second half is the mirror image of its first, so that the map of half a cycle
        returns to it.
    period : float
        How long it takes [s].

    Returns
    -------
    Stability
    """
    start = replay.start
    steps = step_tolerance(replay.engine, TOLERANCE)
    return_map = ReturnMap.of(replay.engine, start.copy(), steps, mirrored)
    jacobian: np.ndarray | None
    try:
        jacobian = return_map.jacobian(start, return_map.vector(start), DIFFERENCE)
    except NoReturn:
        jacobian = None
    return stability_of(replay.engine, jacobian, mirrored, period)


def stability_of(
    engine: Engine, jacobian: np.ndarray | None, mirrored: bool, period: float
) -> Stability:
    """Stability of a steady state by the derivative of its return map; None if it has none."""
    if jacobian is None:
        return Stability(np.array([complex(math.inf)]), "no return", math.inf, 0.0)
    return judged(own_multipliers(engine, jacobian), mirrored, period)


def describe(found: Stability) -> str:
    """Stability in a few lines of text."""
    lines = [f"  stability                {found.kind:>10}"]
    if len(found.multipliers):
        lines.append(f"  largest multiplier       {abs(found.multipliers[0]):>10.3f} per cycle")
    if math.isfinite(found.beat_period):
        lines.append(f"  beat period              {1e3 * found.beat_period:>10.1f} ms")
    return "\n".join(lines)


def own_multipliers(engine: Engine, jacobian: np.ndarray) -> np.ndarray:
    """Eigenvalues of the derivative of a return map, the largest first; none of what is kept."""
    return split_multipliers(engine, jacobian)[0]


def split_multipliers(engine: Engine, jacobian: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues of the derivative of a return map, the largest first, and those of what is kept.

    The entropy that a sealed chamber keeps for ever is no instability: a multiplier of one each.
    """
    matters = jacobian.any(axis=0)  # the others have eigenvalues of zero
    values = np.linalg.eigvals(jacobian[np.ix_(matters, matters)])
    kept = []
    for _ in sealed_entries(engine):
        nearest = np.argmin(np.abs(values - 1.0))
        if abs(values[nearest] - 1.0) < CONSERVED:
            kept.append(values[nearest])
            values = np.delete(values, nearest)
    values = values[np.abs(values) > LEAST]
    return values[np.argsort(-np.abs(values))], np.array(kept, dtype=complex)


def judged(own: np.ndarray, mirrored: bool, period: float) -> Stability:
    """Stability by the multipliers of a map; those of a mirrored half cycle count twice a cycle."""
    cycle = own**2 if mirrored else own
    if not len(own):
        return Stability(cycle, "stable", math.inf, 0.0)
    leading, time = complex(own[0]), 0.5 * period if mirrored else period
    angle = abs(cmath.phase(leading))
    is_real = min(angle, math.pi - angle) < REAL
    growth = math.log(abs(leading))
    return Stability(
        multipliers=cycle,
        kind=_kind(leading, is_real, mirrored),
        beat_period=math.inf if is_real else 2.0 * math.pi * time / angle,
        time_constant=-time / growth if growth != 0.0 else math.inf,
    )


def _kind(leading: complex, is_real: bool, mirrored: bool) -> str:
    """Name of what the leading multiplier of a map does."""
    if abs(leading) < 1.0:
        return "stable"
    if not is_real:
        cycle = leading**2 if mirrored else leading
        turned = abs(abs(cmath.phase(cycle)) - math.pi) < REAL
        return "period doubling" if turned else "quasi-periodic"
    if leading.real > 0.0:
        return "fold"
    return "asymmetric" if mirrored else "period doubling"
