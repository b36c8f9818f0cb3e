import json
import math
import re

import numpy as np
import pytest
from PIL import Image

import saleg
from saleg import BounceChamber
from saleg.errors import RunFileError
from saleg.plotting import AnimationError, NoCycle, animate
from saleg.plotting.film import Film, dimensions


@pytest.fixture(scope="module")
def recorded(base):
    return saleg.simulate(base, 0.1, history=1)


def test_a_gif_has_its_frames_and_is_small(base_run, tmp_path):
    path = animate(base_run, tmp_path / "engine.gif", frames=6)
    with Image.open(path) as picture:
        assert picture.n_frames == 6
        assert picture.size[0] == 720
        assert picture.info["duration"] == 50
        assert picture.info["loop"] == 0
    assert path.stat().st_size < 6 * 5e6 / 48


def test_a_page_loads_nothing(base_run, tmp_path):
    path = animate(base_run, tmp_path / "engine.HTML", frames=4)
    page = path.read_text(encoding="utf-8")
    assert not re.search(r"https?://|<link|src=(?!\"data:)", page)
    frames = json.loads(re.search(r"^const frames = (.*);$", page, re.M)[1])
    assert len(frames) == 4
    assert all(frame.startswith("data:image/png;base64,") for frame in frames)
    assert path.stat().st_size < 4 * 5e6 / 48


def test_the_translator_moves_as_the_cycle_does(base_run):
    film = Film.of(base_run, None, 8, 20.0, 9.0)
    orbit = base_run.orbit.history
    period = orbit["t"].iloc[-1] - orbit["t"].iloc[0]
    np.testing.assert_allclose(np.diff(film.history["t"]), period / 8)
    mm = dimensions(base_run.engine, "right")
    for frame in (0, 3):
        film.show(frame)
        ends = [patch.get_x() + patch.get_width() for patch in film.machine.patches]
        x = 1e3 * np.interp(film.history["t"].iloc[frame], orbit["t"], orbit["x"])
        assert min(abs(end - mm["crown"] - x) for end in ends) < 1e-9
        dots = [line for line in film.figure.axes[1].get_lines() if line.get_marker() == "o"]
        for side, dot in zip(("left", "right"), dots, strict=True):
            pressure = 1e-5 * film.history[f"p_{side}"].iloc[frame]
            assert dot.get_ydata()[0] == pytest.approx(pressure)


def test_a_window_of_a_history(recorded):
    film = Film.of(recorded, (0.02, 0.05), 5, 20.0, 9.0)
    np.testing.assert_allclose(film.history["t"], np.linspace(0.02, 0.05, 5), atol=1e-4)


def test_dimensions_are_the_engine_s(base):
    side = base.right
    mm = dimensions(base, "right")
    assert mm["bore"] == 1e3 * side.bore
    assert mm["head"] - mm["crown"] == pytest.approx(1e3 * side.half_stroke)
    assert mm["head"] - mm["port"] == pytest.approx(1e3 * side.port_closing)
    assert mm["bearing"] - mm["mover_end"] >= 1e3 * side.half_stroke
    half = base.replace(right=BounceChamber(bore=0.05, half_stroke=0.08))
    assert math.isnan(dimensions(half, "right")["port"])
    assert dimensions(half, "right")["bore"] == 50.0


@pytest.mark.parametrize(
    ("name", "settings", "message"),
    [
        ("a.mp4", {}, r"must end in \.gif or \.html"),
        ("a", {}, r"must end in \.gif or \.html"),
        ("a.gif", {"frames": 1}, "frames = 1: must be a number from 2 to 400"),
        ("a.gif", {"frames": 2.5}, "must be a whole number"),
        ("a.gif", {"width": 100.0}, "width = 100.0: must be a number from 4 to 16"),
        ("a.gif", {"rate": math.nan}, "rate = nan"),
        ("a.gif", {"window": (0.0, 0.1)}, "history=1"),
        ("a.gif", {"window": (0.0, "1")}, "must be two times"),
    ],
)
def test_mistakes(base_run, tmp_path, name, settings, message):
    with pytest.raises(AnimationError, match=message):
        animate(base_run, tmp_path / name, **settings)
    assert not list(tmp_path.iterdir())


def test_an_empty_window(recorded, tmp_path):
    with pytest.raises(AnimationError, match=r"nothing there; it goes from 0 to 0\.1 s"):
        animate(recorded, tmp_path / "a.gif", window=(1.0, 2.0))


def test_a_run_without_a_cycle(base, tmp_path):
    with pytest.raises(NoCycle):
        animate(saleg.simulate(base, 1e-3), tmp_path / "a.gif")


def test_what_is_in_the_way_stays(base_run, tmp_path):
    (tmp_path / "a.gif").write_text("mine")
    with pytest.raises(RunFileError, match="exists already"):
        animate(base_run, tmp_path / "a.gif", frames=2)
    assert (tmp_path / "a.gif").read_text() == "mine"
    with pytest.raises(RunFileError, match="is a file"):
        animate(base_run, tmp_path / "a.gif" / "b.gif", frames=2)
    animate(base_run, tmp_path / "a.gif", frames=2, overwrite=True)
    assert [path.name for path in tmp_path.iterdir()] == ["a.gif"]
