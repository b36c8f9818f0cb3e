"""Figures of a performance beside what the dissertation prints."""

import pytest

from saleg.thesis import beside


def within(actual, expected, share):
    assert actual == pytest.approx(expected, rel=share)


def check(performance, column, deviations):
    """Every figure named deviates from the printed one by no more than stated."""
    for figure, share in deviations.items():
        value, printed = getattr(performance, figure), column.figures[figure]
        assert value == pytest.approx(printed, rel=share), figure


def check_table_13(performance):
    """Every figure of Table 13."""
    check(performance, beside.TABLE_13, dict.fromkeys(beside.TABLE_13.figures, 0.035))
