"""Optimising a closed form: optima, the same for all workers, nothing lost, one clear error."""

import json
import multiprocessing
import os
import signal
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import pytest

from analytic import Hill
from saleg import SalegError
from saleg import optimize as o

BOX = dict.fromkeys("abcd", (0.0, 1.0))
TOP = np.array(Hill().top)
#: Each method with the designs it gets, and how near to the top it has to come.
METHODS = {
    "ga": (o.GeneticAlgorithm(size=100, generations=60, stop=np.inf), 2000, 0.05),
    "cma": (o.CMAES(size=16, sample=20), 600, 1e-3),
    "de": (o.DifferentialEvolution(size=20), 1500, 0.01),
    "nsga2": (o.NSGA2(size=40), 1500, 0.05),
    "archive": (o.Archive(axes=(o.Axis("weight", 1, 3, 5),), sample=40, size=20), 1500, 0.05),
    "compass": (o.CompassSearch(step=0.2), 800, 1e-3),
}
each_method = pytest.mark.parametrize("name", METHODS)


def height(row):
    return 2.0 * row["efficiency"]


HEIGHT = o.WeightedScore(((1.0, o.Own(height, "height")),))


def hill(**fields):
    return o.Problem(
        **{
            "bounds": BOX,
            "score": HEIGHT,
            "swept": Hill(),
            "objectives": (o.Objective("efficiency"),),
            **fields,
        }
    )


def same(one, other):
    pd.testing.assert_frame_equal(one.table, other.table, check_exact=True)
    pd.testing.assert_frame_equal(one.history, other.history, check_exact=True)


@each_method
def test_each_method_comes_to_the_top(name):
    method, evaluations, near = METHODS[name]
    found = o.optimize(hill(), method, evaluations, seed=4, workers=1)
    best = found.best
    assert np.abs(np.array([best[name] for name in BOX]) - TOP).max() < near
    assert best["stable"]
    assert len(found.table) <= evaluations
    assert found.history.best.is_monotonic_increasing
    assert found.history.evaluations.iloc[-1] == len(found.table)
    assert found.history.best.iloc[-1] == best["efficiency"]


@each_method
def test_the_same_for_any_workers_whatever_others_do_with_random_numbers(name):
    method, problem = METHODS[name][0], hill()
    plain = o.optimize(problem, method, 230, seed=1, workers=1)
    np.random.seed(7)  # noqa: NPY002  of others
    state = np.random.get_state()[1].copy()  # noqa: NPY002
    with ThreadPoolExecutor(3) as pool:
        same(plain, o.optimize(problem, method, 230, 1, executor=pool))
    assert (np.random.get_state()[1] == state).all()  # noqa: NPY002
    other = o.optimize(problem, method, 230, seed=2, workers=1)
    assert name == "compass" or not plain.table.equals(other.table)


class Stopped(Exception):
    pass


@each_method
def test_interrupted_it_goes_on_and_ends_as_it_would_have(name, tmp_path):
    method, problem = METHODS[name][0], hill()
    whole = o.optimize(problem, method, 230, 3, tmp_path / "whole", workers=1)
    folder = tmp_path / "parts"
    for count in (1, 2, 3):

        def stop(progress, count=count):
            if progress.generation == count:
                raise Stopped

        if len(whole.history) > count + 1:
            with pytest.raises(Stopped):
                o.optimize(problem, method, 230, 3, folder, workers=1, report=stop)
        # As a kill between the log and its mark would leave it.
        with open(folder / "designs.csv", "ab") as log:
            log.write(b"0.5,0.25,torn")
    again = o.optimize(problem, method, 230, 3, folder, workers=1)
    same(whole, again)
    names = ("designs.csv", "progress.json", "optimisation.json")
    for file in names:
        assert (folder / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()
    same(whole, o.optimize(problem, method, 230, 3, folder, workers=1))


#: Real designs, few, in which failures, copies and multipliers occur.
REAL = {
    "ga of designs": o.GeneticAlgorithm(size=14, generations=9, stop=np.inf),
    "cma of designs": o.CMAES(size=6, sample=12),
}


def _run(folder, name):
    if name in REAL:
        return o.optimize(o.thesis_problem(4e3), REAL[name], 44, 3, folder, workers=1)
    problem = hill(swept=Hill(unstable_from=0.28))
    return o.optimize(problem, METHODS[name][0], 130, 3, folder, workers=1)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills forks")
@pytest.mark.parametrize("name", [*METHODS, *REAL])
def test_killed_ten_times_at_random_it_ends_as_it_would_have(name, tmp_path):
    """To the last bit, whether killed before its first design, within a write, or near the end."""
    _run(tmp_path / "first", name)  # compiles
    begin = time.perf_counter()
    whole = _run(tmp_path / "whole", name)
    seconds = time.perf_counter() - begin
    context, rng = multiprocessing.get_context("fork"), np.random.default_rng(5)
    kills, folders = 0, [tmp_path / "killed 0"]
    while kills < 10:
        work = context.Process(target=_run, args=(folders[-1], name))
        work.start()
        work.join(rng.uniform(0.0, 0.5 * seconds))
        if work.exitcode is None:
            os.kill(work.pid, signal.SIGKILL)
        work.join()
        if work.exitcode == -signal.SIGKILL:
            kills += 1
        else:  # at its end before the kill
            folders.append(tmp_path / f"killed {len(folders)}")
    same(whole, _run(folders[-1], name))
    for folder in folders:
        for file in ("designs.csv", "progress.json", "optimisation.json"):
            assert (folder / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()


def test_more_evaluations_go_on_from_a_finished_folder(tmp_path):
    method = o.CMAES(size=8, sample=20)
    short = o.optimize(hill(), method, 101, 0, tmp_path / "more", workers=1)
    long = o.optimize(hill(), method, 200, 0, tmp_path / "more", workers=1)
    straight = o.optimize(hill(), method, 200, 0, workers=1)
    names = [*BOX, "efficiency", "generation"]
    assert long.table[names][:101].equals(short.table[names])
    assert long.table[names].equals(straight.table[names])


def test_another_optimisation_in_the_folder_is_refused(tmp_path):
    method = o.CMAES(size=8, sample=20)
    o.optimize(hill(), method, 30, 0, tmp_path / "one", workers=1)
    with pytest.raises(SalegError, match=r"other problem, method, seed"):
        o.optimize(hill(constraints=(o.Limit("power", 1e3, 2e3),)), "ga", 30, 1, tmp_path / "one")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter.txt").write_text("dear")
    with pytest.raises(SalegError, match=r"no folder of an optimisation: it holds letter.txt"):
        o.optimize(hill(), method, 30, 0, tmp_path / "mine")
    log = tmp_path / "one" / "designs.csv"
    text = log.read_text()
    log.write_text(text.replace("1", "2"))
    with pytest.raises(SalegError, match=r"designs.csv is damaged: it is not as it was written"):
        o.optimize(hill(), method, 30, 0, tmp_path / "one")
    log.write_text(text[:100])
    with pytest.raises(SalegError, match=r"designs.csv is damaged"):
        o.optimize(hill(), method, 30, 0, tmp_path / "one")


def test_nothing_is_dropped_by_an_altered_progress(tmp_path):
    method = o.CMAES(size=8, sample=20)
    whole = o.optimize(hill(), method, 30, 0, tmp_path, workers=1)
    progress, designs = tmp_path / "progress.json", (tmp_path / "designs.csv").read_bytes()
    right = progress.read_text()
    known = json.loads(right)
    for wrong in ({"bytes": 0}, {"bytes": 100}, {"bytes": "all"}, {"designs": None}):
        progress.write_text(json.dumps(known | wrong))
        with pytest.raises(SalegError, match=r"(designs.csv|progress.json) is damaged"):
            o.optimize(hill(), method, 30, 0, tmp_path, workers=1)
        assert (tmp_path / "designs.csv").read_bytes() == designs
    progress.write_text(right)
    assert o.optimize(hill(), method, 30, 0, tmp_path, workers=1).table.equals(whole.table)


def test_a_log_of_another_course_is_refused(tmp_path):
    method = o.CMAES(size=8, sample=20)
    o.optimize(hill(), method, 30, 0, tmp_path, workers=1)
    text = json.loads((tmp_path / "optimisation.json").read_text())
    (tmp_path / "optimisation.json").write_text(json.dumps({**text, "seed": 9}))
    with pytest.raises(SalegError, match="designs this method does not ask for"):
        o.optimize(hill(), method, 30, 9, tmp_path, workers=1)


def test_what_leads_is_stable_by_its_multipliers_and_few_are_computed():
    """The top lies where orbits are unstable, so the best one is on the border of that."""
    problem = hill(swept=Hill(unstable_from=0.28))
    found = o.optimize(problem, o.CMAES(size=8, sample=20), 600, workers=1)
    assert found.best["stable"]
    assert found.best["a"] == pytest.approx(0.28, abs=2e-3)
    unknown = found.table[~found.table.verified]
    assert unknown.efficiency.max() <= found.best["efficiency"]
    assert found.table.verified.sum() < 0.3 * len(found.table)
    assert not found.table.stable[~found.table.verified].any()


def test_a_score_alone_loses_its_stability_term():
    problem = o.Problem(BOX, swept=Hill(unstable_from=0.28), score=o.WeightedScore(
        ((3.0, o.Reached("efficiency", 0.49, 0.1)), (1.0, o.Repeats())),
    ))  # fmt: skip
    found = o.optimize(problem, o.CMAES(size=8, sample=20), 400, workers=1)
    assert found.best["stable"]
    assert found.best["score"] > 0.9


def test_limits_hold_and_the_front_is_known():
    """Light against efficient, with power within a range: a and b trade on the front."""
    problem = hill(
        objectives=(o.Objective("efficiency"), o.Objective("weight", maximise=False)),
        constraints=(o.Limit("power", 3e3, 3.4e3),),
    )
    found = o.optimize(problem, o.NSGA2(size=60), 3000, seed=2, workers=1)
    front = found.front.sort_values("weight")
    assert front.power.between(3e3, 3.4e3).all()
    assert front.efficiency.is_monotonic_increasing
    assert len(front) > 20
    assert front.verified.all()
    # At the light end a = b = 0 and c, d are those of the top: power 1.8 kW, so c and d grow.
    assert front.weight.iloc[0] < 1.1
    with pytest.raises(SalegError, match="takes one objective, the problem has 2; use NSGA2"):
        o.optimize(problem, "cma", 10)


def test_archive_is_the_best_of_every_cell():
    method, evaluations, _ = METHODS["archive"]
    found = o.optimize(hill(), method, evaluations, workers=1)
    archive = found.archive(*method.axes)
    steady = found.table[found.table.status == "steady"]
    cells = np.minimum((steady.weight - 1.0) / 2.0 * 5, 4).astype(int)
    best = steady.efficiency.groupby(cells).max()
    assert archive.set_index("cell").efficiency.sort_index().tolist() == best.tolist()
    assert len(archive) == 5
    # A weight of 2.6 to 3 leaves a + b >= 1.6: off the top by 0.35 in both, at least.
    assert best.iloc[4] == pytest.approx(0.5 * np.exp(-2.0 * 0.35**2), rel=0.02)
    assert archive.verified.all()


def test_copies_are_counted_not_evaluated():
    found = o.optimize(hill(), o.GeneticAlgorithm(size=60, generations=30), 1500, workers=1)
    copied = found.table[found.table.copied]
    assert len(copied) > 50
    values = found.table[[*BOX]].to_numpy()
    for row in copied.index[:20]:
        assert (values[:row] == values[row]).all(axis=1).any()
    assert len(found.table.drop_duplicates([*BOX])) == (~found.table.copied).sum()


def test_all_scores_zero_is_survived():
    """A box in which nothing is found: every method goes on to the end."""
    score = (o.Objective("score"),)
    problem = hill(bounds={**BOX, "d": (0.91, 1.0)}, objectives=score)
    for method, *_ in METHODS.values():
        found = o.optimize(problem, method, 150, workers=1)
        assert found.best["score"] == 0.0
        assert not found.table.verified.any()


def test_second_stage_keeps_the_limits_of_the_score():
    """Power at 2 kW by the score; then the lightest within 5 % of it."""
    terms = ((1.0, o.Bell("power", 2e3, 500.0)), (1.0, o.Reached("efficiency", 0.3, 0.2)))
    problem = o.Problem(BOX, o.WeightedScore(terms), swept=Hill())
    found = o.optimize(problem, o.CMAES(size=8, sample=40), 400, workers=1)
    lighter = o.improve(found, o.Objective("weight", maximise=False), evaluations=500, workers=1)
    assert [tuple(limit) for limit in lighter.problem.constraints] == [("power", 1900.0, 2100.0)]
    assert 1900.0 <= lighter.best["power"] <= 2100.0
    assert lighter.best["weight"] == pytest.approx(1.0, abs=0.01)  # c and d can make the power
    polished = o.polish(found, 200, workers=1)
    assert polished.best["score"] >= found.best["score"]


def test_scatter_gives_mean_and_worst_scores():
    """The score is exp(-slope off^2): of the same samples of the slope for every design."""
    scatter = o.Scatter({"slope": 0.3}, samples=6, seed=1)
    problem = o.Problem({"a": (0.0, 1.0)}, HEIGHT, swept=Hill(slope=2.0), scatter=scatter)
    table = problem.evaluate([[0.3], [0.8]])
    slopes = 2.0 * scatter.factors[:, 0]
    assert table.worst_score.tolist() == pytest.approx([1.0, np.exp(-slopes * 0.25).min()])
    assert table.mean_score.tolist() == pytest.approx([1.0, np.exp(-slopes * 0.25).mean()])
    robust = problem.replace(objectives=(o.Objective("worst_score"),))
    found = o.optimize(robust, o.CompassSearch(), 60, workers=1)
    assert found.best["a"] == pytest.approx(0.3, abs=1e-3)
    assert found.best["worst_score"] <= found.best["score"]


def test_a_problem_names_all_that_is_wrong():
    with pytest.raises(SalegError) as error:
        o.Problem(
            {"a": (1.0, 0.0), "b": (0.0, np.nan), "e": (0.0, 1.0)},
            score=3.0,
            objectives=(o.Objective("efficency"),),
            constraints=(o.Limit("colour", 0.0, 1.0), o.Limit("power", 2.0, 1.0)),
            swept=Hill(),
            rtol=-1.0,
        )
    text = str(error.value)
    assert text.startswith("8 wrong fields in the optimisation")
    for part in (
        "bounds['a'] = (1.0, 0.0): the lower bound must be below the higher",
        "bounds['b'] = (0.0, nan): must be a lower and a higher finite value",
        "no 'e' in a hill",
        "score = 3.0: must be a score",
        "objectives[0] = 'efficency': no row has it; did you mean 'efficiency'",
        "constraints[0] = 'colour': no row has it",
        "constraints[1]",
        "rtol",
    ):
        assert part in text


def test_bounds_of_a_design_are_checked_with_their_units():
    with pytest.raises(SalegError, match=r"bounds\['bore'\] = 100.0 \[m\].*given in mm\?"):
        o.thesis_problem(bounds={"bore": (0.02, 100.0)})
    with pytest.raises(SalegError, match=r"bounds\['stroke'\]"):
        o.thesis_problem(bounds={"stroke": (0.02, 0.1)})


def test_an_optimisation_names_all_that_is_wrong(monkeypatch):
    monkeypatch.setitem(sys.modules, "cma", None)
    with pytest.raises(SalegError) as error:
        o.optimize(hill(), o.CMAES(size=2), 0, -1, workers=0, start=pd.DataFrame({"a": [0.1]}))
    text = str(error.value)
    assert text.startswith("6 wrong fields in the optimisation")
    for part in ('pip install "saleg[optimize]"', "method.size", "evaluations", "seed", "workers"):
        assert part in text
    assert "start = ['b', 'c', 'd']" in text
    with pytest.raises(SalegError, match="did you mean 'cma'"):
        o.optimize(hill(), "cna")
    with pytest.raises(SalegError, match=r"saleg.optimize.Problem"):
        o.optimize(3.0)
    found = o.optimize(hill(), None, 60, workers=1)
    assert type(found.method) is o.DifferentialEvolution


@pytest.mark.parametrize(
    ("score", "shown"),
    [
        (lambda row: row["weight"] * np.nan, "nan"),
        (lambda row: np.where(row["weight"] > 1.5, np.inf, 0.5), "inf"),
        (lambda row: -row["weight"], "-[12]"),
        (lambda row: "good", "'good'"),
        (lambda row: np.ones(3), "array"),
        (lambda row: None, "nan"),
    ],
)
def test_a_score_that_is_none_is_refused(score, shown):
    """A failed design scores 0, so what is below would come behind it, and NaN nowhere."""
    problem = o.Problem(BOX, score, swept=Hill())
    with pytest.raises(SalegError, match=f"score = {shown}.*: must be a number for every row"):
        o.optimize(problem, "ga", 20, workers=1)


@pytest.mark.parametrize(
    ("fields", "says"),
    [
        ({"objectives": o.Objective("power")}, "objectives = .*must be a tuple, of Objective"),
        ({"objectives": None}, "objectives = None: must be a tuple, of Objective"),
        ({"objectives": (o.Objective(["power"]),)}, "no row has it"),
        ({"objectives": (o.Objective("status"),)}, "'status': is text"),
        ({"constraints": o.Limit("power", 1.0)}, "constraints = .*must be a tuple, of Limit"),
        ({"constraints": None}, "constraints = None: must be a tuple, of Limit"),
        ({"constraints": (o.Limit("power", "a"),)}, "must have low <= high, both numbers"),
        ({"constraints": (o.Limit("message", 1.0),)}, "'message': is text"),
        ({"scatter": 0.1}, "scatter = 0.1: must be a Scatter"),
    ],
)
def test_objectives_and_limits_of_no_number_are_refused(fields, says):
    with pytest.raises(o.InvalidProblem, match=says):
        hill(**fields)


@pytest.mark.parametrize(
    ("method", "says"),
    [
        (o.DifferentialEvolution(strategy="best1bim"), "did you mean 'best1bin'"),
        (o.DifferentialEvolution(mutation=(1.0, 0.5)), "mutation.*must be two rising numbers"),
        (o.DifferentialEvolution(mutation="a"), "mutation.*must be two rising numbers"),
        (o.GeneticAlgorithm(stop=np.nan), "stop = nan: must be a number"),
        (o.Archive(axes=()), "axes = .*must be a tuple with at least one Axis"),
        (o.Archive(axes=(3,)), r"axes\[0\] = 3: must be an Axis"),
        (o.Archive(axes=(o.Axis("wieght", 1.0, 2.0),)), "did you mean 'weight'"),
        (o.Archive(axes=(o.Axis("status", 1.0, 2.0),)), "is text"),
        (o.Archive(axes=(o.Axis("weight", 2.0, 1.0, 0.5),)), "(?s)low < high.*whole number"),
    ],
)
def test_settings_of_methods_are_checked(method, says):
    with pytest.raises(o.InvalidProblem, match=says):
        o.optimize(hill(), method, 20, workers=1)


@pytest.mark.parametrize(
    "designs",
    [[[0.1, 0.2]], [0.1, 0.2, 0.3, 0.4], [["x"] * 4], [[0.1, 0.2, 0.3, np.nan]], {"a": [0.1]}],
)
def test_designs_that_are_none_are_refused(designs):
    given = pd.DataFrame(designs) if isinstance(designs, dict) else designs
    with pytest.raises(o.InvalidProblem, match="X = "):
        hill().evaluate(given)


def test_what_is_no_result_has_no_second_stage():
    for stage in (o.improve, o.polish, o.winners):
        with pytest.raises(o.InvalidProblem, match=r"must be what optimize\(...\) returns"):
            stage(hill())
    with pytest.raises(o.InvalidProblem, match="no row has it"):
        o.optimize(hill(), "ga", 20, workers=1).archive(o.Axis("colour", 0.0, 1.0))
    with pytest.raises(SalegError, match="compression_ratio = 3: must be its lowest and highest"):
        o.thesis_problem(4e3, 3)


def test_fronts_without_their_package_say_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymoo", None)
    two = (o.Objective("efficiency"), o.Objective("power"))
    with pytest.raises(o.InvalidProblem, match=r'needs pymoo: pip install "saleg\[optimize\]"'):
        o.optimize(hill(objectives=two), evaluations=20)
