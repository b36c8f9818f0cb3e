"""Whether an engine is its own mirror image, and whether it repeats itself at all."""

from __future__ import annotations

import dis
import itertools
import math
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any

from saleg.engine import Engine
from saleg.laws import NoMisfires, NoScatter
from saleg.laws.arguments import Motion, Stroke
from saleg.laws.base import Law

#: Positions, velocities and currents, over their natural sizes, at which the laws of motion are
#: compared with their mirror images.
PROBES = tuple(
    (position, speed, 0.7 * speed)
    for position, speed in zip(
        (0.03, 0.11, 0.23, 0.31, 0.42, 0.53, 0.61, 0.72, 0.80, 0.86, 0.90, 0.94, 0.97, 0.99),
        (0.97, -0.9, 0.85, -0.8, 0.7, -0.6, 0.5, -0.45, 0.4, -0.3, 0.25, -0.2, 0.1, -0.05),
        strict=True,
    )
)
#: Methods of laws of motion that are shown no motion, but a stroke or a position.
SHOWN_NO_MOTION = ("at_dead_centre", "next_breakpoint")
#: How Python takes a field by name, and the fields of a motion that are not the time.
TAKE = "LOAD_ATTR"
TIMELESS = frozenset(Motion._fields) - {"t"}


def repeats_itself(engine: Engine) -> bool:
    """Whether nothing in an engine depends on the time or on the number of the charge."""
    if not isinstance(engine.scatter, NoScatter):
        return False
    for chamber in engine.chambers:
        if not isinstance(getattr(chamber, "misfires", NoMisfires()), NoMisfires):
            return False
    kinds: list[Any] = [type(law) for law in _laws_of_motion(engine)]
    return not any(_asks_for_time(kind) for kind in kinds)


@lru_cache(maxsize=256)
def _asks_for_time(law: Any) -> bool:
    """Whether a method of a law may look at the time in the motion it is shown.

    It does not if all it takes from the motion is fields by name, and none of them the time.
    Whoever unpacks the motion, takes a field by number or hands the motion on may well look.
    """
    return any(
        not isinstance(method, FunctionType) or _looks_at_time(method.__code__)
        for method in (getattr(law, name) for name in law.compiled if name not in SHOWN_NO_MOTION)
    )


def _looks_at_time(code: CodeType) -> bool:
    """Whether code does anything with its last argument but take fields other than the time."""
    motion = code.co_varnames[code.co_argcount - 1]
    steps = [step for step in dis.get_instructions(code) if step.opname not in ("CACHE", "NOP")]
    for step, following in itertools.zip_longest(steps, steps[1:]):
        names = step.argval if isinstance(step.argval, tuple) else (step.argval,)
        if motion not in names or step.opname == "LOAD_CONST":
            continue
        taken = following.argval if following is not None and following.opname == TAKE else None
        loaded_last = "LOAD_FAST" in step.opname and names[-1] == motion
        if not loaded_last or motion in names[:-1] or taken not in TIMELESS:
            return True
    return False


def is_symmetric(engine: Engine) -> bool:
    """Whether an engine is its own mirror image, laws of motion included."""
    if not engine.is_mirrored:
        return False
    if has_laws_that_mirror(engine):
        return True
    for x, v, direction, current in _probes(engine):
        try:
            there = _forces(engine, Motion(0.0, x, v, direction, current))
            mirrored = _forces(engine, Motion(0.0, -x, -v, -direction, -current))
            signs = (-1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
            for sign, a, b in zip(signs, there, mirrored, strict=True):
                if abs(sign * a - b) > 1e-12 * abs(a):
                    return False
        except Exception:  # a law that fails is named where the engine starts
            return False
    return True


def has_laws_that_mirror(engine: Engine) -> bool:
    """Whether all laws of motion are the same in the mirror whatever their numbers."""
    # A class says so for itself, not for those derived from it.
    laws = *_laws_of_motion(engine), engine.frame
    return all(vars(type(law)).get("mirrors") for law in laws)


def _laws_of_motion(engine: Engine) -> tuple[Law, ...]:
    return engine.springs, engine.friction, engine.alternator


def _probes(engine: Engine) -> list[tuple[float, float, float, float]]:
    """Positions, velocities, directions and currents at which forces are compared."""
    length = 0.5 * engine.maximum_stroke
    speed = 100.0 * length
    return [(a * length, b * speed, math.copysign(1.0, b), c) for a, b, c in PROBES]


def _forces(engine: Engine, motion: Motion) -> list[float]:
    """Forces and the rate of the current, then energies and what is held: odd, then even."""
    stroke = _stroke_at(engine, motion)
    return [
        engine.springs.force(motion),
        engine.friction.force(1.0, motion),
        engine.alternator.force(1.0, motion),
        engine.alternator.current_rate(1.0, motion),
        engine.frame.acceleration(motion.x, motion.x, motion.v),
        engine.frame.energy(motion.x, motion.v),
        engine.frame.loss(motion.v),
        engine.springs.energy(motion),
        engine.alternator.electrical_power(1.0, motion),
        engine.alternator.at_dead_centre(1.0, stroke),
        engine.friction.at_dead_centre(1.0, stroke),
    ]


def _stroke_at(engine: Engine, motion: Motion) -> Stroke:
    """A stroke that ends at different distances from the midpoint."""
    half, speed = 0.5 * engine.maximum_stroke, abs(motion.v)
    ends = sorted((motion.x, -0.9 * motion.x))
    length = ends[1] - ends[0]
    area = 0.5 * sum(chamber.area for chamber in engine.chambers)
    return Stroke(length, length / speed, 2.0 * half, half, area, 1.0, speed, *ends)
