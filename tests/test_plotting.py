import subprocess
import sys

import numpy as np
import pytest

import saleg
from saleg.plotting import (
    LEFT_COLOUR,
    RIGHT_COLOUR,
    NoCycle,
    new_figure,
    pressure_volume,
    velocity_position,
)


def line(ax, label):
    return next(line for line in ax.get_lines() if line.get_label() == label)


def test_pressure_volume_shows_both_chambers_in_their_colours(base_run):
    ax = pressure_volume(base_run)
    assert "bar" in ax.get_ylabel()
    assert "cm" in ax.get_xlabel()
    for side, colour in (("left", LEFT_COLOUR), ("right", RIGHT_COLOUR)):
        curve = line(ax, side)
        assert curve.get_color() == colour
        peak = np.max(curve.get_ydata())
        assert peak == pytest.approx(1e-5 * base_run.performance.peak_pressure, rel=5e-3)


def test_velocity_position_closes_and_reaches_the_dead_centres(base_run):
    ax = velocity_position(base_run)
    curve = max(ax.get_lines(), key=lambda line: len(line.get_xdata()))
    x, v = curve.get_xdata(), curve.get_ydata()
    assert "mm" in ax.get_xlabel()
    assert "m/s" in ax.get_ylabel()
    assert np.ptp(x) == pytest.approx(1e3 * base_run.performance.stroke, rel=1e-9)
    assert x[0] == pytest.approx(x[-1], abs=1e-3)
    assert v[0] == 0.0
    assert v[-1] == pytest.approx(0.0, abs=1e-9)


def test_event_markers_lie_on_the_curves(base_run):
    ax = pressure_volume(base_run)
    for side, colour in (("left", LEFT_COLOUR), ("right", RIGHT_COLOUR)):
        curve = np.column_stack([line(ax, side).get_xdata(), line(ax, side).get_ydata()])
        marks = [
            mark
            for mark in ax.get_lines()
            if mark.get_color() == colour and mark.get_linestyle() == "None"
        ]
        assert len(marks) == 4
        for mark in marks:
            point = np.array([mark.get_xdata()[0], mark.get_ydata()[0]])
            assert np.abs(curve - point).max(axis=1).min() < 1e-6


def test_plots_draw_on_axes_handed_in(base_run, tmp_path):
    figure = new_figure()
    left, right = figure.subplots(1, 2)
    assert pressure_volume(base_run, left) is left
    assert velocity_position(base_run, right) is right
    figure.savefig(tmp_path / "both.png")


def test_a_run_without_a_cycle_says_so(base):
    run = saleg.simulate(base, 1e-3)
    for plot in (pressure_volume, velocity_position):
        with pytest.raises(NoCycle, match="no full cycle"):
            plot(run)


def test_neither_pyplot_nor_a_display_is_needed():
    code = (
        "import sys, saleg, saleg.plotting, saleg.cli;"
        "assert not {'matplotlib', 'pandas', 'numba'} & set(sys.modules);"
        "saleg.plotting.velocity_position(saleg.simulate(saleg.machines.thesis_base(), 0.1));"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
