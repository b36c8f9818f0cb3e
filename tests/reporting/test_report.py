"""Reports: what stands in the page, and that it is whole in itself."""

import math
import re
from html import unescape

import pytest

import saleg
from saleg.cli import main
from saleg.reporting import ReportError, document
from saleg.studies import elasticities


@pytest.fixture(scope="module")
def steady(base):
    return saleg.steady_state(base)


def words(page):
    """Text of a page, tags and styles apart."""
    body = page.partition("<body>")[2]
    return re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]+>", " ", body)))


def test_the_page_says_what_there_is_to_say(steady, tmp_path):
    path = saleg.report(steady, tmp_path / "new" / "base.html")
    page = path.read_text("utf-8")
    told = words(page)
    for text in (
        "thesis-base",
        "rtol 1e-06",
        "mean electrical power 22.599 kW",
        "piston",
        "p-V diagram",
        "phase portrait",
        "forces on the translator",
        "electrical output 481 J, 34.1 %",
        "stability: stable",
        "ChangGas is for temperature 550 to 2150 K",
        f"saleg {saleg.__version__}",
        "bore = 0.064 # m",
    ):
        assert text in told, text
    assert not re.search(r"<script|<link|@import|url\(|\bsrc=", page)


def test_a_name_is_text(base):
    page = document.page(saleg.steady_state(base.replace(name="<img src=x> & co")))
    assert "<img" not in page
    assert "&lt;img src=x&gt; &amp; co" in page


def test_a_run_without_a_cycle_and_one_that_is_not_steady(base):
    nothing = words(document.page(saleg.simulate(base, 1e-3)))
    assert "no full cycle to draw" in nothing
    assert "stability: stable" in nothing  # of the steady state of its engine
    short = words(document.page(saleg.simulate(base, 0.05)))
    assert "from: stored energy" in short  # the gas of the start gave some
    assert "course of the run" in short
    dead = words(document.page(saleg.steady_state(base.replace(equivalence_ratio=0.0))))
    assert "no steady state to vary" in dead


def test_a_file_in_the_way_and_a_wrong_name(steady, tmp_path):
    target = tmp_path / "a.html"
    target.write_text("mine")
    with pytest.raises(saleg.errors.RunFileError, match="exists already"):
        saleg.report(steady, target)
    assert target.read_text() == "mine"
    with pytest.raises(ReportError, match=r"must end in \.html"):
        saleg.report(steady, tmp_path / "a.pdf")


def test_elasticities_beside_steady_states(base):
    """The logarithmic derivative, from steady states solved one by one with other steps."""
    table = elasticities(base, ["moving_mass", "intake.pressure"])
    assert list(table.index) == ["moving_mass", "intake.pressure"]
    for path in table.index:
        powers = [
            saleg.steady_state(base.replace(**{path: factor * base.get(path)})).performance.power
            for factor in (math.exp(0.005), math.exp(-0.005))
        ]
        assert table.loc[path, "power"] == pytest.approx(
            math.log(powers[0] / powers[1]) / 0.01, abs=0.01
        )


def test_elasticities_of_unlike_sides_and_of_nothing(base):
    bounce = saleg.BounceChamber(bore=0.064, half_stroke=0.15, pressure=4e5)
    table = elasticities(base.replace(right=bounce), ["half_stroke", "pressure"], ["stroke"])
    assert table.notna().all(axis=None)
    dead = elasticities(base.replace(equivalence_ratio=0.0), ["bore", "equivalence_ratio"])
    assert list(dead.index) == ["bore"]  # 0 has no relative change
    assert dead.isna().all(axis=None)


def test_the_command(capsys, tmp_path):
    out = tmp_path / "out"
    assert main(["report", "thesis-base", "--set", "egr=0.13", "--out", str(out)]) == 0
    assert [path.name for path in out.iterdir()] == ["report.html"]
    assert "EGR 13 %" in words((out / "report.html").read_text("utf-8"))
    assert main(["report", "thesis-base", "--out", str(out)]) == 2
    assert "add --force" in capsys.readouterr().err
    assert main(["report", "thesis-bass", "--out", str(tmp_path / "b")]) == 2
    assert "'thesis-base'" in capsys.readouterr().err


def test_the_command_on_a_saved_run(base, capsys, tmp_path):
    saleg.simulate(base, 0.5).save(tmp_path / "run.npz")
    where = ["--out", str(tmp_path / "out")]
    assert main(["report", str(tmp_path / "run.npz"), *where]) == 0
    assert "run of 0.5 s" in words((tmp_path / "out" / "report.html").read_text("utf-8"))
    assert main(["report", str(tmp_path / "run.npz"), "--set", "egr=0.1", *where, "--force"]) == 2
    assert "a run that is over" in capsys.readouterr().err
