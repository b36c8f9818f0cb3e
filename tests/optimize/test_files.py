"""Optimisation files: what they say, and what is refused by name."""

import math

import pytest

from saleg.design import Design
from saleg.optimize import (
    CMAES,
    GeneticAlgorithm,
    InvalidProblem,
    Limit,
    Objective,
    OptimisationError,
    thesis_problem,
)
from saleg.optimize.files import SecondStage, read


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "wanted.toml"
        path.write_text(text)
        return path

    return write


def test_an_empty_file_is_the_problem_of_the_text_without_a_target(written):
    found = read(written(""))
    assert found.problem == thesis_problem(None)
    assert found.method is None
    assert (found.evaluations, found.seed, found.improve) == (2000, 0, None)


def test_what_a_file_says_is_what_python_says(written):
    found = read(
        written(
            """
            [optimize]
            target_power = 4000
            compression_ratio = [5.0, 25.0]
            method = "cma"
            evaluations = 1500
            seed = 7
            [bounds]
            intake_temperature = [300.0, 500.0]
            [settings]
            size = 48
            [improve]
            evaluations = 500
            """
        )
    )
    bounds = {"intake_temperature": (300.0, 500.0)}
    assert found.problem == thesis_problem(4e3, (5.0, 25.0), bounds)
    assert found.method == CMAES(size=48)
    assert (found.evaluations, found.seed) == (1500, 7)
    assert found.improve == SecondStage("efficiency", 500)


def test_what_is_fixed_is_no_parameter(written):
    found = read(written("[fixed]\negr = 0.1\n"))
    assert "egr" not in found.problem.bounds
    assert len(found.problem.bounds) == 7
    assert found.problem.swept == Design().replace({"egr": 0.1})


def test_figures_may_be_objectives_and_have_limits(written):
    text = """
        [optimize]
        maximise = ["efficiency", "power_density"]
        minimise = "peak_pressure"
        [limits]
        power = [3500.0, inf]
        """
    problem = read(written(text)).problem
    assert problem.objectives == (
        Objective("efficiency"),
        Objective("power_density"),
        Objective("peak_pressure", maximise=False),
    )
    assert problem.constraints == (Limit("power", 3500.0, math.inf),)


def test_the_script_brings_its_own_genetic_algorithm(written):
    found = read(written('[optimize]\npreset = "thesis_script"\nmethod = "ga"\n'))
    assert isinstance(found.method, GeneticAlgorithm)
    assert (found.method.size, found.method.mutation) == (600, 0.2)
    assert found.problem.bounds["intake_temperature"] == (250.0, 1000.0)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[optimise]\n", "optimise: unknown key; did you mean 'optimize'"),
        ("[optimize]\nseeds = 1\n", "optimize.seeds: unknown key; did you mean 'seed'"),
        (
            '[optimize]\nmethod = "cmaes"\n',
            "optimize.method = 'cmaes': unknown; did you mean 'cma'",
        ),
        ("[optimize]\nevaluations = 0\n", "optimize.evaluations = 0: must be a whole number >= 1"),
        ("[optimize]\nevaluations = true\n", "optimize.evaluations = True: must be a whole"),
        ("[optimize]\nmaximise = [1]\n", "optimize.maximise = .*must be the names of figures"),
        ("[bounds]\nbore = 0.1\n", r"bounds.bore = 0.1: must be \[lowest, highest\]"),
        ("[bounds]\nheat_transfer.a = [50.0, 60.0]\n", "a dotted name must be quoted"),
        ("[bounds]\negr = [0.0, 0.3]\n[fixed]\negr = 0.1\n", "stands in .fixed. and in .bounds."),
        ("[settings]\nsize = 3\n", "without optimize.method"),
        ('[optimize]\nmethod = "ga"\n[settings]\nsizes = 3\n', "settings.sizes: unknown key"),
        ("[improve]\nevaluations = 1.5\n", "improve.evaluations = 1.5"),
        ("optimize = 3\n", "optimize = 3: must be a table"),
        ('[optimize]\nmachine = "thesis"\n', "no machine 'thesis'; did you mean"),
    ],
)
def test_what_makes_no_sense_is_refused_with_file_and_key(written, text, says):
    with pytest.raises(OptimisationError, match=rf"wanted.toml: .*{says}"):
        read(written(text))


def test_a_problem_that_makes_no_sense_names_all_that_is_wrong(written):
    text = "[bounds]\nbore = [0.1, 0.05]\n[limits]\npowr = [1.0, 2.0]\n"
    with pytest.raises(InvalidProblem, match=r"bore(.|\n)*powr"):
        read(written(text))
