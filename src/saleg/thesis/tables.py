"""Printed tables of the dissertation.

M. C. Robinson, Analysis and Optimization of a Dual Free Piston, Spring Assisted, Linear Engine
Generator, dissertation, West Virginia University. The numbers stand as printed in ``data/``, one
CSV file per table; here they are read, and turned into SI.
"""

from __future__ import annotations

import csv
import io
from importlib.resources import files
from typing import TYPE_CHECKING, TextIO

from saleg.errors import SalegError, shown

if TYPE_CHECKING:
    import pandas as pd

#: Files of the tables by number.
FILES = {
    1: "table01_base_case.csv",
    2: "table02_step_size.csv",
    3: "table03_solver_order.csv",
    4: "table04_stop_time.csv",
    5: "table05_heat_release.csv",
    6: "table06_prototypes.csv",
    9: "table09_designs.csv",
    10: "table10_compression_limited.csv",
    11: "table11_weights.csv",
    12: "table12_no_target_power.csv",
    13: "table13_transient_device.csv",
}
#: Factors from printed units to SI; degC has an offset instead.
TO_SI = {
    "-": 1.0,
    "%": 1e-2,
    "pct": 1e-2,
    "mm": 1e-3,
    "cc": 1e-6,
    "m/s": 1.0,
    "km/s^2": 1e3,
    "s": 1.0,
    "ms": 1e-3,
    "Hz": 1.0,
    "g": 1e-3,
    "kg": 1.0,
    "N": 1.0,
    "kN": 1e3,
    "kN/m": 1e3,
    "N/mm": 1e3,
    "bar": 1e5,
    "J": 1.0,
    "kJ": 1e3,
    "MJ/kg": 1e6,
    "kW": 1e3,
    "kW/kg": 1e3,
    "K": 1.0,
    "MB": 1e6,
}
#: Columns that say what stands in a row; all others hold numbers.
WORDS = ("quantity", "kind", "unit", "solver", "profile")


def table(number: int) -> pd.DataFrame:
    """Table of the dissertation as printed.

    Parameters
    ----------
    number : int
        1 to 6 or 9 to 13.

    Returns
    -------
    DataFrame
        In the printed units; text where no number is printed.

    Raises
    ------
    NoTable
        If there is no such table.

    Examples
    --------
    >>> table(2)["efficiency_pct"].tolist()[-1]
    '34.38'
    >>> float(table(12).set_index("quantity").loc["power", "final"])
    5.723
    """
    import pandas as pd

    with _opened(number) as file:
        return pd.read_csv(file)


def columns(number: int) -> dict[str, dict[str, float]]:
    """Columns of Table 1, 6 or 9 to 13 by heading, each a quantity to its value in SI.

    Parameters
    ----------
    number : int

    Returns
    -------
    dict of str to dict of str to float
        What a column has no number for is left out.

    Examples
    --------
    >>> columns(9)["4 kW"]["bore"]
    0.04765
    """
    found: dict[str, dict[str, float]] = {}
    for row in _rows(number):
        for heading, printed in row.items():
            if heading not in WORDS and _is_number(printed):
                found.setdefault(heading, {})[row["quantity"]] = _si(printed, row["unit"])
    return found


def settings(number: int, key: str) -> dict[str, dict[str, float]]:
    """Rows of Tables 2 to 5 by the setting they are for, each a quantity to its value in SI.

    Parameters
    ----------
    number : int
    key : str
        Column with the setting.

    Returns
    -------
    dict of str to dict of str to float
        Rows printed as "unstable" are left out.

    Examples
    --------
    >>> settings(3, "order")["4"]["peak_pressure"]
    10590000.0
    """
    return {row[key]: _numbers(row, key) for row in _rows(number) if "unstable" not in row.values()}


def _numbers(row: dict[str, str], key: str) -> dict[str, float]:
    """Numbers of a row whose headings end in their units, without the setting it is for."""
    found = {}
    for heading, printed in row.items():
        name, _, unit = heading.rpartition("_")
        if unit not in TO_SI:
            name, unit = heading, "-"
        if heading != key and heading not in WORDS:
            found[name] = _si(printed, unit)
    return found


class NoTable(SalegError, ValueError):
    """A table the dissertation prints no numbers in, or does not have."""


def _opened(number: int) -> TextIO:
    """A file of the package, wherever it is installed, a zip file included."""
    if number not in FILES:
        raise NoTable(f"no Table {shown(number)} here; there are {', '.join(map(str, FILES))}")
    file = files("saleg.thesis").joinpath("data", FILES[number])
    return io.TextIOWrapper(file.open("rb"), encoding="utf-8", newline="")


def _rows(number: int) -> list[dict[str, str]]:
    with _opened(number) as file:
        return list(csv.DictReader(file))


def _is_number(printed: str) -> bool:
    try:
        float(printed)
    except ValueError:
        return False
    return True


def _si(printed: str, unit: str) -> float:
    """A printed number in SI, rounded to what decimal fractions give."""
    value = float(printed)
    if unit == "degC":
        return value + 273.15
    return float(f"{value * TO_SI[unit]:.12g}")


def _study(number: int, key: str) -> dict[float, dict[str, float]]:
    """Rows of Table 2, 3 or 4 under the names of :mod:`saleg.studies`."""
    found = {}
    for setting, row in settings(number, key).items():
        row["cost"] = row.pop("time_required")
        row.pop("file_size", None)
        found[float(setting)] = row
    return found


#: Tables 2 (by step [s]), 3 (by order), 4 (by stop time [s]) and 5 (by profile) of the base case,
#: in SI. The step of 1e-4 s is printed as unstable and left out.
TABLE_2 = _study(2, "step_s")
TABLE_3 = _study(3, "order")
TABLE_4 = _study(4, "stop_time_s")
TABLE_5 = settings(5, "profile")
