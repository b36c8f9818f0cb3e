"""What a notebook's cell shows of figures, and what an editor offers."""

import base64
import io
import re

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import saleg
from saleg import plotting
from saleg.plotting import FIGURES, new_figure
from saleg.plotting.figure import Panels


def shown(result):
    """Pixels a notebook shows of the result of a cell; None where it shows text."""
    from IPython.core.formatters import PNGFormatter

    image = PNGFormatter()(result)
    return None if image is None else np.asarray(Image.open(io.BytesIO(image)).convert("L"))


@pytest.mark.parametrize("name", FIGURES)
def test_the_result_of_every_figure_shows_its_picture(base_run, name):
    drawn = getattr(base_run.plot, name)()
    picture = shown(drawn)
    assert (picture < 128).sum() > 1000
    width, height = drawn.figure.get_size_inches()
    assert picture.shape == pytest.approx((100 * height, 100 * width), abs=1)


def test_panels_are_an_array_with_their_figure(base_run):
    panels = base_run.plot.approach_to_steady_state()
    assert isinstance(panels, np.ndarray)
    assert panels.shape == (4,)
    assert panels.figure is panels[0].figure
    assert shown(panels[2]).shape == shown(panels).shape  # the whole figure, not one panel
    assert shown(Panels.of([])) is None


def test_three_dimensional_axes_show_too():
    ax = new_figure().add_subplot(projection="3d")
    assert ax.name == "3d"
    assert shown(ax) is not None


def test_axes_of_one_s_own_are_left_to_whoever_made_them(base_run):
    """A notebook shows pyplot's figures itself; they would stand there twice."""
    ax = Figure().subplots(1, 2)
    assert shown(base_run.plot.power(ax[0])) is None
    assert shown(base_run.plot.dynamics(ax)) is None


def test_an_animation_shows_as_a_picture_without_script(base_run):
    film = base_run.plot.animation(frames=3, width=4.0)
    page = film._repr_html_()
    data = re.fullmatch(
        r'<img src="data:image/gif;base64,([^"]+)" alt="animation of thesis-base" [^<>]*>', page
    )
    assert Image.open(io.BytesIO(base64.b64decode(data[1]))).n_frames == 3
    assert repr(film) == "<Animation of 'thesis-base': 3 frames>"


def test_an_editor_offers_the_figures_of_a_run_and_nothing_else(base_run):
    jedi = pytest.importorskip("jedi")
    code = "import saleg\nrun = saleg.simulate(saleg.machines.thesis_base(), 1.0)\nrun.plot."
    offered = [found.name for found in jedi.Script(code).complete()]
    assert {name for name in offered if not name.startswith("_")} == set(dir(base_run.plot))


def test_completion_of_the_package_lists_what_is_public():
    offered = set(dir(saleg))
    assert offered >= {"Engine", "simulate", "steady_state", "design", "sweep", "optimize"}
    assert not offered & {
        "sys",
        "ModuleType",
        "ALIASES",
        "kernel",
        "batch",
        "engine",
        "TYPE_CHECKING",
    }
    assert all(hasattr(saleg, name) for name in offered)
    assert {name for name in offered if name.startswith("_")} == {"__version__"}
    assert set(plotting.__all__) <= set(vars(plotting))
