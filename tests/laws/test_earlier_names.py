"""Laws written with the earlier names of what they are shown, against the same laws today."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

import saleg
from helpers import compiled_method
from saleg.compiler.compiled_engine import kernel_for
from saleg.compiler.controllers import control_of
from saleg.compiler.slot_text import methods_text
from saleg.engine.controller import Controller
from saleg.laws import Gas, GasProperties, HeatTransfer, StateLogic

GAS = Gas(50e5, 1500.0, 1e-4, 45e5, 0.03, 0.064, 12.0, 550.0, 1.0, -3.0, 2e9)


def sized(law, gas):
    return law.height * gas.clearance


@dataclass(frozen=True)
class EarlierHeatTransfer(HeatTransfer):
    scale: float = 60.0

    def coefficient(self, gas, charge):
        inward = 1.0 if gas.height_rate < 0.0 else 0.5
        return self.scale * inward * gas.p**0.8 * gas.height**-0.2 * area_of(gas) ** 0.1 / 1e3


@dataclass(frozen=True)
class TodaysHeatTransfer(HeatTransfer):
    scale: float = 60.0

    def coefficient(self, gas, charge):
        inward = 1.0 if gas.clearance_rate < 0.0 else 0.5
        return self.scale * inward * gas.p**0.8 * gas.clearance**-0.2 * area_of(gas) ** 0.1 / 1e3


def area_of(gas):
    return math.pi * gas.bore * gas.height


@dataclass(frozen=True)
class OfItsOwnHeight(HeatTransfer):
    """A field of the law's own is no earlier name, wherever it is read."""

    height: float = 2000.0

    def coefficient(self, gas, charge):
        return self.height * gas.height + sized(self, gas)


@dataclass(frozen=True)
class EarlierGas(GasProperties):
    gas_constant: float = 287.0

    def gamma(self, T):
        return 1.40 - 1e-4 * min(T, 1500.0)

    def internal_energy(self, T):
        heat = self.gas_constant * 1e4
        below = heat * -math.log1p(-min(T, 1500.0) / 4000.0)
        return below + self.gas_constant / 0.25 * max(T - 1500.0, 0.0)

    def kink(self):
        return 1500.0


@dataclass(frozen=True)
class TodaysGas(EarlierGas):
    def breakpoint(self):
        return 1500.0


@dataclass(frozen=True)
class EarlierLogic(StateLogic):
    def motors(self, held, signals):
        held[0] += 1.0
        return 1.0 if held[0] < 3.0 else 0.0


def test_a_gas_is_read_and_made_by_earlier_names():
    assert (GAS.height, GAS.height_rate) == (GAS.clearance, GAS.clearance_rate) == (0.03, -3.0)
    named = GAS._asdict()
    named["height"], named["height_rate"] = named.pop("clearance"), named.pop("clearance_rate")
    with pytest.warns(DeprecationWarning, match="is called clearance"):
        assert Gas(**named) == GAS
    assert Gas(*GAS) == GAS == GAS._replace(p=GAS.p)


def test_a_method_by_its_earlier_name_is_taken_for_todays():
    assert EarlierGas().breakpoint() == 1500.0
    assert EarlierLogic().is_motor(np.zeros(4), None) == 1.0


def test_both_faces_of_an_earlier_law_are_those_of_todays(base):
    """They are composed to one text: one kernel serves both."""
    earlier = base.replace(heat_transfer=EarlierHeatTransfer(), gas_properties=EarlierGas())
    todays = base.replace(heat_transfer=TodaysHeatTransfer(), gas_properties=TodaysGas())
    assert EarlierHeatTransfer().coefficient(GAS, None) == TodaysHeatTransfer().coefficient(
        GAS, None
    )
    assert kernel_for(earlier).module.__file__ == kernel_for(todays).module.__file__
    for law, method, given in (
        (EarlierHeatTransfer(), "coefficient", (GAS, None)),
        (EarlierGas(), "gamma", (1200.0,)),
        (EarlierGas(), "internal_energy", (1200.0,)),
        (EarlierGas(), "breakpoint", ()),
    ):
        wanted = getattr(law, method)(*given)
        assert compiled_method(law, method)(*given) == pytest.approx(wanted, rel=1e-14)
    runs = [saleg.reference.simulate(engine, 0.03, rtol=1e-6) for engine in (earlier, todays)]
    assert runs[0].strokes["electrical_energy"].max() > 20.0
    np.testing.assert_array_equal(*(run.strokes for run in runs))


def test_a_field_of_that_name_stays_the_laws_own():
    law = OfItsOwnHeight()
    assert law.coefficient(GAS, None) == 2.0 * 2000.0 * 0.03
    text = "\n".join(methods_text(OfItsOwnHeight, "coefficient", "one", HeatTransfer))
    names = {"inline": lambda function: function}
    exec(text, names)
    assert "gas.clearance" in text
    assert names["one_coefficient"](law, GAS, None) == law.coefficient(GAS, None)
    assert "gas.height" not in text.replace("sized", "")


def test_a_part_of_a_controller_by_its_earlier_name_compiles():
    assert control_of(Controller(state_logic=EarlierLogic())).address != 0
