"""What the heat-transfer law does (3.6.3, Figures 43 to 45)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from saleg.checks import POSITIVE, SERIES, a, checked
from saleg.design import Design
from saleg.engine import Engine
from saleg.laws import Annand, Chang, HeatTransfer, Hohenberg, Woschni
from saleg.studies.sensitivity.parameter_study import PATHS, Study, study, vary_each
from saleg.studies.sensitivity.settle import settle
from saleg.studies.sensitivity.tuning import Subject, heat_transfer_share, tune

if TYPE_CHECKING:
    import pandas as pd

#: The five parameters of Hohenberg's correlation (Eq. 51).
HOHENBERG = tuple(f"heat_transfer.{name}" for name in "abcde")
FACTORS = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5)

#: The four laws the thesis compares, each with the number that scales it.
LAWS: Mapping[str, tuple[HeatTransfer, str]] = {
    "Hohenberg": (Hohenberg(), "a"),
    "Woschni": (Woschni(), "scale"),
    "Annand": (Annand(), "scale"),
    "Chang": (Chang(), "scale"),
}


@checked(engine=a(Engine, Design), factors=SERIES, paths=PATHS)
def hohenberg_parameters(
    engine: Engine | Design, factors: Iterable[float] = FACTORS, paths: Iterable[str] = HOHENBERG
) -> pd.DataFrame:
    """Steady results against the parameters of Hohenberg's correlation, as Figure 43.

    Parameters
    ----------
    engine : Engine or Design
        With :class:`saleg.laws.Hohenberg` for its heat transfer.
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


@checked(engine=a(Engine, Design), laws=a(Mapping), share=POSITIVE.optional)
def heat_transfer_laws(
    engine: Subject,
    laws: Mapping[str, tuple[HeatTransfer, str]] = LAWS,
    *,
    share: float | None = None,
) -> Study:
    """Steady runs under several heat-transfer laws that take the same share of the fuel energy.

    As Figures 44 and 45. The stroke regulator masks much of the difference; study
    ``fix_load(engine)`` to see it.

    Parameters
    ----------
    engine : Engine or Design
    laws : mapping of str to (HeatTransfer, str)
        Laws by name, each with the field that scales it.
    share : float, optional
        Heat transfer over fuel energy [-]; that of the engine unless given.

    Returns
    -------
    Study

    Raises
    ------
    TuningError
        If a law cannot be scaled so.
    """
    wanted = heat_transfer_share(settle(engine)) if share is None else share
    scaled = {
        name: tune(
            engine.replace(heat_transfer=law), f"heat_transfer.{field}", heat_transfer_share, wanted
        )
        for name, (law, field) in laws.items()
    }
    found = {name: changed.get("heat_transfer") for name, changed in scaled.items()}
    return study(engine, "heat_transfer", found)
