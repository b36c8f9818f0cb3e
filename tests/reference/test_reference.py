"""The integrator against the same engine through scipy's solvers."""

import dataclasses
import math
import subprocess
import sys

import numpy as np
import pytest

import saleg
from agreement import (
    AGREEMENT,
    ORBIT_ONLY,
    assert_agree,
    assert_balanced,
    assert_rows_agree,
)
from saleg import BounceChamber, Engine, Status, reference
from saleg.engine.start import AtRest, CompressedCharge, MidpointVelocity
from saleg.laws import BlairViscousFriction, ConstantGamma, FrictionShare


def compare(engine, duration, tolerance=AGREEMENT, **settings):
    """Run both, check that they agree, return both."""
    run = saleg.simulate(engine, duration, rtol=1e-9)
    check = reference.simulate(engine, duration, **{"jitted": True, **settings})
    assert_agree(run, check, tolerance)
    return run, check


@pytest.fixture(scope="module")
def one_sided(base):
    """One cylinder and a gas spring, with tuned friction."""
    spring = BounceChamber(bore=0.064, half_stroke=0.1, pressure=3e5)
    return Engine(
        base.translator,
        left=base.left,
        right=spring,
        springs=base.springs,
        friction=FrictionShare(),
        alternator=base.alternator,
    )


@pytest.mark.parametrize("rtol", [1e-10, 1e-12])
@pytest.mark.parametrize("machine", ["thesis_base", "thesis_transient"])
def test_machines_agree(machine, rtol):
    engine = getattr(saleg.machines, machine)()
    run, check = compare(engine, 0.3, 2e-8, rtol=rtol)
    assert_balanced(run)
    assert_balanced(check)


def test_last_cycle_agrees_in_every_column(base):
    run, check = compare(base, 0.2, rtol=1e-12)
    times = ("t", "ignition_time")
    rows, wanted = run.orbit.last_cycle_strokes, check.last_cycle_strokes
    assert_rows_agree(rows, wanted, 2e-7, but=times)
    assert_rows_agree(run.strokes, check.strokes, 2e-7, but=ORBIT_ONLY)


@pytest.mark.parametrize("machine", ["thesis_base", "thesis_transient"])
def test_plain_python_agrees(machine):
    engine = getattr(saleg.machines, machine)()
    compare(engine, 0.1, jitted=False)


def test_plain_and_compiled_are_the_same_equations(base):
    plain = reference.simulate(base, 0.03, rtol=1e-8)
    compiled = reference.simulate(base, 0.03, rtol=1e-8, jitted=True)
    assert_rows_agree(plain.strokes, compiled.strokes, 1e-10)
    assert plain.evaluations == compiled.evaluations


# What each method reaches at its tolerance, restarts and all: seen 5e-9, 5e-9, 9e-9, 9e-7.
@pytest.mark.parametrize(
    ("solver", "rtol", "reached"),
    [("RK45", 1e-9, 1e-7), ("Radau", 1e-8, 1e-7), ("LSODA", 1e-10, 1e-7), ("BDF", 1e-9, 1e-5)],
)
def test_other_solvers_agree(base, solver, rtol, reached):
    compare(base, 0.1, reached, solver=solver, rtol=rtol)


def test_solver_given_as_class(base):
    from scipy.integrate import DOP853

    by_name = reference.simulate(base, 0.03, jitted=True)
    by_class = reference.simulate(base, 0.03, jitted=True, solver=DOP853)
    assert by_class.settings == by_name.settings
    assert_rows_agree(by_class.strokes, by_name.strokes, 0.0)


@pytest.mark.parametrize(
    "start",
    [
        CompressedCharge(),
        CompressedCharge(burning=0.0),
        MidpointVelocity(),
        MidpointVelocity(factor=-1.15),
    ],
    ids=repr,
)
def test_starts_agree(base, one_sided, start):
    for engine in (base, one_sided):
        run, check = compare(engine.replace(start=start), 0.15)
        assert run.status is Status.COMPLETED
        assert_balanced(run)
        assert_balanced(check)


def test_friction_is_tuned(one_sided):
    run, check = compare(one_sided, 0.1)
    assert run.strokes["friction_held"][-1] != FrictionShare().initial
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=ORBIT_ONLY)


@pytest.mark.slow
def test_cylinder_on_the_right(one_sided):
    turned = dataclasses.replace(one_sided, left=one_sided.right, right=one_sided.left)
    run, _ = compare(turned, 0.15)
    again = saleg.simulate(one_sided, 0.15, rtol=1e-9)
    np.testing.assert_allclose(run.strokes["x_end"], -again.strokes["x_end"], rtol=1e-8)


def test_from_rest_towards_equilibrium(one_sided):
    start = CompressedCharge(position=-0.5, burning=0.0)
    softer = one_sided.replace(start=start, **{"springs.stiffness": 0.0, "right.pressure": 2e4})
    run, check = compare(softer, 0.5)
    assert len(run.strokes) > 5
    assert run.status is Status.STALLED
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=ORBIT_ONLY)


def test_at_rest_nothing_happens(base):
    run, check = compare(base.replace(start=AtRest()), 0.05)
    assert len(run.strokes) == len(check.strokes) == 0


def test_friction_of_blair_agrees(base, transient):
    for engine in (base, transient):
        compare(engine.replace(friction=BlairViscousFriction()), 0.15)


@pytest.mark.parametrize("machine", ["thesis_base", "thesis_transient"])
def test_motored_until_it_stalls(machine):
    engine = getattr(saleg.machines, machine)().replace(equivalence_ratio=0.0)
    run, check = compare(engine, 1.0)
    assert run.status is Status.STALLED
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=ORBIT_ONLY)


def test_head_contact(base):
    hot = base.replace(
        **{"alternator.load_constant": 10.0, "alternator.regulator_gain": 0.0},
        equivalence_ratio=0.9,
    )
    run, _ = compare(hot, 0.2)
    assert run.status is Status.HEAD_CONTACT


def test_ports_of_both_sides_at_one_place(base):
    """At the midpoint one chamber closes at the very instant the other one opens."""
    run, check = compare(base.replace(port_closing=base.left.half_stroke), 0.1)
    assert_balanced(run)
    assert_balanced(check)


def test_port_at_the_very_start(base):
    """A dead centre exactly at a port: it closes at once."""
    run, check = compare(base.replace(port_closing=0.19), 0.05)
    assert run.event_rows["t"][0] == check.event_rows["t"][0] == 0.0


def test_motored_pressure_changes_nothing(base):
    with_it = reference.simulate(base, 0.05, jitted=True, motored_pressure=True)
    without = reference.simulate(base, 0.05, jitted=True)
    assert_rows_agree(with_it.strokes, without.strokes, 1e-8)


def test_frictionless_gas_spring_keeps_its_energy():
    from helpers import bounce_engine

    run = reference.simulate(bounce_engine(), 0.1, rtol=1e-12)
    ends = np.abs(run.strokes["x_end"])
    np.testing.assert_allclose(ends, 0.08, rtol=1e-10)
    assert isinstance(run.engine.left.gas_properties, ConstantGamma)


def test_scipy_is_imported_only_when_needed():
    code = "import sys; from saleg import reference; sys.exit('scipy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_failure_of_the_solver_is_a_status(base):
    """A heat-release law that is not finite."""
    broken = base.replace(heat_release=_Broken())
    run = reference.simulate(broken, 0.02)
    assert run.status is Status.STEP_FAILURE
    assert "no step was small enough" in run.message


class _Broken(type(saleg.machines.thesis_base().left.heat_release)):
    """Becomes NaN half way."""

    def burn_rate(self, u):
        return math.nan if u > 0.5 else super().burn_rate(u)


@pytest.mark.slow
@pytest.mark.parametrize("machine", ["thesis_base", "thesis_transient"])
def test_a_second_of_engine_time(machine):
    engine = getattr(saleg.machines, machine)()
    compare(engine, 1.0, 1e-7, rtol=1e-12)
