"""Scatter of charges: draws, replay, reference, proportion, impulse response of the return map."""

import numpy as np
import pytest

import saleg
from saleg import laws, reference
from saleg.control import Plant, generator
from saleg.laws.scatter import normal

SPREAD = laws.CyclicVariability(seed=3, fuel=0.05, delay=0.02, duration=0.05)


@pytest.fixture(scope="module")
def engine(transient):
    return transient.replace(scatter=SPREAD)


def test_draws_are_normal_and_independent():
    draws = np.array(
        [
            [
                normal(1.0, float(charge), side, purpose)
                for side in (0.0, 1.0)
                for purpose in (1, 2, 3)
            ]
            for charge in range(10_000)
        ]
    )
    # Limited to three: the variance of a normal number loses 0.5 % at most.
    assert np.abs(draws).max() == 3.0
    assert np.abs(draws.mean(axis=0)).max() < 0.04
    assert np.abs(draws.std(axis=0) - 1.0).max() < 0.03
    assert np.abs(np.corrcoef(draws.T) - np.eye(6)).max() < 0.04
    following = np.corrcoef(draws[:-1].T, draws[1:].T)[:6, 6:]
    assert np.abs(following).max() < 0.04


def test_reference_draws_the_same(engine):
    run, again = (
        saleg.simulate(engine, 0.5, rtol=1e-10),
        reference.simulate(engine, 0.5, jitted=True),
    )
    np.testing.assert_allclose(
        run.strokes["x_end"][: len(again.strokes)], again.strokes["x_end"], atol=1e-9
    )


def test_a_run_is_the_same_again_and_another_seed_is_another(engine):
    one, again = saleg.simulate(engine, 0.3), saleg.simulate(engine, 0.3)
    other = saleg.simulate(engine.replace(**{"scatter.seed": 4}), 0.3)
    assert one.strokes["x_end"].tobytes() == again.strokes["x_end"].tobytes()
    assert abs(one.strokes["x_end"][-1] - other.strokes["x_end"][-1]) > 1e-5
    # The last cycle is run again for its history, with the same draws.
    assert one.orbit.strokes["x_end"][-1] == one.last_cycle_strokes["x_end"][-1]


def test_without_scatter_it_is_the_plain_engine(transient):
    plain = saleg.simulate(transient, 0.3)
    none = saleg.simulate(transient.replace(scatter=laws.CyclicVariability()), 0.3)
    np.testing.assert_array_equal(plain.strokes["x_end"], none.strokes["x_end"])


def test_small_scatter_is_what_the_impulse_response_sums_to(transient):
    """Linear theory: the variance is that of the fuel times the sum of the squared response."""
    by, spread, strokes = 0.01, 0.01, 40
    answers = {}
    for side in (0, 1):
        for change in (0.0, by):
            plant = Plant(transient, 3.0, rtol=1e-10)
            rated, found = plant.signals.rated_equivalence_ratio, []
            for stroke in range(100 + side + strokes):
                commands = generator(plant.signals)
                lean = change if stroke == 60 + side else 0.0
                plant.command(commands._replace(equivalence_ratio=rated * (1.0 + lean)))
                plant.advance()
                found.append(plant.signals.x)
            answers[side, change] = np.array(found)
    total = 0.0
    for side in (0, 1):
        response = (answers[side, by] - answers[side, 0.0])[60:] / by
        total += (response[::2] ** 2).sum()
    table = saleg.studies.variability(
        transient.replace(scatter=laws.CyclicVariability(fuel=spread)), 20, 8.0
    )
    predicted = spread * np.sqrt(total)
    measured = np.sqrt((table["dead_centre_left"] ** 2).mean())
    assert measured == pytest.approx(predicted, rel=0.06)


def test_scatter_is_in_proportion_to_its_cause(transient):
    small, great = (
        saleg.studies.variability(
            transient.replace(scatter=laws.CyclicVariability(fuel=spread)), 4, 4.0
        )
        for spread in (0.005, 0.01)
    )
    for name in ("cov_imep", "cov_work", "dead_centre_left", "compression_ratio_scatter"):
        np.testing.assert_allclose(great[name], 2.0 * small[name], rtol=0.02)
    assert list(great["seed"]) == [0.0, 1.0, 2.0, 3.0]


def test_workers_change_nothing(engine):
    one, two = (saleg.studies.variability(engine, 3, 1.5, workers=n) for n in (1, 2))
    assert one.equals(two)


def test_there_is_no_steady_state_but_that_of_the_mean_engine(engine):
    found = saleg.steady_state(engine)
    assert "charges scatter; the mean engine's state is that with NoScatter()" in found.message
    assert saleg.steady_state(engine.replace(scatter=laws.NoScatter())).found


def test_engines_that_die_are_told(transient):
    dying = transient.replace(
        scatter=laws.CyclicVariability(fuel=0.1), **{"alternator.load_constant": 200.0}
    )
    table = saleg.studies.variability(dying, 2, 3.0, settling=0.0, stall_stroke=0.3)
    assert table["ended_early"].all(), table["message"]


def test_files_and_wrong_numbers(engine, transient, tmp_path):
    path = tmp_path / "engine.toml"
    path.write_text(engine.to_toml(), encoding="utf-8")
    assert saleg.Engine.from_toml(path) == engine
    assert "catter" not in transient.to_toml()
    wrong = laws.CyclicVariability(seed=0.5, fuel=2.0, delay=-1.0)
    with pytest.raises(saleg.InvalidEngine) as caught:
        saleg.simulate(transient.replace(scatter=wrong), 0.1)
    paths = [problem.path for problem in caught.value.problems]
    assert paths == ["scatter.seed", "scatter.fuel", "scatter.delay"]
    with pytest.raises(saleg.errors.WrongArguments, match="CyclicVariability in its slot"):
        saleg.studies.variability(transient)
    with pytest.raises(saleg.errors.WrongArguments, match="2 wrong fields"):
        saleg.studies.variability(engine, 0, -1.0)
