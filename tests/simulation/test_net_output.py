"""What is left of an engine's power once its auxiliaries are paid for."""

import math

import pytest

import saleg
from saleg import Auxiliaries, laws


@pytest.fixture(scope="module")
def steady(base):
    return saleg.steady_state(base)


def test_charger_works_isentropically(base, steady):
    ours = steady.net_output(Auxiliaries(charger_efficiency=0.7, ambient_temperature=290.0))
    gas = base.left.gas_properties
    gamma = gas.gamma(290.0)
    cp = gamma / (gamma - 1.0) * gas.gas_constant
    work = cp * 290.0 * (1.05 ** ((gamma - 1.0) / gamma) - 1.0) / 0.7
    full = base.left.reference_state
    charge = full.pressure * base.left.area * full.clearance / (gas.gas_constant * full.temperature)
    # Of the charge 88 % is fresh (EGR 12 %): once in each cylinder and cycle.
    delivered = 2.0 * 0.88 * charge * steady.performance.frequency
    assert ours.delivered == pytest.approx(delivered, rel=1e-6)
    assert ours.charging == pytest.approx(work * ours.delivered, rel=1e-12)


def test_powers_add_up(steady):
    ours = steady.net_output(Auxiliaries(electronics_efficiency=0.9, consumers=150.0))
    assert ours.power == pytest.approx(steady.performance.power)
    assert ours.electronics == pytest.approx(0.1 * ours.power)
    left = ours.power - ours.charging - ours.electronics - ours.consumers
    assert ours.net_power == pytest.approx(left)
    share = ours.net_power / ours.power
    assert ours.net_efficiency == pytest.approx(share * steady.performance.efficiency)


def test_nothing_is_spent_or_gained_below_the_surroundings(steady):
    free = steady.net_output(Auxiliaries(ambient_pressure=2e5, electronics_efficiency=1.0))
    assert free.charging == 0.0
    assert free.net_power == free.power


def test_ports_that_let_gas_flow_are_charged_for_all_they_deliver(base):
    engine = base.replace(gas_exchange=laws.PortFlow(exhaust_pressure=1.0e5))
    run = saleg.simulate(engine, 0.3)
    ratios = [side.delivery_ratio for side in run.scavenging]
    full = base.left.reference_state
    gas_constant = base.left.gas_properties.gas_constant
    reference = full.pressure * base.left.area * full.clearance / (gas_constant * full.temperature)
    expected = sum(ratios) * reference * run.performance.frequency
    assert run.net_output().delivered == pytest.approx(expected, rel=1e-6)


def test_ports_that_let_nothing_in_are_charged_for_nothing(base):
    closed = {"gas_exchange.intake_width": 0.0, "intake.pressure": 1.4e5}
    run = saleg.simulate(base.replace(gas_exchange=laws.PortFlow(), **closed), 0.3)
    net = run.net_output()
    assert not run.last_cycle_strokes["supplied_mass"].any()
    assert (net.delivered, net.charging) == (0.0, 0.0)
    assert "no fresh gas comes in" in run.message


def test_motored_and_unfinished_runs(base):
    motored = saleg.simulate(base.replace(equivalence_ratio=0.0), 0.1)
    assert math.isnan(motored.net_output().net_efficiency)
    nothing = saleg.simulate(base, 1e-3).net_output(Auxiliaries(consumers=5.0))
    assert math.isnan(nothing.net_power)
    assert nothing.consumers == 5.0


def test_wrong_numbers_are_named_together(steady):
    with pytest.raises(saleg.InvalidEngine) as error:
        steady.net_output(Auxiliaries(charger_efficiency=0.0, ambient_pressure=-1.0))
    paths = {problem.path for problem in error.value.problems}
    assert paths == {"auxiliaries.charger_efficiency", "auxiliaries.ambient_pressure"}
    assert "2 wrong fields in the auxiliaries:" in str(error.value)
    with pytest.raises(saleg.InvalidEngine, match="auxiliaries = 3"):
        steady.net_output(3)
