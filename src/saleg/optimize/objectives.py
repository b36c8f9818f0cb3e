"""What should be great or small."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import pandas as pd


class Objective(NamedTuple):
    """A figure that should be as great, or as small, as possible.

    Parameters
    ----------
    figure : str
        Column of the table; ``"score"`` is the score of the problem.
    maximise : bool
    """

    figure: str
    maximise: bool = True

    def values(self, table: pd.DataFrame) -> np.ndarray:
        """Figures of all rows, the greater the better."""
        values = table[self.figure].to_numpy(dtype=float)
        return values if self.maximise else -values
