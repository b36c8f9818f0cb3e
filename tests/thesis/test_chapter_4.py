"""Tables 9, 10 and 12: designs from their eight inputs alone, with the deviations stated."""

import pytest

from saleg.thesis import chapter_4

#: Medians of the magnitudes of the relative deviations, as docs/design.md states them.
MEDIANS = {
    9: {
        "stroke": 0.005,
        "compression_ratio": 0.050,
        "frequency": 0.014,
        "moving_mass": 0.017,
        "efficiency": 0.057,
        "power": 0.085,
        "peak_pressure": 0.097,
    },
    10: {
        "stroke": 0.005,
        "compression_ratio": 0.044,
        "frequency": 0.019,
        "moving_mass": 0.039,
        "efficiency": 0.032,
        "power": 0.034,
        "peak_pressure": 0.041,
    },
    12: {
        "stroke": 0.006,
        "compression_ratio": 0.051,
        "frequency": 0.030,
        "moving_mass": 0.046,
        "efficiency": 0.093,
        "power": 0.109,
        "peak_pressure": 0.071,
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
