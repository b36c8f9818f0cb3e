"""Wrong fields of an engine: all of them named at once, and no other."""

import dataclasses
import math

import pytest

import saleg
from saleg import InvalidEngine, laws
from saleg.engine.columns import is_sound, is_usual, rows_by_make

PORTS = laws.PortFlow


@dataclasses.dataclass(frozen=True)
class SootyWall(laws.Wall):
    states = ("mass_of_soot",)

    def temperature_rate(self, temperature: float, heat: float) -> float:
        return 0.0


BOUNCE = {"bore": -1.0, "half_stroke": math.nan, "pressure": "a"}


@pytest.mark.parametrize(
    ("changes", "fields"),
    [
        # A law of the wrong kind hides nothing, and nothing in it counts.
        (
            {"left.wall": PORTS(exhaust_width=-1.0), "translator.mass": -1.0, "left.bore": -1.0},
            ["left.wall", "translator.mass", "left.bore"],
        ),
        (
            {"right": saleg.BounceChamber(**BOUNCE, leak=PORTS())},
            ["right.leak", "right.bore", "right.half_stroke", "right.pressure"],
        ),
        # Fields that are right are not blamed for what stands beside them.
        (
            {"right": saleg.BounceChamber(**BOUNCE)},
            ["right.bore", "right.half_stroke", "right.pressure"],
        ),
        (
            {"left.back_area": -1.0, "left.back_pressure": math.nan},
            ["left.back_area", "left.back_pressure"],
        ),
        ({"head_gap": 0.5}, ["head_gap"]),
        ({"port_closing": 0.25, "gas_exchange": PORTS(intake_delay=0.3)}, ["port_closing"]),
        # What is wrong elsewhere hides no rule.
        (
            {
                "gas_exchange": PORTS(exhaust_width=-1.0, intake_delay=0.3),
                "supply": laws.Crankcase(volume_at_midpoint=1e-6),
            },
            [
                "gas_exchange.exhaust_width",
                "gas_exchange.intake_delay",
                "supply.volume_at_midpoint",
            ],
        ),
        # Nor does the class of a law.
        (
            {"right.wall": SootyWall(), "translator.mass": -1.0},
            ["translator.mass", "right.wall"],
        ),
    ],
)
def test_one_error_names_every_wrong_field_and_no_other(base, changes, fields):
    with pytest.raises(InvalidEngine) as error:
        base.replace(**changes).validate()
    assert [problem.path for problem in error.value.problems] == fields


def test_windows_are_no_taller_than_the_stroke(base):
    most = base.maximum_stroke
    fits = PORTS(exhaust_height=most, intake_height=most)
    assert base.replace(gas_exchange=fits).problems() == []
    taller = PORTS(exhaust_height=5.0, intake_height=1.01 * most)
    wrong = base.replace(gas_exchange=taller)
    paths = [problem.path for problem in wrong.problems()]
    assert paths == ["gas_exchange.exhaust_height", "gas_exchange.intake_height"]
    rows = rows_by_make([base.replace(gas_exchange=ports) for ports in (fits, taller)])[0]
    assert is_sound(rows).tolist() == [True, False]


def test_windows_wider_than_the_circumference_are_unusual(base):
    widths = (0.2, 0.21)  # of pi 64 mm = 201 mm
    engines = [base.replace(gas_exchange=PORTS(intake_width=width)) for width in widths]
    assert [len(engine.unusual()) for engine in engines] == [0, 1]
    assert engines[1].unusual()[0].path == "gas_exchange.intake_width"
    assert is_usual(rows_by_make(engines)[0]).tolist() == [True, False]
