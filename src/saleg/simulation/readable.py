"""Names and units in which people read quantities: mm, bar, kW and percent for SI.

The one table for reports and figures. A quantity is read in the unit of its SI unit unless its own
name says otherwise, and is called by its own name in words unless people call it something else.
"""

from __future__ import annotations

from typing import Any, NamedTuple

#: Factors from SI to readable units.
FACTORS = {
    "mm": 1e3,
    "cm^3": 1e6,
    "km/s^2": 1e-3,
    "bar": 1e-5,
    "bar/ms": 1e-8,
    "kW": 1e-3,
    "kW/kg": 1e-3,
    "kN": 1e-3,
    "kN/m": 1e-3,
    "ms": 1e3,
    "µs": 1e6,
    "g": 1e3,
    "%": 1e2,
}
#: Readable units by SI unit.
BY_UNIT = {
    "m": "mm",
    "m^3": "cm^3",
    "m/s^2": "km/s^2",
    "Pa": "bar",
    "Pa/s": "bar/ms",
    "W": "kW",
    "W/kg": "kW/kg",
    "N/m": "kN/m",
    "s": "ms",
}
#: Readable units by name, where that decides.
BY_NAME = {
    "efficiency": "%",
    "indicated_efficiency": "%",
    "egr": "%",
    "port_location": "%",
    "relative_stroke": "%",
    "heat_transfer_share": "%",
    "friction_share": "%",
    "charge_mass": "g",
    "trapped_mass": "g",
    "short_circuited": "g",
    "spring_force": "kN",
    "step": "µs",
    "t": "s",
    "period": "s",
    "fired_at": "s",
    "recovery_time": "s",
}
#: What people call columns of a run whose names are symbols.
SYMBOLS = {
    "t": "time",
    "x": "position",
    "v": "velocity",
    "a": "acceleration",
    "V": "volume",
    "p": "pressure",
}
#: What people call quantities whose own names would not do.
WORDS = {
    "p_motored": "motored pressure",
    "heat_loss": "heat flow to the walls",
    "heat_transfer": "heat to the walls per cycle",
    "relative_stroke": "stroke over maximum stroke",
    "stroke_to_bore": "maximum stroke over bore",
    "dimensionless_pressure": r"$\pi b^2 p_{in} / (4 L k)$",
    "dimensionless_heat": r"$Q_{in} / (k L^2)$",
    "frequency_ratio": r"$f_{ss} / \sqrt{k/m}$",
    "egr": "EGR",
    "intake.temperature": "intake temperature",
}


class Readable(NamedTuple):
    """Name and readable unit of a quantity.

    Attributes
    ----------
    words : str
        Its name in words.
    unit : str
        Readable unit; ``"-"`` for a pure number.
    factor : float
        Readable over SI.
    """

    words: str
    unit: str
    factor: float

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.words} [{self.unit}]"

    def of(self, values: Any) -> Any:
        """Values in the readable unit, from SI."""
        return self.factor * values


def readable(name: str, unit: str, words: str = "") -> Readable:
    """Name and readable unit of a quantity.

    Parameters
    ----------
    name : str
        Name of a column or a field, or a dotted path.
    unit : str
        SI unit; ``""`` if it has none, as an input of a user's own function, where ``x`` is ``x``.
    words : str
        Name in words, where the usual one does not do.

    Returns
    -------
    Readable

    Examples
    --------
    >>> readable("power", "W").label, readable("power", "W").of(22500.0)
    ('power [kW]', 22.5)
    >>> readable("egr", "-").label
    'EGR [%]'
    """
    read = BY_NAME.get(name, BY_UNIT.get(unit, unit))
    known = WORDS | SYMBOLS if unit else WORDS
    usual = known.get(name, name.replace("_", " ").replace(".", ": "))
    return Readable(words or usual, read, FACTORS.get(read, 1.0))
