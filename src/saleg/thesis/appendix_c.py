"""Appendix C: retained gas with RCM ignition, and designs over four dimensionless groups.

Examples
--------
>>> from saleg.thesis import appendix_c
>>> appendix_c.GROUPS[117]
'stroke_to_bore'
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from saleg import sweep
from saleg.design import Design
from saleg.laws import RCMIgnitionPascal
from saleg.plotting import sweeps
from saleg.thesis.chapter_4 import SWEEPS
from saleg.thesis.figure import Figure

if TYPE_CHECKING:
    import pandas as pd

#: Dimensionless group by the first of the two figures over it.
GROUPS = {
    117: "stroke_to_bore",
    119: "dimensionless_pressure",
    121: "dimensionless_heat",
    123: "frequency_ratio",
}
#: Ranges of the designs (SI); the appendix does not print its own.
BOX = {
    "bore": (0.04, 0.075),
    "half_stroke": (0.05, 0.16),
    "spring_stiffness": (10e3, 150e3),
    "intake_pressure": (0.9e5, 1.5e5),
    "intake_temperature": (290.0, 400.0),
    "equivalence_ratio": (0.3, 0.8),
}


def retained_gas(count: int = 21) -> pd.DataFrame:
    """Base case along the retained exhaust gas, with RCM ignition (Figures 115, 116).

    Parameters
    ----------
    count : int
        Number of points.

    Returns
    -------
    DataFrame
        As :func:`saleg.sweep.run` gives it.
    """
    design = Design().replace({"ignition": RCMIgnitionPascal()})
    return sweep.run(sweep.grid({"egr": np.linspace(*SWEEPS["egr"], count).tolist()}), design)


def cloud(count: int = 512, seed: int = 2) -> pd.DataFrame:
    """Designs spread over :data:`BOX` (Figures 117 to 124).

    Parameters
    ----------
    count : int
        Number of designs, a power of two.
    seed : int

    Returns
    -------
    DataFrame
        As :func:`saleg.sweep.run` gives it.
    """
    return sweep.run(sweep.sobol(BOX, count, seed=seed))


#: Figures by their number; two share a picture.
FIGURES = {
    **dict.fromkeys((115, 116), Figure(retained_gas, partial(sweeps.panels, x="egr"))),
    **{
        number + other: Figure(cloud, partial(sweeps.groups, x=name))
        for number, name in GROUPS.items()
        for other in (0, 1)
    },
}
