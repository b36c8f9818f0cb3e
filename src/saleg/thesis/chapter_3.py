"""Chapter 3: the base case, and how it answers to numerical settings and to its models.

Studies of the models (Figures 43 to 59) are in the loop of the component design, which section
3.6.1 has active. Figures 60 and 61 are those of :mod:`saleg.thesis.prototypes`.

Examples
--------
>>> from saleg.thesis import chapter_3
>>> figure = chapter_3.FIGURES[49]
>>> ax = figure.draw(figure.run())  # doctest: +SKIP
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from saleg import Run, plotting, simulate, studies
from saleg.design import Design
from saleg.machines import thesis_base
from saleg.plotting import sensitivity as curves
from saleg.plotting import studies as figures
from saleg.plotting.docstrings import documented
from saleg.plotting.style import panels_or_new
from saleg.studies import sensitivity
from saleg.studies.sensitivity import Study
from saleg.thesis.beside import comparison
from saleg.thesis.figure import Figure
from saleg.thesis.tables import TABLE_2, TABLE_3, TABLE_4, TABLE_5

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels


def base_case() -> Run:
    """Base case of Table 1, simulated until it is steady."""
    return simulate(thesis_base(), 2.5, motored_pressure=True)


def report(run: Run) -> str:
    """Figures of the base case beside Tables 1, 2 and 5; empty for any other engine.

    Parameters
    ----------
    run : Run

    Returns
    -------
    str
    """
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
    """Efficiency with cylinder blocks that lag some steps behind: the error of Table 2.

    Parameters
    ----------
    steps : tuple of float
        Fixed steps [s].

    Returns
    -------
    DataFrame
        As :func:`saleg.studies.delay_study` gives it.
    """
    return studies.delay_study(thesis_base(), steps, [0, 1, 2])


@documented()
def draw_delays(late: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Draw a study of :func:`delays` with the rows of Table 2 as rings.

    Parameters
    ----------
    late : DataFrame
        What :func:`delays` gives.
    """
    return figures.delay(late, ax, printed=TABLE_2)


# The models, in the loop


def heat_transfer_parameters() -> pd.DataFrame:
    """Parameters of Hohenberg's correlation (Figure 43)."""
    return sensitivity.hohenberg_parameters(Design())


def heat_transfer_laws() -> Study:
    """Four heat-transfer laws that take the same heat, at fixed load (Figures 44, 45)."""
    return sensitivity.heat_transfer_laws(sensitivity.fix_load(Design()))


def ignition_coefficient() -> Study:
    """Leading coefficient A of the CFR correlation (Figure 46)."""
    return _multiplied("ignition.A", (0.01, 0.1, 1.0, 10.0, 100.0))


def ignition_temperature() -> Study:
    """Temperature coefficient b of the CFR correlation (Figures 47, 48)."""
    return _multiplied("ignition.b", (0.45, 0.5, 0.6, 0.8, 1.0, 1.2))


def equivalence_ratios() -> Study:
    """Equivalence ratios under the CFR correlation (Figure 49)."""
    return sensitivity.equivalence_ratios(Design())


def ignition_parameters() -> pd.DataFrame:
    """Parameters of the CFR correlation (Figure 50)."""
    return sensitivity.cfr_parameters(Design())


def ignition_laws() -> Study:
    """CFR and RCM correlations (Figure 51)."""
    return sensitivity.ignition_laws(Design())


def retained_gas() -> Study:
    """Rates of retained exhaust gas under the RCM correlation (Figure 52)."""
    return sensitivity.retained_gas(Design())


def release_durations() -> Study:
    """Durations of the heat release (Figures 53 to 55)."""
    return sensitivity.release_durations(Design())


def release_profiles() -> Study:
    """Profiles of the heat release (Figures 56, 57, Table 5)."""
    return sensitivity.release_profiles(Design())


def heat_release() -> pd.DataFrame:
    """Profiles of the heat release: deviation of every figure from Table 5 [-]."""
    table = release_profiles().table.set_index("value")
    names = list(next(iter(TABLE_5.values())))
    printed = type(table).from_dict(TABLE_5, orient="index")[names]
    return table.loc[printed.index, names] / printed - 1.0


def regulator_gains() -> pd.DataFrame:
    """Gains of the stroke regulator (Figure 58)."""
    return sensitivity.regulator_gains(Design())


def target_strokes() -> Study:
    """Target strokes of the stroke regulator (Figure 59)."""
    return sensitivity.target_strokes(Design())


def _multiplied(path: str, factors: tuple[float, ...]) -> Study:
    """A number of the base case times several factors."""
    design = Design()
    return sensitivity.study(design, path, [factor * design.get(path) for factor in factors])


def _draw_durations(study: Study, ax: Any = None) -> Any:
    return curves.trends(study.table, ax=ax, logarithmic=True)


def _pressure_and_heat(run: Run, ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4)
    plotting.pressure_time(run, panels[0])
    plotting.heat_flow_time(run, panels[1])
    return panels


def _power_and_efficiency(run: Run, ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4)
    plotting.power(run, panels[0])
    plotting.efficiency(run, panels[1])
    return panels


def _pressures_and_heat_flows(study: Study, ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4)
    curves.pressure_time(study, panels[0])
    curves.heat_flow_time(study, panels[1])
    return panels


#: Figures by their number.
FIGURES = {
    36: Figure(base_case, plotting.velocity_position),
    37: Figure(base_case, plotting.acceleration_velocity),
    38: Figure(base_case, plotting.pressure_position),
    39: Figure(base_case, _pressure_and_heat),
    40: Figure(base_case, _power_and_efficiency),
    41: Figure(base_case, plotting.energy_pie),
    42: Figure(base_case, plotting.approach_to_steady_state),
    43: Figure(
        heat_transfer_parameters,
        partial(curves.trends, figures=("frequency", "heat_transfer_share")),
    ),
    44: Figure(heat_transfer_laws, _pressures_and_heat_flows),
    45: Figure(heat_transfer_laws, curves.velocity_position),
    46: Figure(ignition_coefficient, curves.pressure_volume),
    47: Figure(ignition_temperature, curves.velocity_position),
    48: Figure(ignition_temperature, curves.pressure_volume),
    49: Figure(equivalence_ratios, curves.pressure_volume),
    50: Figure(ignition_parameters, curves.trends),
    51: Figure(ignition_laws, curves.pressure_volume),
    52: Figure(retained_gas, curves.pressure_volume),
    53: Figure(release_durations, curves.velocity_position),
    54: Figure(release_durations, curves.pressure_volume),
    55: Figure(release_durations, _draw_durations),
    56: Figure(release_profiles, curves.release_rates),
    57: Figure(release_profiles, curves.pressure_volume),
    58: Figure(regulator_gains, curves.regulator_gains),
    59: Figure(target_strokes, curves.velocity_position),
}
