"""Cards of results: well-formed, escaped, without script, with the numbers of the result."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import saleg
from saleg import continuation, optimize, sweep
from saleg.display.svg import Curve, chart

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def steady(base):
    return saleg.steady_state(base)


@pytest.fixture(scope="module")
def table():
    return sweep.run(sweep.grid({"bore": np.linspace(0.05, 0.064, 15)}))


@pytest.fixture(scope="module")
def results(base, base_run, steady, table):
    problem = optimize.Problem({"bore": (0.05, 0.07), "half_stroke": (0.06, 0.1)})
    designed = saleg.design.evaluate(bore=0.06)
    named = base.replace(name="<script>alert(1)</script> & co")
    points = sweep.saltelli_points({"egr": (0.1, 0.2), "bore": (0.05, 0.06)}, 8)
    return {
        "engine": base,
        "named": named,
        "lopsided": base.replace(right=saleg.BounceChamber(bore=0.05, half_stroke=0.14)),
        "run": base_run,
        "of a named engine": saleg.simulate(named, 0.1),
        "no cycle": saleg.simulate(base, 1e-3),
        "stalled": saleg.simulate(base.replace(**{"alternator.load_constant": 300.0}), 2.0),
        "steady": steady,
        "no steady state": saleg.steady_state(base.replace(equivalence_ratio=0.0)),
        "performance": steady.performance,
        "energy": base_run.energy,
        "stability": steady.stability,
        "design": designed.design,
        "designed": designed,
        "branch": continuation.branch(base, "alternator.load_constant", 68.0),
        "indices": sweep.indices(
            points.assign(area=points["bore"] ** 2 + 0.1 * points["egr"]), "area", ["egr", "bore"]
        ),
        "found": optimize.optimize(
            problem, optimize.GeneticAlgorithm(size=10), evaluations=20, seed=3
        ),
        "table": table,
        "cycles": base_run.cycles,
        "history": base_run.orbit.history,
        "comparison": saleg.compare({"base": steady, "<b>": base_run}),
    }


NAMES = (
    "engine",
    "named",
    "lopsided",
    "run",
    "of a named engine",
    "no cycle",
    "stalled",
    "steady",
    "no steady state",
    "performance",
    "energy",
    "stability",
    "design",
    "designed",
    "branch",
    "indices",
    "found",
    "table",
    "cycles",
    "history",
    "comparison",
)


def words(card):
    """All text of a card."""
    return " ".join(ET.fromstring(card).itertext())


@pytest.mark.parametrize("name", NAMES)
def test_a_card_is_well_formed_and_neither_runs_nor_loads_anything(results, name):
    card = results[name]._repr_html_()
    tree = ET.fromstring(card)
    assert not {"script", "link", "img", "style", "iframe"} & {item.tag for item in tree.iter()}
    assert "http" not in card.replace('xmlns="http://www.w3.org/2000/svg"', "")
    assert not re.search(r'\bon\w+="|javascript:', card)
    assert "nan" not in words(card)
    assert len(card) < 150_000


@pytest.mark.parametrize("name", NAMES)
def test_text_and_lines_of_a_card_have_the_colour_of_the_page(results, name):
    """Black on the black of a dark theme is how tables and charts get lost."""
    card = results[name]._repr_html_()
    assert not re.search(r"(?<![-\w])color:|#000|black|white(?!-space)", card)
    for item in ET.fromstring(card).iter(SVG + "text"):
        assert item.get("fill", "currentColor") == "currentColor"


def test_names_are_escaped(results):
    for name in ("named", "of a named engine"):
        assert "<script>alert(1)</script> & co" in words(results[name]._repr_html_())
    assert "<b>" in words(results["comparison"]._repr_html_())


def test_key_figures_stand_there_in_readable_units(steady, results):
    p, text = steady.performance, words(steady._repr_html_())
    for value, unit in (
        (f"{p.power / 1e3:.3f}", "kW"),
        (f"{100.0 * p.efficiency:.2f}", "%"),
        (f"{1e3 * p.stroke:.2f}", "mm"),
        (f"{1e-5 * p.peak_pressure:.2f}", "bar"),
    ):
        assert f"{value} {unit}" in text
    assert "stable" in text
    engine = words(results["engine"]._repr_html_())
    for row in ("bore 64 mm", "intake pressure 1.05 bar", "intake temperature 51.9 °C"):
        assert row in engine
    assert "64 | 50 mm" in words(results["lopsided"]._repr_html_())
    assert "Hohenberg(a=65.0" in engine


@pytest.mark.parametrize("name", ["engine", "run", "no cycle", "steady", "designed", "branch"])
def test_repr_is_short_and_names_the_engine(results, name):
    result = results[name]
    engine = result if isinstance(result, saleg.Engine) else result.engine
    assert len(repr(result)) < 110
    assert engine.name in repr(result)
    assert str(getattr(result, "status", "")) in repr(result)


def rectangles(card):
    section = next(ET.fromstring(card).iter(SVG + "g"))
    return [{k: v for k, v in item.items()} for item in section.iter(SVG + "rect")]


@pytest.mark.parametrize("name", ["engine", "lopsided"])
def test_cylinders_are_drawn_to_scale(results, name):
    """Crown to head is the half stroke, the height of a piston the bore, in mm of the section."""
    engine = results[name]
    boxes = rectangles(engine._repr_html_())
    for side, colour, sign in (("left", "#2B8FD6", -1.0), ("right", "#E0742C", 1.0)):
        chamber = getattr(engine, side)
        (piston,) = [box for box in boxes if box.get("fill") == colour]
        x, width = float(piston["x"]), float(piston["width"])
        crown = max(abs(x), abs(x + width))
        heads = [float(b["x"]) for b in boxes if float(b["height"]) > 1e3 * chamber.bore]
        walls = [min(abs(h), abs(h + 4.0)) for h in heads if h * sign > crown]
        assert float(piston["height"]) == pytest.approx(1e3 * chamber.bore)
        assert min(walls) - crown == pytest.approx(1e3 * chamber.half_stroke, rel=1e-3)


def test_a_loop_reaches_the_peak_pressure_and_the_volumes(base_run):
    """Places of ticks give the scale; the extremes of the curve are those of the cycle."""
    svg = next(ET.fromstring(base_run._repr_html_()).iter(SVG + "svg"))
    points = [
        np.array([pair.split(",") for pair in item.get("points").split()], dtype=float)
        for item in svg.iter(SVG + "polyline")
    ]
    texts = [item for item in svg.iter(SVG + "text") if re.fullmatch(r"\d+", item.text)]
    up = [item for item in texts if item.get("text-anchor") == "end"]
    low, high = up[0], up[-1]
    scale = (float(high.text) - float(low.text)) / (float(high.get("y")) - float(low.get("y")))
    at = float(low.text) + scale * (points[0][:, 1].min() + 4.0 - float(low.get("y")))
    assert at == pytest.approx(1e-5 * base_run.performance.peak_pressure, rel=2e-3)
    volumes = base_run.orbit.history["V_left"]
    ratio = base_run.performance.compression_ratio
    assert volumes.max() / volumes.min() == pytest.approx(ratio, rel=1e-3)
    assert len(points) == 2


def test_a_chart_of_nothing_and_of_a_constant_is_drawn():
    for values in (np.full(3, np.nan), np.zeros(3), np.full(3, 5.0), np.array([1e-9, 2e-9, 3e-9])):
        svg = chart("a", [Curve(np.arange(3.0), values, "red")], "x", "y & z")
        assert "nan" not in svg
        assert ET.fromstring(svg).get("viewBox") == "0 0 340 230"


def test_a_table_shows_its_ends_with_units(table):
    text = words(table._repr_html_())
    assert "15 rows: 15 steady" in text
    assert "50 " in text
    assert "64 " in text
    heads = [item.text for item in ET.fromstring(table._repr_html_()).iter("th")]
    width = len(table.columns) + 1
    units = dict(zip(heads[:width], heads[width:], strict=True))
    assert (units["bore"], units["peak_pressure"], units["power"]) == ("mm", "bar", "kW")
    assert heads[width - 1] == "message"


def test_a_table_stays_a_data_frame_of_si_numbers(table):
    assert table["bore"].iloc[0] == 0.05
    kept = table[table["bore"] > 0.06].sort_values("power")
    assert "4 rows" in words(kept[["bore", "power"]]._repr_html_())
    plain = table.copy()
    plain.attrs = {}
    assert "<table" in plain._repr_html_()
