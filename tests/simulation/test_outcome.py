"""How runs end, as their status and message say."""

import saleg


def test_engine_without_fuel_stalls(base):
    run = saleg.simulate(base.replace(equivalence_ratio=0.0), 3.0)
    assert run.status is saleg.Status.STALLED
    assert "t =" in run.message
    assert "try" in run.message
    assert run.performance.power == 0.0


def test_idling_is_named(base):
    """At an intake of 600 K there is an orbit that fires at CR 7.9 or so and delivers nothing."""
    run = saleg.simulate(base.replace(**{"intake.temperature": 600.0}), 1.5)
    assert run.status is saleg.Status.IDLING
    assert run.performance.power == 0.0
