"""Tables 9 to 12: designs from their eight inputs alone, with the deviations stated."""

import pandas as pd
import pytest

import saleg
from helpers import falls
from printed import check, within
from saleg.design import Design, MassModel, Operation, Parameters, Score, formulas
from saleg.sweep import SweepError
from saleg.thesis import beside as base_tables
from saleg.thesis import chapter_4
from saleg.thesis.tables import TABLE_2, columns
from saleg.thesis.walls import with_walls_that_follow

#: The column whose mass leaves no room for an alternator, see docs/design.md.
OUTLIER = "25 kW"

#: Medians of the magnitudes of the relative deviations, as docs/design.md states them.
MEDIANS = {
    9: {
        "stroke": 0.005,
        "compression_ratio": 0.050,
        "frequency": 0.014,
        "moving_mass": 0.018,
        "efficiency": 0.057,
        "power": 0.086,
        "peak_pressure": 0.095,
        "displacement": 0.012,
        "stroke_to_bore": 0.002,
    },
    10: {
        "stroke": 0.004,
        "compression_ratio": 0.043,
        "frequency": 0.015,
        "moving_mass": 0.029,
        "efficiency": 0.032,
        "power": 0.036,
        "peak_pressure": 0.041,
    },
    12: {
        "stroke": 0.005,
        "compression_ratio": 0.050,
        "frequency": 0.031,
        "moving_mass": 0.048,
        "efficiency": 0.093,
        "power": 0.110,
        "peak_pressure": 0.069,
    },
}


@pytest.fixture(scope="module", params=MEDIANS)
def beside(request):
    return request.param, chapter_4.deviations(request.param)


def test_designs_deviate_from_the_print_by_no_more_than_stated(beside):
    number, off = beside
    median = off.abs().median()
    for figure, limit in MEDIANS[number].items():
        assert median[figure] < limit, figure


def test_every_design_is_steady_and_stable():
    for number in chapter_4.TABLES:
        table = chapter_4.run(number)
        assert (table["status"] == "steady").all()
        assert table["stable"].all()


def test_the_report_and_the_picture_show_every_design(beside):
    number, off = beside
    text = chapter_4.report(off)
    assert all(str(name) in text for name in chapter_4.printed(number).index)
    ax = chapter_4.draw(off)
    labels = [label.get_text() for label in ax.get_legend().get_texts()]
    assert labels == [*map(str, off.index), "median"]
    assert "[%]" in ax.get_ylabel()


# Sweeps


@pytest.mark.parametrize("name", chapter_4.SWEEPS)
def test_sweeps_rise_and_fall_as_the_text_says(name):
    """In the stable region, in the direction of the input; nothing is printed of the stiffness."""
    table = chapter_4.sweep_along(name, 13)
    figures = ["efficiency", "power_density", "compression_ratio", "peak_pressure"]
    rising, falling = {
        "bore": (figures, []),
        "half_stroke": ([], ["compression_ratio", "efficiency"]),
        "port_location": ([], ["frequency", "compression_ratio", "power_density", "peak_pressure"]),
        "intake_pressure": (figures, []),
        "intake_temperature": (["frequency"], figures),
        "spring_stiffness": ([], figures),
        "equivalence_ratio": (figures, []),
        "egr": ([], figures),
    }[name]
    stable = table[table["stable"]]
    assert len(stable) > 4
    for figure in rising:
        assert stable[figure].iloc[-1] > stable[figure].iloc[0], figure
    for figure in falling:
        assert stable[figure].iloc[-1] < stable[figure].iloc[0], figure
    assert len(chapter_4.draw_sweep(table, name)) == 8


# Table 9


@pytest.fixture(scope="module")
def designs():
    return chapter_4.run(9)


def test_the_outlier_of_table_9_is_one():
    """At 25 kW springs, rod and pistons leave a tenth of the mass a mover needs."""
    off = chapter_4.deviations(9)
    assert off["moving_mass"][OUTLIER] == pytest.approx(0.18, abs=0.02)
    assert off["frequency"][OUTLIER] == pytest.approx(-0.08, abs=0.01)
    others = off.drop(index=OUTLIER)
    assert others["moving_mass"].abs().max() < 0.06
    assert others["frequency"].abs().max() < 0.035


def test_efficiencies_of_table_9_are_high_as_the_thesis_step_makes_them(designs):
    """Ours is lower in every column; its own Table 2 loses 1.1 points from 5 to 0.5 us.

    It cannot be all of it: of Table 10 some columns are higher.
    """
    missing = chapter_4.printed(9)["efficiency"] - designs["efficiency"]
    assert (missing > 0.0).all()
    own_error = TABLE_2[5e-6]["efficiency"] - TABLE_2[5e-7]["efficiency"]
    assert own_error > 0.01
    assert missing.median() > own_error
    table_10 = chapter_4.deviations(10)["efficiency"]
    assert sorted(table_10)[4] > 0.0


def test_the_lag_of_the_thesis_explains_half_of_what_is_left(designs):
    """Two steps of 5 us, which explain Tables 2 and 3, halve the deviations of Table 9."""
    figures = ["efficiency", "power"]
    printed = chapter_4.printed(9)
    late = {}
    for name, values in chapter_4.inputs(9).iterrows():
        engine = saleg.design.evaluate(**values.to_dict()).engine
        performance = saleg.studies.delayed(engine, 1.5, step=5e-6, delay=2).performance
        late[name] = [getattr(performance, figure) for figure in figures]
    after = pd.DataFrame.from_dict(late, orient="index", columns=figures)
    ours, theirs = (
        (table[figures] / printed[figures] - 1.0).abs().median() for table in (designs, after)
    )
    assert (theirs < 0.6 * ours).all()


# Table 11


def test_one_reward_of_power_explains_the_order_under_all_weights_of_table_11():
    """The target power of 4 kW, which this score leaves out, decides all but the first.

    The design of higher efficiency has the better score without power whatever the weights;
    the other is nearer to 4 kW, and best in three of four. All four orders fix what
    its nearness is worth: between 0.020 and 0.031 of the weight of power.
    """
    least, most = 0.0, 1.0
    rows = chapter_4.printed(11).assign(stability=0.0)
    for heading in {name.rpartition("_")[0] for name in rows.index}:
        efficiency, stability, power, ratio, peak = map(float, heading.split("-"))
        score = Score(
            efficiency=efficiency,
            stability=stability,
            compression_ratio=ratio,
            peak_pressure=peak,
            efficiency_tolerance=0.4,  # as the script has it
        )
        best, second = (rows.loc[f"{heading}_{place}"] for place in ("best", "second"))
        ahead = (score(best) - score(second)) * (efficiency + stability + ratio + peak) / power
        if abs(best.power - 4e3) < abs(second.power - 4e3):
            assert best.efficiency < second.efficiency
            least = max(least, -ahead)
        else:
            most = min(most, ahead)
    assert 0.020 < least < most < 0.031


# Masses


def test_base_case_through_the_loop_without_its_mass():
    """Tables 1, 2 (0.5 us) and 5: the mass is found, not given."""
    found = saleg.design.evaluate()
    assert found.status is saleg.Status.STEADY
    assert found.stable
    figures = ("stroke", "compression_ratio", "frequency", "efficiency", "peak_pressure")
    limits = dict.fromkeys(figures, 0.025) | {"power": 0.045}
    check(found.performance, base_tables.FINEST, limits)


def test_the_base_case_weighs_what_table_1_says():
    """And runs at the frequency of Table 5; both are missed further with Eq. 63 as printed."""
    mass, frequency = columns(1)["value"]["moving_mass"], base_tables.FINEST.figures["frequency"]
    ours = saleg.design.evaluate()
    as_printed = saleg.design.evaluate(Design(masses=MassModel.as_printed()))
    assert Design().masses == MassModel.with_crankcase()
    for found, of_mass, of_frequency in ((ours, 0.006, 0.003), (as_printed, 0.025, 0.01)):
        within(found.moving_mass, mass, of_mass)
        within(found.performance.frequency, frequency, of_frequency)
    assert as_printed.moving_mass < 0.985 * mass


def alternator_densities(number, crankcase):
    """Density that gives each mass of a table with the printed stroke, frequency and power."""
    table = chapter_4.printed(number)
    found = {}
    for name, row in table.iterrows():
        mover = saleg.design.AlternatorMover(density=1.0)
        per_density = mover.mass(Parameters(), Operation(row.stroke, row.frequency, row.power))
        length = row.neutral_clearance_length
        bearing = formulas.bearing_position(row.stroke, length)
        crown = formulas.crown_position(bearing, crankcase * length)
        rest = formulas.piston_mass(row.bore) + formulas.rod_mass(crown)
        rest += formulas.spring_mass(row.spring_stiffness)
        found[name] = (row.moving_mass - rest) / per_density
    return pd.Series(found)


def test_eq_63_leaves_out_the_crankcase():
    """One density for all masses with a crankcase of length L, none with Eq. 63 as printed."""
    as_printed = alternator_densities(9, crankcase=0.0).drop(index=OUTLIER)
    with_crankcase = alternator_densities(9, crankcase=1.0).drop(index=OUTLIER)
    assert as_printed.std() / as_printed.mean() > 0.12
    assert with_crankcase.std() / with_crankcase.mean() < 0.035
    assert with_crankcase.mean() == pytest.approx(820.0, rel=0.02)
    # In the outlier next to nothing is left for the alternator, either way.
    assert alternator_densities(9, crankcase=1.0)[OUTLIER] < 100.0


def test_room_beneath_the_pistons_is_confirmed_on_columns_that_took_no_part():
    """Table 10 without its 10 and 25 kW, which leave too little for a mover as Table 12 does.

    Its seven others agree with 820 to 2 %, and scatter less than with the equation as printed.
    """
    unfitted = alternator_densities(10, crankcase=1.0)
    assert (unfitted[["10 kW", "25 kW"]] < 0.6 * 820.0).all()
    assert alternator_densities(12, crankcase=1.0).iloc[0] < 0.75 * 820.0
    others = unfitted.drop(index=["10 kW", "25 kW"])
    assert others.mean() == pytest.approx(820.0, rel=0.02)
    as_printed = alternator_densities(10, crankcase=0.0)[others.index]
    assert others.std() / others.mean() < 0.03 < as_printed.std() / as_printed.mean()


def test_a_sweep_the_chapter_has_not_is_refused_with_the_nearest():
    with pytest.raises(SweepError, match=r"no sweep of Chapter 4 along 'bor'; did you mean 'bore'"):
        chapter_4.sweep_along("bor")


def test_walls_that_follow_change_little_over_the_intake_temperature(base):
    """4.2 wants "a more robust model for wall temperature": all falls but the frequency, as before.

    As it stands the engine keeps its 550 K; heat is conserved in the wall.
    """
    following = with_walls_that_follow(base)
    figures, walls = [], []
    for temperature in (325.05, 400.0, 480.0):
        intake = {"intake.temperature": temperature}
        fixed, steady = (saleg.steady_state(e.replace(**intake)) for e in (base, following))
        walls.append(steady.strokes["wall_temperature"].mean())
        heat = steady.strokes["heat_lost"].sum(axis=0)[0] * steady.performance.frequency
        law = following.left.wall
        assert heat == pytest.approx(law.conductance * (walls[-1] - 360.0), rel=1e-3)
        assert steady.performance.power == pytest.approx(fixed.performance.power, rel=0.01)
        figures.append(steady.performance)
    assert walls[0] == pytest.approx(550.0, abs=0.5)
    assert walls == sorted(walls)
    for name in ("power", "efficiency", "compression_ratio", "stroke", "peak_pressure"):
        assert falls([getattr(one, name) for one in figures]), name
