"""Measured traces: read, refused, aligned, compared."""

import numpy as np
import pytest

import saleg
from saleg.calibration import Trace, TraceError, comparison, synthetic
from saleg.plotting import measured


def bouncing(t, shift):
    """Position and pressures of a made-up engine."""
    angle = 2.0 * np.pi * 47.0 * (t - shift)
    return -0.09 * np.cos(angle), 5e5 + 4e5 * np.cos(angle)


HEAD = "time [ms], position [mm], pressure left [bar]"


def test_a_file_with_units(tmp_path):
    file = tmp_path / "rig.csv"
    rows = "\n".join(f"{n},{n + 0.5},{10 - n}" for n in range(9))
    file.write_text(f"# rig 3\n{HEAD}, temperature\n{rows}\n")
    trace = Trace.read(file, noise={"x": 1e-4})
    np.testing.assert_allclose(trace.t, 1e-3 * np.arange(9))
    np.testing.assert_allclose(trace.x, 1e-3 * (np.arange(9) + 0.5))
    np.testing.assert_allclose(trace.p_left, 1e5 * (10 - np.arange(9)))
    assert trace.channels == ["x", "p_left"]
    assert (trace.sigma("x"), trace.sigma("p_left")) == (1e-4, 0.01 * 8e5)
    assert trace.name == "rig"


def test_semicolons_and_decimal_commas(tmp_path):
    file = tmp_path / "a.csv"
    rows = "\n".join(f"{n},5;{n + 1}" for n in range(9))
    file.write_text(f"t [s];p_right [Pa]\n{rows}\n")
    trace = Trace.read(file)
    np.testing.assert_allclose(trace.t, np.arange(9) + 0.5)
    assert trace.channels == ["p_right"]


ROWS = "\n".join(f"{n},{n},{n + 1}" for n in range(9))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        (f"time,position [mm],p [bar]\n{ROWS}", "column 'time': needs its unit"),
        (f"time [mm],position [mm],p [bar]\n{ROWS}", "'mm' is no unit here"),
        (f"angle [s],position [mm],p [bar]\n{ROWS}", "no column of time"),
        (f"time [s],a,b\n{ROWS}", "needs one of x, p_left, p_right"),
        (f"time [s],x [mm],position [mm]\n{ROWS}", "there is another for the same"),
        (f"{HEAD}\n{ROWS}\n9,wide,1", "line 11, column 2: 'wide' is no number"),
        (f"{HEAD}\n{ROWS}\n9", "line 11, column 2: '' is no number"),
        (f"{HEAD}\n{ROWS}\n8,1,1", "later than the one before"),
        (f"{HEAD}\n{ROWS}\n9,nan,1", "must be finite numbers"),
        (f"{HEAD}\n1,1,1", "at least 8 instants"),
    ],
)
def test_files_that_are_no_trace(tmp_path, text, message):
    file = tmp_path / "a.csv"
    file.write_text(text)
    with pytest.raises(TraceError, match=message) as error:
        Trace.read(file)
    assert str(file) in str(error.value)


def test_arguments_that_are_no_trace():
    t = np.arange(9.0)
    with pytest.raises(TraceError, match="8 values for 9"):
        Trace(t, x=t[1:])
    with pytest.raises(TraceError, match="p_left: pressures must be absolute"):
        Trace(t, p_left=-t)
    with pytest.raises(TraceError, match="must be numbers"):
        Trace(t, x=["a"] * 9)
    with pytest.raises(TraceError, match="noise of 'y'"):
        Trace(t, x=t, noise={"y": 1.0})


def test_a_cycle_is_aligned_with_itself(base):
    """Shift and noise of a made trace come back, whatever part of a cycle it holds."""
    steady = saleg.steady_state(base)
    history = steady.orbit.history
    period = 1.0 / steady.performance.frequency
    rng = np.random.default_rng(5)
    for length, shift in ((1.0, 0.004), (2.5, 7.013), (0.6, -1.0)):
        t = np.linspace(0.0, length * period, 300) + 3.0
        phase = history["t"].iloc[0] + np.mod(t - shift, period)
        noisy = np.interp(phase, history["t"], history["p_left"]) + 2e4 * rng.normal(size=300)
        x = np.interp(phase, history["t"], history["x"])
        found = comparison(Trace(t, x=x, p_left=noisy), steady)
        off = np.mod(found.shift - shift + 0.5 * period, period) - 0.5 * period
        assert abs(off) < 1e-5
        assert found.rms["p_left"] == pytest.approx(2e4, rel=0.15)
        assert found.rms["x"] < 1e-4
        assert found.relative["p_left"] == pytest.approx(found.rms["p_left"] / np.ptp(noisy))


def test_a_made_up_trace_has_its_noise(base):
    steady = saleg.steady_state(base)
    trace = synthetic(steady, {"x": 1e-4, "p_right": 3e4}, count=400, seed=2)
    found = comparison(trace, steady)
    assert found.rms == pytest.approx({"x": 1e-4, "p_right": 3e4}, rel=0.15)
    again = synthetic(steady, {"x": 1e-4, "p_right": 3e4}, count=400, seed=2)
    np.testing.assert_array_equal(trace.x, again.x)
    with pytest.raises(TraceError, match="no channel 'y'"):
        synthetic(steady, {"y": 1.0})


def test_nothing_to_compare_with(base):
    t = np.linspace(0.0, 0.02, 20)
    trace = Trace(t, x=bouncing(t, 0.0)[0])
    with pytest.raises(TraceError, match="no full cycle"):
        comparison(trace, saleg.simulate(base, 1e-3))
    with pytest.raises(TraceError, match="no full cycle"):
        comparison(trace, saleg.steady_state(base.replace(equivalence_ratio=0.0)))
    with pytest.raises(TraceError, match="no pressures over time"):
        measured.pressures(trace, saleg.steady_state(base))


def test_overlay_on_the_figure_of_a_run(base, base_run):
    t = np.linspace(0.0, 0.02, 50)
    x, p = bouncing(t, 0.003)
    trace = Trace(t, x=x, p_left=p, name="rig")
    for across, draw in (("time", "pressure_time"), ("position", "pressure_position")):
        ax = getattr(base_run.plot, draw)()
        count = len(ax.get_lines())
        assert measured.pressures(trace, base_run, ax, across=across) is ax
        dots = ax.get_lines()[count]
        np.testing.assert_allclose(dots.get_ydata(), 1e-5 * p)
        assert dots.get_label().startswith("rig, left (RMS difference")
    ax = measured.positions(trace, saleg.steady_state(base))
    np.testing.assert_allclose(ax.get_lines()[-1].get_ydata(), 1e3 * x)
