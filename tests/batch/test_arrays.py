"""Steady states solved together are those of engines solved one by one, to the last bit."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import saleg
from helpers import single_piston
from saleg import Effort, laws, sweep
from saleg.batch.many import steady_row
from saleg.columns import Column, Differs, by_branch, column, exp, log
from saleg.engine.columns import is_sound, is_usual, rows_by_make, rows_of_columns
from saleg.errors import InvalidEngine
from saleg.simulation.initial_rows import prepare_rows
from saleg.simulation.initial_state import prepare
from saleg.steady.many import steady_rows, verdicts
from saleg.steady.solver import found_steady_state


def kinds(base):
    """Engines of the laws of the base case, of all kinds of rows."""
    yield base
    yield base.replace(name="another")
    for bore in (0.060, 0.066):
        yield base.replace(bore=bore)  # mirrored
        yield base.replace(**{"bore": bore, "left.equivalence_ratio": 0.5})  # begins on the right
        yield base.replace(**{"bore": bore, "left.equivalence_ratio": 0.7})
        yield base.replace(**{"bore": bore, "alternator.efficiency": 0.0})  # idles
        yield single_piston(base, bore=bore)
    yield base.replace(egr=0.0)  # at the end of its range
    yield base.replace(**{"heat_release.a": 4.0})
    yield base.replace(moving_mass=2390.0)  # given in grams: unusual, and does not settle
    yield base.replace(equivalence_ratio=0.0)  # unfuelled
    yield base.replace(bore=-1.0)
    yield base.replace(bore=True)
    yield base.replace(head_gap=1.0)
    yield base.replace(intake=3)
    yield base.replace(egr=1.0)
    yield None


@pytest.fixture(scope="module")
def mixed():
    engines = list(kinds(saleg.machines.thesis_base()))
    return [engines[n] for n in np.random.default_rng(1).permutation(len(engines))]


def alone(engine, effort, multipliers=False):
    """Row of an engine solved by itself."""
    try:
        return steady_row(found_steady_state(engine, 1e-6, effort=effort), multipliers)
    except InvalidEngine as error:
        return {"status": "invalid", "message": str(error)}


@pytest.mark.parametrize("effort", list(Effort))
def test_rows_are_those_of_engines_solved_alone(mixed, effort):
    table = saleg.steady_states(mixed, effort=effort)
    for engine, row in zip(mixed, table.to_dict("records"), strict=True):
        for name, value in alone(engine, effort).items():
            assert row[name] == value or (row[name] != row[name] and value != value), name


def test_multipliers_are_those_of_engines_solved_alone(mixed):
    table = saleg.steady_states(mixed, effort=Effort.QUICK, multipliers=True)
    for engine, row in zip(mixed, table.to_dict("records"), strict=True):
        for name, value in alone(engine, Effort.QUICK, multipliers=True).items():
            assert row[name] == value or (row[name] != row[name] and value != value), name
    assert table.stable.sum() >= 10


def test_unusual_and_remarkable_rows_say_so(base):
    harsh = {"intake.pressure": 6e5, "equivalence_ratio": 0.9}
    hot = {"wall_temperature": 2500.0, "equivalence_ratio": 0.1}
    unusual = {"intake.temperature": 190.0, "wall_temperature": 900.0}
    engines = [base, *(base.replace(**changes) for changes in (harsh, hot, unusual))]
    table = saleg.steady_states(engines)
    said = ("peak pressure", "heat from the walls", "unusual: intake.temperature")
    assert [[text in message for text in said] for message in table.message] == [
        [False, False, False],
        [True, False, False],
        [False, True, False],
        [False, False, True],
    ]
    assert list(table.message) == [alone(e, Effort.THOROUGH)["message"] for e in engines]


def test_the_order_and_the_size_of_pieces_do_not_matter(mixed):
    table = saleg.steady_states(mixed, effort=Effort.QUICK)
    for chunk in (1, 5):
        again = saleg.steady_states(mixed[::-1], effort=Effort.QUICK, chunk=chunk, workers=1)
        assert again[::-1].reset_index(drop=True).equals(table)


def test_most_rows_are_solved_together(mixed):
    lots = [lot for rows in rows_by_make(mixed) for lot in steady_rows(rows, 1e-6, Effort.THOROUGH)]
    statuses = [status for lot in lots for status in verdicts(lot, 1e-6)[0]]
    assert statuses.count("steady") >= 10
    assert statuses.count("idling") == 2


@dataclass(frozen=True)
class OwnFriction(laws.ViscousFriction):
    """A law that only takes single numbers where it starts."""

    def at_dead_centre(self, memory, stroke):
        return float(self.coefficient)


def test_starts_are_prepared_as_for_one_engine(base):
    """In columns, and one by one where a law is the user's; whatever branch each row takes."""
    engines = [
        base.replace(**{"moving_mass": 2.0 + 0.1 * n, "equivalence_ratio": 0.1 * (n % 3)})
        for n in range(24)
    ]
    own = [base.replace(friction=OwnFriction(coefficient=1.0 + n)) for n in range(8)]
    bounce = [single_piston(base, mass=2.0 + 0.1 * n) for n in range(8)]
    for rows in rows_by_make([*engines, *own, *bounce]):
        states, ready = prepare_rows(rows, lambda engine: engine)
        assert ready.all()
        for n in range(rows.count):
            alone, row = prepare(rows.row(n)), states.row(n)
            kept = [name for name in alone.engine.dtype.names if name != "x_breakpoint"]
            assert (alone.engine[kept] == row.engine[kept]).all() or np.isnan(
                alone.engine["x_dead_centre"]
            )
            assert alone.chambers.tobytes() == row.chambers.tobytes()
            assert alone.y.tobytes() == row.y.tobytes()


def test_columns_of_paths_are_engines(base):
    """Rows where both chambers come out alike are those of a mirrored engine."""
    bores = np.array([0.060, base.get("bore"), 0.070])
    mirrored, other = rows_of_columns(base, {"left.bore": bores})
    assert mirrored.places.tolist() == [1]
    assert other.places.tolist() == [0, 2]
    assert mirrored.row(0) == base
    assert other.row(1) == base.replace(**{"left.bore": 0.070})


def test_sweeps_of_an_engine_have_the_rows_of_its_steady_states(base):
    points = sweep.grid({"left.bore": [-1.0, 0.060, base.get("bore")], "egr": [0.0, 0.2]})
    table = sweep.run(points, base, multipliers=False)
    alone = saleg.steady_states(base.replace(**row) for row in points.to_dict("records"))
    assert table[list(alone)].equals(alone)


def test_ranges_of_columns_are_those_of_numbers(base):
    values = np.array([-1.0, 0.0, 0.3, 0.999, 1.0, np.nan, np.inf])
    (rows,) = rows_of_columns(base, {"egr": values})
    valid = [not base.replace(egr=value).problems() for value in values]
    assert is_sound(rows).tolist() == valid
    (rows,) = rows_of_columns(base, {"bore": np.array([0.06, 60.0, 1e-5])})
    assert is_usual(rows).tolist() == [True, False, False]


def test_columns_calculate_as_numbers_do():
    x = np.random.default_rng(0).uniform(0.1, 9.0, 1000)
    rows = column(x)
    assert (log(rows**1.35) - exp(-rows)).tolist() == [
        log(a**1.35) - exp(-a) for a in map(float, x)
    ]
    assert column([2.0, 2.0]) == 2.0
    assert type(column([0.0, -0.0])) is Column
    with pytest.raises(Differs):
        max(rows, 5.0)


def test_rows_that_differ_about_a_branch_go_their_own_ways():
    x = np.array([1.0, -4.0, 0.0, 9.0, -1.0])

    def inverse_or_zero(lot):
        value = column(x[lot])
        return 1.0 / value if value > 0.0 else 0.0 * value

    found = np.empty(5)
    for lot, values in by_branch(inverse_or_zero, np.arange(5)):
        found[lot] = values
    assert found.tolist() == [1.0, 0.0, 0.0, 1.0 / 9.0, 0.0]
    assert by_branch(lambda lot: 1.0 / column(x[lot]), np.arange(5))[0][1] is None


def test_a_part_that_minds_its_numbers_is_left_alone(base):
    @dataclass(frozen=True)
    class Minds(laws.ViscousFriction):
        def __post_init__(self):
            super().__post_init__()
            assert isinstance(self.coefficient, float)

    engine = base.replace(friction=Minds(coefficient=10.0))
    assert rows_by_make([engine]) == []
    assert rows_of_columns(engine, {"friction.coefficient": np.array([1.0, 2.0])}) == []
    assert rows_of_columns(replace(base, name="x"), {"bore": np.array([0.06])})
