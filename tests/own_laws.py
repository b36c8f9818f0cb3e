"""Laws of a user's with faults that a number turns on: one kernel serves all tests of them."""

from dataclasses import dataclass, fields

import numpy as np

from saleg import Engine, laws
from saleg.laws import Motion
from saleg.quantities import quantity


@dataclass(frozen=True)
class FaultySprings(laws.LinearSprings):
    """Springs with a soft stop on the right alone, and a drag their energy knows nothing of."""

    stop: float = quantity("N/m", default=0.0)
    drag: float = quantity("N", default=0.0)

    def force(self, motion: Motion) -> float:
        stopped = self.stop * max(motion.x - 0.0845, 0.0)
        return -2.0 * self.stiffness * motion.x - stopped - self.drag * motion.direction

    def energy(self, motion: Motion) -> float:
        beyond = max(motion.x - 0.0845, 0.0)
        return self.stiffness * motion.x * motion.x + 0.5 * self.stop * beyond * beyond


@dataclass(frozen=True)
class NanPower(laws.LinearLoad):
    """A load whose power is no number once it is broken."""

    broken: float = quantity("-", default=0.0)

    def electrical_power(self, held: float, motion: Motion) -> float:
        power = held * self.efficiency * self.load_constant * motion.v * motion.v
        return np.nan if self.broken > 0.0 else power


def faulty(engine: Engine, *, stop: float = 0.0, drag: float = 0.0, broken: float = 0.0) -> Engine:
    """An engine with these laws in the place of its springs and load."""
    load = engine.alternator
    numbers = {field.name: getattr(load, field.name) for field in fields(load)}
    return engine.replace(
        springs=FaultySprings(stiffness=engine.springs.stiffness, stop=stop, drag=drag),
        alternator=NanPower(**numbers, broken=broken),
    )
