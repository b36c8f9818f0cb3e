"""Numbers with units as people write them: ``66 mm``, ``1.05bar``, ``20 kN/m``; SI without one.

Only at the boundary, where words come in: from the command line and from the heads of tables.
"""

from __future__ import annotations

import re

from saleg.errors import SalegError, nearest

#: Units by SI unit, each with factor and offset to SI.
UNITS: dict[str, dict[str, tuple[float, float]]] = {
    "m": {"mm": (1e-3, 0.0), "cm": (1e-2, 0.0), "um": (1e-6, 0.0), "inch": (0.0254, 0.0)},
    "m^2": {"mm^2": (1e-6, 0.0), "cm^2": (1e-4, 0.0)},
    "m^3": {"mm^3": (1e-9, 0.0), "cm^3": (1e-6, 0.0), "l": (1e-3, 0.0)},
    "m/s": {"mm/s": (1e-3, 0.0)},
    "kg": {"g": (1e-3, 0.0), "mg": (1e-6, 0.0)},
    "s": {"ms": (1e-3, 0.0), "us": (1e-6, 0.0), "min": (60.0, 0.0)},
    "Hz": {"kHz": (1e3, 0.0), "1/s": (1.0, 0.0), "1/min": (1.0 / 60.0, 0.0)},
    "K": {"degC": (1.0, 273.15)},
    "Pa": {
        "bar": (1e5, 0.0),
        "mbar": (1e2, 0.0),
        "hPa": (1e2, 0.0),
        "kPa": (1e3, 0.0),
        "MPa": (1e6, 0.0),
        "atm": (101325.0, 0.0),
        "psi": (6894.757293168361, 0.0),
    },
    "N": {"kN": (1e3, 0.0)},
    "N/m": {"kN/m": (1e3, 0.0), "N/mm": (1e3, 0.0)},
    "N s/m": {"kN s/m": (1e3, 0.0)},
    "J": {"kJ": (1e3, 0.0)},
    "W": {"kW": (1e3, 0.0), "MW": (1e6, 0.0)},
    "J/kg": {"kJ/kg": (1e3, 0.0), "MJ/kg": (1e6, 0.0)},
    "J/kg/K": {"kJ/kg/K": (1e3, 0.0)},
    "H": {"mH": (1e-3, 0.0), "uH": (1e-6, 0.0)},
    "-": {"%": (1e-2, 0.0)},
}
#: Other ways to write the same.
_SPELLINGS = (
    ("µ", "u"),
    ("μ", "u"),
    ("°C", "degC"),
    ("²", "^2"),
    ("³", "^3"),
    ("**", "^"),
    ("·", " "),
    ("*", " "),
)
_HEAD = re.compile(r"\s*(.*?)\s*[\[(]([^\[\]()]*)[\])]\s*")
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")


class UnitError(SalegError, ValueError):
    """A unit that is not known, or not one of this quantity."""


def to_si(unit: str, si_unit: str) -> tuple[float, float]:
    """Factor and offset from a unit to the SI unit of its quantity.

    Raises
    ------
    UnitError
        With the units there are.

    Examples
    --------
    >>> to_si("mm", "m"), to_si("°C", "K"), to_si("", "Pa")
    ((0.001, 0.0), (1.0, 273.15), (1.0, 0.0))
    """
    plain = unit.strip()
    for spelling, usual in _SPELLINGS:
        plain = plain.replace(spelling, usual)
    known = UNITS.get(si_unit, {})
    if plain in ("", si_unit):
        return 1.0, 0.0
    if plain in known:
        return known[plain]
    there = [si_unit, *known] if si_unit != "-" else list(known)
    raise UnitError(
        f"'{unit}' is no unit here{nearest(plain, there)}; there are {', '.join(there)}"
    )


def head_of(cell: str) -> tuple[str, str]:
    """Name and unit of the head of a column, the unit in brackets of either kind.

    Examples
    --------
    >>> head_of("time [ms]"), head_of("power (kW)"), head_of("power")
    (('time', 'ms'), ('power', 'kW'), ('power', ''))
    """
    found = _HEAD.fullmatch(cell)
    return (found[1], found[2].strip()) if found else (cell.strip(), "")


def number_in_si(text: str, si_unit: str) -> float | None:
    """Number in SI from text with or without a unit; None for text that begins with no number.

    Raises
    ------
    UnitError
        If the unit is not known, or not one of this quantity.

    Examples
    --------
    >>> number_in_si("66 mm", "m"), number_in_si("0.066", "m"), number_in_si("wide", "m")
    (0.066, 0.066, None)
    """
    try:
        return float(text)
    except ValueError:
        found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    if found[2].startswith(","):
        raise UnitError("decimals have a point, not a comma")
    factor, offset = to_si(found[2], si_unit)
    # 66 mm is to be the float 0.066, which 66 * 0.001 is not.
    number = float(found[1])
    inverse = 1.0 / factor
    scaled = number / round(inverse) if _is_whole(inverse) else number * factor
    return scaled + offset


def _is_whole(value: float) -> bool:
    return value > 1.5 and abs(value - round(value)) < 1e-9 * value
