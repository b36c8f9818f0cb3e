import dataclasses
import inspect
import math
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.text import Text

import saleg
from helpers import ROOT
from saleg import plotting
from saleg.errors import SalegError
from saleg.plotting import (
    FIGURES,
    LEFT_COLOUR,
    RIGHT_COLOUR,
    NoCycle,
    new_figure,
)
from saleg.plotting.energy import energy_flows

SIDES = (("left", LEFT_COLOUR), ("right", RIGHT_COLOUR))
#: Figures of one axes over the cycle, with the units of both.
UNITS = {
    "velocity_position": ("[mm]", "[m/s]"),
    "acceleration_velocity": ("[m/s]", "[km/s$^2$]"),
    "pressure_position": ("[mm]", "[bar]"),
    "pressure_volume": ("[cm$^3$]", "[bar]"),
    "pressure_time": ("[ms]", "[bar]"),
    "heat_flow_time": ("[ms]", "[kW]"),
    "forces": ("[ms]", "[kN]"),
    "power": ("[ms]", "[kW]"),
    "efficiency": ("[ms]", "[%]"),
}
#: Columns and scales of the curves of either side.
SIDED = {
    "pressure_volume": ("V_{}", 1e6, "p_{}", 1e-5),
    "pressure_position": ("x", 1e3, "p_{}", 1e-5),
    "pressure_time": ("t", 1e3, "p_{}", 1e-5),
    "heat_flow_time": ("t", 1e3, "heat_loss_{}", 1e-3),
}


@pytest.fixture(scope="module")
def history(base_run):
    return base_run.orbit.history


@pytest.fixture(scope="module")
def unsteady(base):
    return saleg.simulate(base, 0.045)


def line(ax, label):
    return next(line for line in ax.get_lines() if line.get_label() == label)


def ribbons(ax):
    """Widths of the bands of a Sankey diagram at either end, by label."""
    widths = {}
    for patch in ax.patches:
        if patch.get_label():
            points = patch.get_path().vertices
            low, high = points[:5, 1], points[5:10, 1][::-1]
            widths[patch.get_label()] = high - low
    return widths


def texts(ax):
    return "\n".join(text.get_text() for text in ax.texts)


@pytest.mark.parametrize("name", UNITS)
def test_labels_carry_their_units(base_run, name):
    ax = FIGURES[name](base_run)
    assert ax.get_xlabel().endswith(UNITS[name][0])
    assert ax.get_ylabel().endswith(UNITS[name][1])
    assert ax.get_title()
    assert ax.get_legend() is not None


@pytest.mark.parametrize("name", SIDED)
def test_curves_of_both_sides_are_the_history_in_their_colours(base_run, history, name):
    across, scale_x, up, scale_y = SIDED[name]
    ax = FIGURES[name](base_run)
    for side, colour in SIDES:
        curve = line(ax, side)
        x = history[across.format(side)] - (history["t"].iloc[0] if across == "t" else 0.0)
        assert curve.get_color() == colour
        np.testing.assert_allclose(curve.get_xdata(), scale_x * x, rtol=1e-14)
        np.testing.assert_allclose(curve.get_ydata(), scale_y * history[up.format(side)])


@pytest.mark.parametrize(
    ("name", "columns", "scales"),
    [
        ("velocity_position", ("x", "v"), (1e3, 1.0)),
        ("acceleration_velocity", ("v", "a"), (1.0, 1e-3)),
    ],
)
def test_curves_of_the_translator_are_the_history(base_run, history, name, columns, scales):
    curve = line(FIGURES[name](base_run), "_translator")
    np.testing.assert_allclose(curve.get_xdata(), scales[0] * history[columns[0]])
    np.testing.assert_allclose(curve.get_ydata(), scales[1] * history[columns[1]])


def test_velocity_position_closes_and_reaches_the_dead_centres(base_run):
    curve = line(plotting.velocity_position(base_run), "_translator")
    x, v = curve.get_xdata(), curve.get_ydata()
    assert np.ptp(x) == pytest.approx(1e3 * base_run.performance.stroke, rel=1e-9)
    assert x[0] == pytest.approx(x[-1], abs=1e-3)
    assert v[0] == 0.0
    assert v[-1] == pytest.approx(0.0, abs=1e-9)


def test_peak_pressure_is_drawn(base_run):
    peak = np.max(line(plotting.pressure_volume(base_run), "left").get_ydata())
    assert peak == pytest.approx(1e-5 * base_run.performance.peak_pressure, rel=5e-3)


@pytest.mark.parametrize("name", ["pressure_volume", "pressure_position", "pressure_time"])
def test_motored_pressure_is_dotted_where_it_was_integrated(base, base_run, history, name):
    ax = FIGURES[name](base_run)
    for side, colour in SIDES:
        parts = [curve for curve in ax.get_lines() if curve.get_label() == f"_motored {side}"]
        drawn = np.concatenate([curve.get_ydata() for curve in parts])
        assert all(curve.get_color() == colour for curve in parts)
        assert all(curve.is_dashed() for curve in parts)
        assert set(drawn) == set(1e-5 * history[f"p_motored_{side}"])
    without = FIGURES[name](saleg.simulate(base, 0.1))
    assert not [curve for curve in without.get_lines() if "motored" in curve.get_label()]


@pytest.mark.parametrize("name", [*SIDED, "velocity_position", "acceleration_velocity"])
def test_event_markers_lie_on_the_curves(base_run, name):
    ax = FIGURES[name](base_run)
    for side, colour in SIDES:
        curve = line(ax, side if name in SIDED else "_translator")
        points = np.column_stack([curve.get_xdata(), curve.get_ydata()])
        marks = [
            mark
            for mark in ax.get_lines()
            if mark.get_color() == colour
            and mark.get_linestyle() == "None"
            and len(mark.get_xdata())
        ]
        assert len(marks) == 4
        for mark in marks:
            point = np.array([mark.get_xdata()[0], mark.get_ydata()[0]])
            assert np.abs(points - point).max(axis=1).min() < 1e-9


def test_markers_stand_where_the_event_table_says(base_run):
    ax = plotting.pressure_position(base_run)
    events = base_run.orbit.events
    lit = events[(events["event"] == "ignition") & (events["side"] == "left")]
    star = next(
        mark
        for mark in ax.get_lines()
        if mark.get_marker() == "*" and mark.get_color() == LEFT_COLOUR
    )
    assert star.get_xdata()[0] == pytest.approx(1e3 * lit["x"].iloc[0], rel=1e-12)
    assert star.get_ydata()[0] == pytest.approx(1e-5 * lit["pressure"].iloc[0], rel=1e-9)


def test_forces_add_up_to_inertia(base_run, history):
    ax = plotting.forces(base_run)
    acting = ("gas left", "gas right", "springs", "friction", "alternator")
    total = sum(np.asarray(line(ax, label).get_ydata()) for label in acting)
    inertia = np.asarray(line(ax, "inertia (sum)").get_ydata())
    np.testing.assert_allclose(total, inertia, atol=1e-9)
    np.testing.assert_allclose(inertia, 2.39e-3 * history["a"])
    assert line(ax, "gas left").get_color() == LEFT_COLOUR
    assert line(ax, "gas right").get_color() == RIGHT_COLOUR


def test_power_has_its_mean_and_rms(base_run, history):
    ax = plotting.power(base_run)
    curve, mean, rms = ax.get_lines()[:3]
    np.testing.assert_allclose(curve.get_ydata(), 1e-3 * history["electrical_power"])
    assert mean.get_ydata()[0] == pytest.approx(1e-3 * base_run.performance.power)
    assert rms.get_ydata()[0] == pytest.approx(1e-3 * base_run.performance.rms_power)


def test_running_efficiency_swings_in_a_narrow_band_and_meets_the_mean(base_run):
    for cycles, band in ((10, 0.06), (40, 0.015)):
        ax = plotting.efficiency(base_run, cycles=cycles)
        curve, mean = ax.get_lines()[:2]
        values = np.asarray(curve.get_ydata())
        efficiency = 100.0 * base_run.performance.efficiency
        assert mean.get_ydata()[0] == pytest.approx(efficiency)
        assert values[0] == pytest.approx(efficiency, rel=1e-5)
        assert values[-1] == pytest.approx(efficiency, rel=1e-5)
        assert 0.0 < np.ptp(values) < band * efficiency
        # The fuel of each of the two charges counts at once.
        assert np.count_nonzero(np.diff(values) < -0.005 * band * efficiency) == 2


def test_efficiency_of_a_single_cycle_begins_with_its_first_charge(base_run):
    values = np.asarray(plotting.efficiency(base_run, cycles=1).get_lines()[0].get_ydata())
    assert math.isnan(values[0])
    assert values[-1] == pytest.approx(100.0 * base_run.performance.efficiency, rel=1e-5)


@pytest.mark.parametrize("which", ["base_run", "unsteady"])
def test_energy_flows_add_up_to_the_fuel(which, request):
    energy = request.getfixturevalue(which).energy
    flows = energy_flows(energy)
    # Beside the residual there is the error with which the released heat is integrated.
    assert sum(flows.values()) + energy.residual == pytest.approx(energy.fuel, rel=1e-9)
    assert abs(sum(flows.values()) - energy.fuel) < 2.0 * abs(energy.residual) < 1e-8 * energy.fuel


def test_sankey_is_the_energy_balance(base_run):
    energy = base_run.energy
    ax = plotting.energy_sankey(base_run)
    widths = ribbons(ax)
    ends = {
        "electrical output": energy.electrical,
        "alternator loss": energy.alternator - energy.electrical,
        "friction": energy.friction,
        "exhaust": energy.exhaust,
        "heat transfer": energy.heat_transfer,
        "unburnt fuel": energy.unburnt,
    }
    trunk = {
        "heat released": energy.released,
        "piston work": energy.friction + energy.alternator,
        "alternator": energy.alternator,
    }
    assert set(widths) == set(ends) | set(trunk)
    for name, joules in (ends | trunk).items():
        np.testing.assert_allclose(widths[name], joules / energy.fuel, rtol=1e-6)
    assert sum(widths[name][-1] for name in ends) == pytest.approx(1.0, abs=1e-6)
    for name, joules in ends.items():
        assert f"{name}  " in texts(ax)
        assert f"{100.0 * joules / energy.fuel:.1f} %" in texts(ax)
    assert "no term of the balance" in texts(ax)
    assert plotting.energy_balance is plotting.energy_sankey


@pytest.mark.parametrize("name", ["energy_pie", "energy_sankey", "energy_balance"])
def test_steady_state_draws_its_energy(base, name):
    steady = saleg.steady_state(base)
    figure = getattr(steady.plot, name)().figure
    words = " ".join(text.get_text() for text in figure.findobj(Text))
    assert f"{100.0 * steady.performance.efficiency:.1f}" in words


def test_sankey_of_an_unsteady_cycle_shows_what_joins(unsteady):
    energy = unsteady.energy
    assert energy.stored < -1e-3 * energy.fuel
    widths = ribbons(plotting.energy_sankey(unsteady))
    np.testing.assert_allclose(widths["stored energy"], -energy.stored / energy.fuel)
    joined = widths["stored energy"][0] + widths["stored fuel"][0]
    trunk = ("heat released", "piston work", "alternator", "stored energy", "stored fuel")
    ends = [name for name in widths if name not in trunk]
    assert sum(widths[name][-1] for name in ends) == pytest.approx(1.0 + joined, abs=5e-4)


def test_sankey_ends_do_not_overlap(base_run):
    ax = plotting.energy_sankey(base_run)
    end = max(patch.get_path().vertices[:, 0].max() for patch in ax.patches if patch.get_label())
    spans = sorted(
        (points[4, 1], points[5, 1])
        for points in (patch.get_path().vertices for patch in ax.patches if patch.get_label())
        if points[4, 0] == end
    )
    assert len(spans) == 6
    assert all(below[1] < above[0] - 0.05 for below, above in pairwise(spans))


def test_pie_is_the_energy_balance(base_run):
    ax = plotting.energy_pie(base_run)
    shares = [(wedge.theta2 - wedge.theta1) / 360.0 for wedge in ax.patches]
    flows = [flow for flow in energy_flows(base_run.energy).values() if flow > 1.0]
    np.testing.assert_allclose(np.abs(shares), np.array(flows) / base_run.energy.fuel, rtol=1e-5)
    assert "exhaust 41.4 %" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_names_of_a_pie_neither_overlap_nor_leave_the_figure(base):
    """Of a cycle in which one flow is 0.4 % of the fuel."""
    ax = plotting.energy_pie(saleg.simulate(base, 0.07))
    figure = ax.figure
    figure.canvas.draw()
    boxes = [text.get_window_extent() for text in ax.get_legend().get_texts()]
    assert len(boxes) == 7
    assert all(above.y0 >= below.y1 for above, below in pairwise(boxes))
    assert all(figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 for box in boxes)


@pytest.mark.parametrize("name", ["energy_pie", "energy_sankey"])
def test_a_balance_that_does_not_close_is_not_drawn(base_run, name):
    off = dataclasses.replace(base_run)
    off.__dict__["energy"] = dataclasses.replace(base_run.energy, residual=-20.0)
    with pytest.raises(NoCycle, match=r"off by 1\.4 % of the fuel energy; try a smaller step"):
        FIGURES[name](off)


def test_pie_cannot_show_what_joins(unsteady):
    with pytest.raises(NoCycle, match="energy_sankey"):
        plotting.energy_pie(unsteady)


def test_approach_shows_every_cycle(base_run):
    panels = plotting.approach_to_steady_state(base_run)
    cycles = base_run.cycles
    stroke, centres, ratio, power = panels
    np.testing.assert_allclose(stroke.get_lines()[0].get_ydata(), 1e3 * cycles["stroke"])
    np.testing.assert_allclose(ratio.get_lines()[0].get_ydata(), cycles["compression_ratio"])
    np.testing.assert_allclose(power.get_lines()[0].get_ydata(), 1e-3 * cycles["power"])
    for (side, colour), sign in zip(SIDES, (-1e3, 1e3), strict=True):
        np.testing.assert_allclose(line(centres, side).get_ydata(), sign * cycles[f"x_{side}"])
        assert line(centres, side).get_color() == colour
    assert [ax.get_ylabel().split()[-1] for ax in panels] == ["[mm]", "[mm]", "[-]", "[kW]"]
    assert {ax.get_xlabel() for ax in panels} == {"time [s]"}


def test_dynamics_has_two_panels_and_one_legend(base_run):
    motion, pressures = plotting.dynamics(base_run)
    assert motion.get_ylabel() == "velocity [m/s]"
    assert pressures.get_ylabel() == "pressure [bar]"
    assert motion.get_legend() is None
    assert pressures.get_legend() is not None
    with pytest.raises(ValueError, match="2 axes, not 1"):
        plotting.dynamics(base_run, [motion])


def test_axes_that_do_not_fit_are_refused(base_run):
    """One for a figure of four came back as a bare ValueError, four for one as AttributeError."""
    four = new_figure().subplots(2, 2)
    for draw, ax, said in (
        (plotting.approach_to_steady_state, four[0, 0], "needs 4 axes, not 1"),
        (plotting.approach_to_steady_state, "abcd", "needs 4 axes, not 1"),
        (plotting.approach_to_steady_state, [1, 2, 3, 4], "one matplotlib axes here, not 1"),
        (plotting.pressure_volume, four.ravel(), "one matplotlib axes here, not 4 in a ndarray"),
        (plotting.energy_sankey, four[0, 0].figure, "one matplotlib axes here, not <"),
    ):
        with pytest.raises(SalegError, match=said):
            draw(base_run, ax)


@pytest.mark.parametrize(("name", "count"), [("dynamics", 2), ("approach_to_steady_state", 4)])
def test_figures_of_several_panels_take_an_array_of_axes(base_run, name, count):
    axes = new_figure().subplots(count)
    assert list(FIGURES[name](base_run, ax=axes)) == list(axes)
    assert all(panel.has_data() for panel in axes)


def labels(axis):
    return [float(label.get_text().replace("\u2212", "-")) for label in axis.get_ticklabels()]


@pytest.mark.parametrize(("duration", "kept"), [(0.025, None), (2.0, 12)])
def test_approach_of_few_cycles_is_readable(base, duration, kept):
    run = saleg.simulate(base, duration, keep_cycles=kept)
    panels = plotting.approach_to_steady_state(run)
    panels[0].figure.canvas.draw()
    for panel in panels:
        start, end = panel.get_xlim()
        assert start == run.cycles["t"].iloc[0]
        assert end - start < 1.05 * (run.duration - start)
        low, high = panel.get_ylim()
        assert high - low > 0.99e-4 * high
        for axis in (panel.xaxis, panel.yaxis):
            assert len(labels(axis)) <= 7
            assert len(set(labels(axis))) == len(labels(axis))


@pytest.mark.parametrize("name", UNITS | {"energy_sankey": 0, "energy_pie": 0})
def test_plots_draw_on_axes_handed_in(base_run, name, tmp_path):
    figure = new_figure()
    ax = figure.subplots()
    assert FIGURES[name](base_run, ax) is ax
    ax.clear()  # on which an energy balance stands alone
    assert getattr(base_run.plot, name)(ax=ax) is ax
    figure.savefig(tmp_path / "figure.png")


@pytest.mark.parametrize("name", FIGURES)
def test_a_run_without_a_cycle_says_so(base, name):
    run = saleg.simulate(base, 1e-3)
    with pytest.raises(NoCycle, match=r"full cycle.*try a longer run") as raised:
        FIGURES[name](run)
    assert isinstance(raised.value, SalegError)


def test_a_stalled_run_is_not_passed_off_as_a_good_one(base):
    run = saleg.simulate(
        base.replace(**{"alternator.load_constant": 400.0, "alternator.regulator_gain": 0.0}), 1.0
    )
    assert "stalled" in run.plot.velocity_position().get_title()
    for name in ("energy_sankey", "energy_pie", "efficiency"):
        with pytest.raises(NoCycle, match="no fresh fuel"):
            FIGURES[name](run)


@pytest.mark.parametrize("name", FIGURES)
def test_no_figure_passes_a_bad_run_off_as_a_good_one(base_run, name):
    orbit = base_run.orbit
    bad = dataclasses.replace(base_run, status=saleg.Status.HEAD_CONTACT, replay=lambda: orbit)
    axes = np.atleast_1d(FIGURES[name](bad))
    assert any("(the run ended: head contact)" in ax.get_title() for ax in axes)


@pytest.fixture(scope="module")
def stalled(base):
    """Its pressures hardly vary in the last cycle, and nothing happens in it."""
    return saleg.simulate(base.replace(**{"alternator.load_constant": 300.0}), 2.0)


@pytest.mark.parametrize("name", ["pressure_volume", "pressure_position", "pressure_time"])
def test_pressures_that_hardly_vary_are_not_clipped(stalled, name):
    ax = FIGURES[name](stalled)
    for side, _ in SIDES:
        curve = line(ax, side)
        assert 0.0 == ax.get_ylim()[0] < np.max(curve.get_ydata()) < 0.97 * ax.get_ylim()[1]
        assert np.max(curve.get_xdata()) <= ax.get_xlim()[1]


def test_a_motion_without_events_lists_none(stalled):
    assert plotting.velocity_position(stalled).get_legend() is None


def test_no_power_is_a_curve_inside_the_axes(stalled):
    ax = plotting.power(stalled)
    assert not line(ax, "electrical power").get_ydata().any()
    assert ax.get_ylim()[0] < 0.0 < ax.get_ylim()[1]


def test_an_engine_driven_by_its_alternator_has_no_sankey(base_run):
    driven = dataclasses.replace(base_run)
    driven.__dict__["energy"] = dataclasses.replace(base_run.energy, electrical=-20.0)
    with pytest.raises(NoCycle, match="alternator drove"):
        plotting.energy_sankey(driven)


def test_run_plot_lists_documents_and_draws_the_figures(base_run):
    assert set(dir(base_run.plot)) == {*FIGURES, "animation"}
    for name in FIGURES:
        assert getattr(base_run.plot, name).__doc__ == FIGURES[name].__doc__
        assert "ax : " in FIGURES[name].__doc__
        assert list(inspect.signature(FIGURES[name]).parameters)[:2] == ["run", "ax"]
        assert name in repr(base_run.plot)
        assert name in plotting.__all__
    assert base_run.plot.power().get_ylabel() == "electrical power [kW]"
    with pytest.raises(AttributeError, match="did you mean 'pressure_volume'"):
        base_run.plot.presure_volume()
    assert not hasattr(base_run.plot, "_repr_html_")


def test_neither_pyplot_nor_a_display_is_needed():
    code = (
        "import sys, saleg, saleg.cli; saleg.plotting.studies.delay;"
        "assert not {'matplotlib', 'pandas', 'numba'} & set(sys.modules);"
        "saleg.simulate(saleg.machines.thesis_base(), 0.1).plot.velocity_position();"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_page_of_figures_names_them_all():
    page = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in page for name in FIGURES)


def test_one_balance_on_one_axes_and_no_approach_of_a_steady_state(base, base_run):
    ax = plotting.energy_sankey(base_run)
    for draw in (plotting.energy_sankey, plotting.energy_pie):
        with pytest.raises(saleg.errors.AxesError, match="shows one run"):
            draw(base_run, ax)
    with pytest.raises(NoCycle, match="no approach"):
        saleg.steady_state(base).plot.approach_to_steady_state()
