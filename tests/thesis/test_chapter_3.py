"""Base case and numerical studies beside Tables 1 to 5."""

from printed import within
from saleg.plotting.style import new_figure
from saleg.thesis import chapter_3


def test_base_case_is_reported_beside_tables_1_2_and_5():
    text = chapter_3.report(chapter_3.base_case())
    assert "Table 1 (5 us)" in text
    assert "finest (T. 2, 5)" in text


def test_two_steps_late_give_the_rows_of_table_2():
    late = chapter_3.delays((5e-6, 1e-5))
    for row in late[late["delay"] == 2].itertuples():
        for figure in ("stroke", "peak_pressure", "efficiency"):
            within(getattr(row, figure), chapter_3.TABLE_2[row.step][figure], 0.01)
    ax = chapter_3.draw(late, new_figure(4, 3).subplots())
    assert "thesis, Table 2" in [line.get_label() for line in ax.lines]


def test_profiles_of_heat_release_against_table_5():
    off = chapter_3.heat_release().abs()
    assert off.drop(columns="power").loc["single Wiebe (base)"].max() < 0.015
    assert off.drop(columns="power").to_numpy().max() < 0.035
    assert off["power"].max() < 0.045
