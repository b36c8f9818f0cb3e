"""Rows that follow each other along lines come to what each would have come to by itself."""

import numpy as np
import pytest

import saleg
from saleg import Effort, sweep
from saleg.batch.many import steady_row
from saleg.design.many import DesignSolver
from saleg.engine.columns import rows_of_columns
from saleg.steady import many
from saleg.steady.lines import CHECKED_EVERY, lines_among, no_lines
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


def test_where_a_line_leads_elsewhere_its_rows_begin_anew(base, monkeypatch):
    """A row that is checked has come to another orbit: those before it count no more."""
    ratios = np.linspace(0.4, 0.6, 2 * CHECKED_EVERY + 1)
    (rows,) = rows_of_columns(base, {"equivalence_ratio": ratios})
    found = many._Search.found

    def led_astray(self, lines):
        room, good = found(self, lines)
        if lines.any:
            room.image[CHECKED_EVERY] += 1.0
        return room, good

    followed = searched(rows, True, 1e-6, LIMITS)
    monkeypatch.setattr(many._Search, "found", led_astray)
    doubted = searched(rows, True, 1e-6, LIMITS)
    monkeypatch.setattr(many, "lines_among", lambda numbers: no_lines(len(numbers)))
    apart = searched(rows, True, 1e-6, LIMITS)
    anew = doubted.half_cycles == apart.half_cycles
    assert anew[: CHECKED_EVERY + 1].all()
    assert (doubted.strokes[anew] == apart.strokes[anew]).all()
    rest = slice(CHECKED_EVERY + 1, None)
    assert (doubted.strokes[rest] == followed.strokes[rest]).all()
    assert followed.half_cycles.sum() < doubted.half_cycles.sum() < apart.half_cycles.sum()


def test_lines_of_a_grid_in_any_order():
    """Along the input with the most values; their first rows along the other."""
    bore, ratio = np.meshgrid(np.linspace(0.05, 0.07, 6), np.linspace(0.4, 0.9, 12), indexing="ij")
    numbers = np.column_stack(
        [bore.ravel(), ratio.ravel(), 2.0 * bore.ravel(), 0.0 * ratio.ravel()]
    )
    places = np.random.default_rng(0).permutation(len(numbers))
    lines = lines_among(numbers[places])
    at = np.argsort(places)  # of each row of the grid
    for n, row in enumerate(at.tolist()):
        i, j = divmod(n, 12)
        before = lines.before[row].tolist()
        steps = [1, 2, 3, 4]
        if j == 0:
            wanted = [at[12 * (i - k)] if i >= k else -1 for k in steps]
        else:
            wanted = [at[n - k] if j >= k else -1 for k in steps]
        assert before == wanted
        assert lines.checked[row] == (j == 11 or (i == 5 and j == 0))
    done = np.argsort(lines.order)
    assert all(done[b] < done[r] for r in range(72) for b in lines.before[r] if b >= 0)


def test_random_rows_are_on_no_line():
    numbers = np.random.default_rng(0).uniform(size=(64, 5))
    assert not lines_among(numbers).any
    assert not lines_among(np.zeros((8, 3))).any
    assert not lines_among(np.zeros((8, 0))).any
    assert not lines_among(np.linspace(0.0, 1.0, 4)[:, None]).any


def test_rows_far_apart_or_twice_the_same_are_not_extrapolated_across():
    place = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 13.0, 14.0])
    lines = lines_among(place[:, None])
    assert [[n for n in row if n >= 0] for row in lines.before.tolist()] == [
        [],
        [0],
        [1, 0],
        [],
        [3],
        [4],
        [5, 4],
    ]
