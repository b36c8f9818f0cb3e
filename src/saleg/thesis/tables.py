"""Printed tables of the dissertation, and a run beside them.

M. C. Robinson, Analysis and Optimization of a Dual Free Piston, Spring Assisted, Linear Engine
Generator, dissertation, West Virginia University. The numbers stand as printed in ``data/``, one
CSV file per table; here they are read, and turned into SI.
"""

from __future__ import annotations

import csv
from importlib.resources import files
from typing import TYPE_CHECKING, NamedTuple

from saleg.machines import CATALOGUE
from saleg.simulation.report import FIGURES

if TYPE_CHECKING:
    import pandas as pd

    from saleg.engine import Engine
    from saleg.simulation.run import Run

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
    "mm": 1e-3,
    "bar": 1e5,
    "kW": 1e3,
    "kW/kg": 1e3,
    "%": 1e-2,
    "pct": 1e-2,
    "kN": 1e3,
    "kN/m": 1e3,
    "kJ": 1e3,
    "g": 1e-3,
    "ms": 1e-3,
    "km/s^2": 1e3,
    "MJ/kg": 1e6,
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
    ValueError
        If there is no such table.

    Examples
    --------
    >>> table(2)["efficiency_pct"].tolist()[-1]
    '34.38'
    >>> float(table(12).set_index("quantity").loc["power", "final"])
    5.723
    """
    import pandas as pd

    return pd.read_csv(_path(number))


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
        if unit not in TO_SI and unit not in ("s", "Hz"):
            name, unit = heading, "-"
        if heading != key and heading not in WORDS:
            found[name] = _si(printed, unit)
    return found


def _path(number: int) -> str:
    if number not in FILES:
        raise ValueError(f"no Table {number!r} here; there are {', '.join(map(str, FILES))}")
    return str(files("saleg.thesis").joinpath("data", FILES[number]))


def _rows(number: int) -> list[dict[str, str]]:
    with open(_path(number), newline="", encoding="utf-8") as file:
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
    return float(f"{value * TO_SI.get(unit, 1.0):.12g}")


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


class Column(NamedTuple):
    """One published set of results.

    Attributes
    ----------
    title : str
        Where it is printed.
    figures : dict of str to float
        Figures of :class:`saleg.Performance` by name, in SI.
    """

    title: str
    figures: dict[str, float]


def _results(number: int) -> dict[str, float]:
    """Results of Table 1 or 13 under the names of :class:`saleg.Performance`."""
    printed = columns(number)["value"]
    printed["charge_mass"] = printed.pop("mixture_mass")
    names = [name for name, *_ in FIGURES if name != "moving_mass"]
    return {name: printed[name] for name in names if name in printed}


TABLE_1 = Column("Table 1 (5 us)", _results(1))
TABLE_13 = Column("Table 13 (5 us)", _results(13))
#: Table 2 at a step of 0.5 us; compression ratio and frequency from the base row of Table 5.
FINEST = Column(
    "finest (T. 2, 5)",
    {name: value for name, value in TABLE_2[5e-7].items() if name != "cost"}
    | {name: TABLE_5["single Wiebe (base)"][name] for name in ("compression_ratio", "frequency")},
)
COLUMNS = {"thesis-base": (TABLE_1, FINEST), "thesis-transient": (TABLE_13,)}

REMARKS = {
    "thesis-base": """\
Why they differ: the thesis takes steps of 5 us, and its results still move with the step (first
order: 0.25 points of efficiency per us, Table 2). saleg ends its steps exactly on the events, so
the column to compare with is the finest one: Table 2 at 0.5 us, compression ratio and frequency
from Table 5. Power and fuel energy come out 2-3 % higher because the fuel energy of Table 1,
1.38 kJ, lies 2.2 % below what the charge it describes holds; efficiency is free of that.""",
    "thesis-transient": """\
Why they differ: the fuel energy of Table 13, 222 J, lies 2.5 % below what the charge it describes
holds, and power and alternator force are higher in step with it; efficiency is free of that. The
thesis' steps of 5 us add a first-order error (Table 2 shows it for the base case).""",
}


def comparison(run: Run) -> str | None:
    """Performance of a run beside what the thesis prints.

    Parameters
    ----------
    run : Run

    Returns
    -------
    str or None
        An aligned table of the figures printed there, with deviations in percent, and an
        explanation; None unless the engine is one of the thesis', unmodified, and completed a
        cycle.
    """
    name = run.engine.name
    if not is_published(run.engine) or run.last_cycle_strokes is None:
        return None
    beside = COLUMNS[name]
    head = f"  {'':<24} {'saleg':>10} {'':<6}"
    head += "".join(f" {column.title:>16} {'':>8}" for column in beside)
    lines = [head.rstrip()]
    for figure, label, factor, unit, digits in FIGURES:
        if not any(figure in column.figures for column in beside):
            continue
        value = getattr(run.performance, figure) * factor
        text = f"  {label:<24} {value:>10.{digits}f} {'' if unit == '-' else unit:<6}"
        text += "".join(_beside(column, figure, value, factor) for column in beside)
        lines.append(text.rstrip())
    return "\n".join([*lines, "", REMARKS[name]])


def is_published(engine: Engine) -> bool:
    """Whether an engine is one of the thesis', with nothing changed."""
    return engine.name in COLUMNS and engine == CATALOGUE[engine.name]()


def _beside(column: Column, figure: str, value: float, factor: float) -> str:
    """A figure as printed and how far the value, in the readable unit, is from it."""
    if figure not in column.figures:
        return f" {'':>16} {'':>8}"
    printed = column.figures[figure] * factor
    return f" {printed:>16g} {100.0 * (value / printed - 1.0):>+6.1f} %"
