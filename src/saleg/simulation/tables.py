"""Records of a run as data frames; SI units in ``frame.attrs["units"]``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.engine import Engine
from saleg.simulation.indicators import (
    cycle_compression_ratios,
    full_cycles,
    own_compression_ratios,
    stroke_compression_ratios,
)

if TYPE_CHECKING:
    import pandas as pd

CYCLE_UNITS = {
    "t": "s",
    "period": "s",
    "frequency": "Hz",
    "stroke": "m",
    "x_left": "m",
    "x_right": "m",
    "compression_ratio": "-",
    "power": "W",
    "efficiency": "-",
    "load_weight": "-",
    "friction_coefficient": "N s/m",
    "peak_pressure_left": "Pa",
    "peak_pressure_right": "Pa",
    "peak_temperature_left": "K",
    "peak_temperature_right": "K",
    "peak_velocity": "m/s",
    "fuel_energy": "J",
    "heat_released": "J",
    "heat_transfer": "J",
    "exhaust_energy": "J",
    "friction_work": "J",
    "alternator_work": "J",
    "electrical_energy": "J",
}

DEAD_CENTRE_UNITS = {
    "t": "s",
    "x": "m",
    "stroke": "m",
    "compression_ratio": "-",
    "frequency": "Hz",
    "power": "W",
    "motoring": "-",
    "motor_amplitude": "N",
    "motor_frequency": "Hz",
    "load_weight": "-",
    "equivalence_ratio": "-",
    "intake_temperature": "K",
    "peak_pressure_left": "Pa",
    "peak_pressure_right": "Pa",
    "compression_ratio_left": "-",
    "compression_ratio_right": "-",
}

EVENT_UNITS = {
    "t": "s",
    "event": "-",
    "side": "-",
    "x": "m",
    "v": "m/s",
    "pressure": "Pa",
    "temperature": "K",
}

HISTORY_UNITS = {
    "t": "s",
    "x": "m",
    "v": "m/s",
    "a": "m/s^2",
    "p": "Pa",
    "T": "K",
    "V": "m^3",
    "p_rate": "Pa/s",
    "p_motored": "Pa",
    "heat_release": "W",
    "heat_loss": "W",
    "ignition": "-",
    "mode": "-",
    "mass": "kg",
    "burnt": "kg",
    "wall_temperature": "K",
    "spring_force": "N",
    "friction_force": "N",
    "alternator_force": "N",
    "electrical_power": "W",
    "load_weight": "-",
    "current": "A",
    "shaking_force": "N",
    "frame_x": "m",
    "frame_v": "m/s",
}


def cycle_table(engine: Engine, strokes: np.ndarray) -> pd.DataFrame:
    """Table of the full cycles, one row each, left dead centre to left dead centre."""
    from saleg.simulation.shown_table import Table

    out, back = full_cycles(strokes)
    travelled = np.abs(out["x_end"] - out["x_start"]) + np.abs(back["x_end"] - back["x_start"])
    period = out["duration"] + back["duration"]
    electrical = out["electrical_energy"] + back["electrical_energy"]
    fuel = out["fresh_fuel_energy"].sum(axis=1) + back["fresh_fuel_energy"].sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        efficiency = np.where(fuel > 0.0, electrical / fuel, np.nan)
    columns = {
        "t": out["t"] - out["duration"],
        "period": period,
        "frequency": 1.0 / period,
        "stroke": 0.5 * travelled,
        "x_left": back["x_end"],
        "x_right": out["x_end"],
        "compression_ratio": cycle_compression_ratios(engine, strokes),
        "power": electrical / period,
        "efficiency": efficiency,
        "load_weight": back["load_weight"],
        "friction_coefficient": back["friction_held"],
        "peak_pressure_left": np.maximum(out["peak_pressure"][:, 0], back["peak_pressure"][:, 0]),
        "peak_pressure_right": np.maximum(out["peak_pressure"][:, 1], back["peak_pressure"][:, 1]),
        "peak_temperature_left": np.maximum(
            out["peak_temperature"][:, 0], back["peak_temperature"][:, 0]
        ),
        "peak_temperature_right": np.maximum(
            out["peak_temperature"][:, 1], back["peak_temperature"][:, 1]
        ),
        "peak_velocity": np.maximum(out["peak_velocity"], back["peak_velocity"]),
        "fuel_energy": fuel,
        "heat_released": (out["heat_released"] + back["heat_released"]).sum(axis=1),
        "heat_transfer": (out["heat_lost"] + back["heat_lost"]).sum(axis=1),
        "exhaust_energy": (out["exhaust_energy"] + back["exhaust_energy"]).sum(axis=1),
        "friction_work": out["friction_work"] + back["friction_work"],
        "alternator_work": out["alternator_work"] + back["alternator_work"],
        "electrical_energy": electrical,
    }
    frame = Table.of(columns, CYCLE_UNITS)
    frame.index.name = "cycle"
    return frame


def dead_centre_table(engine: Engine, strokes: np.ndarray) -> pd.DataFrame:
    """Table of the strokes, one row each, at the dead centre that ends it."""
    from saleg.simulation.shown_table import Table

    length = np.abs(strokes["x_end"] - strokes["x_start"])
    columns = {
        "t": strokes["t"],
        "x": strokes["x_end"],
        "stroke": length,
        "compression_ratio": stroke_compression_ratios(engine, strokes),
        "frequency": 0.5 / strokes["duration"],
        "power": strokes["electrical_energy"] / strokes["duration"],
        "motoring": strokes["motoring"] > 0.0,
        "motor_amplitude": strokes["motor_amplitude"],
        "motor_frequency": strokes["motor_frequency"],
        "load_weight": strokes["load_weight"],
        "equivalence_ratio": strokes["equivalence_ratio"],
        "intake_temperature": strokes["intake_temperature"],
        "peak_pressure_left": strokes["peak_pressure"][:, 0],
        "peak_pressure_right": strokes["peak_pressure"][:, 1],
        "compression_ratio_left": own_compression_ratios(engine, 0, strokes),
        "compression_ratio_right": own_compression_ratios(engine, 1, strokes),
    }
    return Table.of(columns, DEAD_CENTRE_UNITS)


def event_table(rows: np.ndarray, names: tuple[str, ...]) -> pd.DataFrame:
    """Table of the events, one row each."""
    from saleg.simulation.shown_table import Table

    columns = {
        "t": rows["t"],
        "event": _named(rows["kind"], names),
        "side": _named(rows["side"], ("left", "right")),
        "x": rows["x"],
        "v": rows["v"],
        "pressure": rows["p"],
        "temperature": rows["T"],
    }
    return Table.of(columns, EVENT_UNITS)


def _named(codes: np.ndarray, names: tuple[str, ...]) -> Any:
    import pandas as pd

    return pd.Categorical.from_codes(codes.tolist(), categories=pd.Index(names))


def history_table(rows: np.ndarray) -> pd.DataFrame:
    """Table of the recorded instants, one row each; shares its memory with the records."""
    from saleg.simulation.shown_table import Table

    names, units = [], {}
    for name in rows.dtype.names or ():
        sides = ("_left", "_right") if rows.dtype[name].shape else ("",)
        names += [name + side for side in sides]
        units.update({name + side: HISTORY_UNITS[name] for side in sides})
    values = rows.view(np.float64).reshape(len(rows), len(names))
    return Table.of(values, units, columns=names, copy=False)
