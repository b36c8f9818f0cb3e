"""Chapter 3: the base case, and how it answers to numerical settings and heat release."""

from __future__ import annotations

from typing import TYPE_CHECKING

from saleg import studies
from saleg.machines import thesis_base
from saleg.plotting import studies as figures
from saleg.simulation import Run, simulate
from saleg.thesis.tables import TABLE_2, TABLE_3, TABLE_4, TABLE_5, comparison

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def base_case() -> Run:
    """Base case of Table 1, simulated until it is steady."""
    return simulate(thesis_base(), 2.5)


def report(run: Run) -> str:
    """Figures of the base case beside Tables 1, 2 and 5; empty for any other engine."""
    return comparison(run) or ""


def step_sizes() -> pd.DataFrame:
    """Steps of Table 2, ours beside the printed ones."""
    return studies.beside_thesis(studies.step_size_study(thesis_base()), TABLE_2, "step")


def orders() -> pd.DataFrame:
    """Orders of the method in Table 3, ours beside the printed ones."""
    return studies.beside_thesis(studies.solver_study(thesis_base()), TABLE_3, "order")


def stop_times() -> pd.DataFrame:
    """Stop times of Table 4, ours beside the printed ones."""
    return studies.beside_thesis(studies.stop_time_study(thesis_base()), TABLE_4, "stop_time")


def delays(steps: tuple[float, ...] = (1e-6, 5e-6, 1e-5)) -> pd.DataFrame:
    """Efficiency with cylinder blocks that lag some steps behind: the error of Table 2."""
    return studies.delay_study(thesis_base(), steps, [0, 1, 2])


def draw(late: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Draw a study of :func:`delays` with the rows of Table 2 as rings."""
    return figures.delay(late, ax, printed=TABLE_2)


def heat_release() -> pd.DataFrame:
    """Heat-release profiles of Table 5: deviation of every figure from the print [-]."""
    table = studies.sensitivity.release_profiles(thesis_base()).table.set_index("value")
    names = list(next(iter(TABLE_5.values())))
    printed = type(table).from_dict(TABLE_5, orient="index")[names]
    return table.loc[printed.index, names] / printed - 1.0
