"""How far a steady state is from the true one, and whether disturbances of it grow."""

import numpy as np
import pytest

import saleg
from saleg.simulation.integration import integrate
from saleg.simulation.outcome import imbalance
from saleg.simulation.settings import Settings

BASE = saleg.machines.thesis_base()


def test_an_orbit_with_a_slow_mode_is_as_near_as_others():
    # Undamped and hardly fired: a disturbance falls by 0.14 % per cycle, so that the error of the
    # steps displaces the orbit by some hundreds of times itself.
    slow = BASE.replace(
        **{
            "friction.coefficient": 0.0,
            "bore": 0.005706,
            "half_stroke": 0.280965,
            "port_closing": 0.381299,
            "moving_mass": 14.5967,
            "springs.stiffness": 74040.0,
            "alternator.load_constant": 665.99,
            "equivalence_ratio": 0.64039,
            "egr": 0.41236,
            "intake.pressure": 89896.0,
            "intake.temperature": 333.5,
        }
    )
    exact = saleg.steady_state(slow, rtol=1e-12)
    found = saleg.steady_state(slow)
    assert exact.multipliers[0].real == pytest.approx(0.9986, abs=1e-4)
    assert found.performance.stroke == pytest.approx(exact.performance.stroke, rel=1e-5)


def test_energy_closes_at_the_default_tolerance():
    rng = np.random.default_rng(4)
    seen = 0
    for _ in range(60):
        changes = {
            path: BASE.get(path) * 3.0 ** rng.uniform(-1.0, 1.0)
            for path in ("bore", "moving_mass", "equivalence_ratio", "spring.stiffness", "egr")
        }
        found = saleg.steady_state(BASE.replace(**changes), effort=saleg.Effort.QUICK)
        if found.found:
            seen += 1
            assert imbalance(found.strokes[-1], found.strokes) < 1e-6
    assert seen > 20


def test_multipliers_of_an_orbit_that_is_not_its_own_mirror_image():
    # The spark comes too late on the right: a symmetric engine that fires on the left only.
    spark = saleg.laws.SparkAfterDelay(delay=0.008)
    engine = BASE.replace(ignition=spark, **{"fuel.air_fuel_ratio": 9.13})
    found = saleg.steady_state(engine, rtol=1e-9)
    assert found.found
    assert not found.mirrored
    left, right = found.strokes["heat_released"].sum(axis=0)
    assert left > 1000.0
    assert right == 0.0
    leading, following = found.multipliers[:2].real
    assert leading < -1.0
    assert abs(following) < 0.5
    assert found.stability.kind == "period doubling"
    settings = Settings(14.0 * found.strokes["duration"].sum(), rtol=1e-11)
    start = found.replay.start
    start.y[0] *= 1.0 - 1e-5
    strokes = integrate(engine, start, settings).strokes
    ends = strokes["x_end"][strokes["direction"] < 0.0]
    growth = np.diff(ends)[1:] / np.diff(ends)[:-1]
    assert growth[4:8] == pytest.approx(leading, rel=2e-3)
