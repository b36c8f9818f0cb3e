"""Figures of sweeps."""

import numpy as np
import pandas as pd
import pytest

import saleg
from helpers import SMALL_SWEEP, swept_line
from saleg import sweep
from saleg.plotting import sweeps as figures


@pytest.fixture(scope="module")
def cloud():
    ranges = {"bore": (0.03, 0.08), "half_stroke": (0.06, 0.14), "intake_temperature": (260, 640)}
    return sweep.run(sweep.sobol(ranges, 32))


def test_panels_tell_kinds_of_points_apart():
    table = swept_line("intake_temperature", 300.0, 640.0, 18)
    axes = figures.panels(table, "intake_temperature")
    assert len(axes) == 8
    texts = [text.get_text() for text in axes[0].figure.legends[0].get_texts()]
    assert texts[0] == "stable"
    assert "stalled, idling or invalid" in texts
    efficiency = axes[5]
    assert efficiency.get_title() == "efficiency [%]"
    drawn = efficiency.lines[0].get_ydata()
    stable = (table.status == "steady") & table.stable
    np.testing.assert_allclose(drawn[stable], 100.0 * table.efficiency[stable])
    assert np.isnan(drawn[~stable]).all()
    table.attrs = sweep.run(sweep.grid({"intake_temperature": [300.0]})).attrs
    assert len(
        figures.panels(table.drop(columns=["stable", "largest_multiplier"]), "intake_temperature")
    )


def test_a_second_input_has_lines_of_its_own():
    table = sweep.run(sweep.grid({"bore": [0.060, 0.062, 0.064], "egr": [0.1, 0.3]}))
    efficiency = figures.panels(table, "bore")[5]
    first, second = efficiency.lines
    for line, share in ((first, 0.1), (second, 0.3)):
        np.testing.assert_allclose(
            line.get_ydata(), 100.0 * table.efficiency[table.egr == share], rtol=1e-12
        )


def test_tables_with_names_stand_apart(base):
    points = sweep.grid({"bore": [0.060, 0.064]})
    first, second = (
        sweep.run(points, base.replace(egr=share), multipliers=False) for share in (0.1, 0.3)
    )
    axes = figures.panels(first, "bore", label="10 % EGR")
    axes = figures.panels(second, "bore", axes, label="30 % EGR")
    one, other = next(panel for panel in axes if panel.get_title() == "efficiency [%]").lines
    np.testing.assert_allclose(other.get_ydata(), 100.0 * second.efficiency)
    assert one.get_color() != other.get_color()
    texts = [text.get_text() for text in axes[0].figure.legends[0].get_texts()]
    assert [text.partition(":")[0] for text in texts] == ["10 % EGR", "30 % EGR"]


def test_maps_over_two_inputs(base):
    grid = sweep.grid({"bore": [0.060, 0.062, 0.064], "egr": [0.1, 0.3]})
    table = sweep.run(grid, base, multipliers=False)
    axes = figures.maps(table, "bore", "egr")
    assert (axes[4].get_xlabel(), axes[0].get_ylabel()) == ("bore [mm]", "EGR [%]")
    titles = [panel.get_title() for panel in axes]
    cells = axes[titles.index("efficiency [%]")].collections[0].get_array()
    wanted = 100.0 * table.pivot_table(index="egr", columns="bore", values="efficiency")
    np.testing.assert_allclose(cells, wanted)


def test_maps_of_scattered_points(cloud):
    axes = figures.maps(cloud, "bore", "half_stroke")
    kept = cloud[cloud.status == "steady"]
    dots = axes[0].collections[0].get_offsets()
    np.testing.assert_allclose(dots[:, 0], 1e3 * kept.bore)
    crossed = axes[0].collections[1].get_offsets()
    assert len(crossed) == (~kept.stable.astype(bool)).sum() > 0


def test_a_sweep_of_an_engine_shows_every_figure_once(base):
    table = sweep.run(sweep.grid({"moving_mass": [2.2, 2.4]}), base, multipliers=False)
    titles = [axes.get_title() for axes in figures.panels(table, "moving_mass")]
    assert not any("moving mass" in title for title in titles)
    shown = [title for title in titles if title]
    assert len(set(shown)) == len(shown) >= 5


def test_what_cannot_be_drawn_is_named():
    failed = sweep.run(sweep.grid({"bore": [-1.0, -2.0]}))
    table = sweep.run(sweep.grid(SMALL_SWEEP))
    for wrong, match in (
        (lambda: figures.panels(failed, "bore"), "nothing to draw"),
        (lambda: figures.groups(failed, "stroke_to_bore"), "nothing to draw"),
        (lambda: figures.design_map(failed, "bore", "bore", "bore"), "'score'"),
        (lambda: figures.groups(table.assign(status="stalled"), "bore"), "none of 6 points"),
        (lambda: figures.panels(table, "boer"), "no column 'boer'"),
        (lambda: figures.panels(table, "message"), "holds no numbers"),
        (lambda: figures.design_map(table, "bore", "egr", "message"), "holds no numbers"),
        (lambda: figures.panels(pd.DataFrame(table.to_dict()), "bore"), "no unit of"),
    ):
        with pytest.raises(sweep.SweepError, match=match):
            wrong()
    with pytest.raises(ValueError, match="needs 8 axes, not 4"):
        figures.panels(table, "bore", ax=np.empty(4, object))


def test_logarithmic_panels_have_plain_numbers():
    table = sweep.run(sweep.grid({"intake_pressure": [0.9e5, 1.1e5, 3.4e5]}))
    table["peak_pressure"] = [80e5, 300e5, 4000e5]
    panel = figures.groups(table, "intake_pressure")[7]
    assert panel.get_yscale() == "log"
    panel.figure.canvas.draw()
    texts = [text.get_text() for text in panel.get_yticklabels() if text.get_text()]
    assert {"100", "200", "500"} <= set(texts)


def test_groups_and_maps(cloud):
    for name in saleg.design.results.GROUPS:
        axes = figures.groups(cloud, name)
        stable, unstable = axes[3].collections
        assert len(stable.get_offsets()) == cloud.stable[cloud.status == "steady"].sum()
        assert len(unstable.get_offsets()) == (~cloud.stable[cloud.status == "steady"]).sum()
        assert len(unstable.get_facecolor()) == 0
    ax = figures.design_map(cloud, "stroke_to_bore", "frequency", "power_density")
    assert ax.get_zlabel() == "power density [kW/kg]"
    orbits = cloud[cloud.status == "steady"]
    counted = f"{orbits.stable.sum()} stable of {len(cloud)} designs, {len(orbits)} with an orbit"
    assert ax.get_title() == counted
    assert axes[0].figure.get_suptitle() == counted
