"""What each column of a table of a run is called, where it stands in its record, and its unit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from saleg.kernel import layout
from saleg.simulation.tables import EVENT_UNITS, HISTORY_UNITS

STROKE_UNITS = {
    "t": "s",
    "duration": "s",
    "x_start": "m",
    "x_end": "m",
    "direction": "-",
    "load_weight": "-",
    "friction_held": "N s/m",
    "alternator_work": "J",
    "electrical_energy": "J",
    "electrical_squared": "W^2 s",
    "alternator_impulse": "N s",
    "friction_work": "J",
    "speed_squared": "m^2/s",
    "peak_acceleration": "m/s^2",
    "peak_velocity": "m/s",
    "spring_energy": "J",
    "frame_energy": "J",
    "mount_loss": "J",
    "motoring": "-",
    "motor_amplitude": "N",
    "motor_frequency": "Hz",
    "equivalence_ratio": "-",
    "intake_temperature": "K",
    "heat_released": "J",
    "heat_lost": "J",
    "gas_work": "J",
    "port_work": "J",
    "peak_pressure": "Pa",
    "peak_temperature": "K",
    "peak_pressure_rise": "Pa/s",
    "fresh_fuel_energy": "J",
    "exhaust_energy": "J",
    "exhaust_fuel_energy": "J",
    "fuel_energy": "J",
    "internal_energy": "J",
    "charge_mass": "kg",
    "ignition_time": "s",
    "ignition_height": "m",
    "combustion_duration": "s",
    "fresh_mass": "kg",
    "closing_mass": "kg",
    "closing_temperature": "K",
    "supplied_mass": "kg",
    "expelled_mass": "kg",
    "expelled_fresh": "kg",
    "crankcase_work": "J",
    "wall_temperature": "K",
}

#: Fields that came later, generation by generation: files from before do not have them.
GENERATIONS: tuple[tuple[str, ...], ...] = (
    (
        "fresh_mass",
        "closing_mass",
        "closing_temperature",
        "supplied_mass",
        "expelled_mass",
        "expelled_fresh",
        "crankcase_work",
        "wall_temperature",
    ),
    ("frame_energy", "mount_loss", "shaking_force", "frame_x", "frame_v", "mass", "burnt"),
)
LATER_FIELDS = tuple(name for names in GENERATIONS for name in names)
#: Those of them that are not known where a file lacks them; of the others nothing was there: 0.
UNKNOWN_BEFORE = ("shaking_force", "mass", "burnt")

#: Words for the whole numbers in a column, by the column's name.
CODES = {"event": layout.EVENT_NAMES, "side": ("left", "right")}


class Place(NamedTuple):
    """Where a column stands in a record.

    Attributes
    ----------
    field : str
        Field of the record.
    side : int or None
        Index into a field with one value per side.
    unit : str
        SI unit, ``"-"`` for a pure number, empty for codes.
    """

    field: str
    side: int | None
    unit: str

    def of(self, rows: np.ndarray) -> np.ndarray:
        """The column as a view into records."""
        return rows[self.field] if self.side is None else rows[self.field][:, self.side]


class Layout(NamedTuple):
    """A table made of records: their type, and the place of each column by its name."""

    dtype: np.dtype
    places: dict[str, Place]


def _layout(dtype: np.dtype, names: dict[str, str], units: dict[str, str]) -> Layout:
    """Layout of a record, given the name of each field and the unit of each name."""
    places = {}
    for field in dtype.names or ():
        name = names.get(field, field)
        unit = "" if name in CODES else units[name]
        if dtype[field].shape:
            for side, word in enumerate(CODES["side"]):
                places[f"{name}_{word}"] = Place(field, side, unit)
        else:
            places[name] = Place(field, None, unit)
    return Layout(dtype, places)


_EVENT_FIELDS = dict(zip(layout.EVENT_RECORD.names or (), EVENT_UNITS, strict=True))
_STROKES = _layout(layout.STROKE_RECORD, {}, STROKE_UNITS)
_EVENTS = _layout(layout.EVENT_RECORD, _EVENT_FIELDS, EVENT_UNITS)
_HISTORY = _layout(layout.HISTORY_RECORD, {}, HISTORY_UNITS)

#: Tables from which a run is made again, by name; those of its last cycle begin with "orbit".
LAYOUTS = {
    "strokes": _STROKES,
    "events": _EVENTS,
    "history": _HISTORY,
    "orbit_strokes": _STROKES,
    "orbit_events": _EVENTS,
    "orbit": _HISTORY,
}
