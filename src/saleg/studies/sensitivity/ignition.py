"""What the ignition law does (3.6.4, Figures 46 to 52)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from saleg.checks import SERIES, a, checked
from saleg.design import Design
from saleg.engine import Engine
from saleg.laws import CFRIgnition, Ignition, RCMIgnitionPascal
from saleg.studies.sensitivity.parameter_study import PATHS, Study, study, vary_each

if TYPE_CHECKING:
    import pandas as pd

#: The four parameters of the CFR correlation (Eq. 55) and the equivalence ratio.
CFR = (*(f"ignition.{name}" for name in "Abnx"), "equivalence_ratio")
FACTORS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6)

LAWS: Mapping[str, Ignition] = {"CFR": CFRIgnition(), "RCM, p in Pa": RCMIgnitionPascal()}


@checked(engine=a(Engine, Design), factors=SERIES, paths=PATHS)
def cfr_parameters(
    engine: Engine | Design, factors: Iterable[float] = FACTORS, paths: Iterable[str] = CFR
) -> pd.DataFrame:
    """Steady results against the parameters of the CFR correlation, as Figure 50.

    For the curves of Figures 46 to 48 of one parameter, see :func:`saleg.sensitivity.study`.

    Parameters
    ----------
    engine : Engine or Design
        With :class:`saleg.laws.CFRIgnition` for its ignition.
    factors : iterable of float
        Values over those of the engine [-].
    paths : iterable of str
        Dotted paths of the parameters.

    Returns
    -------
    DataFrame
        As :func:`saleg.sensitivity.vary_each` gives it.
    """
    return vary_each(engine, list(paths), factors)


@checked(engine=a(Engine, Design), ratios=SERIES)
def equivalence_ratios(
    engine: Engine | Design, ratios: Iterable[float] = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
) -> Study:
    """Steady runs at several equivalence ratios [-], as Figure 49.

    Parameters
    ----------
    engine : Engine or Design
    ratios : iterable of float
        Equivalence ratios [-].

    Returns
    -------
    Study
    """
    return study(engine, "equivalence_ratio", ratios)


@checked(engine=a(Engine, Design), laws=a(Mapping))
def ignition_laws(engine: Engine | Design, laws: Mapping[str, Ignition] = LAWS) -> Study:
    """Steady runs under several ignition laws, as Figure 51.

    Parameters
    ----------
    engine : Engine or Design
    laws : mapping of str to Ignition
        Laws by name.

    Returns
    -------
    Study
    """
    return study(engine, "ignition", laws)


@checked(engine=a(Engine, Design), rates=SERIES, law=a(Ignition).optional)
def retained_gas(
    engine: Engine | Design,
    rates: Iterable[float] = (0.0, 0.1, 0.2, 0.3, 0.4),
    law: Ignition | None = None,
) -> Study:
    """Steady runs at several rates of exhaust gas recirculation, as Figure 52.

    Parameters
    ----------
    engine : Engine or Design
    rates : iterable of float
        Shares of the gas that are retained, EGR [-].
    law : Ignition, optional
        Ignition law; :class:`saleg.laws.RCMIgnitionPascal`, which sees the oxygen, unless given.

    Returns
    -------
    Study
    """
    return study(engine.replace(ignition=law or RCMIgnitionPascal()), "egr", rates)
