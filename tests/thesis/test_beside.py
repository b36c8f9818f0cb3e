"""A run beside the tables of its engine."""

import pytest

import saleg
from saleg.thesis import beside


def test_a_run_stands_beside_its_tables(base_run):
    shown = beside.comparison(base_run).splitlines()
    assert "Table 1 (5 us)" in shown[0]
    assert "finest (T. 2, 5)" in shown[0]
    stroke = next(line for line in shown if "stroke" in line).split()
    assert "181" in stroke  # Table 1
    assert "180.7" in stroke  # Table 2


def test_a_changed_engine_stands_alone(base):
    changed = saleg.simulate(base.replace(bore=0.06), 0.2)
    assert beside.comparison(changed) is None
    assert not beside.is_published(base.replace(bore=0.06))


def test_columns_hold_the_printed_numbers():
    """As they stand in Tables 1, 2, 5 and 13."""
    assert beside.TABLE_1.figures["mean_alternator_force"] == pytest.approx(1270.0)
    assert beside.TABLE_1.figures["charge_mass"] == pytest.approx(0.484e-3)
    assert beside.FINEST.figures["power"] == pytest.approx(21.99e3)
    assert beside.FINEST.figures["frequency"] == pytest.approx(47.02)
    assert beside.TABLE_13.figures["fuel_energy_per_cycle"] == pytest.approx(222.0)
    assert len(beside.TABLE_13.figures) == 11
