"""Wrong arguments of functions: one error, which names all of them, before anything is done."""

import inspect
import pickle

import numpy as np
import pandas as pd
import pytest

import saleg
from saleg import SalegError, control, optimize, studies, sweep
from saleg.checks import (
    FRAME,
    NUMBER,
    ONE_OR_MORE,
    POSITIVE,
    SERIES,
    checked,
    each,
    number,
    numbers,
    whole,
)
from saleg.design import formulas
from saleg.errors import WrongArguments
from saleg.studies import sensitivity

#: Parameters that are checked where they are used, with an error of their own.
ELSEWHERE = {"executor", "order", "printed", "strokes_per_cycle"}
#: Functions with errors of their own for all they are handed.
OWN = {control.simulate, control.simulate_many, control.rapid_start, studies.delayed}
WALKED = [
    *(getattr(control, name) for name in control.__all__),
    *(getattr(studies, name) for name in studies.__all__),
    *(getattr(sensitivity, name) for name in sensitivity.__all__),
    *vars(formulas).values(),
    sweep.indices,
]
DOORS = [
    item
    for item in WALKED
    if inspect.isfunction(item) and item not in OWN and inspect.signature(item).parameters
    if item.__module__ != "saleg.checks"
]


@pytest.mark.parametrize("function", DOORS, ids=lambda function: function.__name__)
@pytest.mark.parametrize("value", [object(), b"x", 10**5000], ids=["object", "bytes", "digits"])
def test_all_wrong_arguments_are_named_at_once(function, value):
    """Before, a TypeError or AttributeError of whatever line stumbled over the first."""
    parameters = inspect.signature(function).parameters.values()
    names = [item.name for item in parameters if item.kind is not item.VAR_KEYWORD]
    names = [name for name in names if name not in ELSEWHERE]
    with pytest.raises(WrongArguments) as caught:
        function(**dict.fromkeys(names, value))
    assert {problem.path for problem in caught.value.problems} == set(names)
    assert f"arguments of {function.__name__}()" in str(caught.value)


CASES = [
    (NUMBER, [1, np.float32(2), -0.5], [None, "1", True, 1j, np.nan, np.inf, 10**400]),
    (POSITIVE, [1e-9], [0.0, -1]),
    (number(0.0, 1.0, open_high=True), [0, 0.5], [1.0, -1e-9]),
    (whole(1), [1, np.int64(3)], [0, 1.5, True, 10**400]),
    (SERIES, [[1, 2.5], (0.0,), np.ones(3), iter([1.0]), []], [5, "12", {1.0: 2}, [[1.0]], ["a"]]),
    (each(whole(0), "counts"), [[0, 2]], [[0.5], None]),
    (numbers(0.0), [1.0, [0.0, 2.0], np.ones((2, 2))], [-1.0, [1.0, -2.0], "a", [True], [np.nan]]),
    (ONE_OR_MORE, [3, [1.0, 2]], ["x", np.ones((2, 2)), pd.DataFrame({5: [1.0]})]),
    (FRAME, [pd.DataFrame()], [None, {"a": [1.0]}, np.ones(3)]),
]


@pytest.mark.parametrize(("check", "good", "bad"), CASES)
def test_a_check_takes_what_is_right_and_nothing_else(check, good, bad):
    @checked(value=check)
    def taken(value):
        return value

    for value in good:
        assert taken(value) is not None
    for value in bad:
        with pytest.raises(WrongArguments, match="value = "):
            taken(value)
        with pytest.raises(WrongArguments, match="or None"):
            checked(value=check.optional)(taken.__wrapped__)(object())


def test_a_checked_function_keeps_its_face():
    signature = inspect.signature(control.recovery_time)
    assert list(signature.parameters) == ["run", "at"]
    assert control.recovery_time.__doc__.startswith("Time from a disturbance")
    with pytest.raises(TypeError, match="unexpected keyword argument 'to'"):
        formulas.mean_speed(0.1, 50.0, to=1)
    with pytest.raises(TypeError, match="3 were given"):
        formulas.mean_speed(0.1, 50.0, 1)
    with pytest.raises(WrongArguments) as caught:
        control.recovery_time(None, at="x")
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_the_class_is_named_whose_arguments_are_wrong():
    """Before, `__init__()` was."""
    with pytest.raises(WrongArguments, match=r"in the arguments of DeadCentreControl\(\)"):
        control.DeadCentreControl(3)


def test_commands_there_are_not_are_named_beside_those_there_are():
    signals = control.Plant(saleg.machines.thesis_base(), 0.1).signals
    with pytest.raises(
        SalegError, match=r"(?s)no command 'fuel'.*no command 'load'.*load_weight, "
    ):
        control.generator(signals, fuel=1, load=2)


@pytest.fixture(scope="module")
def found():
    method = optimize.GeneticAlgorithm(size=4, generations=1)
    return optimize.optimize(optimize.thesis_problem(4e3), method, evaluations=4)


CALLS = [
    (lambda found: optimize.improve(found, evaluations=10**400), "evaluations"),
    (lambda found: optimize.optimize(found.problem, evaluations=10**12), "evaluations"),
    (lambda f: optimize.optimize(f.problem, optimize.CMAES(size=10**400)), "size"),
    (lambda found: optimize.winners(found, 5), "problem = 5"),
    (lambda found: optimize.winners(found, count=0), "count = 0"),
    (lambda found: optimize.Problem(5), "bounds = 5"),
    (lambda found: found.problem.evaluate(None), "X"),
    (lambda found: optimize.Within(5, 0.0, 1.0), "term = 5"),
    (lambda found: optimize.WeightedScore(5), "terms = 5"),
    (lambda found: saleg.design.solve(saleg.design.Design(), near=5), "near = 5"),
    (lambda found: saleg.design.Design().get(np.ones(2)), "a path is text"),
    (lambda found: sweep.run(sweep.grid({"bore": [0.06]}), report=5), "report = 5"),
    (lambda found: saleg.simulate(saleg.machines.thesis_base(), 10**5000), "duration = <int>"),
    (
        lambda found: control.motored(saleg.machines.thesis_base(), [1.0, 2.0], [1.0, 2.0, 3.0]),
        "2 frequencies and 3 amplitudes",
    ),
    (lambda found: saleg.plotting.forces(None), "run = None"),
    (lambda found: saleg.export.from_tables(None), "description = None"),
    (lambda found: saleg.plotting.new_figure(width="x"), "width = 'x'"),
    (lambda found: optimize.thesis_problem(bounds="x"), "bounds = 'x'"),
    (lambda found: saleg.export.save(None, "run.npz"), "run = None"),
    (lambda found: saleg.fundamental.march(None, -0.5), "system = None"),
    (lambda found: saleg.fundamental.compression_ratio("x", None), "2 wrong fields"),
    (lambda found: saleg.laws.LinearLoad.from_circuit(None, 0.0), "2 wrong fields"),
]


@pytest.mark.parametrize(("call", "text"), CALLS, ids=lambda item: item if item else "")
def test_one_clear_error(found, call, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SalegError) as caught:
        call(found)
    assert text in str(caught.value)
    assert not list(tmp_path.iterdir())
