import dataclasses
import math

import numpy as np
import pandas as pd
import pytest

import saleg
from saleg import control
from saleg.kernel import layout
from saleg.plotting import NoCycle, new_figure
from saleg.plotting import control as draw


@pytest.fixture(scope="module")
def started(transient):
    return control.start_up(transient, 38.0, duration=1.2)


@pytest.fixture(scope="module")
def misfired(transient):
    return control.misfire(transient, at=1.0, duration=1.6)


@pytest.fixture(scope="module")
def ran_away(started):
    """A run whose last strokes end at the heads, as one that runs away."""
    strokes = started.strokes.copy()
    half = 0.5 * started.engine.maximum_stroke
    strokes["x_end"][-3:] = np.sign(strokes["x_end"][-3:]) * half * (1.0 - 1e-3)
    strokes["x_start"][-3:] = -strokes["x_end"][-3:]
    return dataclasses.replace(started, strokes=strokes)


def curve(ax, name):
    return next(line for line in ax.get_lines() if line.get_label() == f"_{name}")


def edges(ax, label):
    """Left and right end of what is shaded under a label."""
    found = [patch for patch in ax.patches if patch.get_label() == label]
    return [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in found]


def texts(ax):
    return [text.get_text() for text in ax.texts]


def table(columns, units):
    frame = pd.DataFrame(columns)
    frame.attrs["units"] = {name: units.get(name, "-") for name in frame}
    return frame


def test_start_up_draws_commands_and_what_the_cylinders_answer(started):
    panels = draw.start_up(started)
    centres, cycles = started.dead_centres, started.cycles
    assert [ax.get_ylabel() for ax in panels] == [
        "motor frequency [Hz]",
        "peak pressure [bar]",
        "load weight [-]",
        "peak temperature [K]",
        "equivalence ratio [-]",
        "compression ratio [-]",
    ]
    motor = curve(panels[0], "motor_frequency").get_ydata()
    assert (np.isnan(motor) == ~centres["motoring"]).all()
    np.testing.assert_array_equal(
        curve(panels[2], "load_weight").get_ydata(), centres["load_weight"]
    )
    left, right = panels[1].get_lines()[:2]
    np.testing.assert_allclose(left.get_ydata(), 1e-5 * cycles["peak_pressure_left"])
    np.testing.assert_allclose(right.get_ydata(), 1e-5 * cycles["peak_pressure_right"])


def test_approach_marks_when_the_engine_was_fired(started):
    for ax in draw.approach(started):
        mark = next(line for line in ax.get_lines() if "fired" in line.get_label())
        assert mark.get_xdata()[0] == control.fired_at(started)
        assert mark.get_label() == "fired at 0.49 s"


def test_start_ups_are_named_where_they_fire(started, transient):
    never = control.start_up(transient, 50.0, duration=0.5)
    ax = draw.start_ups({50.0: never, 38.0: started})
    assert texts(ax) == ["38 Hz\nfired at\n0.49 s", "50 Hz: never fired"]
    np.testing.assert_array_equal(
        ax.get_lines()[0].get_ydata(), started.dead_centres["compression_ratio"]
    )


def test_demand_stands_beside_the_power(started):
    wanted = control.Demand.step(0.8, 3900.0, 1900.0)
    panels = draw.demand(started, wanted)
    power, demand = panels[0].get_lines()[:2]
    np.testing.assert_allclose(power.get_ydata(), 1e-3 * started.dead_centres["power"])
    assert list(demand.get_xdata()) == [0.0, 0.8, 0.8, started.duration]
    np.testing.assert_allclose(demand.get_ydata(), [3.9, 3.9, 1.9, 1.9])
    assert panels[4].get_ylabel() == "stroke [mm]"


@pytest.mark.parametrize("name", ["intake_temperature", "equivalence_ratio"])
def test_demand_shows_what_is_varied(started, name):
    strokes = started.strokes.copy()
    strokes[name][-10:] *= 0.8
    varied = dataclasses.replace(started, strokes=strokes)
    panels = draw.demand(varied, control.Demand.step(0.8, 3900.0, 1900.0))
    assert panels[4].get_ylabel().startswith(name.replace("_", " "))


def test_what_runs_away_does_not_ruin_the_scale(ran_away):
    ax = draw.demand(ran_away, control.Demand.step(0.8, 3900.0, 1900.0))[2]
    assert ran_away.dead_centres["compression_ratio"].max() > 1000.0
    assert ax.get_ylim()[1] < 50.0
    assert texts(ax) == ["up to 2e+03 \N{UPWARDS ARROW} "]


def test_what_does_not_run_away_is_not_cut(misfired):
    for ax, name in zip(
        draw.duty_cycle(misfired),
        ("compression_ratio", "stroke", "frequency", "power"),
        strict=True,
    ):
        drawn = curve(ax, name).get_ydata()
        assert ax.get_ylim()[0] <= min(drawn)
        assert max(drawn) < ax.get_ylim()[1]
        assert not ax.texts


def test_duty_cycle_marks_motor_and_fuel_cut(misfired):
    ax = draw.duty_cycle(misfired, window=(0.9, 1.5))[0]
    assert ax.get_xlim() == (0.9, 1.5)
    np.testing.assert_allclose(edges(ax, "motored"), control.motored_times(misfired))
    ((begin, end),) = edges(ax, "without fuel")
    np.testing.assert_allclose([(begin, end)], control.fuel_cuts(misfired))
    assert 1.0 <= begin < end < 1.05
    kinds = misfired.event_rows["kind"]
    off = misfired.event_rows["t"][kinds == layout.EVENT_MOTOR_OFF]
    np.testing.assert_allclose([end for _, end in control.motored_times(misfired)], off)


def test_first_misfire_and_late_ignitions_are_marked(started):
    rows = np.zeros(8, layout.EVENT_RECORD)
    rows["t"] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.55, 0.58, 0.6]
    rows["side"] = [0, 0, 1, 0, 0, 0, 0, 1]
    rows["kind"] = [
        layout.EVENT_PORT_CLOSING,
        layout.EVENT_MISFIRE,
        layout.EVENT_IGNITION,  # of the other side
        layout.EVENT_IGNITION,  # late, but it lights
        layout.EVENT_PORT_CLOSING,
        layout.EVENT_MISFIRE,
        layout.EVENT_PORT_OPENING,
        layout.EVENT_IGNITION,
    ]
    run = dataclasses.replace(started, event_rows=rows)
    assert control.late_ignitions(run).tolist() == [0.4]
    assert control.first_misfire(run) == 0.55
    assert math.isnan(control.first_misfire(started))
    ax = draw.duty_cycle(run, gas=True)[0]
    marks = {line.get_label(): line.get_xdata() for line in ax.get_lines()}
    assert list(marks["late ignition"]) == [0.4]
    assert marks["first misfire"][0] == 0.55


def test_a_controlled_run_has_its_figure_beside_the_others(misfired, base_run):
    panels = misfired.plot.controlled()
    assert [len(ax.get_lines()) >= 1 for ax in panels] == [True] * 8
    np.testing.assert_array_equal(
        curve(panels[5], "equivalence_ratio").get_ydata(),
        misfired.dead_centres["equivalence_ratio"],
    )
    assert not edges(base_run.plot.controlled()[0], "motored")


@pytest.mark.parametrize(
    ("name", "count"),
    [("start_up", 6), ("approach", 2), ("duty_cycle", 4), ("controlled", 8)],
)
def test_figures_of_runs_take_axes_and_refuse_runs_without_a_cycle(started, base, name, count):
    axes = new_figure().subplots(count)
    assert list(getattr(draw, name)(started, axes)) == list(axes)
    with pytest.raises(NoCycle):
        getattr(draw, name)(saleg.simulate(base, 1e-3))


@pytest.mark.parametrize("name", ["start_up", "approach", "duty_cycle"])
def test_experiments_with_names_stand_apart(started, misfired, name):
    figure = getattr(draw, name)
    panels = figure(misfired, figure(started, label="start"), label="misfire")
    texts = [text.get_text() for text in panels[0].figure.legends[0].get_texts()]
    assert {"start", "misfire"} <= {text.partition(":")[0] for text in texts}
    ratio = panels[{"start_up": 5, "approach": 0, "duty_cycle": 0}[name]]
    shown = [line for line in ratio.get_lines() if line.get_label() in ("start", "misfire")]
    for line, run in zip(shown, (started, misfired), strict=True):
        np.testing.assert_array_equal(line.get_ydata(), run.dead_centres["compression_ratio"])
    assert shown[0].get_color() != shown[1].get_color()


def test_resonance_shades_where_the_ports_open():
    motored = table(
        {
            "motor_frequency": [50.0, 40.0, 39.0, 30.0],
            "motor_amplitude": [66.0] * 4,
            "relative_stroke": [0.1, 0.5, 0.2, 0.1],
            "compression_ratio": [1.2, 3.0, 1.5, 1.2],
            "opens_ports": [False, True, False, False],
            "opened_ports": [False, True, True, False],
            "status": ["steady", "steady", "completed", "steady"],
        },
        {"motor_frequency": "Hz", "motor_amplitude": "N"},
    )
    stroke, ratio = draw.motored_resonance(motored)
    line = stroke.get_lines()[0]
    assert list(line.get_xdata()) == [30.0, 39.0, 40.0, 50.0]
    np.testing.assert_allclose(line.get_ydata(), [10.0, 20.0, 50.0, 10.0])
    assert ratio.get_xlabel() == "motor frequency [Hz]"
    assert edges(ratio, "ports open when settled") == [(39.5, 45.0)]
    assert edges(ratio, "ports opened on the way") == [(34.5, 45.0)]
    assert stroke.get_title() == "Motored: motor amplitude 66 N"
    one = draw.motored_amplitudes(motored)[1]  # of a single amplitude
    assert one.get_xlabel() == "motor amplitude [N]"


def states():
    """Four points of a map: two stable, one unstable, one idling."""
    return table(
        {
            "intake.temperature": [300.0, 300.0, 350.0, 350.0],
            "equivalence_ratio": [0.3, 0.6, 0.3, 0.6],
            "status": ["steady", "steady", "idling", "steady"],
            "stable": [True, True, False, False],
            "power": [1e3, 3e3, math.nan, 2e3],
            "compression_ratio": [12.0, 16.0, math.nan, 14.0],
        },
        {"intake.temperature": "K", "power": "W"},
    )


def test_operating_map_tells_the_kinds_apart():
    power, ratio = draw.operating_map(control.OperatingMap("equivalence_ratio", states()))
    drawn = {line.get_label(): np.asarray(line.get_ydata()) for line in power.get_lines()}
    np.testing.assert_array_equal(drawn["stable"], [1.0, 3.0, np.nan, np.nan])
    np.testing.assert_array_equal(drawn["unstable orbit"], [np.nan, np.nan, np.nan, 2.0])
    assert len(drawn["stalled, idling or invalid"]) == 1
    assert ratio.get_xlabel() == "equivalence ratio [-]"


def test_operating_grid_marks_what_it_does_not_map():
    power, ratio = draw.operating_grid(states())
    assert (power.get_title(), ratio.get_title()) == ("power [kW]", "compression ratio [-]")
    points = {line.get_label(): line.get_xydata().tolist() for line in power.get_lines()}
    assert points == {
        "unstable orbit": [[350.0, 0.6]],
        "stalled, idling or invalid": [[350.0, 0.3]],
    }


def test_a_grid_of_one_temperature_is_not_filled():
    some = states()
    line = some[some["intake.temperature"] == 350.0].reset_index(drop=True)
    line.attrs = some.attrs
    power, _ = draw.operating_grid(line)
    assert len(power.get_lines()) == 2


def test_survival_tells_those_that_stall_apart():
    ax = draw.survival(
        table(
            {
                "strokes": [1, 2, 1, 2],
                "motor": [True, True, False, False],
                "survives": [True, True, True, False],
                "recovery_time": [0.16, 0.2, 0.12, math.nan],
            },
            {"recovery_time": "s"},
        )
    )
    drawn = {line.get_label(): line.get_xydata().tolist() for line in ax.get_lines()}
    assert drawn == {
        "with the motor": [[1.0, 0.16], [2.0, 0.2]],
        "without the motor": [[1.0, 0.12]],
        "without the motor: does not recover": [[2.0, 0.0]],
    }
