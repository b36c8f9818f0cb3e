"""Section 4.3: what the text says of scores, on printed numbers and on our own designs."""

import numpy as np
import pandas as pd
import pytest

from saleg.thesis import chapter_4, optimisation
from saleg.thesis.tables import columns


@pytest.fixture(scope="module")
def scores():
    return optimisation.printed_scores(9)


def test_every_printed_design_of_table_9_scores_above_0_998(scores):
    """As the text says of all of them; with the tolerance of the script none but one could."""
    assert (scores["printed"] > 0.998).all()


def test_scores_are_the_weighted_mean_of_figure_85(scores):
    """Its weights 3, 3, 2, 1, 1 and the curves of docs/optimisation.md, written out once more.

    From 10 kW on our model loses by power: that term alone makes the printed design the better one.
    """
    ours = chapter_4.run(9)
    target = pd.Series(optimisation.TARGETS)
    efficiency = 1.0 - np.exp(-2.0 * np.maximum((ours["efficiency"] - 0.3) / 0.1, 0.0) ** 6)
    stability = np.exp(-2.0 * (ours["stability"] / 0.1) ** 2)
    power = np.exp(-(((ours["power"] - target) / 1.5e3) ** 2))
    pressure = 1.0 - np.exp(-(((270e5 - ours["peak_pressure"]) / 20e5) ** 6))
    assert ours["compression_ratio"].between(5.0, 35.0).all()
    assert (ours["largest_multiplier"] < 1.0).all()
    total = (3.0 * efficiency + 3.0 * stability + 2.0 * power + 1.0 + pressure) / 10.0
    assert scores["computed"].to_numpy() == pytest.approx(total.to_numpy(), abs=1e-12)
    lost = (scores["printed"] - scores["computed"]).iloc[5:]
    assert (0.2 * (1.0 - power.iloc[5:]) > 0.9 * lost).all()


def test_table_11_ranks_the_same_two_designs_as_printed():
    """The first set of weights prefers the one, the three others the other."""
    ours = optimisation.rescored()
    printed = columns(11)
    for heading, row in ours.iterrows():
        best = printed[f"{heading}_best"]["efficiency"]
        assert printed[optimisation.DESIGNS[row.idxmax()]]["efficiency"] == best


def test_figures_and_problems_are_those_of_the_section():
    assert sorted(optimisation.FIGURES) == list(range(85, 92))
    assert optimisation.TARGETS["25 kW"] == 25e3
    assert optimisation.problem(12).score.target_power is None
    assert optimisation.problem(10).score.greatest_compression_ratio == 25.0
    assert optimisation.problem(9).bounds["intake_temperature"] == (250.0, 1000.0)


@pytest.mark.parametrize("number", [9, 10])
def test_printed_designs_lie_within_the_bounds_of_their_problems(number):
    """They may be printed with four digits, no more."""
    given = chapter_4.inputs(number)
    for name, (low, high) in optimisation.problem(number).bounds.items():
        assert given[name].between(0.9999 * low, 1.0001 * high).all(), name


@pytest.mark.parametrize(("number", "name"), [(9, "25 kW"), (10, "1 kW")])
def test_a_design_for_each_target_power(number, name):
    """Beyond 0.998 by our model and stable; two of all eighteen."""
    row = optimisation.targets(number, [name], seed=0).loc[name]
    assert row["score"] > 0.998
    assert row["stable"]
    assert row["power"] == pytest.approx(optimisation.TARGETS[name], rel=0.12)
    assert row["efficiency"] > 0.40  # the target of the text


@pytest.fixture(scope="module")
def front():
    return optimisation.front(11, evaluations=1000, seed=0)


def test_the_front_beats_the_designs_of_table_11(front):
    """A and B by our model, within their own limits, at the same power."""
    names = list(optimisation.DESIGNS.values())
    printed = chapter_4.run(11).loc[names]
    better = optimisation.beaten(front, printed)
    assert list(better.index) == names
    for figure in ("efficiency", "power_density"):
        assert (better[figure] >= printed[figure]).all()
    assert better["stable"].all()
    assert better["power"].between(*optimisation.FRONT_POWER).all()
    assert better["compression_ratio"].between(*optimisation.RATIOS[11]).all()
    for name, (low, high) in optimisation.problem(11).bounds.items():
        assert better[name].between(low, high).all()


def test_what_nothing_dominates_is_not_beaten(front):
    best = front.front.loc[[front.front["efficiency"].idxmax()]]
    assert len(optimisation.beaten(front, best)) == 1  # by itself
    assert optimisation.beaten(front, best.assign(efficiency=0.9)).empty


def test_cool_intakes_are_favoured_and_short_strokes_are_not_by_themselves():
    """Over the whole box efficiency falls with the temperature of the intake as the text finds; of
    low ratios of stroke to bore that does not hold (docs/optimisation.md)."""
    table = optimisation.uniform(600)
    table = table[table["status"] == "steady"]
    ranks = table[["efficiency", "intake_temperature", "stroke_to_bore"]].rank().corr()
    assert ranks.loc["efficiency", "intake_temperature"] < -0.8
    assert ranks.loc["efficiency", "stroke_to_bore"] > -0.1


def test_a_search_between_two_temperatures_stays_there():
    cool, hot = optimisation.along("intake_temperature", (300, 350, 700), evaluations=400).iloc
    assert 300.0 <= cool["intake_temperature"] <= 350.0 <= hot["intake_temperature"] <= 700.0
    assert min(cool["best_score"], hot["best_score"]) >= 0.7  # all but the efficiency is met


def test_good_designs_are_counted_by_power():
    """Two good ones of three steady ones between 2 and 4 kW, at known temperatures."""
    table = pd.DataFrame(
        {
            "status": "steady",
            "power": [2.5e3, 3e3, 3.5e3, 9e3],
            "efficiency": [0.42, 0.2, 0.45, 0.42],
            "compression_ratio": [20.0, 20.0, 20.0, 40.0],
            "peak_pressure": 1e7,
            "intake_temperature": [300.0, 500.0, 400.0, 300.0],
            "frequency": 50.0,
            "stroke_to_bore": 2.0,
            "score": 0.5,
        }
    )
    counted = optimisation.by_power(table, (2e3, 4e3, 16e3))
    assert counted["steady"].tolist() == [3, 1]
    assert counted["good"].tolist() == [2, 0]
    assert counted["intake_temperature_5"].iloc[0] == pytest.approx(305.0)
    assert counted["intake_temperature_95"].iloc[0] == pytest.approx(395.0)
