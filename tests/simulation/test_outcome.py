"""How runs end, as their status and message say."""

import numpy as np
import pytest

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


@pytest.mark.parametrize("share", [1e-5, 1e-7, 1e-9])
def test_an_engine_with_next_to_no_heat_is_not_too_coarsely_stepped(base, share):
    """Its energy closes as well as that of an engine with fuel, against what moves to and fro."""
    changes = {"equivalence_ratio": share, "friction.coefficient": 0.1, "ignition.x": 0.0}
    run = saleg.simulate(base.replace(**changes), 0.3, rtol=1e-5)
    assert run.status is saleg.Status.COMPLETED, run.message
    assert abs(run.energy.residual) < 1e-5 * np.abs(run.strokes["gas_work"]).max()


@pytest.mark.parametrize("rtol", [1e-5, 1e-6, 1e-8])
@pytest.mark.parametrize("shares", [(0.232, 0.451), (0.451, 0.232)])
def test_a_trace_of_the_fuel_of_the_start_is_no_firing(base, rtol, shares):
    """Without fuel an engine is dead, whichever side keeps more of its first burnt charge."""
    left, right = shares
    engine = base.replace(
        **{
            "half_stroke": 0.128,
            "port_closing": 0.15,
            "equivalence_ratio": 0.0,
            "friction.coefficient": 0.0,
            "wall_temperature": 325.0,  # walls that heat the gas would keep it running
            "left.egr": left,
            "right.egr": right,
        }
    )
    assert saleg.steady_state(engine, rtol=rtol).status is saleg.Status.STALLED
