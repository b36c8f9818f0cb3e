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


def of_nothing(engine):
    """Validity of an engine that has not run."""
    return validity_of(engine, saleg.Performance.of_nothing(engine), np.zeros(0, STROKE_RECORD), [])


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


def test_a_machine_supports_what_it_meets():
    """West Virginia's power within 5 %, of that engine itself and of one a tenth larger."""
    engine = saleg.machines.wvu()
    for like in (engine, engine.replace(bore=1.1 * engine.get("bore"))):
        nearest = of_nothing(like).nearest
        assert (nearest.name, nearest.is_measured) == ("wvu", True)
        assert nearest.differences == ()
        assert nearest.supported == ("power",)
        assert abs(nearest.deviations["power"]) < 0.1
    ulsan = of_nothing(saleg.machines.ulsan()).nearest
    assert (ulsan.name, ulsan.supported) == ("ulsan", ())
    assert ulsan.differences == ()


def test_beyond_half_as_much_again_nothing_is_supported():
    engine = saleg.machines.wvu()
    wide = engine.replace(bore=1.6 * engine.get("bore"))
    nearest = of_nothing(wide).nearest
    assert nearest.supported == ()
    assert any(text.startswith("bore ") for text in nearest.differences)


def test_an_engine_that_burns_nothing_is_near_to_none():
    chamber = saleg.BounceChamber(bore=0.06, half_stroke=0.1)
    engine = saleg.Engine.mirrored(saleg.Translator(mass=2.0), chamber)
    report = of_nothing(engine)
    assert report.nearest is None
    assert str(report) == ""
    assert report.table.empty
