"""Pages in a real browser, on a phone and a desk: no error, all figures seen, nothing cut off."""

import pytest

import saleg
from browser import CHROMIUM, Browser

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium here to open pages in")

WIDTHS = (390, 1280)


@pytest.fixture(scope="module")
def browser():
    with Browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def pages(base, tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    steady, run = saleg.steady_state(base), saleg.simulate(base, 0.5)
    bounce = saleg.BounceChamber(bore=0.05, half_stroke=0.15, pressure=4e5)
    unlike = saleg.simulate(base.replace(right=bounce), 1e-3)
    long = run.engine.replace(name="an engine with_a_name_that_has_no_end_and_no_space_" * 3)
    return {
        "steady": (saleg.report(steady, folder / "steady.html"), 6),
        "run": (saleg.report(run, folder / "run.html"), 7),
        "no cycle": (saleg.report(unlike, folder / "nothing.html"), 1),
        "long name": (saleg.report(saleg.simulate(long, 1e-3), folder / "long.html"), 1),
        "animation": (saleg.plotting.animate(run, folder / "film.html", frames=3), 1),
    }


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", ["steady", "run", "no cycle", "long name", "animation"])
def test_a_page_is_seen_whole(browser, pages, name, width, dark):
    path, figures = pages[name]
    seen = browser.open(path, width, dark=dark)
    assert browser.complaints == []
    assert [url for url in browser.loaded if not url.startswith("file:")] == []
    assert seen["scroll"] <= width
    assert seen["inner"] <= width
    assert seen["outside"] == []
    assert len(seen["figures"]) >= figures
    for figure in seen["figures"]:
        assert figure["width"] > 100
        assert figure["height"] > 40
        assert 0 <= figure["left"] < figure["right"] <= width
    if name != "animation":
        assert seen["smallest"] >= 10  # text of pictures [px]


def test_an_animation_plays_and_stops(browser, pages):
    browser.open(pages["animation"][0], 390)
    assert browser.evaluate("play.textContent") == "pause"
    browser.evaluate("play.click()")
    assert browser.evaluate("play.textContent") == "play"
    browser.evaluate("place.value = 2; place.oninput()")
    assert browser.evaluate("frame.src === frames[2] && frame.naturalWidth > 300")
    assert browser.complaints == []


def test_a_page_with_faults_is_told(browser, tmp_path):
    """The measure itself: a script that fails and a picture wider than the window."""
    page = tmp_path / "bad.html"
    page.write_text(
        '<!DOCTYPE html><meta name="viewport" content="width=device-width">'
        '<svg width="900" height="90"></svg><script>nothing.at.all()</script>'
    )
    seen = browser.open(page, 390)
    assert "svg" in seen["outside"]
    assert seen["scroll"] > 390
    assert browser.complaints
