"""Numerical studies: tables of the thesis beside ours, and where its error comes from."""

import time

import numpy as np
import pytest

import saleg
from helpers import TABLES, bounce_engine
from saleg import studies
from saleg.errors import SalegError
from saleg.plotting.studies import delay, work_precision
from saleg.thesis.tables import TABLE_2, TABLE_3


def test_steps_of_the_thesis_change_nothing_here(base):
    table = studies.step_size_study(base, [5e-5, 1e-5], duration=0.6)
    for name in ("stroke", "efficiency", "power", "peak_pressure"):
        assert table[name].iloc[0] == pytest.approx(table[name].iloc[1], rel=1e-5)
    beside = studies.beside_thesis(table, TABLE_2, "step")
    assert beside["thesis_efficiency"].tolist() == [0.533, 0.369]
    assert beside.attrs["units"]["thesis_stroke"] == "m"


def test_printed_rows_are_those_of_the_tables():

    lines = (TABLES / "table02_step_size.csv").read_text().splitlines()[2:]
    for line in lines:
        step, _, _, peak, stroke, efficiency, power = map(float, line.split(","))
        row = TABLE_2[step]
        printed = (peak * 1e5, stroke * 1e-3, efficiency * 1e-2, power * 1e3)
        ours = [row[name] for name in ("peak_pressure", "stroke", "efficiency", "power")]
        assert ours == pytest.approx(printed, rel=1e-12)


def test_orders_agree_from_two_up(base):
    """As in Table 3, though here because each is converged."""
    table = studies.solver_study(base, [2, 4, 8], step=1e-5, duration=0.4).set_index("order")
    assert table.loc[4, "efficiency"] == pytest.approx(table.loc[8, "efficiency"], rel=1e-8)
    assert table.loc[2, "efficiency"] == pytest.approx(table.loc[8, "efficiency"], rel=1e-4)
    assert set(TABLE_3) == {1, 2, 3, 4, 5, 8}


def test_stop_time_matters_only_until_steady(base):
    table = studies.stop_time_study(base, [0.8, 1.2])
    assert table["stroke"].iloc[0] == pytest.approx(table["stroke"].iloc[1], rel=1e-6)


def test_delay_of_two_steps_gives_the_rows_of_table_2(base):
    """Stroke, peak and efficiency at 5 and 10 us, with one whole number fitted."""
    table = studies.delay_study(base, [5e-6, 1e-5], [2]).set_index("step")
    for step, row in table.iterrows():
        for name in ("stroke", "peak_pressure", "efficiency"):
            assert row[name] == pytest.approx(TABLE_2[step][name], rel=0.01)


def test_error_of_a_delay_is_of_first_order_in_the_lag(base):
    table = studies.delay_study(base, [1e-6, 2e-6, 4e-6], [2], duration=1.0)
    exact = studies.tolerance_study(base, [1e-10])["efficiency"].iloc[0]
    errors = table["efficiency"].to_numpy() - exact
    order = np.polyfit(np.log(table["step"]), np.log(errors), 1)[0]
    assert order == pytest.approx(1.0, abs=0.2)
    slope = (errors[-1] - errors[0]) / 3e-6  # Table 2: about 0.25 points per microsecond
    assert 1e-2 * 0.2e6 < slope < 1e-2 * 0.3e6


def test_coarse_delays_fail_with_a_status(base):
    table = studies.delay_study(base, [1e-4], [1], duration=0.5)
    assert table["status"].iloc[0] != "steady"
    with pytest.raises(ValueError, match="whole steps"):
        studies.delayed(base, 1.0, step=1e-5, delay=-1)


@pytest.mark.parametrize("wrong", [{"delay": "2"}, {"delay": 0.5}, {"step": "1e-5"}, {"step": 2.0}])
def test_delays_that_make_no_sense_are_named(base, wrong):
    with pytest.raises(SalegError, match=f"{next(iter(wrong))} = "):
        studies.delay_study(base, [wrong.get("step", 1e-5)], [wrong.get("delay", 1)])


def test_no_cost_includes_the_first_call(base, monkeypatch):
    """The first call, which may compile, is made before the clock starts."""
    called = []

    def slow_at_first(name):
        run = getattr(studies.convergence, name)

        def spy(engine, duration, **settings):
            time.sleep(0.0 if called else 0.5)
            called.append(duration)
            return run(engine, duration, **settings)

        monkeypatch.setattr(studies.convergence, name, spy)

    slow_at_first("simulate")
    slow_at_first("delayed")
    for study, arguments in (
        (studies.step_size_study, ([1e-5],)),
        (studies.solver_study, ([4],)),
        (studies.tolerance_study, ([1e-6],)),
        (studies.stop_time_study, ([0.1],)),
        (studies.delay_study, ([1e-5], [1])),
    ):
        called.clear()
        settings = {} if study is studies.stop_time_study else {"duration": 0.1}
        table = study(base, *arguments, **settings)
        assert table["cost"].max() < 0.5
        assert called == [studies.WARM_UP, 0.1]


def test_an_empty_study_has_its_columns(base):
    table = studies.step_size_study(base, [])
    assert list(table) == list(studies.step_size_study(base, [1e-4], duration=0.01))
    assert len(table) == 0


def test_the_thesis_stands_beside_its_base_case_only(base, transient):
    for engine in (transient, base.replace(bore=0.063)):
        table = studies.step_size_study(engine, [1e-5], duration=0.1)
        with pytest.raises(SalegError, match="another engine"):
            studies.beside_thesis(table, TABLE_2, "step")


def test_rows_are_found_however_the_step_was_computed(base):
    table = studies.step_size_study(base, [3 * 1e-5 / 3, 0.1 * 5e-5], duration=0.1)
    table = table[table["status"] != ""].sort_values("step").reset_index(drop=True)
    assert table.attrs["engine"] == base.to_toml()
    beside = studies.beside_thesis(table, TABLE_2, "step")
    assert beside["thesis_efficiency"].tolist() == [0.3553, 0.369]
    with pytest.raises(SalegError, match="no column 'steps' in the study; there are step, order"):
        studies.beside_thesis(table, TABLE_2, "steps")


def test_work_precision_without_fuel_compares_what_there_is():
    engine = bounce_engine()
    table = studies.work_precision(
        engine, orders=[4], steps=[1e-5], tolerances=[1e-6], duration=0.2
    )
    assert table["efficiency"].isna().all()
    assert (table["error"] < 1e-4).all()


def test_work_precision_needs_a_figure(base):
    engine = base.replace(**{"alternator.load_constant": 400.0, "alternator.regulator_gain": 0.0})
    with pytest.raises(SalegError, match=r"no figures.*stroke fell"):
        studies.work_precision(engine, duration=2.0)


def test_work_precision_and_its_plot(base):
    table = studies.work_precision(
        base, orders=[2, 4], steps=[4e-5, 2e-5], tolerances=[1e-4, 1e-6], duration=0.2
    )
    assert (table["error"] < 1e-3).all()
    ax = work_precision(table)
    drawn = {line.get_label(): line.get_xydata() for line in ax.lines}
    assert set(drawn) == {"order 2", "order 4", "adaptive"}
    rows = table[table["method"] == "order 4"]
    np.testing.assert_allclose(drawn["order 4"], rows[["evaluations", "error"]])


def test_delay_plot_shows_the_printed_rows(base):
    table = studies.delay_study(base, [5e-6, 1e-5], [0, 2], duration=0.5)
    ax = delay(table, printed=TABLE_2)
    labels = [line.get_label() for line in ax.lines]
    assert labels == ["no delay", "2 steps late", "thesis, Table 2"]
    assert 36.9 in ax.lines[-1].get_ydata()
    assert "[%]" in ax.get_ylabel()
    assert "[µs]" in ax.get_xlabel()
    assert hasattr(ax.figure, "_repr_png_")  # shows in a notebook


def test_delay_plot_of_another_engine_has_no_printed_rows(transient):
    table = studies.delay_study(transient, [5e-6, 1e-5], [0, 2], duration=0.2)
    ax = saleg.plotting.studies.delay(table, printed=TABLE_2)
    assert [line.get_label() for line in ax.lines] == ["no delay", "2 steps late"]
