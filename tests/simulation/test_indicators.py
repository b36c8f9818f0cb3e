"""Figures of a cycle against what the table of cycles says."""

import dataclasses

import numpy as np
import pytest

import saleg
from helpers import single_piston
from saleg.engine.start import CompressedCharge
from saleg.simulation.indicators import beyond_ports


@pytest.mark.parametrize("duration", [0.09, 0.4])
def test_change_of_the_compression_ratio_is_that_of_the_table(base, duration):
    run = saleg.simulate(base.replace(start=CompressedCharge(position=0.8, burning=0.0)), duration)
    ratios = run.cycles["compression_ratio"]
    changes = ratios.diff().abs().dropna()
    assert run.performance.cr_change == pytest.approx(changes.tail(10).mean(), rel=1e-9)
    assert run.performance.compression_ratio == pytest.approx(ratios.iloc[-1], rel=1e-12)


def test_a_single_cycle_has_no_change(base):
    run = saleg.simulate(base, 0.025)
    assert len(run.cycles) == 1
    assert np.isnan(run.performance.cr_change)


@pytest.mark.parametrize(
    "bounce",
    [
        {"length": 0.15, "pressure": 4e5},
        {"length": 0.07, "pressure": 1e5, "bore": 0.08},
    ],
)
def test_a_bounce_chamber_counts_in_no_figure_of_the_cylinder(base, bounce):
    """By the volumes and pressures the cylinder itself went through."""
    run = saleg.simulate(single_piston(base, **bounce), 1.0)
    history, figures = run.orbit.history, run.performance
    volumes = history.V_left.max() / history.V_left.min()
    assert figures.compression_ratio == pytest.approx(volumes, rel=1e-9)
    for table in (run.cycles, run.dead_centres):
        assert table.compression_ratio.iloc[-1] == pytest.approx(volumes, rel=1e-6)
    assert figures.peak_pressure == pytest.approx(history.p_left.max(), rel=1e-4)
    assert figures.peak_temperature == pytest.approx(history.T_left.max(), rel=1e-4)
    assert figures.peak_pressure_rise == pytest.approx(history.p_rate_left.max(), rel=1e-2)
    assert run.cycles.peak_pressure_right.iloc[-1] == pytest.approx(history.p_right.max(), rel=1e-4)


def test_a_bounce_chamber_is_remarked_on_under_its_own_name(base):
    """A small one reaches nine times the pressure of the cylinder."""
    run = saleg.simulate(single_piston(base, length=0.07, pressure=1e5, bore=0.08), 1.0)
    highest = run.cycles.peak_pressure_right.iloc[-1]
    assert highest > 5.0 * run.performance.peak_pressure
    assert run.remarks == [f"peak pressure in the bounce chamber {highest / 1e5:.4g} bar (> 400)"]


@pytest.mark.parametrize(("length", "clearances"), [(0.15, 0.2), (0.07, 0.17)])
def test_the_regulator_goes_by_the_cylinder(base, length, clearances):
    """Eq. 59 by hand: what a bounce chamber has beyond the cylinder's clearance is no stroke."""
    engine = single_piston(base, length=length, pressure=2e5)
    assert engine.maximum_stroke == pytest.approx(clearances)
    mirrored = dataclasses.replace(engine, left=engine.right, right=engine.left)
    assert mirrored.maximum_stroke == engine.maximum_stroke
    cycle = saleg.simulate(engine, 1.0).cycles.iloc[-1]
    weight = 1.0 - 7.5 * (0.9 * clearances - cycle.stroke) / (0.5 * clearances)
    assert cycle.load_weight == pytest.approx(weight, rel=1e-5)


def test_the_compression_ratio_of_unlike_cylinders_is_that_of_their_volumes(base):
    engine = base.replace(**{"left.bore": 0.055, "left.equivalence_ratio": 0.5})
    run = saleg.simulate(engine, 0.5)
    volume = run.orbit.history[["V_left", "V_right"]]
    wanted = volume.max().sum() / volume.min().sum()
    assert run.performance.compression_ratio == pytest.approx(wanted, rel=1e-9)
    assert run.cycles.compression_ratio.iloc[-1] == pytest.approx(wanted, rel=1e-6)


def test_ports_are_passed_where_the_events_say(base):
    """A single piston rings down without fuel: about no midpoint, until its ports stay closed."""
    engine = single_piston(base).replace(**{"equivalence_ratio": 0.0, "friction.coefficient": 40.0})
    run = saleg.simulate(engine, 0.4)
    ends = run.strokes["t"]
    opened = run.events.t[run.events.event == "port opening"].to_numpy()
    in_stroke = np.histogram(opened, np.concatenate([[0.0], ends]))[0] > 0
    passed = beyond_ports(engine, run.strokes)
    assert 0 < passed.sum() < len(passed) // 3
    assert passed.tolist() == in_stroke.tolist()


def test_what_is_lit_at_dead_centre_starts_there(base):
    """Neither before nor after it, and half of the heat is out as late as the law says."""
    law = base.left.heat_release
    lit = base.replace(ignition=saleg.laws.IgnitionAtDeadCentre())
    found = saleg.simulate(lit, 0.5).performance
    assert found.start_of_combustion == pytest.approx(0.0, abs=1e-12)
    assert found.start_of_combustion_position == pytest.approx(0.0, abs=1e-12)
    half = (np.log(2.0 / (1.0 + np.exp(-law.a))) / law.a) ** (1.0 / (law.b + 1.0))
    assert found.burn_centre == pytest.approx(half * law.combustion_duration, rel=1e-9)
