"""Net output of an engine: what is left of its power once charger and electronics are paid for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from saleg.engine import Cylinder, Engine
from saleg.errors import InvalidEngine
from saleg.laws.usual import GAS_PRESSURE
from saleg.quantities import Problem, Quantities, problems, quantity
from saleg.simulation.indicators import both


@dataclass(frozen=True)
class Auxiliaries(Quantities):
    """Charger, electronics and other consumers beside an engine.

    Parameters
    ----------
    charger_efficiency : float
        Isentropic efficiency of what brings fresh gas to the pressure of the intake, with its drive
        [-].
    electronics_efficiency : float
        Of the converter behind the alternator [-].
    consumers : float
        Power of pumps and controls [W].
    ambient_pressure, ambient_temperature : float
        State in which fresh gas is drawn in [Pa], [K].
    """

    charger_efficiency: float = quantity("-", default=0.6, low=0, high=1, open_low=True)
    electronics_efficiency: float = quantity("-", default=0.95, low=0, high=1, open_low=True)
    consumers: float = quantity("W", default=0.0, low=0)
    ambient_pressure: float = quantity("Pa", default=1e5, low=0, open_low=True, usual=GAS_PRESSURE)
    ambient_temperature: float = quantity("K", default=300.0, low=100.0, high=1500.0)


@dataclass(frozen=True)
class NetOutput:
    """Power of an engine over a cycle, and what its auxiliaries take of it.

    Attributes
    ----------
    power : float
        Electrical power of the alternator [W].
    charging : float
        Power of the charger [W]; what lets gas in below the ambient pressure gives nothing back.
    electronics : float
        Loss of the electronics [W].
    consumers : float
        Power of pumps and controls [W].
    net_power : float
        What is left [W].
    net_efficiency : float
        That over the power of the fuel [-]; NaN without fuel.
    delivered : float
        Fresh gas that the intakes deliver [kg/s].
    """

    power: float
    charging: float
    electronics: float
    consumers: float
    net_power: float
    net_efficiency: float
    delivered: float


class InvalidAuxiliaries(InvalidEngine):
    """Auxiliaries with fields out of range; `problems` lists them all."""

    whole = "auxiliaries"


def net_output_of(
    engine: Engine, cycle: np.ndarray | None, auxiliaries: Auxiliaries | None = None
) -> NetOutput:
    """Net output of an engine over a cycle.

    Parameters
    ----------
    engine : Engine
    cycle : ndarray of STROKE_RECORD, shape (2,)
        Strokes of a cycle; None if there is none, and all but the consumers is NaN.
    auxiliaries : Auxiliaries, optional

    Raises
    ------
    InvalidEngine
        If a number of the auxiliaries is out of range.
    """
    beside = Auxiliaries() if auxiliaries is None else auxiliaries
    if isinstance(beside, Auxiliaries):
        wrong = problems(beside, "auxiliaries")
    else:
        wrong = [Problem("auxiliaries", beside, "-", "must be saleg.Auxiliaries")]
    if wrong:
        raise InvalidAuxiliaries(wrong)
    if cycle is None:
        nan = math.nan
        return NetOutput(nan, nan, nan, beside.consumers, nan, nan, nan)
    period = float(cycle["duration"].sum())
    power = float(cycle["electrical_energy"].sum()) / period
    fuel = float(both(cycle["fresh_fuel_energy"]).sum()) / period
    delivered = [_delivered(engine, cycle, side) / period for side in range(2)]
    charging = sum(
        flow * _specific_work(engine, side, beside) for side, flow in enumerate(delivered)
    )
    electronics = (1.0 - beside.electronics_efficiency) * abs(power)
    net = power - charging - electronics - beside.consumers
    efficiency = net / fuel if fuel > 0.0 else math.nan
    spent = charging, electronics, beside.consumers
    return NetOutput(power, *spent, net, efficiency, sum(delivered))


def _delivered(engine: Engine, cycle: np.ndarray, side: int) -> float:
    """Fresh gas that an intake delivers in a cycle [kg], with the fuel mixed into it."""
    chamber = engine.chambers[side]
    if not isinstance(chamber, Cylinder):
        return 0.0
    if "contents" in chamber.gas_exchange.states:
        return float(cycle["supplied_mass"][:, side].sum())
    out = (1.0 - 2.0 * side) * cycle["x_end"] + chamber.half_stroke
    if not (out > chamber.port_closing).any():
        return 0.0
    retained = getattr(chamber.gas_exchange, "egr", 0.0)
    closed_on = float(cycle["charge_mass"][-1, side])
    if chamber.injection.is_direct:
        closed_on -= (
            float(cycle["fresh_fuel_energy"][:, side].sum()) / chamber.fuel.lower_heating_value
        )
    return closed_on * (1.0 - retained)


def _specific_work(engine: Engine, side: int, beside: Auxiliaries) -> float:
    """Work of the charger for a kilogram of gas [J/kg], by an isentropic compression."""
    chamber = engine.chambers[side]
    if not isinstance(chamber, Cylinder) or chamber.intake.pressure <= beside.ambient_pressure:
        return 0.0
    gas, T = chamber.gas_properties, beside.ambient_temperature
    gamma, R = gas.gamma(T), gas.gas_constant
    rise = (chamber.intake.pressure / beside.ambient_pressure) ** ((gamma - 1.0) / gamma) - 1.0
    return gamma / (gamma - 1.0) * R * T * rise / beside.charger_efficiency
