"""Figures of an optimisation show the data of its table."""

import numpy as np
import pytest

from saleg import optimize
from saleg.errors import SalegError
from saleg.plotting.optimisation import FIGURES
from saleg.plotting.scores import score_terms


@pytest.fixture(scope="module")
def found():
    bounds = {"bore": (0.05, 0.07), "half_stroke": (0.06, 0.1)}
    fixed = {"port_location": 0.45, "intake_pressure": 1.2e5, "intake_temperature": 300.0}
    fixed |= {"spring_stiffness": 150e3, "equivalence_ratio": 0.5, "egr": 0.2}
    swept = optimize.Problem(bounds).swept.replace(fixed)
    problem = optimize.Problem(bounds, optimize.Score(target_power=1e4), swept=swept)
    return optimize.optimize(problem, optimize.GeneticAlgorithm(size=10), evaluations=25, seed=3)


@pytest.fixture(scope="module")
def two_goals(found):
    goals = (optimize.Objective("efficiency"), optimize.Objective("power_density"))
    problem = found.problem.replace(objectives=goals)
    return optimize.Found(problem, found.method, 0, found.table, found.history, "")


def line(ax, text):
    return next(item for item in ax.get_lines() if item.get_label() == text)


def test_the_course_is_the_best_so_far(found):
    drawn = line(found.plot.convergence(), "best so far")
    counts = np.asarray(drawn.get_xdata(), dtype=int)
    scores = found.table["score"].to_numpy()
    wanted = [scores[:count].max() for count in counts]
    assert counts[-1] == len(found.table) == 25
    # What leads is differentiated, which may take its score down, never up.
    assert np.asarray(drawn.get_ydata()) == pytest.approx(wanted)


def test_a_cell_of_the_archive_has_the_best_score_of_its_designs(found):
    across, up = optimize.Axis("bore", 0.05, 0.07, 2), optimize.Axis("half_stroke", 0.06, 0.1, 2)
    drawn = found.plot.archive(across, up).collections[0].get_array()
    right = found.table["bore"] >= 0.06
    upper = found.table["half_stroke"] >= 0.08
    for row, column in np.ndindex(2, 2):
        inside = found.table[(right == bool(column)) & (upper == bool(row))]
        if len(inside):
            assert drawn[row, column] == inside["score"].max()
        else:
            assert np.ma.getmaskarray(np.ma.masked_invalid(drawn))[row, column]


def test_parallel_coordinates_begin_with_the_shares_of_the_box(found):
    best = line(found.plot.parallel(count=5), "best").get_ydata()
    row = found.best
    assert best[0] == pytest.approx((row["bore"] - 0.05) / 0.02)
    assert best[1] == pytest.approx((row["half_stroke"] - 0.06) / 0.04)


def test_nothing_dominates_the_front(two_goals):
    drawn = line(two_goals.plot.front(), "front")
    x, y = np.asarray(drawn.get_xdata()), np.asarray(drawn.get_ydata())
    assert np.all(np.diff(x) > 0.0)
    assert np.all(np.diff(y) < 0.0)
    all_x = 100.0 * two_goals.table["efficiency"]
    all_y = 1e-3 * two_goals.table["power_density"]
    for a, b in zip(x, y, strict=True):
        assert not np.any((all_x > a) & (all_y > b))


def test_one_objective_has_no_front(found):
    with pytest.raises(SalegError, match="one objective, score, has no front"):
        found.plot.front()


def test_terms_of_the_score_are_those_of_figure_85():
    panels = score_terms(optimize.Score(target_power=4e3))
    assert [ax.get_xlabel() for ax in panels] == [
        "efficiency [%]",
        "stability [-]",
        "power [kW]",
        "compression ratio [-]",
        "peak pressure [bar]",
    ]
    assert [ax.get_title() for ax in panels] == [f"weight {weight}" for weight in (3, 3, 2, 1, 1)]
    power = panels[2].get_lines()[0]
    assert power.get_xdata()[np.argmax(power.get_ydata())] == pytest.approx(4.0, abs=0.05)


def test_a_function_has_no_terms_to_draw():
    with pytest.raises(SalegError, match="has no terms to draw"):
        score_terms(len)


@pytest.mark.parametrize("name", [name for name in FIGURES if name != "front"])
def test_every_figure_is_drawn(found, name):
    drawn = getattr(found.plot, name)()
    first = drawn[0] if isinstance(drawn, np.ndarray) else drawn
    first.figure.canvas.draw()
    assert "ax : " in FIGURES[name].__doc__


def test_a_figure_that_is_not_there_is_named_with_the_nearest(found):
    with pytest.raises(AttributeError, match="no figure 'fronts'; did you mean 'front'"):
        found.plot.fronts  # noqa: B018
    assert "convergence" in dir(found.plot)
