"""Numbers of the gallery and the comparison: within what is claimed, and as the pages have them."""

import importlib.util
import math
from functools import partial

import numpy as np
import pytest

from helpers import ROOT
from saleg.thesis import claims, printed_tables
from saleg.thesis.figures import FIGURES

PAGES = {
    name: (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    for name in ("gallery", "comparison")
}
PICTURES = ROOT / "docs" / "images" / "gallery"
#: Greatest deviation of a number from that of a page: another machine rounds otherwise.
SAME = 0.01


def by_run():
    """What is shown, grouped by what is run for it."""
    groups = {}
    for shown in claims.SHOWN:
        run = FIGURES[shown.figures[0]].run
        key = (run.func, repr(run.args)) if isinstance(run, partial) else run
        groups.setdefault(key, []).append(shown)
    return [
        pytest.param(
            group,
            id=str(group[0].figures[0]),
            marks=[pytest.mark.long] if is_long(group) else [],
        )
        for group in groups.values()
    ]


def is_long(group):
    return any(number in claims.LONG for shown in group for number in shown.figures)


def rows(page):
    """Rows of the tables of a page, each a list of cells."""
    return [
        [cell.strip() for cell in line.strip().strip("|").split(" | ")]
        for line in PAGES[page].splitlines()
        if line.startswith("|")
    ]


def same(text, value):
    number = float(text)
    return math.isclose(number, value, rel_tol=SAME, abs_tol=1e-6)


@pytest.mark.parametrize("group", by_run())
def test_a_claim_holds_and_stands_on_the_pages(group):
    found = claims.data(group[0])
    gallery, comparison = rows("gallery"), rows("comparison")
    for shown in group:
        for claim in shown.claims:
            value = claim.ours(found)
            assert claim.low <= value <= claim.high, claim.what
            figures = ", ".join(map(str, shown.figures))
            (row,) = (row for row in comparison if row[:2] == [figures, claim.what])
            assert row[2] == claim.printed
            assert same(row[3], value), claim.what
            assert [claim.what, claim.printed, row[3]] in gallery


def test_all_figures_with_data_are_shown_once():
    numbers = [number for shown in claims.SHOWN for number in shown.figures]
    assert numbers == sorted(FIGURES)
    for shown in claims.SHOWN:
        assert shown.claims
        assert f"**{shown.title}**" in PAGES["gallery"]
        assert f" {shown.says}\n" in PAGES["gallery"]
        assert (PICTURES / f"figure_{shown.figures[0]}.png").is_file()
        assert f"images/gallery/figure_{shown.figures[0]}.png" in PAGES["gallery"]


def test_pictures_of_the_gallery_are_small():
    pictures = list(PICTURES.iterdir())
    assert len(pictures) == len(claims.SHOWN)
    assert sum(picture.stat().st_size for picture in pictures) < 4e6


@pytest.mark.parametrize(
    "title",
    [
        pytest.param(
            title,
            marks=[pytest.mark.long] if title in printed_tables.LONG else [],
        )
        for title in printed_tables.TABLES
    ],
)
def test_a_table_stands_on_the_page(title):
    section = PAGES["comparison"].split(f"\n## {title}\n")[1].split("\n## ")[0]
    lines = [line.strip("| ").split(" | ") for line in section.splitlines() if "|" in line]
    found = printed_tables.TABLES[title]()
    assert len(found) == len(lines) - 2
    for row, (case, quantity, printed, ours, _) in zip(found, lines[2:], strict=True):
        assert (case, quantity) == (row.case, row.quantity)
        assert same(printed, row.printed)
        assert same(ours, row.ours), (case, quantity)


def test_deviations_of_numbers_and_of_words():
    claim = claims.Claim("stroke [mm]", float, "181", 180.0, 182.0)
    assert claim.deviation(190.05) == pytest.approx(0.05)
    assert np.isnan(claim._replace(printed="rises").deviation(2.0))


def test_the_script_of_the_pages_draws_and_tells_what_they_show(tmp_path, monkeypatch):
    path = ROOT / "examples" / "gallery" / "write_pages.py"
    spec = importlib.util.spec_from_file_location("write_pages", path)
    pages = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pages)
    monkeypatch.setattr(pages, "PICTURES", tmp_path)
    pages.main([10, 15])
    assert sorted(file.name for file in tmp_path.iterdir()) == ["figure_10.png", "figure_15.png"]
    assert PAGES["gallery"].startswith(pages.INTRODUCTION)
    assert PAGES["comparison"].startswith(pages.COMPARISON)
    for number in (10, 15):
        shown = claims.of(number)
        assert pages.claims_table(shown, claims.data(shown)) in PAGES["gallery"]
