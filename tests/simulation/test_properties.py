"""Random valid engines: always a status, never an exception, never a NaN without one."""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import saleg
from saleg.engine.start import AtRest, CompressedCharge, MidpointVelocity

# Many of them are unusual.
pytestmark = pytest.mark.filterwarnings("ignore::saleg.SalegWarning")

positions = st.floats(0.05, 0.99) | st.floats(-0.99, -0.05)
starts = st.one_of(
    st.builds(CompressedCharge, position=positions, burning=st.sampled_from([0.0, 1.0])),
    st.builds(
        MidpointVelocity,
        frequency=st.floats(1.0, 200.0),
        factor=st.floats(-3.0, 3.0),
    ),
    st.just(AtRest()),
)


@st.composite
def engines(draw):
    """Engines far beyond anything sensible, though each valid."""
    half = draw(st.floats(0.01, 0.5))
    changes = {
        "half_stroke": half,
        "bore": draw(st.floats(0.01, 0.3)),
        "port_closing": 2.0 * half * draw(st.floats(0.05, 0.98)),
        "head_gap": half * draw(st.sampled_from([1e-3, 1e-2])),
        "moving_mass": draw(st.floats(0.05, 50.0)),
        "spring.stiffness": draw(st.sampled_from([0.0, 1e3, 3e4, 1e6])),
        "intake.pressure": draw(st.floats(0.3e5, 5e5)),
        "intake.temperature": draw(st.floats(150.0, 900.0)),
        "equivalence_ratio": draw(st.floats(0.0, 3.0)),
        "egr": draw(st.floats(0.0, 0.95)),
        "wall_temperature": draw(st.floats(250.0, 1500.0)),
        "friction.coefficient": draw(st.sampled_from([0.0, 0.1, 10.0, 500.0])),
        "alternator.load_constant": draw(st.floats(0.0, 500.0)),
        "alternator.regulator_gain": draw(st.floats(0.0, 30.0)),
        "heat_release.combustion_duration": draw(st.floats(1e-5, 0.05)),
        "heat_transfer.a": draw(st.floats(0.0, 300.0)),
        "ignition.k": draw(st.floats(0.0, 5000.0)),
    }
    engine = saleg.machines.thesis_base().replace(start=draw(starts), **changes)
    if draw(st.booleans()):
        engine = engine.replace(**{"left.bore": draw(st.floats(0.01, 0.3))})
    return engine


def check(run):
    assert isinstance(run.status, saleg.Status)
    assert len(run.message) > 20
    assert math.isfinite(run.duration)
    for name in run.strokes.dtype.names:
        assert np.isfinite(run.strokes[name]).all(), name
    assert str(run)
    if run.status in (saleg.Status.COMPLETED, saleg.Status.STEADY, saleg.Status.IDLING):
        values = run.performance.to_dict()
        if run.last_cycle_strokes is not None:
            unknown = {"cr_change"} if len(run.strokes) < 6 else set()
            if values["fuel_energy_per_cycle"] < 1e-290:
                unknown |= {"efficiency", "indicated_efficiency"}
            compressed = [
                row["ignition_time"][0 if row["direction"] < 0.0 else 1]
                for row in run.last_cycle_strokes
            ]
            if max(compressed) < 0.0:
                unknown |= {"start_of_combustion", "start_of_combustion_position", "burn_centre"}
            nan = {name for name, value in values.items() if not math.isfinite(value)}
            assert nan <= unknown, (nan, run.strokes["ignition_time"], run.message)
            assert values["peak_pressure"] > 0.0
            assert (np.diff(run.strokes["t"]) > 0.0).all()


@settings(
    max_examples=500,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(engine=engines())
def test_random_engines_have_a_status(engine):
    engine.validate()
    check(saleg.simulate(engine, 0.1, rtol=1e-6))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    engine=engines(),
    order=st.sampled_from([1, 2, 3, 4, 5, 8]),
    step=st.floats(1e-5, 1e-3),
)
def test_random_engines_at_coarse_fixed_steps(engine, order, step):
    check(saleg.simulate(engine, 0.1, order=order, step=step))
