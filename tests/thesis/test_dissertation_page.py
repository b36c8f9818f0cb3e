"""The dissertation on one page: every number once, and every name in it leads somewhere."""

import importlib
import re

import pytest

from helpers import ROOT
from saleg.thesis.figures import FIGURES

TEXT = (ROOT / "docs" / "dissertation.md").read_text(encoding="utf-8")
#: Greatest number of each kind in the dissertation.
KINDS = {"Equations": 69, "Tables": 13, "Figures": 124}


def rows(kind):
    """Rows of a section by number: what it is, where it is."""
    section = TEXT.split(f"\n## {kind}\n")[1].split("\n## ")[0]
    return [line.strip("| ").split(" | ") for line in section.splitlines() if line[:3] != "|--"]


def found(name):
    """What a dotted name stands for."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            value = importlib.import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            value = getattr(value, part)
        return value
    raise ModuleNotFoundError(name)


@pytest.mark.parametrize("kind", KINDS)
def test_every_number_is_there_once(kind):
    numbered = [row for row in rows(kind) if row[0].isdigit()]
    assert [int(row[0]) for row in numbered] == list(range(1, KINDS[kind] + 1))
    for _, what, where in numbered:
        assert what
        assert "`saleg." in where or "](" in where, what


def test_every_name_can_be_imported():
    names = set(re.findall(r"`(saleg\.[\w.]+)`", TEXT))
    assert len(names) > 80
    for name in names:
        assert found(name) is not None


def test_figures_with_a_picture_are_those_that_hold_data():
    drawn = {int(row[0]) for row in rows("Figures") if row[0].isdigit() and "gallery.md" in row[2]}
    assert drawn == set(FIGURES)
    # The list of the issue, from reading the dissertation.
    ranges = ((9, 19), (36, 61), (63, 63), (65, 82), (85, 95), (97, 108), (115, 124))
    assert drawn == {n for low, high in ranges for n in range(low, high + 1)}


def test_links_to_the_gallery_lead_to_headings():
    gallery = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    headings = {
        line.removeprefix("### ").lower().replace(" ", "-")
        for line in gallery.splitlines()
        if line.startswith("### ")
    }
    anchors = re.findall(r"gallery\.md#([\w-]+)", TEXT)
    assert anchors
    assert set(anchors) == headings
