"""Optimising engines: rows are those of the design loop, and presets are what they say."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import saleg
from saleg import optimize as o
from saleg.steady import lanes


def test_presets_keep_fuel_that_finds_no_air_out():
    """Equivalence ratios up to 1.2 in the script; beyond 1 there is no air in the model."""
    for preset in (o.thesis_text, o.thesis_script):
        assert preset.box["equivalence_ratio"][1] == 1.0
        assert len(preset.box) == 8
        assert preset.problem(4e3).names == tuple(preset.box)
    assert o.thesis_text.method == o.GeneticAlgorithm(
        size=500, mutation=0.25, crossover=0.25, generations=70, stop=0.999
    )
    assert (o.thesis_script.method.size, o.thesis_script.method.generations) == (600, 20)


def test_a_small_optimisation_of_designs():
    """The best one is that of the design loop, with all of its multipliers within the circle."""
    bounds = {"bore": (0.035, 0.06), "half_stroke": (0.025, 0.05), "intake_temperature": (300, 400)}
    problem = o.thesis_problem(4e3, (5.0, 25.0), bounds)
    method = o.CMAES(size=8, sample=40)
    found = o.optimize(problem, method, 80, seed=1, workers=2)
    best = found.best
    assert best["score"] > 0.7
    alone = saleg.design.evaluate(**{name: best[name] for name in problem.bounds})
    assert best["stable"]
    assert alone.stable
    for name in ("efficiency", "power", "compression_ratio", "peak_pressure"):
        assert getattr(alone.performance, name) == pytest.approx(best[name], rel=1e-9)
    assert o.score(found.table, problem).tolist() == found.table.score.tolist()
    assert found.table.attrs["units"]["power"] == "W"
    failed = found.table[~found.table.status.isin(["steady", "idling"])]
    assert (failed.score == 0.0).all()
    assert isinstance(found.design(), saleg.design.Design)


def test_paths_of_a_design_and_of_an_engine_are_parameters():
    paths = {"bore": (0.060, 0.068), "heat_transfer.a": (60.0, 70.0)}
    table = o.Problem(paths).evaluate([[0.064, 65.0], [0.062, 70.0]])
    assert list(table.status) == ["steady", "steady"]
    engine = saleg.machines.thesis_base()
    problem = o.Problem(
        {"egr": (0.0, 0.3)},
        lambda row: np.clip(row["efficiency"], 0.0, 1.0),
        swept=engine,
        objectives=(o.Objective("power"),),
    )
    table = problem.evaluate([[0.1], [0.2]])
    for row, share in enumerate((0.1, 0.2)):
        alone = saleg.steady_state(engine.replace(egr=share)).performance
        assert table.power[row] == pytest.approx(alone.power, rel=1e-9)
    assert problem.candidate({"egr": 0.2}) == engine.replace(egr=0.2)


def test_one_seed_is_one_result_whoever_works_and_whatever_was_compiled(monkeypatch):
    """Generations of designs are neither searched for side by side nor along lines of a piece."""
    thesis = o.thesis_problem(target_power=4e3)
    problem = replace(thesis, bounds={"bore": thesis.bounds["bore"]})
    method = o.GeneticAlgorithm(size=40, generations=2)
    plain = o.optimize(problem, method, 60, seed=1, workers=1)
    monkeypatch.setattr(lanes, "MANY", 2)
    monkeypatch.setattr(lanes, "kernel_of_lanes", None)  # not to be called
    again = o.optimize(problem, method, 60, seed=1, workers=3)
    pd.testing.assert_frame_equal(again.table, plain.table, check_exact=True)
