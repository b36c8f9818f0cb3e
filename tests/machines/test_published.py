"""Machines of others: what is given stands in them, and what was found is on the page."""

import csv
import math

import pytest

import saleg
from helpers import ROOT
from saleg.engine.start import adiabatic_rise
from saleg.machines import PUBLISHED, OpenQuantity, Published, PublishedMachine
from saleg.studies import compare_published, explain_published
from saleg.thesis.tables import columns

PAGE = (ROOT / "docs" / "machines.md").read_text(encoding="utf-8")
OURS = ROOT / "src" / "saleg" / "machines" / "ours.csv"
#: Greatest deviation of a number from that kept: another machine rounds otherwise.
SAME = 0.01
#: What machines.md of the sources' printed numbers gives: paths and values in SI.
GIVEN = {
    "polimi": {
        "left.bore": 0.068,
        "left.ignition.clearance": 0.015,
        "left.heat_release.a": 6.908,
        "left.heat_release.combustion_duration": 3e-3,
        "translator.mass": 4.8,
        "friction.coefficient": 12.0,
        "alternator.load_constant": 250.0,
    },
    "newcastle": {"left.bore": 0.131, "translator.mass": 22.0, "left.intake.pressure": 1.5e5},
}


@pytest.fixture(scope="module")
def compared():
    return {name: compare_published(machine) for name, machine in PUBLISHED.items()}


@pytest.mark.parametrize(("name", "column"), [("ulsan", "ulsan"), ("wvu", "wvu")])
def test_prototypes_hold_what_table_6_prints(name, column):
    printed, engine = columns(6)[column], PUBLISHED[name].engine()
    assert engine.get("bore") == printed["bore"]
    assert engine.maximum_stroke == pytest.approx(printed["maximum_stroke"])
    assert engine.get("port_closing") == printed["exhaust_port_location"]
    assert engine.get("moving_mass") == printed["mass"]
    assert engine.get("springs.stiffness") == printed["spring_stiffness"]
    squeezed = printed["intake_pressure"] / engine.get("intake.pressure")
    heated = printed["intake_temperature"] / engine.get("intake.temperature")
    assert heated == pytest.approx(squeezed ** (0.4 / 1.4))
    case = engine.get("supply")
    most, least = (case.volume(place * engine.left.half_stroke) for place in (-1.0, 1.0))
    assert (most / least) ** 1.4 == pytest.approx(squeezed)


def test_ulsan_burns_propane_at_the_equivalence_ratio_printed():
    printed, engine = columns(6)["ulsan"], saleg.machines.ulsan()
    assert engine.get("equivalence_ratio") == printed["equivalence_ratio"]
    heat = engine.get("fuel.lower_heating_value")
    assert heat == pytest.approx(printed["lower_heating_value"], rel=2e-3)


@pytest.mark.parametrize("name", GIVEN)
def test_single_pistons_hold_what_is_given(name):
    engine = PUBLISHED[name].engine()
    assert {path: engine.get(path) for path in GIVEN[name]} == pytest.approx(GIVEN[name])


def test_the_gas_spring_of_milan_is_that_at_bottom_dead_centre():
    """0.2696 dm3 and 0.99 MPa there, and published is a compression ratio of 4.01."""
    spring = saleg.machines.polimi().right
    least = (spring.half_stroke - 0.05) * spring.area
    assert least == pytest.approx(0.2696e-3)
    squeeze = spring.half_stroke * spring.area / least
    assert spring.pressure * adiabatic_rise(spring, squeeze) == pytest.approx(0.99e6, rel=1e-6)
    assert (least + 0.1 * spring.area) / least == pytest.approx(4.01, rel=0.01)


def test_the_inward_stroke_of_milan_leaves_no_place_for_an_atmosphere():
    """Work of the spring, of compressing 1 bar from the ports by 1.35, and of load and friction."""
    area, least, gamma = 0.808e-2, 0.2696e-3, 1.4
    most = least + 0.1 * area
    outer = 0.99e6 * (least / most) ** gamma
    spring = (0.99e6 * least - outer * most) / (gamma - 1.0)
    bore_area = math.pi * 0.068**2 / 4.0
    closed, n = 0.08604, 1.35
    compression = 1e5 * bore_area * closed / (n - 1.0) * ((closed / 0.01104) ** (n - 1.0) - 1.0)
    speed_squared = 0.5 * (math.pi * 28.32 * 0.1) ** 2
    taken = compression + (250.0 + 12.0) * speed_squared * 0.5 / 28.32
    atmosphere = 1e5 * (area - bore_area) * 0.1
    assert spring == pytest.approx(284.0, abs=1.0)
    assert taken == pytest.approx(277.0, abs=2.0)
    assert taken + atmosphere > spring + 30.0


def test_a_pair_of_ulsans_stiffest_springs_makes_46_hz_of_35():
    """The pair's stiffness beside that of a gas on which 0.8 kg swings at 35 Hz; measured 47 Hz."""
    engine = saleg.machines.ulsan(14.7e3)
    pair = 2.0 * engine.get("springs.stiffness")
    gas = engine.get("moving_mass") * (2.0 * math.pi * 35.0) ** 2
    frequency = math.sqrt((gas + pair) / engine.get("moving_mass")) / (2.0 * math.pi)
    assert frequency == pytest.approx(46.4, abs=0.1)


def test_open_quantities_lie_within_their_ranges():
    for machine in PUBLISHED.values():
        engine = machine.engine()
        engine.validate()
        assert engine.name == machine.name
        for one in machine.open_quantities:
            assert one.low <= engine.get(one.path) <= one.high, one.path
            assert one.low < one.high
            for end in (one.low, one.high):
                engine.replace(**{one.path: end}).validate()
        assert len({item.label for item in machine.published}) == len(machine.published)


def test_west_virginia_burns_25_joules_a_stroke_of_nine_tenths():
    state = saleg.steady_state(saleg.machines.wvu())
    released = state.strokes["heat_released"].sum(axis=-1)
    assert released == pytest.approx(25.0, rel=0.01)
    assert state.performance.stroke == pytest.approx(0.9 * 0.050, rel=0.01)


def test_milan_and_newcastle_hold_the_fuel_their_results_imply():
    for name in ("polimi", "newcastle"):
        found = {item.figure: item.value for item in PUBLISHED[name].published}
        heat = found["power"] / found["frequency"] / found["efficiency"]
        engine = PUBLISHED[name].engine()
        fuel = saleg.start.standard_charge(engine.left)[1]
        assert fuel * engine.left.fuel.lower_heating_value == pytest.approx(heat)


def test_the_page_and_the_package_have_what_comes_out(compared):
    with OURS.open(encoding="utf-8") as file:
        kept = {(row["machine"], row["result"]): float(row["ours"]) for row in csv.DictReader(file)}
    assert len(kept) == sum(map(len, compared.values()))
    for name, rows in compared.items():
        section = PAGE.split(f"\n## {PUBLISHED[name].title}\n")[1].split("\n## ")[0]
        for result, ours, off in rows:
            assert kept[name, result.label] == pytest.approx(ours, rel=SAME)
            assert PUBLISHED[name].deviations()[result.label] == pytest.approx(off, abs=SAME)
            (line,) = (
                line for line in section.splitlines() if line.startswith(f"| {result.label} | ")
            )
            told = float(line.split(" | ")[4].removesuffix(" %")) / 100.0
            assert told == pytest.approx(off, abs=SAME * abs(1.0 + off) + 1e-3)


def test_published_values_set_what_the_source_leaves_open(compared):
    for rows in compared.values():
        for result, _, off in rows:
            if result.held_by:
                assert off == pytest.approx(0.0, abs=2e-3)


def test_what_explains_a_deviation_is_found(base):
    """A machine of our own whose load was another one: that explains its results, and no other."""
    truth = saleg.steady_state(base.replace(**{"alternator.load_constant": 75.0})).performance
    machine = PublishedMachine(
        name="planted",
        title="Base case with another load",
        source="ours",
        is_measured=False,
        engine=lambda: base,
        given=(),
        open_quantities=(
            OpenQuantity("alternator.load_constant", 60.0, 82.0, "planted"),
            OpenQuantity("friction.coefficient", 11.0, 13.0, "of no account"),
        ),
        published=(
            Published("peak_pressure", truth.peak_pressure),
            Published("compression_ratio", truth.compression_ratio),
        ),
    )
    for found in explain_published(machine):
        (cause,) = found.explaining
        assert cause == found.nearest
        assert cause.path == "alternator.load_constant"
        assert cause.value == pytest.approx(75.0, abs=1.0)
        assert abs(cause.deviation) < 0.01
        assert found.least < found.result.value < found.greatest


def test_what_a_published_value_sets_is_set_anew(base):
    """The stroke is held by the load, so that friction alone explains a power lost to it."""
    rough = base.replace(**{"friction.coefficient": 18.0})
    stroke = saleg.steady_state(base).performance.stroke
    held = Published("stroke", stroke, held_by="alternator.load_constant")
    lost = saleg.steady_state(rough).performance.power
    machine = PublishedMachine(
        name="planted",
        title="Base case with more friction",
        source="ours",
        is_measured=False,
        engine=lambda: base,
        given=(),
        open_quantities=(OpenQuantity("friction.coefficient", 8.0, 24.0, "planted"),),
        published=(held, Published("power", lost)),
    )
    ((found,),) = (one.explaining for one in explain_published(machine))
    engine = base.replace(**{"friction.coefficient": found.value})
    assert found.value > base.get("friction.coefficient")
    assert abs(found.deviation) < 0.02
    assert saleg.steady_state(engine).performance.stroke < stroke
