"""Rows that follow each other along lines come to what each would have come to by itself."""

import numpy as np
import pytest

import saleg
from saleg import Effort, sweep
from saleg.batch.many import steady_row
from saleg.design.many import DesignSolver
from saleg.engine.columns import rows_of_columns
from saleg.steady import many
from saleg.steady.lines import MOST_WEIGHT, OWN_EVERY, lines_among, no_lines
from saleg.steady.many import Limits, searched
from saleg.steady.solver import MAX_MAPS, MIRROR_MISSED, THOROUGH_STEPS, found_steady_state

SPENT = ("half_cycles", "evaluations")
RTOL = 1e-9
MULTIPLIERS = 1e-5  # differences are that good, whatever the tolerance of the orbit
LIMITS = Limits(MAX_MAPS, THOROUGH_STEPS, MIRROR_MISSED)


def same_figures(table, rows, tolerance):
    """Whether rows have the same verdicts and kinds, and figures within a tolerance."""
    for found, row in zip(table.to_dict("records"), rows, strict=True):
        for name, value in row.items():
            if name in ("status", "stable", "kind"):
                assert found[name] == value, (name, found[name], value)
            elif isinstance(value, float) and name not in (*SPENT, "residual", "mass_error"):
                wanted = MULTIPLIERS if name in ("largest_multiplier", "beat_period") else tolerance
                assert found[name] == pytest.approx(value, wanted, 1e-9, nan_ok=True), name


def test_a_line_has_the_rows_of_its_engines_in_fewer_maps(base):
    points = sweep.grid({"equivalence_ratio": np.linspace(0.46, 0.54, 40)})
    table = sweep.run(points, base, rtol=RTOL)
    engines = [base.replace(**row) for row in points.to_dict("records")]
    rows = [steady_row(found_steady_state(engine, RTOL), True) for engine in engines]
    same_figures(table, rows, 1e-7)
    assert table.half_cycles.sum() < 0.7 * sum(row["half_cycles"] for row in rows)


def test_a_grid_of_designs_has_the_rows_of_its_designs():
    grid = {"bore": np.linspace(0.062, 0.066, 3), "equivalence_ratio": np.linspace(0.5, 0.6, 10)}
    points = sweep.grid(grid)
    table = sweep.run(points, rtol=RTOL, multipliers=False)
    solver = DesignSolver(saleg.design.Design(), RTOL, False, False, Effort.THOROUGH)
    rows = [solver(values) for values in points.to_dict("records")]
    same_figures(table, rows, 1e-6)
    assert table.half_cycles.sum() < 0.9 * sum(row["half_cycles"] for row in rows)


def test_a_line_across_the_end_of_all_orbits_has_the_verdicts_of_its_engines(base):
    """From idling at little fuel to none: nothing is followed to where no engine would be."""
    points = sweep.grid({"equivalence_ratio": np.linspace(0.0, 0.2, 24)})
    table = sweep.run(points, base, multipliers=False, effort=Effort.QUICK)
    engines = [base.replace(**row) for row in points.to_dict("records")]
    alone = [found_steady_state(engine, 1e-6, effort=Effort.QUICK) for engine in engines]
    assert list(table.status) == [str(found.status) for found in alone]
    assert len(set(table.status)) > 1


def test_who_works_does_not_matter(base):
    points = sweep.grid({"equivalence_ratio": np.linspace(0.4, 0.6, 60)})
    one = sweep.run(points, base, workers=1, multipliers=False)
    assert sweep.run(points, base, workers=3, multipliers=False).equals(one)
    shuffled = points.sample(frac=1.0, random_state=1)
    again = sweep.run(shuffled, base, multipliers=False, chunk=60)
    ordered = sweep.run(points, base, multipliers=False, chunk=60)
    again = again.set_index(shuffled.index).sort_index()
    assert again.half_cycles.equals(ordered.half_cycles)
    assert again.power.equals(ordered.power)


def test_where_a_line_leads_to_no_orbit_its_rows_begin_anew(base, monkeypatch):
    """A row between two others was led elsewhere: those beside it count no more."""
    ratios = np.linspace(0.4, 0.6, 2 * OWN_EVERY + 1)
    (rows,) = rows_of_columns(base, {"equivalence_ratio": ratios})
    found = many._Search.found

    def led_astray(self, lines):
        room, good = found(self, lines)
        if lines.any:
            room.image[OWN_EVERY // 2] += 1.0
            good[OWN_EVERY // 2] = False
        return room, good

    followed = searched(rows, True, 1e-6, LIMITS)
    monkeypatch.setattr(many._Search, "found", led_astray)
    doubted = searched(rows, True, 1e-6, LIMITS)
    monkeypatch.setattr(many, "lines_among", lambda numbers: no_lines(len(numbers)))
    apart = searched(rows, True, 1e-6, LIMITS)
    anew = doubted.half_cycles == apart.half_cycles
    assert anew[: OWN_EVERY + 1].all()
    assert (doubted.strokes[anew] == apart.strokes[anew]).all()
    rest = slice(OWN_EVERY + 1, None)
    assert (doubted.strokes[rest] == followed.strokes[rest]).all()
    assert followed.half_cycles.sum() < doubted.half_cycles.sum() < apart.half_cycles.sum()


def test_a_row_between_two_orbits_begins_from_its_own_start(base, monkeypatch):
    """Halfway between a line's orbit and another there is none: what is found there is doubted."""
    ratios = np.linspace(0.4, 0.6, 5)
    (rows,) = rows_of_columns(base, {"equivalence_ratio": ratios})
    prepared = many.prepare_rows

    def hot_at_the_end(rows, begun):
        states, ready = prepared(rows, begun)
        states.chambers["intake_temperature"][-1] += 40.0
        return states, ready

    monkeypatch.setattr(many, "prepare_rows", hot_at_the_end)
    mixed = searched(rows, True, 1e-6, LIMITS)
    monkeypatch.setattr(many, "lines_among", lambda numbers: no_lines(len(numbers)))
    apart = searched(rows, True, 1e-6, LIMITS)
    assert mixed.half_cycles[2] > apart.half_cycles[2]  # what led nowhere counts
    assert (mixed.strokes[2:] == apart.strokes[2:]).all()


def test_lines_of_a_grid_in_any_order():
    """Along the input with the most values, each row in the middle between two found before."""
    bore, ratio = np.meshgrid(np.linspace(0.05, 0.07, 6), np.linspace(0.4, 0.9, 12), indexing="ij")
    numbers = np.column_stack(
        [bore.ravel(), ratio.ravel(), 2.0 * bore.ravel(), 0.0 * ratio.ravel()]
    )
    places = np.random.default_rng(0).permutation(len(numbers))
    lines = lines_among(numbers[places])
    done = np.argsort(lines.order)
    for row, place in enumerate(places.tolist()):
        i, j = divmod(place, 12)
        before = lines.before[row][lines.before[row] >= 0]
        if j in (0, 11):
            assert len(before) == 0
            assert lines.stretch[row] == -1
            continue
        beside = places[before]
        assert (beside // 12 == i).all()
        one, other = sorted(beside[:2] % 12)
        assert one < j < other
        assert abs((j - one) - (other - j)) <= 1
        assert lines.ahead[row, : len(before)] == pytest.approx((j - beside % 12) / 11)
        assert (done[before] < done[row]).all()


def test_random_rows_are_on_no_line():
    numbers = np.random.default_rng(0).uniform(size=(64, 5))
    assert not lines_among(numbers).any
    assert not lines_among(np.zeros((8, 3))).any
    assert not lines_among(np.zeros((8, 0))).any
    assert not lines_among(np.linspace(0.0, 1.0, 4)[:, None]).any


def test_long_lines_have_rows_of_their_own_starts():
    lines = lines_among(np.linspace(0.0, 1.0, 3 * OWN_EVERY + 5)[:, None])
    own = np.flatnonzero(lines.before[:, 0] < 0)
    assert own.tolist() == [0, OWN_EVERY, 2 * OWN_EVERY, 3 * OWN_EVERY, 3 * OWN_EVERY + 4]
    assert lines.around(np.array([1])).nonzero()[0].tolist() == list(range(1, OWN_EVERY))


def test_rows_twice_the_same_or_far_apart_magnify_no_errors():
    """What stands there twice begins by itself; weights of an interpolation stay small."""
    place = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 13.0, 14.0])
    lines = lines_among(place[:, None])
    assert (lines.before[3] == -1).all()
    assert 3 not in lines.before
    for row in (1, 2, 4, 5):
        nodes = place[lines.before[row][lines.before[row] >= 0]]
        assert nodes[:2].min() < place[row] < nodes[:2].max()
        weights = [
            np.prod([(place[row] - x) / (nodes[i] - x) for x in np.delete(nodes, i)])
            for i in range(len(nodes))
        ]
        assert np.abs(weights).sum() <= MOST_WEIGHT
