"""Tables 9, 10 and 12: designs from their eight inputs alone, with the deviations stated."""

import pytest

from saleg.thesis import chapter_4

#: Medians of the magnitudes of the relative deviations, as docs/design.md states them.
MEDIANS = {
    9: {
        "stroke": 0.005,
        "compression_ratio": 0.050,
        "frequency": 0.014,
        "moving_mass": 0.018,
        "efficiency": 0.057,
        "power": 0.086,
        "peak_pressure": 0.095,
    },
    10: {
        "stroke": 0.004,
        "compression_ratio": 0.043,
        "frequency": 0.015,
        "moving_mass": 0.029,
        "efficiency": 0.032,
        "power": 0.036,
        "peak_pressure": 0.041,
    },
    12: {
        "stroke": 0.005,
        "compression_ratio": 0.050,
        "frequency": 0.031,
        "moving_mass": 0.048,
        "efficiency": 0.093,
        "power": 0.110,
        "peak_pressure": 0.069,
    },
}


@pytest.fixture(scope="module", params=MEDIANS)
def beside(request):
    return request.param, chapter_4.deviations(request.param)


def test_designs_deviate_from_the_print_by_no_more_than_stated(beside):
    number, off = beside
    median = off.abs().median()
    for figure, limit in MEDIANS[number].items():
        assert median[figure] < limit, figure


def test_every_design_is_steady_and_stable():
    for number in chapter_4.TABLES:
        table = chapter_4.run(number)
        assert (table["status"] == "steady").all()
        assert table["stable"].all()


def test_the_report_and_the_picture_show_every_design(beside):
    number, off = beside
    text = chapter_4.report(off)
    assert all(str(name) in text for name in chapter_4.printed(number).index)
    ax = chapter_4.draw(off)
    labels = [label.get_text() for label in ax.get_legend().get_texts()]
    assert labels == [*map(str, off.index), "median"]
    assert "[%]" in ax.get_ylabel()
