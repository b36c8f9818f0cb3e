"""Figures of the gas exchange of a cylinder whose ports let gas flow."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from saleg.engine import Cylinder, Engine
from saleg.simulation.performance import figure


@dataclass(frozen=True)
class Scavenging:
    """Gas exchange of one cylinder over a cycle.

    The reference mass is that of a fresh charge at the state of the intake that fills the cylinder
    as its ports close (Heywood, section 6.6, with that volume for the displaced one). NaN for a
    chamber whose ports let no gas flow, and without a cycle.

    Attributes
    ----------
    delivery_ratio : float
        Mass delivered through the intake, less what is blown back of it, over the reference
        mass [-].
    charging_efficiency : float
        Delivered mass that is retained over the reference mass [-].
    trapping_efficiency : float
        Delivered mass that is retained over all that is delivered [-].
    scavenging_efficiency : float
        Delivered mass that is retained over the mass trapped [-].
    residual_fraction : float
        Mass of gas from before over the mass trapped [-].
    trapped_mass : float
        Mass trapped as the ports close [kg].
    trapped_temperature : float
        Its temperature then [K].
    short_circuited : float
        Fresh mass lost through the exhaust and past the rings [kg].
    pumping_work : float
        Work of the piston on its crankcase [J]; 0 without one.
    """

    delivery_ratio: float = figure("-", "delivery ratio", 3)
    charging_efficiency: float = figure("-", "charging efficiency", 3)
    trapping_efficiency: float = figure("-", "trapping efficiency", 3)
    scavenging_efficiency: float = figure("-", "scavenging efficiency", 3)
    residual_fraction: float = figure("-", "residual fraction", 3)
    trapped_mass: float = figure("kg", "trapped mass", 4)
    trapped_temperature: float = figure("K", "trapped at", 1)
    short_circuited: float = figure("kg", "fresh gas lost", 4)
    pumping_work: float = figure("J", "pumping work per cycle", 2)

    @property
    def is_known(self) -> bool:
        """Whether gas flows through the ports of the chamber, and there was a cycle."""
        return not math.isnan(self.delivery_ratio)


def scavenging_of(engine: Engine, cycle: np.ndarray | None) -> tuple[Scavenging, Scavenging]:
    """Gas exchange of the left and the right chamber.

    Parameters
    ----------
    engine : Engine
    cycle : ndarray of STROKE_RECORD, shape (2,)
        Strokes of a cycle; None if there is none.
    """
    return _of_side(engine, cycle, 0), _of_side(engine, cycle, 1)


def _of_side(engine: Engine, cycle: np.ndarray | None, side: int) -> Scavenging:
    cylinder = engine.chambers[side]
    if (
        cycle is None
        or not isinstance(cylinder, Cylinder)
        or "contents" not in cylinder.gas_exchange.states
    ):
        return Scavenging(**{item.name: math.nan for item in dataclasses.fields(Scavenging)})
    full = cylinder.reference_state
    density = full.pressure / (cylinder.gas_properties.gas_constant * full.temperature)
    reference = density * cylinder.area * full.clearance
    delivered = float(cycle["supplied_mass"][:, side].sum())
    fresh, trapped = (float(cycle[name][-1, side]) for name in ("fresh_mass", "closing_mass"))
    with np.errstate(all="ignore"):
        scavenged = float(np.divide(fresh, trapped))
        return Scavenging(
            delivery_ratio=delivered / reference,
            charging_efficiency=fresh / reference,
            trapping_efficiency=float(np.divide(fresh, delivered)),
            scavenging_efficiency=scavenged,
            residual_fraction=1.0 - scavenged,
            trapped_mass=trapped,
            trapped_temperature=float(cycle["closing_temperature"][-1, side]),
            short_circuited=float(cycle["expelled_fresh"][:, side].sum()),
            pumping_work=0.0 - float(cycle["crankcase_work"][:, side].sum()),
        )
