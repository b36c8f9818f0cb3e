"""Validity of a result: laws outside their ranges, implausible figures, the nearest machine."""

import dataclasses
from html import unescape

import numpy as np
import pytest

import saleg
from saleg.kernel.layout import STROKE_RECORD
from saleg.reporting import document
from saleg.simulation.plausibility import LIMITS
from saleg.simulation.validity import validity_of
from saleg.thesis.tables import columns


def of_figures(engine, *, released=1.0, **figures):
    """Validity of an engine that made some figures with some heat."""
    strokes = np.zeros(2, STROKE_RECORD)
    strokes["heat_released"] = released
    nothing = saleg.Performance.of_nothing(engine)
    return validity_of(engine, dataclasses.replace(nothing, **figures), strokes, [])


@pytest.fixture(scope="module")
def first(base):
    return saleg.steady_state(base)


def test_the_base_case_is_plausible_and_like_no_machine(first):
    """Auto-ignited methane: those of others light petrol, propane and diesel at a moment."""
    report = first.validity
    assert report.implausible == ()
    assert {(row["side"], row["law"]) for row in report.range_exits} == {
        ("left", "ChangGas"),
        ("right", "ChangGas"),
    }
    assert report.nearest.supported == ()
    assert "auto-ignition (its spark or injection)" in report.nearest.differences
    assert "another fuel" in report.nearest.differences
    assert "supported by no published machine; nearest is " in str(report)


def test_a_run_says_the_same_as_its_steady_state(base, first):
    run = saleg.simulate(base, 1.0)
    assert run.validity.nearest == first.validity.nearest
    assert run.validity.implausible == ()
    for one, same in zip(first.validity.range_exits, run.validity.range_exits, strict=True):
        assert one["seen_high"] == pytest.approx(same["seen_high"], rel=1e-4)


def test_text_cards_and_reports_say_it(first):
    """Which law left its range and how far, which figure is implausible, what supports it."""
    report, peak = first.validity, first.performance.peak_temperature
    told = f"for temperature 550 to 2150 K, saw 325.1 to {peak:.4g}, outside for "
    share = f"{100.0 * report.range_exits[0]['time_share']:.3g} % of its time"
    page = unescape(document.page(first))
    for text in (str(first), unescape(first._repr_html_()), page):
        assert told + share in text
        assert f"earest is {report.nearest.name}" in text
        assert report.nearest.differences[0] in text
    harsh = saleg.steady_state(
        first.engine.replace(**{"intake.pressure": 6e5, "equivalence_ratio": 0.9})
    )
    page = unescape(document.page(harsh))
    for figure in harsh.validity.implausible:
        assert f"{figure}: {figure.reason}" in page
        assert f"beyond what is built: {figure}" in unescape(harsh._repr_html_())


def test_both_sides_of_an_engine_count_in_what_a_law_saw(base):
    """The hotter side is told, be it left or right."""
    hot = base.replace(**{"right.equivalence_ratio": 0.7})
    for engine in (hot, dataclasses.replace(hot, left=hot.right, right=hot.left)):
        found = saleg.steady_state(engine)
        highest = max(row["seen_high"] for row in found.validity.range_exits)
        assert f"to {highest:.4g}, outside" in str(found)


def test_nothing_is_supported_where_there_is_no_figure(base):
    stalled = saleg.simulate(base.replace(**{"alternator.load_constant": 300.0}), 2.0)
    assert "nearest" not in str(stalled)


def test_what_is_beyond_a_limit_is_told_with_its_reason(base):
    harsh = saleg.steady_state(base.replace(**{"intake.pressure": 6e5, "equivalence_ratio": 0.9}))
    found = {figure.name: figure for figure in harsh.validity.implausible}
    pressure = found["peak pressure"]
    assert pressure.value == pytest.approx(harsh.performance.peak_pressure / 1e5)
    assert (pressure.limit, pressure.unit) == (400.0, "bar")
    assert "250 bar" in pressure.reason
    rows = harsh.validity.table
    assert pressure.reason in set(rows.reason)
    assert f"implausible: {pressure}; {pressure.reason}" in str(harsh.validity)
    assert harsh.remarks == [str(figure) for figure in harsh.validity.implausible]


def test_the_limits_leave_room_for_every_printed_design():
    names = {"peak pressure": "peak_pressure", "compression ratio": "compression_ratio"}
    limits = {limit.name: limit for limit in LIMITS}
    for number in (9, 10, 11, 12):
        for column in columns(number).values():
            for name, printed in names.items():
                if printed in column:
                    value = limits[name].value({printed: column[printed]})
                    assert value < 0.7 * limits[name].highest


def test_the_rise_is_that_of_a_degree_of_the_cycle():
    """At 50 Hz a degree lasts 1/18000 s."""
    (rise,) = (limit for limit in LIMITS if limit.name == "steepest rise")
    figures = {"peak_pressure_rise": 1.8e10, "frequency": 50.0}
    assert rise.value(figures) == pytest.approx(10.0)


def test_a_machine_supports_the_figures_of_this_result():
    """West Virginia prints 309 W, of that engine within what its source leaves open."""
    engine = saleg.machines.wvu()
    open_ended = engine.replace(**{"friction.coefficient": 36.0, "leak.gap": 0.0}, name="mine")
    for one in (engine, open_ended, dataclasses.replace(engine, left=engine.right)):
        nearest = of_figures(one, frequency=40.0, power=300.0).nearest
        assert (nearest.name, nearest.is_measured, nearest.is_it) == ("wvu", True, True)
        assert nearest.differences == ()
        assert nearest.deviations == {"power": pytest.approx(300.0 / 309.0 - 1.0)}
        assert nearest.supported == ("power",)
        assert of_figures(one, frequency=40.0, power=200.0).nearest.supported == ()


def test_an_engine_like_a_machine_is_supported_by_what_ours_of_that_meets():
    engine = saleg.machines.wvu()
    like = engine.replace(bore=1.1 * engine.get("bore"))
    nearest = of_figures(like, frequency=40.0, power=500.0).nearest
    assert (nearest.name, nearest.is_it, nearest.differences) == ("wvu", False, ())
    assert nearest.supported == ("power",)
    assert nearest.deviations == saleg.machines.PUBLISHED["wvu"].deviations()


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("translator.mass", 25.0, "moving mass 25 (its 2.5) kg"),
        ("alternator.load_constant", 200.0, "load 200 (its "),
        ("intake.pressure", 2e5, "charge 2 (its 1) bar"),
        ("equivalence_ratio", 1.4, "equivalence ratio 1.4 (its "),
        ("bore", 1.6 * 0.0364, "bore 58.24 (its 36.4) mm"),
    ],
)
def test_half_as_much_again_of_what_a_machine_fixes_is_another_machine(path, value, told):
    engine = saleg.machines.wvu().replace(**{path: value})
    nearest = of_figures(engine, frequency=40.0, power=309.0).nearest
    if nearest.name == "wvu":
        assert any(text.startswith(told) for text in nearest.differences)
    assert nearest.supported == ()


def test_nothing_is_supported_without_fuel_that_burns():
    for name in ("wvu", "newcastle"):
        engine = saleg.machines.PUBLISHED[name].engine()
        for figures in ({}, {"frequency": 30.0, "released": 0.0}):
            nearest = of_figures(engine, **figures).nearest
            assert nearest.name == name
            assert nearest.supported == ()
            assert "this one does not run on fuel" in str(nearest)


def test_what_a_machine_is_set_to_is_no_support():
    """Newcastle's load and bounce pressure are set so that stroke and compression ratio are met."""
    engine = saleg.machines.newcastle()
    met = {"stroke": 0.150, "compression_ratio": 15.0, "frequency": 30.0, "power": 3e4}
    nearest = of_figures(engine, **met, efficiency=0.40).nearest
    assert set(nearest.deviations) == {"frequency", "power", "efficiency"}
    assert nearest.supported == ("frequency", "efficiency")
    other = of_figures(engine, **(met | {"compression_ratio": 20.0}), efficiency=0.42).nearest
    assert other.supported == ()
    assert "compression ratio +33 %" in str(other)


def test_what_is_published_for_other_numbers_is_left_out():
    """Ulsan's 47 Hz are those of its stiffest springs."""
    stiff = of_figures(saleg.machines.ulsan(14.7e3), frequency=46.0, efficiency=0.072).nearest
    assert stiff.is_it
    assert stiff.deviations["frequency at springs.stiffness 14700"] == pytest.approx(-1.0 / 47.0)
    assert set(stiff.supported) == set(stiff.deviations)
    assert len(stiff.deviations) == 2
    between = of_figures(saleg.machines.ulsan(5e3), frequency=40.0).nearest
    assert (between.is_it, between.deviations, between.supported) == (True, {}, ())


def test_either_side_counts_and_any_spark_is_a_spark(base):
    """One side with a spark is told as the other, and each kind of spark, by the law itself."""
    sparks = (saleg.laws.SparkAtClearance(), saleg.laws.SparkBeforeDeadCentre())
    for law in sparks:
        found = [
            of_figures(base.replace(**{f"{side}.ignition": law}), frequency=45.0).nearest
            for side in ("left", "right")
        ]
        assert found[0] == dataclasses.replace(found[1], differences=found[0].differences)
        assert set(found[0].differences) == set(found[1].differences)
        both = of_figures(base.replace(ignition=law), frequency=45.0).nearest
        assert not any("auto-ignition" in text for text in both.differences)


def test_an_engine_that_burns_nothing_is_near_to_none():
    chamber = saleg.BounceChamber(bore=0.06, half_stroke=0.1)
    engine = saleg.Engine.mirrored(saleg.Translator(mass=2.0), chamber)
    report = of_figures(engine)
    assert report.nearest is None
    assert str(report) == ""
    assert report.table.empty


def test_a_spark_foreseen_comes_when_asked_or_says_why_not(base):
    """With strokes alike at the time asked; where only one side fires both facts are told."""
    met = saleg.steady_state(base.replace(ignition=saleg.laws.SparkBeforeDeadCentre(1e-3)))
    assert met.performance.start_of_combustion == pytest.approx(1e-3, rel=1e-5)
    assert met.remarks == []
    late = saleg.steady_state(base.replace(ignition=saleg.laws.SparkBeforeDeadCentre(0.0)))
    (silent,) = late.remarks
    assert "cylinder has fuel and does not fire" in silent
    ratios = [row for row in late.validity.range_exits if row["quantity"] == "stroke_ratio"]
    assert ratios[0]["seen_low"] * ratios[1]["seen_high"] == pytest.approx(1.0)
    assert (ratios[0]["low"], ratios[0]["high"]) == (0.99, 1.01)


@pytest.mark.parametrize("name", ["polimi", "newcastle"])
def test_an_engine_with_one_cylinder_foresees_no_dead_centre(name):
    """Asked for 1 ms the spark would come 3.4 ms and 4.3 ms before dead centre."""
    engine = saleg.machines.PUBLISHED[name].engine()
    spark = engine.replace(ignition=saleg.laws.SparkBeforeDeadCentre(1e-3))
    with pytest.raises(saleg.InvalidEngine, match="must not foresee the dead centre"):
        spark.validate()
