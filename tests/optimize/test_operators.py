"""The genetic algorithm does what the dissertation says: statistics of its operators."""

import numpy as np
import pytest
from scipy import stats

from saleg.optimize import GeneticAlgorithm
from saleg.optimize.fronts import first_front
from saleg.optimize.methods.base import Start
from saleg.optimize.methods.genetic import crossed_genes, mutated_genes, roulette
from saleg.optimize.problem import Told

GENES, MANY = 8, 40_000


def told(fitness):
    fitness = np.asarray(fitness, dtype=float)
    return Told(None, fitness[:, None], np.zeros(len(fitness)), fitness, fitness)


def begun(given=None, seed=0, **settings):
    given = np.zeros((0, GENES)) if given is None else given
    return GeneticAlgorithm(**settings).begin(Start(GENES, 1, seed, given))


@pytest.fixture
def rng():
    return np.random.default_rng(1)


def test_mutation_changes_six_of_ten_genes_by_a_fifteenth_of_their_range(rng):
    parents = np.full((MANY, GENES), 0.5)
    children = mutated_genes(parents, 0.6, 1.0 / 15.0, rng)
    changed = children != parents
    assert changed.mean() == pytest.approx(0.6, abs=4.0 * np.sqrt(0.24 / changed.size))
    copies = int((~changed.any(axis=1)).sum())
    assert stats.binomtest(copies, MANY, 0.4**GENES).pvalue > 1e-3
    assert changed.sum(axis=1).mean() == pytest.approx(4.8, abs=0.03)
    # Seven and a half deviations from the bounds nothing is clipped.
    steps = (children - parents)[changed]
    assert stats.kstest(steps[:20_000] * 15.0, "norm").pvalue > 1e-3


def test_mutation_piles_up_at_the_bounds(rng):
    """A bore of 25 mm between 10 and 500 mm: 32 % of the changed ones end at 10 mm."""
    at = np.full((MANY, 1), (0.025 - 0.010) / 0.490)
    children = mutated_genes(at, 1.0, 1.0 / 15.0, rng)
    assert (children == 0.0).mean() == pytest.approx(0.32, abs=0.01)
    assert children.min() == 0.0


def test_crossover_splits_uniformly_and_keeps_the_first_gene_of_the_parent(rng):
    parents, mates = np.zeros((MANY, GENES)), np.ones((MANY, GENES))
    children = crossed_genes(parents, mates, rng)
    assert (children[:, 0] == 0.0).all()
    assert (np.diff(children, axis=1) >= 0.0).all()  # one point
    points = (children == 0.0).sum(axis=1)
    counts = np.bincount(points, minlength=GENES + 1)[1:]
    assert stats.chisquare(counts).pvalue > 1e-3  # 1/8 are copies of the parent


def test_roulette_draws_in_proportion_to_fitness(rng):
    fitness = np.array([1.0, 0.5, 0.0, 0.25, 0.25])
    counts = np.bincount(roulette(fitness, MANY, rng), minlength=5)
    assert counts[2] == 0
    expected = MANY * fitness / 2.0
    assert stats.chisquare(np.delete(counts, 2), np.delete(expected, 2)).pvalue > 1e-3


def test_roulette_of_nothing_but_zeros_is_fair(rng):
    counts = np.bincount(roulette(np.zeros(5), MANY, rng), minlength=5)
    assert stats.chisquare(counts).pvalue > 1e-3


def test_roulette_beyond_the_last_cumulative_sum():
    """Sums of tenths fall short of 1; a draw up there is the last with any fitness."""

    class Top:
        def random(self, count):
            return np.full(count, np.nextafter(1.0, 0.0))

    fitness = np.array([0.1] * 10 + [0.0])
    assert np.cumsum(fitness)[-1] < 1.0
    assert roulette(fitness, 3, Top()).tolist() == [9, 9, 9]


def test_children_are_binomial_and_only_the_old_are_parents():
    """Mutation first, then crossover: N (0.25 + 0.25) children in the mean."""
    search = begun(size=400, seed=3, generations=200, stop=np.inf)
    search.tell(told(np.full(len(search.ask()), 0.5)))
    counts = []
    for _ in range(200):
        counts.append(len(search.ask()))
        search.tell(told(np.full(counts[-1], 0.5)))
    assert search.finished
    variance = 2.0 * 400 * 0.25 * 0.75
    assert np.mean(counts) == pytest.approx(200.0, abs=4.0 * np.sqrt(variance / 200))
    assert np.var(counts) == pytest.approx(variance, rel=0.4)


def test_the_elite_is_never_lost_and_never_falls():
    search = begun(size=30, seed=5, generations=50, stop=np.inf)
    rng, best = np.random.default_rng(0), -1.0
    while not search.finished:
        asked = search.ask()
        fitness = rng.random(len(asked)) ** 8
        best = max(best, fitness.max(initial=-1.0))
        mean = search.tell(told(fitness))
        assert search._fitness.max() == best
        assert 0.0 <= mean <= best


def test_mean_is_that_of_parents_and_children_before_selection():
    search = begun(size=10, seed=1, mutation=1.0, crossover=0.0)
    search.tell(told(np.full(len(search.ask()), 0.2)))
    assert len(search.ask()) == 10
    assert search.tell(told(np.full(10, 0.6))) == pytest.approx(0.4)


def test_on_ties_the_older_one_is_the_elite():
    given = np.full((1, GENES), 0.25)
    search = begun(given, size=4, mutation=1.0, crossover=1.0)
    search.tell(told(np.full(len(search.ask()), 0.7)))
    search.tell(told(np.full(len(search.ask()), 0.7)))
    assert (search._genes[0] == 0.25).all()


def test_a_start_is_drawn_from_the_designs_given_with_replacement():
    given = np.random.default_rng(0).random((50, GENES))
    asked = begun(given, size=50).ask()
    assert {tuple(row) for row in asked} < {tuple(row) for row in given}


def test_the_stop_rule():
    search = begun(size=4)
    search.tell(told(np.full(4, 0.9991)))
    assert not search.finished  # looked at after a generation only
    search.tell(told(np.full(len(search.ask()), 0.5)))
    assert search.finished


def test_front_is_that_of_brute_force():
    rng = np.random.default_rng(2)
    objectives, violation = rng.random((200, 3)).round(1), (rng.random(200) < 0.3) * 1.0
    objectives[::17] = np.nan

    def dominated(row):
        others = objectives[(violation == 0) & ~np.isnan(objectives).any(axis=1)]
        at = objectives[row]
        return ((others >= at).all(axis=1) & (others > at).any(axis=1)).any()

    whole = [r for r in range(200) if violation[r] == 0 and not np.isnan(objectives[r]).any()]
    expected = {tuple(objectives[row]) for row in whole if not dominated(row)}
    front = first_front(objectives, violation)
    assert {tuple(objectives[row]) for row in front} == expected
    assert len(front) == len(expected)
