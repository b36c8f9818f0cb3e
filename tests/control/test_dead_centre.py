"""Dead-centre control, power at one dead centre, misfires told, warned of and prevented."""

import math

import numpy as np
import pytest

import saleg
from saleg import control
from saleg.control import DeadCentreControl, Demand, Feedback, MisfireGuard, PowerAtDeadCentre
from saleg.control.plant import InPython
from saleg.errors import InvalidController
from saleg.laws import CompressionThreshold, ScaledLoad
from saleg.start import AtRest


@pytest.fixture(scope="module")
def engine():
    return saleg.machines.thesis_transient()


@pytest.fixture(scope="module")
def steady(engine):
    return saleg.steady_state(engine)


@pytest.fixture(scope="module")
def line(engine, steady):
    power = steady.performance.power
    return control.operating_line(engine, [power - 2000.0, power - 1000.0, power])


class ScatteredFuel:
    """Another controller, whose equivalence ratio scatters evenly by a share on either side."""

    def __init__(self, controller, share, seed):
        self.controller, self.share = controller, share
        self.random = np.random.default_rng(seed)

    def act(self, signals):
        commands = self.controller.act(signals)
        factor = 1.0 + self.share * self.random.uniform(-1.0, 1.0)
        return commands._replace(equivalence_ratio=factor * commands.equivalence_ratio)


class Cut:
    """Another controller, without fuel for some strokes from a time on."""

    def __init__(self, controller, strokes, at):
        self.controller, self.strokes, self.at = controller, strokes, at

    def act(self, signals):
        commands = self.controller.act(signals)
        if signals.t < self.at or self.strokes == 0:
            return commands
        self.strokes -= 1
        return commands._replace(equivalence_ratio=0.0)


def deviations(run, steady, after=1.0):
    """Dead centres less those of the steady state [m]."""
    ends = np.abs(run.strokes["x_end"][run.strokes["t"] > after])
    return ends - np.abs(steady.strokes["x_end"]).mean()


def test_a_dead_centre_is_held_at_rest(engine, steady):
    run = control.simulate(engine, DeadCentreControl(steady), 2.0)
    assert abs(run.performance.compression_ratio - steady.performance.compression_ratio) < 0.01


@pytest.mark.parametrize("name", ["thesis_transient", "thesis_base"])
def test_a_dead_centre_is_held_under_15_percent_scatter_of_fuel(name):
    engine = getattr(saleg.machines, name)()
    steady = saleg.steady_state(engine)
    holding = DeadCentreControl(steady, Feedback(scatter=0.1))
    run = control.simulate(engine, ScatteredFuel(holding, 0.15, 1), 3.0)
    off = deviations(run, steady)
    assert np.sqrt(np.mean(off**2)) < 0.25e-3
    assert np.abs(off).max() < 0.5e-3
    assert holding.failures == []


def test_springs_halve_the_scatter_of_a_held_dead_centre_and_not_that_of_the_work():
    """As docs/dead_centre.md says beside what is published."""
    scatter, work = [], []
    for stiffness in (0.0, 60e3):
        engine = saleg.machines.thesis_base().replace(**{"spring.stiffness": stiffness})
        steady = saleg.steady_state(engine)
        holding = DeadCentreControl(steady, Feedback(scatter=0.1))
        run = control.simulate(engine, ScatteredFuel(holding, 0.15, 1), 4.0)
        done = run.strokes["gas_work"][run.strokes["t"] > 1.0].sum(axis=1)
        scatter.append(deviations(run, steady).std())
        work.append(done.std() / done.mean())
    assert scatter[1] / scatter[0] == pytest.approx(0.5, abs=0.1)
    assert work[1] / work[0] == pytest.approx(1.0, abs=0.1)


def test_another_friction_leaves_no_offset(engine, steady):
    """The disturbance observer takes away what the model does not know."""
    stiff = engine.replace(**{"friction.coefficient": 1.5 * engine.get("friction.coefficient")})
    off = deviations(control.simulate(stiff, DeadCentreControl(steady), 4.0), steady, after=3.5)
    assert np.abs(off).max() < 1e-6


def test_the_line_keeps_the_dead_centre_and_has_the_powers(line, steady):
    for power, point in zip(line.powers, line.steady, strict=True):
        assert point.performance.power == pytest.approx(power, rel=1e-5)
        assert point.performance.stroke == pytest.approx(steady.performance.stroke, rel=1e-5)
    assert line.load_weights[-1] == pytest.approx(steady.strokes["load_weight"].mean(), rel=1e-4)
    assert line.equivalence_ratios[-1] == pytest.approx(0.655, rel=1e-3)


def test_a_power_that_cannot_be_had_is_refused(engine):
    with pytest.raises(control.NoOperatingLine, match="no steady state of 90000 W"):
        control.operating_line(engine, [90e3])


def test_a_step_of_2_kw_settles_sooner_than_with_the_controllers_of_the_thesis(
    engine, line, steady
):
    power = steady.performance.power
    demand = Demand.step(2.0, power, power - 2000.0)
    run = control.simulate(engine, PowerAtDeadCentre(line, demand), 3.5)
    strokes = run.strokes[run.strokes["t"] > 2.0]
    t, powers = strokes["t"] - 2.0, strokes["electrical_energy"] / strokes["duration"]
    missing = powers - (power - 2000.0)
    settled = t[np.flatnonzero(np.abs(missing) > 100.0)[-1] + 1]
    assert settled < 0.25  # heating the intake or leaning on the stroke regulator: 0.9 s
    assert missing.min() > -300.0
    assert np.abs(deviations(run, steady, 2.0)).max() < 0.6e-3
    assert np.abs(deviations(run, steady, 3.2)).max() < 2e-5


def test_a_failed_charge_is_told_at_its_own_dead_centre_and_made_up_for(engine, steady):
    holding = DeadCentreControl(steady)
    run = control.simulate(engine, Cut(holding, 1, at=1.5), 2.5)
    without = run.strokes["t"][run.strokes["equivalence_ratio"] == 0.0]
    assert holding.failures[0] == pytest.approx(without[0], abs=1e-12)
    plain = control.misfire(engine, strokes=1, motor=False, duration=2.5)
    least, plain_least = (
        item.dead_centres.compression_ratio[item.dead_centres.t > 1.4].min()
        for item in (run, plain)
    )
    assert plain_least < 12.0
    assert least > 17.0
    assert control.recovery_time(run, 1.5) < 0.7 * control.recovery_time(plain, 1.5)


def test_five_failed_charges_in_a_row_are_survived_without_the_motor(engine, steady):
    """With the stroke regulator two are too many (docs/control.md)."""
    run = control.simulate(engine, Cut(DeadCentreControl(steady), 5, at=1.5), 2.5)
    assert run.status is saleg.Status.STEADY
    assert control.recovery_time(run, 1.5) < 0.2


def test_a_guard_keeps_an_overloaded_engine_from_misfiring(engine, steady):
    plain = control.overload(engine, duration=4.0)
    warned = control.misfire_warning(plain)
    lost = control.first_misfire(plain)
    assert lost - 0.1 < warned < lost - 2.0 / (2.0 * 45.0)  # two strokes at 45 Hz
    overload = ScaledLoad(times=(2.0, 4.0), factors=(1.0, 6.0))
    loaded = control.rapid_start(
        state_logic=CompressionThreshold(latched=1.0), load_control=overload
    )
    guard = MisfireGuard(InPython(loaded), steady, least=39.6e-3)
    run = control.simulate(engine.replace(start=AtRest()), guard, 5.0)
    assert math.isnan(control.first_misfire(run))
    assert guard.lowered
    assert run.strokes["electrical_energy"][-2:].min() > 0.0


def test_margins_end_at_the_dead_centre(engine, steady):
    """As the figure of the cycle, and NaN where nothing lights."""
    run = saleg.simulate(engine, 1.2)
    expected = steady.performance.start_of_combustion
    assert control.ignition_margins(run)[-1] == pytest.approx(expected, rel=1e-4)
    cold = saleg.simulate(engine.replace(equivalence_ratio=0.0), 0.05)
    assert np.isnan(control.ignition_margins(cold)).all()


def test_settings_out_of_range_are_refused():
    with pytest.raises(InvalidController, match="tolerance"):
        Feedback(tolerance=0.0)
