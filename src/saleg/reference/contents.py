"""What stands in a chamber: in the state of the reference solver, and beside it between events."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from saleg.engine import Chamber, CombustionChamber, Engine
from saleg.kernel import layout
from saleg.kernel.plain_breathing import (
    CRANKCASE_ENERGY,
    ENERGY,
    is_held_open,
    volume_of_crankcase,
)
from saleg.kernel.plain_rhs import MOTORED_PRESSURE, POSITION, PRESSURE
from saleg.laws import GasProperties, Parts
from saleg.reference.states import ChamberState


def fill(engine: Engine, chambers: Sequence[ChamberState], y: np.ndarray, side: int) -> None:
    """Put what a chamber holds at the start into the states its laws ask for."""
    c, chamber = chambers[side], engine.chambers[side]
    if c.breathes:
        p, volume = float(y[PRESSURE + side]), c.area * (c.half_stroke + c.sign * y[POSITION])
        T = p * volume / (c.mass * c.constant_now)
        if is_held_open(chambers, side):
            T = c.intake_temperature
        put_state(chamber, c, y, side, p, T)
    if c.wall_follows:
        y[layout.WALL + side] = c.wall_temperature
    if c.crankcase:
        volume = volume_of_crankcase(engine, chambers, side, y[POSITION])
        mass = c.intake_pressure * volume / (c.gas_constant * c.intake_temperature)
        y[layout.CRANKCASE_MASS + side] = mass
        y[CRANKCASE_ENERGY + side] = mass * specific_energy(chamber, c.intake_temperature)


def specific_energy(chamber: Chamber, T: float) -> float:
    """Specific internal energy of the gas in a chamber at a temperature [J/kg]."""
    return float(chamber.gas_properties.internal_energy(T))  # type: ignore[attr-defined]


def energy_held(chamber: Chamber, c: ChamberState, T: float) -> float:
    """Internal energy of what a chamber holds at a temperature [J]."""
    if c.follows == 0.0:
        return c.mass * specific_energy(chamber, T)
    gas: GasProperties = chamber.gas_properties  # type: ignore[attr-defined]
    return gas.energy_of(T, Parts(c.fuel, c.air, c.burnt))


def specific_enthalpy_of_fuel(chamber: CombustionChamber) -> float:
    """Specific enthalpy of fuel as it is injected [J/kg]: of its vapour, less its latent heat."""
    T, latent_heat = chamber.injection.fuel_state()
    gas = chamber.gas_properties
    if not gas.follows_composition:
        return gas.internal_energy(T) + gas.gas_constant * T - latent_heat
    return gas.energy_of(T, Parts(1.0, 0.0, 0.0)) + gas.gas_constants[0] * T - latent_heat


def put_state(
    chamber: Chamber, c: ChamberState, y: np.ndarray, side: int, p: float, T: float
) -> None:
    """Give the charge of a chamber a pressure [Pa] and a temperature [K]."""
    y[[PRESSURE + side, MOTORED_PRESSURE + side]] = p
    if c.breathes:
        put_masses(c, y, side)
        y[ENERGY + side] = energy_held(chamber, c, T)


def put_masses(c: ChamberState, y: np.ndarray, side: int) -> None:
    """Bring the masses in the state up to date with what stands beside it."""
    first = layout.FUEL + side
    y[first : first + 6 : 2] = c.fuel, c.air, c.burnt


def take_contents(chambers: Sequence[ChamberState], y: np.ndarray) -> None:
    """Bring what stands beside the state up to date with it."""
    for side, c in enumerate(chambers):
        if c.breathes:
            first = layout.FUEL + side
            c.fuel, c.air, c.burnt = y[first : first + 6 : 2].tolist()
            c.mass = c.fuel + c.air + c.burnt
        if c.wall_follows:
            c.wall_temperature = float(y[layout.WALL + side])


def supplied_energy(c: ChamberState, y: np.ndarray, side: int) -> float:
    """Lower heating value of the fuel that has flowed in since the dead centre [J]."""
    return float(y[layout.SUPPLIED_FUEL + side] * c.lower_heating_value) if c.by_flow else 0.0


def write_passed(c: ChamberState, y: np.ndarray, side: int, row: Any) -> None:
    """Write what has passed through a chamber that breathes into the row of a stroke."""
    row["fresh_fuel_energy"][side] += y[layout.SUPPLIED_FUEL + side] * c.lower_heating_value
    row["exhaust_fuel_energy"][side] += y[layout.EXPELLED_FUEL + side] * c.lower_heating_value
    row["exhaust_energy"][side] += y[layout.ENTHALPY_OUT + side]
    row["fresh_mass"][side] = c.fresh
    row["closing_mass"][side] = c.mass_trapped
    direct = c.injection_place > 0.0
    row["closing_temperature"][side] = c.trapped_temperature if direct else c.T_closing
    row["supplied_mass"][side] = y[layout.SUPPLIED + side]
    row["expelled_mass"][side] = y[layout.EXPELLED + side]
    row["expelled_fresh"][side] = y[layout.EXPELLED_FRESH + side]
    row["crankcase_work"][side] = y[layout.CRANKCASE_WORK + side]
