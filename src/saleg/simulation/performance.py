"""Figures of one cycle: performance and energy balance."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from saleg.engine import CombustionChamber, Engine
from saleg.simulation.indicators import (
    adverse_work,
    both,
    compression_ratio,
    repeatability,
    summed,
    timing,
)

nan = math.nan


class Figure(NamedTuple):
    """Unit, name and digits of a field of :class:`Performance` in reports.

    Attributes
    ----------
    unit : str
        SI unit.
    label : str
        Name in words.
    digits : int or None
        Digits after the point, in the readable unit; None for what a report leaves out.
    note : str
        What stands after the unit.
    """

    unit: str
    label: str
    digits: int | None = None
    note: str = ""


def figure(unit: str, label: str, digits: int | None = None, note: str = "") -> Any:
    """Declare a field of :class:`Performance`; see :class:`Figure`."""
    return field(metadata={"figure": Figure(unit, label, digits, note)})


@dataclass(frozen=True)
class Performance:
    """Performance over one full cycle, left dead centre to left dead centre; SI.

    Figures of cylinders leave bounce chambers out; an engine without a cylinder has those of both
    chambers. NaN stands for what is not defined: efficiencies without fresh fuel, timings without
    a start of combustion, the change of the compression ratio over a single cycle.

    Attributes
    ----------
    stroke : float
        Stroke [m].
    compression_ratio : float
        Geometric compression ratio, greatest over least volume of the cylinders together [-]:
        ``(L + S/2) / (L - S/2)`` where they are alike.
    frequency : float
        Cycles per second [Hz].
    power, rms_power : float
        Mean and root-mean-square electrical power [W].
    efficiency : float
        Mean electrical power over the power of the fresh fuel [-].
    mean_alternator_force : float
        Time mean of the magnitude of the alternator force [N].
    peak_pressure : float
        Greatest pressure in a cylinder [Pa]. That of a bounce chamber stands in the tables of
        cycles and dead centres, which have the peaks of each side.
    peak_acceleration, peak_velocity : float
        Greatest magnitudes [m/s^2, m/s].
    fuel_energy_per_cycle : float
        Lower heating value of the fresh fuel of both cylinders [J].
    charge_mass : float
        Mass of the charge of one cylinder [kg].
    moving_mass : float
        Mass of the translator [kg].
    peak_temperature : float
        Greatest temperature in a cylinder [K].
    peak_pressure_rise : float
        Greatest rate of pressure rise in a cylinder [Pa/s].
    indicated_work : float
        Work of the gas on both pistons, open ports included [J].
    indicated_efficiency : float
        Indicated work over the energy of the fresh fuel [-].
    adverse_work : float
        Work lost in the inverted part of the p-V loops around dead centre [J]; NaN where the
        history of the cycle is not known.
    start_of_combustion : float
        Time of the start of combustion before dead centre [s].
    start_of_combustion_position : float
        Distance of the piston from its dead centre at that moment [m].
    burn_centre : float
        Time after dead centre at which half of the heat is released [s].
    stability : float
        Change of the left dead centre over the cycle, in half strokes [-] (Eq. 68).
    cr_change : float
        Mean magnitude of the change of the compression ratio from cycle to cycle, over the last
        ten changes [-].
    """

    stroke: float = figure("m", "stroke", 2)
    compression_ratio: float = figure("-", "compression ratio", 3)
    frequency: float = figure("Hz", "frequency", 3)
    power: float = figure("W", "mean electrical power", 3)
    rms_power: float = figure("W", "RMS electrical power", 3)
    efficiency: float = figure("-", "efficiency", 2)
    mean_alternator_force: float = figure("N", "mean alternator force", 1)
    peak_pressure: float = figure("Pa", "peak pressure", 2)
    peak_acceleration: float = figure("m/s^2", "peak acceleration", 3)
    peak_velocity: float = figure("m/s", "peak velocity", 3)
    fuel_energy_per_cycle: float = figure("J", "fuel energy per cycle", 1)
    charge_mass: float = figure("kg", "charge mass", 4)
    moving_mass: float = figure("kg", "moving mass", 3)
    peak_temperature: float = figure("K", "peak temperature", 1)
    peak_pressure_rise: float = figure("Pa/s", "peak pressure rise", 2)
    indicated_work: float = figure("J", "indicated work per cycle", 1)
    indicated_efficiency: float = figure("-", "indicated efficiency", 2)
    adverse_work: float = figure("J", "adverse work per cycle", 3)
    start_of_combustion: float = figure("s", "start of combustion", 3, "before dead centre")
    start_of_combustion_position: float = figure("m", "  at distance", 2)
    burn_centre: float = figure("s", "burn centre", 3, "after dead centre")
    stability: float = figure("-", "stability")
    cr_change: float = figure("-", "change of the compression ratio")

    def to_dict(self) -> dict[str, float]:
        """All figures by name."""
        return dataclasses.asdict(self)

    def _repr_html_(self) -> str:
        from saleg.display import performance_card

        return performance_card(self)

    @classmethod
    def of_nothing(cls, engine: Engine) -> Performance:
        """Performance of an engine that completed no cycle or stalled: zeros and NaN."""
        values = {item.name: nan for item in dataclasses.fields(cls)}
        for name in ("stroke", "frequency", "power", "rms_power", "mean_alternator_force"):
            values[name] = 0.0
        values["moving_mass"] = float(engine.translator.mass)
        return cls(**values)

    @classmethod
    def of_cycle(
        cls,
        engine: Engine,
        strokes: np.ndarray,
        run: np.ndarray,
        history: np.ndarray | None = None,
    ) -> Performance:
        """Performance over a cycle.

        Parameters
        ----------
        engine : Engine
        strokes : ndarray of STROKE_RECORD, shape (2,)
            The cycle, with its peaks located.
        run : ndarray of STROKE_RECORD
            All strokes up to the end of the cycle.
        history : ndarray of HISTORY_RECORD, optional
            The cycle's history.
        """
        figures = {name: float(value) for name, value in cycle_figures(engine, strokes).items()}
        stability, cr_change = repeatability(engine, run)
        return cls(
            **figures,
            adverse_work=nan if history is None else adverse_work(engine, history),
            stability=stability,
            cr_change=cr_change,
        )


def cycle_figures(engine: Engine, strokes: np.ndarray) -> dict[str, Any]:
    """Figures that follow from the two strokes of a cycle; of many cycles, each an array.

    Parameters
    ----------
    engine : Engine
        One, or many as an engine of columns.
    strokes : ndarray of STROKE_RECORD, shape (2,) or (n, 2)
        The cycle, with its peaks located.

    Returns
    -------
    dict
        All of :class:`Performance` but the adverse work and what is told of cycles before.
    """
    cycle = summed(strokes)
    period, energy = cycle["duration"], cycle["electrical_energy"]
    fuel, work = both(cycle["fresh_fuel_energy"]), both(cycle["gas_work"])
    starts, ends = strokes["x_start"], strokes["x_end"]
    low = np.minimum(starts, ends).min(axis=-1)
    high = np.maximum(starts, ends).max(axis=-1)
    burns = [isinstance(chamber, CombustionChamber) for chamber in engine.chambers]
    counted = burns if any(burns) else [True, True]
    masses = _charges(strokes)[..., burns] if any(burns) else np.array([nan])
    burn = timing(engine, strokes)
    with np.errstate(all="ignore"):
        return {
            "stroke": np.abs(ends - starts).sum(axis=-1) / 2.0,
            "compression_ratio": compression_ratio(engine, low, high),
            "frequency": 1.0 / period,
            "power": energy / period,
            "rms_power": np.sqrt(np.maximum(cycle["electrical_squared"], 0.0) / period),
            "efficiency": _share(energy / period * period, fuel),
            "mean_alternator_force": cycle["alternator_impulse"] / period,
            "peak_pressure": _greatest(strokes["peak_pressure"][..., counted]),
            "peak_acceleration": strokes["peak_acceleration"].max(axis=-1),
            "peak_velocity": strokes["peak_velocity"].max(axis=-1),
            "fuel_energy_per_cycle": fuel,
            "charge_mass": masses.sum(axis=-1) / masses.shape[-1],
            "moving_mass": engine.translator.mass,
            "peak_temperature": _greatest(strokes["peak_temperature"][..., counted]),
            "peak_pressure_rise": _greatest(strokes["peak_pressure_rise"][..., counted]),
            "indicated_work": work,
            "indicated_efficiency": _share(work, fuel),
            "start_of_combustion": burn.start,
            "start_of_combustion_position": burn.start_position,
            "burn_centre": burn.centre,
        }


def _charges(strokes: np.ndarray) -> np.ndarray:
    """Mass of the charge on each side; where gas flows through the ports, as they close."""
    trapped, held = strokes["closing_mass"][..., 1, :], strokes["charge_mass"][..., 1, :]
    masses: np.ndarray = np.where(trapped > 0.0, trapped, held)
    return masses


def _greatest(peaks: np.ndarray) -> Any:
    """Greatest of the peaks of two strokes and all sides."""
    return peaks.max(axis=(-2, -1))


def _share(work: Any, fuel: Any) -> Any:
    """Work over the energy of the fuel; NaN without fuel, or with too little to divide by."""
    share = work / fuel
    return np.where((fuel > 0.0) & np.isfinite(share), share, nan)


#: Figures of a cycle by name, and their SI units.
FIGURES: dict[str, Figure] = {
    item.name: item.metadata["figure"] for item in dataclasses.fields(Performance)
}
UNITS = {name: figure.unit for name, figure in FIGURES.items()}


@dataclass(frozen=True)
class EnergyBalance:
    """Energy balance between two dead centres; joules.

    Every term is integrated or evaluated by itself, none is a difference that makes the balance
    close; `residual` is what is left over.

    Attributes
    ----------
    fuel : float
        Lower heating value of the fresh fuel [J].
    unburnt : float
        Lower heating value of the fuel that left with the exhaust [J].
    released : float
        Heat released by combustion [J].
    heat_transfer : float
        Heat to the walls [J].
    exhaust : float
        Internal energy given up when the ports opened, against that of the fresh charge [J].
    port_work : float
        Work of the intake pressure on the pistons while the ports are open [J].
    friction, alternator : float
        Mechanical work taken by friction and alternator [J].
    mounts : float
        Heat in the mounts of a frame that moves [J].
    electrical : float
        Electrical energy delivered [J].
    stored : float
        Increase of the energy in springs and gas [J], and of a frame that moves, of all that is
        carried along with it and of its mounts (the translator rests on it at dead centres).
    stored_fuel : float
        Increase of the fuel in the chambers, by its lower heating value [J].
    residual : float
        ``released + port_work - heat_transfer - exhaust - friction - alternator - mounts -
        stored`` [J].
    """

    fuel: float
    unburnt: float
    released: float
    heat_transfer: float
    exhaust: float
    port_work: float
    friction: float
    alternator: float
    mounts: float
    electrical: float
    stored: float
    stored_fuel: float
    residual: float

    def to_dict(self) -> dict[str, float]:
        """All terms by name [J]."""
        return dataclasses.asdict(self)

    def _repr_html_(self) -> str:
        from saleg.display import balance_card

        return balance_card(self)

    @property
    def largest_term(self) -> float:
        """Magnitude of the largest term of the balance [J]."""
        gas = (self.released, self.heat_transfer, self.exhaust, self.port_work)
        return reduce(np.maximum, map(abs, (*gas, self.friction, self.alternator, self.stored)))

    @property
    def alternator_loss(self) -> float:
        """Mechanical work the alternator did not turn into electrical energy [J]."""
        return self.alternator - self.electrical

    @classmethod
    def between(cls, before: Any, strokes: np.ndarray) -> EnergyBalance:
        """Balance over consecutive strokes, given the row of the stroke before them.

        Of many runs each term is an array: rows of shape (n,) before strokes of shape (n, k).
        """
        last, all_of = strokes[..., -1], summed(strokes)
        held_before, held_after = (
            row["spring_energy"] + row["frame_energy"] + both(row["internal_energy"])
            for row in (before, last)
        )
        terms = {
            "released": both(all_of["heat_released"]),
            "heat_transfer": both(all_of["heat_lost"]),
            "exhaust": both(all_of["exhaust_energy"]),
            "port_work": both(all_of["port_work"]),
            "friction": all_of["friction_work"],
            "alternator": all_of["alternator_work"],
            "mounts": all_of["mount_loss"],
            "stored": held_after - held_before,
        }
        gains = terms["released"] + terms["port_work"]
        used = ("heat_transfer", "exhaust", "friction", "alternator", "mounts", "stored")
        uses = sum(terms[name] for name in used)
        terms["fuel"] = both(all_of["fresh_fuel_energy"])
        terms["unburnt"] = both(all_of["exhaust_fuel_energy"])
        terms["electrical"] = all_of["electrical_energy"]
        terms["stored_fuel"] = both(last["fuel_energy"]) - both(before["fuel_energy"])
        terms["residual"] = gains - uses
        if strokes.ndim == 1:
            terms = {name: float(value) for name, value in terms.items()}
        return cls(**terms)
