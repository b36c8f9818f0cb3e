"""Engines that breathe: the integrator against the reference, which has other variables."""

import dataclasses

import numpy as np
import pytest

import saleg
from agreement import ORBIT_ONLY, assert_agree, assert_balanced, assert_rows_agree
from breathing_engines import single_piston
from saleg import laws, reference

PORTS = laws.PortFlow(
    exhaust_width=0.1,
    exhaust_height=0.03,
    intake_width=0.1,
    intake_height=0.025,
    intake_delay=0.012,
    displacement=0.4,
)
#: Peaks, which the integrator reads off cubics within its steps but for the last cycle.
PEAKS = ("peak_pressure", "peak_temperature", "peak_velocity")


@pytest.fixture(scope="module")
def boosted(base):
    """Ports on both sides, and a charged intake."""
    return base.replace(gas_exchange=PORTS, **{"intake.pressure": 1.5e5})


@pytest.fixture(scope="module")
def single(base):
    """Cylinder with crankcase, leaking rings and a wall that follows; a leaking gas spring."""
    return single_piston(base, PORTS)


def compare(engine, duration, **how):
    """Run both, check that all their figures and rows agree, return the reference's run."""
    run = saleg.simulate(engine, duration, rtol=1e-10)
    check = reference.simulate(engine, duration, **how)
    assert_agree(run, check, 1e-6)
    assert_rows_agree(run.strokes, check.strokes, 1e-6, but=(*ORBIT_ONLY, *PEAKS))
    rows, wanted = (one.strokes[list(PEAKS)] for one in (run, check))
    assert_rows_agree(rows, wanted, 1e-5)
    assert_balanced(run)
    assert_balanced(check)
    return check


def test_ports_with_a_charged_intake_agree(boosted):
    check = compare(boosted, 0.06)
    assert check.strokes["supplied_mass"].max(axis=0).min() > 2e-4
    assert check.strokes["fresh_mass"][-1].min() > 2e-4


def test_crankcase_rings_wall_and_leaking_gas_spring_agree(single):
    """Blown back by the cylinder, its crankcase holds burnt gas that no fuel may be metered to."""
    check = compare(single, 0.08, jitted=True)  # as Python the same: see below
    assert np.ptp(check.strokes["wall_temperature"][:, 0]) > 10.0
    assert np.ptp(check.strokes["charge_mass"][:, 1]) > 1e-7
    assert np.abs(check.strokes["crankcase_work"][:, 0]).max() > 10.0


def test_laws_that_look_at_charge_wall_and_motored_pressure_agree(boosted):
    """Left by flow, right in an instant, both scattered; leaking rings take of either charge."""
    leak = laws.RingLeak(gap=1e-6)
    left = dataclasses.replace(
        boosted.left,
        heat_transfer=laws.Annand(),
        leak=leak,
        wall=laws.LumpedWall(heat_capacity=2.0, conductance=20.0),
    )
    right = dataclasses.replace(
        boosted.right,
        heat_transfer=laws.Woschni(),
        gas_exchange=laws.InstantExchange(egr=0.1),
        leak=leak,
    )
    spread = laws.CyclicVariability(seed=3, fuel=0.05, delay=0.02, duration=0.05)
    engine = dataclasses.replace(boosted, left=left, right=right, scatter=spread)
    check = compare(engine, 0.06)
    assert check.strokes["heat_lost"].max(axis=0).min() > 10.0
    # Charges scatter here too.
    plain = engine.replace(**{f"scatter.{name}": 0.0 for name in ("fuel", "delay", "duration")})
    ends = [saleg.simulate(one, 0.06).strokes["x_end"] for one in (engine, plain)]
    count = min(map(len, ends))
    assert np.abs(ends[0][:count] - ends[1][:count]).max() > 1e-5


def test_plain_and_compiled_are_the_same_equations(single):
    plain = reference.simulate(single, 0.02, rtol=1e-8)
    compiled = reference.simulate(single, 0.02, rtol=1e-8, jitted=True)
    assert_rows_agree(plain.strokes, compiled.strokes, 1e-10)
    assert plain.evaluations == compiled.evaluations
