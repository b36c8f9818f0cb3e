"""Every printed table that saleg computes, number by number beside ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from saleg import Performance, simulate
from saleg.machines import thesis_base, thesis_transient
from saleg.simulation.performance import FIGURES
from saleg.simulation.readable import readable
from saleg.thesis import beside, chapter_3, chapter_4
from saleg.thesis.tables import TABLE_2, TABLE_5

if TYPE_CHECKING:
    import pandas as pd

#: Figures of the numerical studies.
STUDIED = ("peak_pressure", "stroke", "efficiency", "power")
#: SI units by figure.
UNITS = {name: unit for name, (unit, *_) in FIGURES.items()} | {
    "moving_mass": "kg",
    "displacement": "m^3",
    "stroke_to_bore": "-",
}


class Row(NamedTuple):
    """One printed number beside ours, in a readable unit.

    Attributes
    ----------
    case : str
        Column or row of the table.
    quantity : str
        With its unit in brackets.
    printed, ours : float
        In that unit.
    """

    case: str
    quantity: str
    printed: float
    ours: float

    @property
    def deviation(self) -> float:
        """Relative deviation [-]."""
        return self.ours / self.printed - 1.0


def table_1() -> list[Row]:
    """Base case as printed, computed there with a step of 5 µs."""
    return _performance("base case", beside.TABLE_1, simulate(thesis_base(), 1.5).performance)


def table_2() -> list[Row]:
    """Steps of Table 2 with the two steps of lag that explain it (:func:`chapter_3.delays`)."""
    steps = tuple(sorted(TABLE_2, reverse=True))
    late = chapter_3.delays(steps)
    two = late[late["delay"] == 2].set_index("step")
    return [
        row
        for step in steps
        for row in _rows(f"{1e6 * step:g} µs, two steps late", TABLE_2[step], two.loc[step])
    ]


def table_2_finest() -> list[Row]:
    """Finest rows of Tables 2 and 5, the ones to compare with."""
    return _performance("finest step", beside.FINEST, simulate(thesis_base(), 1.5).performance)


def table_3() -> list[Row]:
    """Orders of the solver at 5 µs; ours hits every event, whatever the order."""
    return _studied(chapter_3.orders(), "order", "order {:g}")


def table_4() -> list[Row]:
    """Stop times."""
    return _studied(chapter_3.stop_times(), "stop_time", "{:g} s")


def table_5() -> list[Row]:
    """Profiles of the heat release, in the loop of the component design."""
    found = chapter_3.release_profiles().table.set_index("value")
    return [row for name, row_of in TABLE_5.items() for row in _rows(name, row_of, found.loc[name])]


def designs(number: int) -> list[Row]:
    """Designs of Table 9, 10, 11 or 12 from their eight inputs alone.

    Parameters
    ----------
    number : int
    """
    ours, theirs = chapter_4.run(number), chapter_4.printed(number)
    names = chapter_4.PRINTED_AS
    rows = []
    for case in theirs.index:
        printed = {name: theirs.loc[case, old] for name, old in names.items()}
        rows += _rows(str(case).replace("_", " "), printed, ours.loc[case])
    return rows


def table_13() -> list[Row]:
    """Engine of Chapter 5."""
    found = simulate(thesis_transient(), 1.5).performance
    return _performance("base case of Chapter 5", beside.TABLE_13, found)


#: Tables by their heading.
TABLES: dict[str, Callable[[], list[Row]]] = {
    "Table 1: base case, 5 µs": table_1,
    "Tables 2 and 5: the finest rows": table_2_finest,
    "Table 2: steps of a method that lags two steps behind": table_2,
    "Table 3: orders of the solver": table_3,
    "Table 4: stop times": table_4,
    "Table 5: profiles of the heat release": table_5,
    "Table 9: designs for nine powers": lambda: designs(9),
    "Table 10: the same with a tighter compression ratio": lambda: designs(10),
    "Table 11: designs under four sets of weights": lambda: designs(11),
    "Table 12: design without target power": lambda: designs(12),
    "Table 13: engine of Chapter 5": table_13,
}
#: Tables that take more than some seconds.
LONG = ("Table 2: steps of a method that lags two steps behind", "Table 3: orders of the solver")


def _performance(case: str, column: beside.Column, found: Performance) -> list[Row]:
    return _rows(case, column.figures, {name: getattr(found, name) for name in column.figures})


def _studied(table: pd.DataFrame, key: str, label: str) -> list[Row]:
    rows = []
    for _, row in table.iterrows():
        printed = {name: row[f"thesis_{name}"] for name in STUDIED}
        rows += _rows(label.format(row[key]), printed, row)
    return rows


def _rows(case: str, printed: Mapping[str, Any], ours: Any) -> list[Row]:
    return [_row(case, name, printed[name], ours[name]) for name in _compared(printed)]


def _compared(printed: Iterable[str]) -> list[str]:
    return [name for name in printed if name in UNITS]


def _row(case: str, name: str, printed: Any, ours: Any) -> Row:
    shown = readable(name, UNITS[name])
    unit = shown.unit if shown.unit else "-"
    return Row(case, f"{shown.words} [{unit}]", shown.of(float(printed)), shown.of(float(ours)))
