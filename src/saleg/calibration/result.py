"""Result of a calibration."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.engine import Engine
from saleg.steady.state import SteadyState

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class Calibration:
    """Parameters fitted to what was measured, and how well they are known.

    Attributes
    ----------
    engine : Engine
        With the parameters found.
    steady : SteadyState
        Its steady state.
    table : DataFrame
        A row per parameter by its path: start, value, ends of the confidence interval (``low``,
        ``high``), in SI units (column ``unit``), and whether a bound was met. The interval is NaN
        where there are no more residuals than parameters, or they do not tell.
    correlation : DataFrame
        Correlation of the estimates [-]; close to 1 or -1 where the data do not tell two apart.
    residuals : dict of str to ndarray
        Simulated less measured over the standard deviation, by figure or ``trace: channel`` [-].
    shifts : tuple of float
        Time of each trace at which the cycle has its left dead centre [s].
    confidence : float
        Of the intervals [-].
    converged : bool
    message : str
    """

    engine: Engine
    steady: SteadyState
    table: pd.DataFrame
    correlation: pd.DataFrame
    residuals: dict[str, np.ndarray]
    shifts: tuple[float, ...]
    confidence: float
    converged: bool
    message: str = field(default="")

    @property
    def scatter(self) -> float:
        """Root mean square of all residuals [-]; about 1 where the deviations given are right."""
        return float(np.sqrt(np.mean(np.square(np.concatenate(list(self.residuals.values()))))))

    def draw(self, ax: Any = None) -> Any:
        """Residuals as a picture: see :func:`saleg.plotting.measured.residuals`.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
        """
        from saleg.plotting.measured import residuals

        return residuals(self, ax)

    def __str__(self) -> str:
        lines = [f"{self.engine.name}: {self.message}; residuals scatter by {self.scatter:.3g}"]
        for path, row in self.table.iterrows():
            known = f"{row['low']:.5g} to {row['high']:.5g}" if row["low"] == row["low"] else "-"
            bound = ", at its bound" if row["at_bound"] else ""
            unit = "" if row["unit"] == "-" else f" {row['unit']}"
            told = f"{row['value']:.5g}{unit} ({100.0 * self.confidence:g} %: {known}{bound})"
            lines.append(f"  {path!s:<28} {told}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Calibration of {self.engine.name!r}: {', '.join(map(str, self.table.index))}>"
