"""A study of the thesis' base case beside rows it prints, which the caller hands in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from saleg.checks import FRAME, TEXT, checked
from saleg.machines import thesis_base
from saleg.studies.convergence import UNITS, StudyError

if TYPE_CHECKING:
    import pandas as pd


def is_of_base_case(study: pd.DataFrame) -> bool:
    """Whether a study is of the engine of Tables 2 to 4, unmodified."""
    return study.attrs.get("engine") == thesis_base().to_toml()


@checked(table=FRAME, key=TEXT)
def beside_thesis(
    table: pd.DataFrame, printed: Mapping[float, Mapping[str, float]], key: str
) -> pd.DataFrame:
    """Set a study of the base case beside the rows a table of the thesis prints.

    Parameters
    ----------
    table : DataFrame
        A study of the thesis' base case, unmodified.
    printed : mapping
        Rows of the thesis by the value of `key`, for instance ``saleg.thesis.tables.TABLE_2``.
    key : str
        Column that tells the rows apart: "step", "order" or "stop_time".

    Returns
    -------
    DataFrame
        The study with a column ``thesis_...`` for every figure printed; NaN where the thesis
        prints none, as for its unstable run.

    Raises
    ------
    StudyError
        If the study is of another engine, or has no column `key`.
    """
    if not is_of_base_case(table):
        raise StudyError(
            "the thesis prints these rows for its base case only, and this study is of another "
            "engine, or is a table whose .attrs were lost"
        )
    if key not in table:
        raise StudyError(f"no column {key!r} in the study; there are {', '.join(map(str, table))}")
    result = table.copy()
    rows = [_row_at(printed, value) for value in table[key]]
    for name in dict.fromkeys(name for row in printed.values() for name in row):
        result[f"thesis_{name}"] = [row.get(name, math.nan) for row in rows]
        result.attrs["units"][f"thesis_{name}"] = UNITS[name]
    return result


def _row_at(printed: Mapping[float, Mapping[str, float]], value: float) -> Mapping[str, float]:
    """The row printed for a value, however the value was computed; empty if there is none."""
    found = (row for key, row in printed.items() if math.isclose(key, value, rel_tol=1e-9))
    return next(found, {})
