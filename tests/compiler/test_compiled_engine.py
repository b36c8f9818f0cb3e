"""An engine as the integrator takes it: kernel, numbers, controller."""

import numpy as np
import pytest

import saleg
from saleg import BounceChamber, Controller, Engine, Translator
from saleg.compiler.compiled_engine import compiled_engine, kernel_for
from saleg.laws import NoHeatTransfer, Wiebe


def test_engines_with_the_same_laws_share_a_kernel(base):
    one, other = compiled_engine(base), compiled_engine(base.replace(bore=0.05))
    assert one.kernel is other.kernel is kernel_for(base)


def test_the_record_holds_the_numbers_of_the_laws_by_slot(base):
    engine = base.replace(
        **{"spring.stiffness": 21e3, "left.heat_release.combustion_duration": 0.004}
    )
    found = compiled_engine(engine).parameters
    assert found["springs"]["stiffness"] == [21e3]
    assert found["left"]["heat_release"]["combustion_duration"] == [0.004]
    right = base.right.heat_release.combustion_duration
    assert found["right"]["heat_release"]["combustion_duration"] == [right]


def test_a_series_of_numbers_is_an_array_in_the_record(base):
    law = saleg.laws.ProgressiveSprings()
    found = compiled_engine(base.replace(springs=law)).parameters
    np.testing.assert_array_equal(found["springs"]["stiffnesses"], [law.stiffnesses])


def test_a_bounce_chamber_has_idle_laws_of_combustion(base):
    bounce = BounceChamber(bore=0.064, half_stroke=0.1)
    engine = Engine(translator=Translator(mass=2.4), left=base.left, right=bounce)
    found = compiled_engine(engine).parameters
    assert found["right"]["heat_release"]["a"] == [Wiebe().a]
    assert isinstance(bounce.laws["heat_transfer"], NoHeatTransfer)


@pytest.mark.parametrize("asks", [True, False])
def test_a_controller_is_asked_or_not(base, asks):
    found = compiled_engine(base, Controller(), asks=asks)
    assert (found.control[0] != 0) is asks
    assert (
        found.parameters.dtype["actuators"] == compiled_engine(base).parameters.dtype["actuators"]
    )
