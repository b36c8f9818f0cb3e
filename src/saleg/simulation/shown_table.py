"""Tables of results as notebooks show them; imported with pandas, when a table is made."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd


class Table(pd.DataFrame):
    """Table of results with units; a data frame that a notebook's cell shows in readable units.

    Numbers are SI. ``attrs["units"]`` has the SI units by column, or by row of a comparison.
    """

    @property
    def _constructor(self) -> Any:
        return Table

    @classmethod
    def of(cls, data: Any, units: Mapping[str, str], **settings: Any) -> Table:
        """Table of a data frame or of what makes one, with units.

        Parameters
        ----------
        data : DataFrame or what makes one
        units : mapping of str to str
            SI units by name.
        **settings
            Further settings of a data frame.
        """
        table = cls(data, **settings)
        table.attrs["units"] = dict(units)
        return table

    def _repr_html_(self) -> str | None:
        from saleg.display import table_card

        if "units" in self.attrs:
            return table_card(self)
        shown: str | None = super()._repr_html_()  # type: ignore[misc]
        return shown
