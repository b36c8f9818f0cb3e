"""Several runs on the same axes: each is told from the others, and nothing is hidden."""

import dataclasses
from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import saleg
from saleg import plotting
from saleg.plotting import FIGURES, LEFT_COLOUR, RIGHT_COLOUR
from saleg.plotting.overlay import RUN_COLOURS, darker, runs_on

TOGETHER = [name for name in FIGURES if not name.startswith("energy")]


@pytest.fixture(scope="module")
def heavy(base):
    return saleg.simulate(base.replace(moving_mass=3.0), 1.0)


def first(drawn):
    return np.ravel(drawn)[0]


def legends(drawn):
    """Texts of all legends of a figure."""
    panels, figure = list(np.ravel(drawn)), first(drawn).figure
    found = [*(panel.get_legend() for panel in panels), *figure.legends]
    return [[text.get_text() for text in one.get_texts()] for one in found if one is not None]


def lab(colour):
    """CIE L*a*b* of an sRGB colour (CIE 15, D65)."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb > 0.04045, ((rgb + 0.055) / 1.055) ** 2.4, rgb / 12.92)
    matrix = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    xyz = np.array(matrix) @ linear / [0.9505, 1.0, 1.089]
    x, y, z = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0)
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


def test_colours_of_runs_stay_apart():
    """A difference of 2.3 is just noticeable; curves far from each other need ten times that."""
    pairs = [*combinations(RUN_COLOURS, 2), *combinations(map(darker, RUN_COLOURS[:4]), 2)]
    pairs += [(colour, darker(colour)) for colour in RUN_COLOURS]
    pairs += [(colour, RIGHT_COLOUR) for colour in RUN_COLOURS]
    for one, other in pairs:
        assert np.linalg.norm(lab(one) - lab(other)) > 20.0, (one, other)


@pytest.mark.parametrize("name", TOGETHER)
def test_two_runs_are_told_apart_in_a_legend_without_doubles(base_run, heavy, name):
    drawn = getattr(base_run.plot, name)(label="base case")
    again = getattr(heavy.plot, name)(drawn, label="heavy")
    assert all(a is b for a, b in zip(np.ravel(drawn), np.ravel(again), strict=True))
    (texts,) = legends(drawn)
    assert len(set(texts)) == len(texts)
    assert {"base case", "heavy"} <= set(texts)


@pytest.mark.parametrize("name", TOGETHER)
def test_the_legend_of_two_runs_covers_no_curve(base_run, heavy, name):
    drawn = getattr(heavy.plot, name)(getattr(base_run.plot, name)(label="base"), label="heavy")
    figure = first(drawn).figure
    figure.canvas.draw()
    (legend,) = [
        one for one in (*(p.get_legend() for p in np.ravel(drawn)), *figure.legends) if one
    ]
    box = legend.get_window_extent()
    assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
    assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
    assert not any(box.overlaps(panel.get_window_extent()) for panel in np.ravel(drawn))


def test_curves_of_both_runs_are_their_histories_in_full(base_run, heavy):
    ax = heavy.plot.pressure_time(base_run.plot.pressure_time(label="base"), label="heavy")
    curves = {line.get_label(): line for line in ax.get_lines()}
    for run, name in ((base_run, "base"), (heavy, "heavy")):
        history = run.orbit.history
        for side, label in (("left", name), ("right", f"_{name}")):
            np.testing.assert_allclose(curves[label].get_ydata(), 1e-5 * history[f"p_{side}"])
        assert ax.get_xlim()[1] >= 1e3 * np.ptp(history["t"]) * (1.0 - 1e-12)
        assert ax.get_ylim()[1] > 1e-5 * run.performance.peak_pressure
    assert curves["base"].get_color() != curves["heavy"].get_color()


def test_a_run_without_a_name_keeps_the_colours_of_the_sides(base_run, heavy):
    ax = base_run.plot.pressure_volume()
    heavy.plot.pressure_volume(ax)
    handles, texts = ax.get_legend().legend_handles, ax.get_legend().get_texts()
    colours = {
        text.get_text(): handle.get_color() for handle, text in zip(handles, texts, strict=True)
    }
    assert colours["left"] == LEFT_COLOUR
    assert colours["run 2"] == RUN_COLOURS[1]
    assert runs_on(ax) == 2


def test_time_goes_on_as_long_as_the_longest_run(base_run, heavy):
    assert heavy.duration < base_run.duration
    alone = base_run.plot.approach_to_steady_state()[0].get_xlim()[1]
    panels = heavy.plot.approach_to_steady_state(base_run.plot.approach_to_steady_state())
    assert panels[0].get_xlim()[1] >= alone
    assert panels[0].get_title() == "Approach to steady state"
    panels = heavy.plot.controlled(base_run.plot.controlled())
    assert panels[0].get_xlim()[1] >= base_run.duration


def test_the_approach_ends_when_all_is_settled(base_run):
    """What is left out differs from the last cycle by less than a thousandth, in every figure."""
    panels = base_run.plot.approach_to_steady_state()
    end, cycles = panels[0].get_xlim()[1], base_run.cycles
    assert end < 0.5 * base_run.duration
    left_out = cycles[cycles["t"] > end]
    for name in ("stroke", "compression_ratio", "power", "x_left", "x_right"):
        last = cycles[name].iloc[-1]
        assert (abs(left_out[name] - last) < 1e-3 * abs(last)).all()


def test_figures_say_whose_they_are(base_run, heavy, base):
    for name in ("forces", "energy_pie", "energy_balance", "approach_to_steady_state", "dynamics"):
        axes = np.ravel(getattr(base_run.plot, name)())
        assert axes[0].figure.get_supxlabel() == "thesis-base, rtol 1e-09"
    ax = saleg.simulate(base, 0.1, method="fixed", step=1e-5).plot.forces(base_run.plot.forces())
    signed = "thesis-base, rtol 1e-09 | thesis-base, order 4, steps of 10 µs"
    assert ax.figure.get_supxlabel() == signed
    assert base_run.plot.forces(Figure().subplots()).figure.get_supxlabel() == ""


def test_a_run_nobody_commands_is_not_under_control(base_run):
    assert "control" not in base_run.plot.controlled()[0].get_title()


def test_a_run_that_ended_badly_says_so_in_the_legend(base_run):
    orbit = base_run.orbit
    bad = dataclasses.replace(base_run, status=saleg.Status.HEAD_CONTACT, replay=lambda: orbit)
    for name in TOGETHER:
        drawn = getattr(bad.plot, name)(getattr(base_run.plot, name)(), label="other")
        assert any("other (head contact)" in text for texts in legends(drawn) for text in texts)
        assert "head contact" not in first(drawn).get_title()


@pytest.mark.parametrize("draw", [plotting.energy_sankey, plotting.energy_pie])
def test_an_energy_balance_has_the_name_of_its_run_in_the_title(base_run, draw):
    assert draw(base_run, label="base case").get_title().startswith("base case: ")


def test_a_steady_state_has_the_figures_of_its_cycle(base):
    found = saleg.steady_state(base)
    ax = found.plot.pressure_volume(label="steady")
    drawn = max(line.get_ydata().max() for line in ax.get_lines() if len(line.get_ydata()))
    assert drawn == pytest.approx(1e-5 * found.performance.peak_pressure, rel=5e-3)
    lost = saleg.steady_state(base.replace(equivalence_ratio=0.0))
    if lost.orbit is None:
        with pytest.raises(saleg.SalegError, match="no steady state to draw"):
            _ = lost.plot
