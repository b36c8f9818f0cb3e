"""What stroke regulator and flux of the alternator do (3.3, 3.6.6, Figures 58 and 59)."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING

from saleg.checks import NUMBER, SERIES, a, checked
from saleg.design import Design
from saleg.engine import Engine
from saleg.errors import SalegError
from saleg.laws import FluxProfile
from saleg.studies.sensitivity.parameter_study import Study, study, vary
from saleg.studies.sensitivity.settle import settle

if TYPE_CHECKING:
    import pandas as pd

GAINS = (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.5, 9.0, 10.0, 12.0, 13.0, 14.0, 16.0, 20.0, 50.0)
TARGETS = (0.70, 0.75, 0.80, 0.825, 0.85, 0.875, 0.90, 0.925, 0.95)


@checked(engine=a(Engine, Design), gains=SERIES)
def regulator_gains(engine: Engine | Design, gains: Iterable[float] = GAINS) -> pd.DataFrame:
    """Steady results against the gain of the stroke regulator (Eq. 59), as Figure 58.

    Parameters
    ----------
    engine : Engine or Design
    gains : iterable of float
        Gains G [-].

    Returns
    -------
    DataFrame
        As :func:`saleg.sensitivity.vary` gives it.
    """
    return vary(engine, "alternator.regulator_gain", gains)


@checked(engine=a(Engine, Design), targets=SERIES)
def target_strokes(engine: Engine | Design, targets: Iterable[float] = TARGETS) -> Study:
    """Steady runs at several target strokes of the regulator, as Figure 59.

    Parameters
    ----------
    engine : Engine or Design
    targets : iterable of float
        Target strokes over the maximum stroke [-].

    Returns
    -------
    Study
    """
    return study(engine, "alternator.target_stroke", targets)


@checked(engine=a(Engine, Design), amplitude=NUMBER, periods=SERIES)
def flux_ripples(
    engine: Engine | Design,
    amplitude: float = 0.1,
    periods: Iterable[float] = (1.0, 1.5, 2.0, 3.0, 5.0),
) -> Study:
    """Steady runs with a flux that ripples along the stroke, beside one without.

    The flux gradient is 1 plus a cosine or a sine of the position, which has zero mean over a
    period.

    Parameters
    ----------
    engine : Engine or Design
        With :class:`saleg.laws.LinearLoad` or another alternator of its parameters.
    amplitude : float
        Amplitude of the ripple over the mean flux gradient [-].
    periods : iterable of float
        Periods of the ripple in the steady stroke of the engine [-].

    Returns
    -------
    Study
        The first case is a flux without ripple, in the same law.

    Raises
    ------
    SalegError
        If the engine does not move.
    """
    stroke = settle(engine).performance.stroke
    if stroke <= 0.0:
        raise SalegError("no stroke along which the flux could ripple: the engine stalls")
    names = ("load_constant", "efficiency", "regulator_gain", "target_stroke", "maximum_weight")
    load = {name: engine.get(f"alternator.{name}") for name in names}
    cases = {"none": FluxProfile(**load, cosines=(0.0,), sines=(0.0,))}
    for count, (name, part) in itertools.product(periods, (("cosine", 1.0), ("sine", 0.0))):
        cases[f"{name}, {count:g} per stroke"] = FluxProfile(
            **load,
            wavelength=stroke / count,
            cosines=(amplitude * part,),
            sines=(amplitude * (1.0 - part),),
        )
    return study(engine, "alternator", cases)
