"""Every example runs, once, without a warning, and makes the pictures its pages show."""

import ast
import re
import subprocess
import sys

import pytest

from helpers import ROOT

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
IMAGES = ROOT / "docs" / "images"
#: Greatest size of a picture in the docs [bytes].
LIMIT = 150e3


def pages(example):
    """Pages an example says it makes the pictures of."""
    described = ast.get_docstring(ast.parse(example.read_text(encoding="utf-8")))
    named = re.findall(r"docs/\w+\.md|README(?=\.)", described)
    return [ROOT / name.replace("README", "README.md") for name in named]


def shown(page):
    """Names of the pictures on a page."""
    return set(re.findall(r"images/(\w+\.png)", page.read_text(encoding="utf-8")))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs_and_makes_the_pictures_of_its_pages(example, tmp_path):
    """One without pictures runs without a folder, and leaves nothing where it ran."""
    made, here = tmp_path / "made", tmp_path / "here"
    made.mkdir()
    here.mkdir()
    folder = [str(made)] if pages(example) else []
    subprocess.run([sys.executable, "-W", "error", str(example), *folder], check=True, cwd=here)
    assert list(here.iterdir()) == []
    pictures = {path.name: path.stat().st_size for path in made.iterdir()}
    assert set(pictures) == set().union(*map(shown, pages(example)))
    assert all(size < LIMIT for size in pictures.values()), pictures


def test_pictures_of_the_docs_are_small_and_come_from_the_examples():
    written = {page for example in EXAMPLES for page in pages(example)}
    expected = set().union(*map(shown, written))
    for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
        assert shown(page) <= expected, page.name
    pictures = {path.name: path.stat().st_size for path in IMAGES.iterdir()}
    assert set(pictures) == expected
    assert all(size < LIMIT for size in pictures.values()), pictures
