"""Every example runs, asserts its own numbers, and makes the pictures the documentation shows."""

import importlib.util

import pytest

from helpers import ROOT

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
IMAGES = ROOT / "docs" / "images"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
TEXT = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
#: Examples that draw nothing.
WITHOUT_PICTURES = {"03_export.py", "14_control_in_time.py", "19_direct_injection.py"}
LARGEST = 150e3  # bytes
#: Sizes of examples that are run smaller than they stand; as they stand by ``pytest -m long``.
SMALLER = {
    "10_optimise": {
        "DESIGNS": {"score": 1500, "efficiency": 500, "archive": 250, "front": 250},
    },
}
CASES = [pytest.param(path, SMALLER.get(path.stem, {}), id=path.stem) for path in EXAMPLES]
CASES += [
    pytest.param(path, {}, id=f"{path.stem} as it stands", marks=pytest.mark.long)
    for path in EXAMPLES
    if path.stem in SMALLER
]


def load(path):
    """Module of an example, not run as a script."""
    spec = importlib.util.spec_from_file_location(f"example_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(("path", "sizes"), CASES)
def test_example_runs_and_makes_the_pictures_of_the_docs(path, sizes, tmp_path, monkeypatch):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    example = load(path)
    for name, size in sizes.items():
        assert type(getattr(example, name)) is type(size), name
        monkeypatch.setattr(example, name, size)
    example.main(tmp_path)
    assert not list(elsewhere.iterdir())
    made = sorted(tmp_path.glob("*.png"))
    assert bool(made) != (path.name in WITHOUT_PICTURES)
    for picture in made:
        assert picture.stat().st_size < LARGEST
        assert f"images/{picture.name}" in TEXT
        assert (IMAGES / picture.name).is_file()


def test_pictures_of_the_docs_are_small_and_shown():
    for picture in IMAGES.iterdir():
        assert picture.stat().st_size < LARGEST
        assert f"images/{picture.name}" in TEXT
