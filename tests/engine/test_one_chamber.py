"""Engines with one chamber and a mechanical spring, pressures behind pistons, air springs."""

import dataclasses

import matplotlib
import numpy as np
import pytest

import saleg
from agreement import assert_agree, assert_balanced
from saleg import BounceChamber, Engine, OpenEnd, Translator, laws, reference
from saleg.engine.start import MidpointVelocity

SPRING = laws.OneSidedSprings(right_stiffness=60e3, right_contact=-0.03)


@pytest.fixture(scope="module")
def one_spring(base):
    """A cylinder on the left, returned by one spring; its right end is open."""
    return Engine(
        Translator(mass=5.0),
        base.left,
        None,
        springs=SPRING,
        friction=base.friction,
        alternator=laws.LinearLoad(load_constant=40.0),
        name="one spring",
    ).replace(equivalence_ratio=0.5)


@pytest.fixture(scope="module")
def steady(one_spring):
    return saleg.steady_state(one_spring)


def bouncing(left, right, springs):
    """Two frictionless ends of constant gamma and no load: nothing is lost."""
    return Engine(
        Translator(mass=2.0),
        left,
        right,
        springs=springs,
        friction=laws.ViscousFriction(0.0),
        alternator=laws.LinearLoad(load_constant=0.0),
        start=MidpointVelocity(frequency=30.0, stroke=0.5),
    )


GAS_SPRING = BounceChamber(
    bore=0.05, half_stroke=0.1, pressure=2e5, gas_properties=laws.ConstantGamma(1.4)
)
#: What a gas spring on either side does, beside the cylinders.
AIR = laws.AirSprings(area=GAS_SPRING.area, length=0.1, pressure=2e5, exponent=1.4)


def gas_energy(chamber, x):
    """Internal energy of an adiabatic charge [J], pV/(gamma - 1)."""
    volume, gamma = chamber.area * (chamber.half_stroke + x), 1.4
    full = chamber.area * chamber.half_stroke
    return chamber.pressure * full**gamma * volume ** (1.0 - gamma) / (gamma - 1.0)


def test_open_end_conserves_energy():
    """Returned by air, two more volumes in closed form: so one kernel serves the next test too."""
    engine = bouncing(GAS_SPRING, OpenEnd(pressure=1.3e5), AIR)
    history = saleg.simulate(engine, 0.3, rtol=1e-10, history=1).history
    x, v = history["x"].to_numpy(), history["v"].to_numpy()
    springs = gas_energy(GAS_SPRING, x) + gas_energy(GAS_SPRING, -x)
    surroundings = 1.3e5 * GAS_SPRING.area * x
    total = 0.5 * 2.0 * v**2 + gas_energy(GAS_SPRING, x) + springs + surroundings
    assert np.ptp(x) > 0.05
    np.testing.assert_allclose(total, total[0], rtol=1e-8)


def test_pressure_behind_a_piston_conserves_energy():
    behind = dataclasses.replace(GAS_SPRING, back_area=1.5e-3, back_pressure=2e5)
    engine = bouncing(behind, GAS_SPRING, laws.LinearSprings(stiffness=5e3))
    history = saleg.simulate(engine, 0.3, rtol=1e-10, history=1).history
    x, v = history["x"].to_numpy(), history["v"].to_numpy()
    gas = gas_energy(GAS_SPRING, x) + gas_energy(GAS_SPRING, -x)
    total = 0.5 * 2.0 * v**2 + gas + 5e3 * x**2 + 1.5e-3 * 2e5 * x
    np.testing.assert_allclose(total, total[0], rtol=1e-8)
    # Newton's law holds in the history: the force of the springs has that behind the pistons.
    force = GAS_SPRING.area * (history["p_left"] - history["p_right"]) + history["spring_force"]
    np.testing.assert_allclose(2.0 * history["a"], force, atol=1e-6 * force.abs().max())


def test_air_springs_are_two_adiabatic_volumes():
    thin = dataclasses.replace(GAS_SPRING, pressure=1e4, bore=1e-4)
    beside = bouncing(thin, OpenEnd(pressure=1e4), AIR)
    within = bouncing(GAS_SPRING, GAS_SPRING, laws.LinearSprings(stiffness=0.0))
    ends = [saleg.simulate(engine, 0.2, rtol=1e-10).strokes for engine in (beside, within)]
    assert len(ends[0]) > 5
    np.testing.assert_allclose(ends[0]["x_end"], ends[1]["x_end"], rtol=1e-6)
    np.testing.assert_allclose(ends[0]["t"], ends[1]["t"], rtol=1e-6)


def test_steady_state_is_where_waiting_leads(one_spring, steady):
    assert steady.status == saleg.Status.STEADY
    assert steady.stability.kind == "stable"
    run = saleg.simulate(one_spring, 6.0)
    for name in ("stroke", "power", "compression_ratio", "frequency"):
        expected = getattr(run.performance, name)
        assert getattr(steady.performance, name) == pytest.approx(expected, rel=1e-5)
    assert_balanced(run, 1e-6)


def test_reference_agrees(one_spring):
    run = saleg.simulate(one_spring, 0.3, rtol=1e-9)
    assert_agree(run, reference.simulate(one_spring, 0.3, jitted=True))


def test_mirror_image_is_exact(one_spring):
    springs = laws.OneSidedSprings(right_stiffness=0.0, left_stiffness=60e3, left_contact=0.03)
    turned = dataclasses.replace(one_spring, left=None, right=one_spring.left, springs=springs)
    here, there = saleg.simulate(one_spring, 0.3), saleg.simulate(turned, 0.3)
    np.testing.assert_array_equal(here.strokes["x_end"], -there.strokes["x_end"])
    np.testing.assert_array_equal(
        here.strokes["electrical_energy"], there.strokes["electrical_energy"]
    )


def test_what_nothing_pushes_back_leaves_by_the_open_end(one_spring):
    run = saleg.simulate(one_spring.replace(springs=laws.OneSidedSprings()), 3.0)
    assert run.status is saleg.Status.HEAD_CONTACT
    assert "the open right side" in run.message
    assert "nothing pushed it back" in run.message


def test_everything_goes_with_it(one_spring, steady, tmp_path):
    path = tmp_path / "one.toml"
    path.write_text(one_spring.to_toml())
    assert Engine.from_toml(path) == one_spring
    swept = saleg.sweep.run(saleg.sweep.grid({"bore": [0.062, 0.064]}), one_spring)
    assert list(swept["status"]) == ["steady", "steady"]
    assert swept["power"][1] == pytest.approx(steady.performance.power, rel=1e-6)
    branch = saleg.steady.continuation.branch(one_spring, "bore", 0.062, step=1e-3)
    assert branch.table["power"].iloc[-1] == pytest.approx(swept["power"][0], rel=1e-5)
    run = saleg.simulate(one_spring, 0.5)
    matplotlib.use("Agg")
    for name in ("pressure_volume", "forces", "dynamics", "energy_sankey"):
        assert getattr(run.plot, name)().figure
    figure = run.plot.pressure_volume().figure
    assert figure.axes[0].get_xlim()[1] < 800.0  # [cm^3]: the open end has no volume to draw
    assert "open end" in one_spring._repr_html_()
    assert steady.plot.forces().figure


def test_bore_of_the_piston_is_given_once(one_spring):
    wider = one_spring.replace(bore=0.07)
    assert wider.problems() == []
    assert wider.piston_areas == (wider.left.area, wider.left.area)
    assert one_spring.maximum_stroke == 2.0 * one_spring.left.half_stroke
    assert one_spring.gas_sides == ("left",)


def test_two_open_ends_and_double_pressures_are_refused(base):
    wrong = [
        (Engine(Translator(mass=2.0), None, None), {"left", "right"}),
        (
            Engine(Translator(mass=2.0), base.left, None).replace(
                back_pressure=1e5, back_area=1e-3
            ),
            {"left.back_pressure"},
        ),
        (base.replace(back_pressure=1e5), {"back_area"}),
        (
            Engine(Translator(mass=2.0), base.left, OpenEnd(pressure=-1.0, head_gap=-1.0)),
            {"right.pressure", "right.head_gap"},
        ),
        (Engine(Translator(mass=2.0), base.left, "open"), {"right"}),
    ]
    for engine, fields in wrong:
        assert {problem.path for problem in engine.problems()} == fields
