"""Base case and numerical studies beside Tables 1 to 5."""

import numpy as np
import pytest

import saleg
from printed import check, within
from saleg.plotting import new_figure
from saleg.thesis import beside, chapter_3


def test_base_case_against_the_finest_rows(base_run):
    """Table 2 at 0.5 us and the base row of Table 5; power is high as the fuel energy is."""
    assert base_run.status is saleg.Status.STEADY
    figures = ("stroke", "compression_ratio", "frequency", "peak_pressure", "efficiency")
    check(base_run.performance, beside.FINEST, dict.fromkeys(figures, 0.015) | {"power": 0.04})


def test_base_case_against_table_1(base_run):
    """Table 1 was computed at 5 us; its peak and efficiency carry that step's error (Table 2)."""
    deviations = {
        "stroke": 0.005,
        "frequency": 0.005,
        "power": 0.01,
        "mean_alternator_force": 0.01,
        "charge_mass": 0.015,
        "peak_acceleration": 0.02,
        "compression_ratio": 0.03,
        "peak_pressure": 0.03,
        "fuel_energy_per_cycle": 0.04,
        "efficiency": 0.045,
    }
    assert set(deviations) == set(beside.TABLE_1.figures)
    check(base_run.performance, beside.TABLE_1, deviations)


def test_friction_of_eq_40_is_that_of_the_base_case(base, base_run):
    run = saleg.simulate(base.replace(friction=saleg.laws.BlairViscousFriction(13.7)), 1.5)
    assert run.cycles["friction_coefficient"].iloc[-1] == pytest.approx(12.4, rel=0.005)
    assert run.energy.friction / run.energy.fuel == pytest.approx(0.06, rel=0.02)


def test_shares_of_the_fuel_energy(base_run):
    """Figure 41: more than half of the fuel energy is lost as heat; friction takes about 6 %."""
    energy = base_run.energy
    assert 0.5 < (energy.heat_transfer + energy.exhaust) / energy.fuel < 0.6
    assert energy.friction / energy.fuel == pytest.approx(0.06, abs=0.003)
    assert energy.unburnt / energy.fuel == pytest.approx(0.05, abs=0.01)


def test_regulated_weight_is_eq_59(base_run):
    last = base_run.cycles.iloc[-1]
    weight = 1.0 - 7.5 * (0.18 - last["stroke"]) / 0.1
    assert last["load_weight"] == pytest.approx(weight, abs=1e-5)


def test_base_case_is_reported_beside_tables_1_2_and_5():
    text = chapter_3.report(chapter_3.base_case())
    assert "Table 1 (5 us)" in text
    assert "finest (T. 2, 5)" in text


def test_two_steps_late_give_the_rows_of_table_2():
    late = chapter_3.delays((5e-6, 1e-5))
    for row in late[late["delay"] == 2].itertuples():
        for figure in ("stroke", "peak_pressure", "efficiency"):
            within(getattr(row, figure), chapter_3.TABLE_2[row.step][figure], 0.01)
    ax = chapter_3.draw_delays(late, new_figure(4, 3).subplots())
    assert "thesis, Table 2" in [line.get_label() for line in ax.lines]


def test_profiles_of_heat_release_against_table_5():
    """In the loop, as the text has it: at fixed mass the frequency of (2) is off by 1.3 %."""
    off = chapter_3.heat_release().abs()
    assert off.drop(columns=["power", "efficiency"]).to_numpy().max() < 0.007
    assert off["efficiency"].max() < 0.018
    assert off["power"].max() < 0.026


@pytest.mark.parametrize("number", range(36, 43))
def test_figures_of_the_base_case(base_run, number):
    figure = chapter_3.FIGURES[number]
    assert figure.run is chapter_3.base_case
    assert all(ax.get_title() for ax in np.ravel(figure.draw(base_run))[:1])


def test_studies_are_run_and_drawn_by_the_number_of_their_figure():
    """One of each kind; a study that two figures show is run once."""
    assert list(chapter_3.FIGURES) == list(range(36, 60))
    shown = {}
    for number in (46, 51, 56, 57):
        figure = chapter_3.FIGURES[number]
        shown.setdefault(figure.run, figure.run())
        ax = figure.draw(shown[figure.run])
        assert ax.get_title()
        assert len(ax.lines) >= 2
