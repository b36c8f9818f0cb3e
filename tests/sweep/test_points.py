"""Points of a sweep, and what makes no sense as a sweep."""

import math
import re
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pandas as pd
import pytest

import saleg
from helpers import SMALL_SWEEP
from saleg import sweep
from saleg.design import Design


def test_points():
    points = sweep.grid(SMALL_SWEEP)
    assert list(points.columns) == ["bore", "egr"]
    assert len(points) == 6
    assert list(points.egr[:2]) == [0.1, 0.2]
    cube = sweep.latin_hypercube({"bore": (0.05, 0.06), "egr": (0.0, 0.3)}, 10, seed=4)
    slices = np.floor((cube.bore - 0.05) / 0.001)
    assert sorted(slices.astype(int)) == list(range(10))
    again = sweep.latin_hypercube({"bore": (0.05, 0.06), "egr": (0.0, 0.3)}, 10, seed=4)
    assert cube.equals(again)
    even = sweep.sobol({"bore": (0.05, 0.06)}, 16)
    assert even.bore.between(0.05, 0.06).all()


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: sweep.grid({}),
        lambda: sweep.grid({"bore": []}),
        lambda: sweep.grid({"bore": 0.06}),
        lambda: sweep.grid({"bore": ["x"]}),
        lambda: sweep.listed({"bore": [0.06], "egr": [0.1, 0.2]}),
        lambda: sweep.sobol({"bore": (0.05, 0.06)}, 12),
        lambda: sweep.latin_hypercube({"bore": (0.06, 0.05)}, 4),
        lambda: sweep.latin_hypercube({}, 4),
        lambda: sweep.latin_hypercube({"bore": (0.05, 0.06)}, 0),
        lambda: sweep.run(pd.DataFrame({"bore": ["x"]})),
        lambda: sweep.run(pd.DataFrame()),
        lambda: sweep.run(sweep.grid({"boer": [0.06]})),
        lambda: sweep.run(sweep.grid(SMALL_SWEEP), chunk=0),
        lambda: sweep.run(sweep.grid(SMALL_SWEEP), saleg.machines.thesis_base(), warm=True),
    ],
)
def test_what_makes_no_sense_is_refused(wrong):
    with pytest.raises(saleg.SalegError):
        wrong()


BORES = {"bore": (0.05, 0.06)}


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        (lambda: sweep.latin_hypercube(BORES, 4, seed=-1), "seed = -1"),
        (lambda: sweep.sobol(BORES, 4, seed=1.5), "seed = 1.5"),
        (lambda: sweep.saltelli_points(BORES, 4, seed="x"), "seed = 'x'"),
        (lambda: sweep.saltelli_points(BORES, True), "count = True"),
        (lambda: sweep.sobol({"bore": (0.05, math.inf)}, 4), "finite"),
        (lambda: sweep.sobol([("bore", (0.05, 0.06))], 4), "values by name"),
        (lambda: sweep.grid([0.06]), "values by name"),
        (lambda: sweep.sobol(BORES, 2**40), "split the sweep"),
        (lambda: sweep.latin_hypercube(BORES, 10**9), "split the sweep"),
        (lambda: sweep.saltelli_points(BORES, 2**32), "split the sweep"),
        (lambda: sweep.grid(dict.fromkeys("abcd", range(100))), "split the sweep"),
        (lambda: sweep.run({"bore": [0.06]}), "must be a DataFrame"),
        (lambda: sweep.run(None), "must be a DataFrame"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), "thesis-base"), "cannot sweep 'thesis-base'"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), Design), "cannot sweep"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), workers=0), "workers = 0"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), workers=1.5), "workers = 1.5"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), executor="threads"), "method submit"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), executor=ProcessPoolExecutor), "method submit"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), chunk=True), "chunk = True"),
        (lambda: sweep.run(sweep.grid(SMALL_SWEEP), folder=3), "folder = 3"),
        (lambda: sweep.run(sweep.grid({"moving_mass": [2.0]})), "follows from the eight"),
        (lambda: sweep.run(sweep.grid({"intake.pressure": [1.05e5]})), "follows from the eight"),
        (lambda: sweep.run(sweep.grid({"masses.rod": [0.5]})), "masses.rod is no number"),
        (lambda: sweep.run(sweep.grid({"heat_transfer": [0.5]})), "is no number but a Hohenberg"),
        (
            lambda: sweep.run(sweep.grid({"friction": [0.5]}), saleg.machines.thesis_base()),
            "friction is no number",
        ),
        (
            lambda: sweep.run(pd.DataFrame([[0.06, 0.07]], columns=["bore", "bore"])),
            "stands twice",
        ),
    ],
)
def test_what_to_change_is_said(wrong, match):
    with pytest.raises(saleg.SalegError, match=re.escape(match)):
        wrong()
