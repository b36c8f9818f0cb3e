import dataclasses
import re

import pytest

from saleg import Performance
from saleg.simulation.performance import FIGURES
from saleg.simulation.readable import BY_NAME, BY_UNIT, FACTORS, readable


@pytest.mark.parametrize(
    ("name", "unit", "si", "read", "label"),
    [
        ("stroke", "m", 0.18, 180.0, "stroke [mm]"),
        ("displacement", "m^3", 1e-3, 1000.0, "displacement [cm^3]"),
        ("peak_pressure", "Pa", 1e5, 1.0, "peak pressure [bar]"),
        ("peak_pressure_rise", "Pa/s", 1e8, 1.0, "peak pressure rise [bar/ms]"),
        ("peak_acceleration", "m/s^2", 1e3, 1.0, "peak acceleration [km/s^2]"),
        ("power", "W", 1e3, 1.0, "power [kW]"),
        ("power_density", "W/kg", 1e3, 1.0, "power density [kW/kg]"),
        ("springs.stiffness", "N/m", 1e4, 10.0, "springs: stiffness [kN/m]"),
        ("efficiency", "-", 0.25, 25.0, "efficiency [%]"),
        ("compression_ratio", "-", 17.0, 17.0, "compression ratio [-]"),
        ("charge_mass", "kg", 1e-3, 1.0, "charge mass [g]"),
        ("t", "s", 2.0, 2.0, "time [s]"),
        ("burn_centre", "s", 1e-3, 1.0, "burn centre [ms]"),
        ("intake.temperature", "K", 300.0, 300.0, "intake temperature [K]"),
    ],
)
def test_readable_units(name, unit, si, read, label):
    shown = readable(name, unit)
    assert shown.of(si) == pytest.approx(read, rel=1e-15)
    assert shown.label == label


def test_every_readable_unit_has_a_factor():
    assert set(BY_UNIT.values()) | (set(BY_NAME.values()) - {"s"}) <= set(FACTORS)


def test_every_field_of_a_performance_is_described():
    names = {item.name for item in dataclasses.fields(Performance)}
    assert set(FIGURES) == names
    section = Performance.__doc__.partition("Attributes")[2]
    described = re.findall(r"^    ([a-z_, ]+) : float$", section, flags=re.MULTILINE)
    assert {name for line in described for name in line.split(", ")} == names
