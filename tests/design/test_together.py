"""Designs solved together are those solved one by one, to the last bit."""

from dataclasses import dataclass, replace

import pandas as pd
import pytest

import saleg
from saleg import Effort, sweep
from saleg.design.designs import Design
from saleg.design.many import DesignSolver
from saleg.design.masses import MassModel
from saleg.design.together import solved_together

BOX = {
    "bore": (0.056, 0.070),
    "half_stroke": (0.09, 0.11),
    "equivalence_ratio": (0.4, 0.8),
    "heat_transfer.a": (50.0, 80.0),
    "masses.rod.crankcase": (0.0, 1.0),
}


def points():
    """Designs of all kinds of rows."""
    table = sweep.latin_hypercube(BOX, 12, seed=2).assign(spring_stiffness=30e3)
    table.loc[1, "bore"] = -1.0
    table.loc[2, "masses.rod.crankcase"] = -1.0
    table.loc[3, "spring_stiffness"] = 0.0  # no groups
    table.loc[4, "equivalence_ratio"] = 0.0  # no power, and no orbit
    table.loc[5, "heat_transfer.a"] = 0.0  # at the end of its range
    return table


def alone(table, effort, design):
    """Rows of designs solved one by one."""
    solver = DesignSolver(design, 1e-6, False, False, effort)
    for values in table.to_dict("records"):
        try:
            yield solver(values)
        except saleg.SalegError as error:
            yield {"status": "invalid", "message": str(error)}


def same(table, rows):
    """Whether rows of a table are these."""
    for found, row in zip(table.to_dict("records"), rows, strict=True):
        for name, value in row.items():
            assert found[name] == value or (found[name] != found[name] and value != value), name


def test_rows_are_those_of_designs_solved_alone():
    table = points()
    same(
        saleg.design.evaluate_many(table, effort=Effort.QUICK),
        alone(table, Effort.QUICK, Design()),
    )
    found = solved_together(Design(), table.to_dict("records"), 1e-6, Effort.QUICK, len(table))
    assert sum(len(places) for places, _ in found) >= 8


def test_thorough_rows_are_those_of_designs_solved_alone():
    table = points().drop(index=4)
    same(saleg.design.evaluate_many(table), alone(table, Effort.THOROUGH, Design()))


def test_the_size_of_pieces_does_not_matter():
    table = points()
    whole = saleg.design.evaluate_many(table, effort=Effort.QUICK)
    apart = saleg.design.evaluate_many(table, effort=Effort.QUICK, chunk=5, workers=1)
    pd.testing.assert_frame_equal(whole, apart, check_exact=True)


@dataclass(frozen=True)
class HeavyPistons:
    """A model of the user's, which may do what it likes with single numbers."""

    def mass(self, parameters, operation):
        return max(float(parameters.bore) * 5.0, 0.3)


def test_designs_with_models_of_the_users_are_solved_one_by_one():
    design = replace(Design(), masses=MassModel(pistons=HeavyPistons()))
    table = pd.DataFrame({"bore": [0.062, 0.064]})
    assert solved_together(design, table.to_dict("records"), 1e-6, Effort.QUICK, len(table)) == []
    found = saleg.design.evaluate_many(table, design, effort=Effort.QUICK)
    same(found, alone(table, Effort.QUICK, design))
    assert found.pistons_mass.tolist() == pytest.approx([0.31, 0.32])
