"""Results side by side, by arithmetic of one's own."""

import math

import numpy as np
import pytest

import saleg
from saleg.errors import SalegError


@pytest.fixture(scope="module")
def pair(base):
    changed = base.replace(equivalence_ratio=0.5, **{"intake.temperature": 340.0})
    return saleg.steady_state(base), saleg.steady_state(changed)


def test_a_comparison_has_the_figures_and_their_differences(pair):
    one, other = pair
    table = saleg.compare({"base": one, "lean": other})
    assert list(table.columns) == ["base", "lean", "lean - base", "lean / base - 1"]
    for name, value in one.performance.to_dict().items():
        if math.isnan(value):
            continue
        changed = getattr(other.performance, name)
        expected = [value, changed, changed - value, (changed - value) / value]
        np.testing.assert_allclose(table.loc[name], expected, rtol=1e-9)


def test_inputs_that_differ_come_first_and_no_others(pair):
    table = saleg.compare(pair)
    assert list(table.index[:2]) == ["equivalence_ratio", "intake.temperature"]
    assert table.index[2] == "stroke"
    np.testing.assert_allclose(table.iloc[1, :3], [325.05, 340.0, 14.95])
    units = table.attrs["units"]
    assert list(units) == list(table.index)
    assert (units["intake.temperature"], units["peak_pressure"]) == ("K", "Pa")


def test_results_without_names_have_those_of_their_engines(pair, base):
    lean = pair[1].engine.replace(name="lean")
    third = saleg.simulate(lean, 0.3)
    names = list(saleg.compare([*pair, third]).columns)[:3]
    assert names == ["thesis-base", "thesis-base #2", "lean"]
    stalled = saleg.simulate(base.replace(**{"alternator.load_constant": 300.0}), 2.0)
    assert "thesis-base (stalled)" in saleg.compare([pair[0], stalled]).columns


def test_engines_of_other_kinds_have_their_own_paths(pair, base):
    lopsided = base.replace(
        **{"right.bore": 0.063}, friction=saleg.laws.BlairViscousFriction(factor=13.7)
    )
    table = saleg.compare([pair[0], saleg.simulate(lopsided, 0.1)])
    inputs = table.iloc[: list(table.index).index("stroke"), :2]
    assert set(inputs.index) == {"right.bore", "friction.coefficient", "friction.factor"}
    assert math.isnan(inputs.iloc[:, 0]["friction.factor"])
    assert inputs.loc["right.bore"].tolist() == [0.064, 0.063]


def test_designs_are_compared_by_their_components_too():
    designs = [saleg.design.evaluate(bore=bore) for bore in (0.060, 0.064)]
    table = saleg.compare(designs)
    masses = [design.masses.pistons for design in designs]
    np.testing.assert_allclose(table.loc["pistons_mass"].iloc[:2], masses)
    assert table.attrs["units"]["pistons_mass"] == "kg"


@pytest.mark.parametrize(
    "results",
    [
        lambda one: [one],
        lambda one: [],
        lambda one: {},
        lambda one: one,
        lambda one: [one, one.engine],
        lambda one: {"a": one, "b": None},
    ],
)
def test_what_cannot_be_compared_is_refused(pair, results):
    with pytest.raises(SalegError, match="two or more runs or steady states in a list or mapping"):
        saleg.compare(results(pair[0]))
