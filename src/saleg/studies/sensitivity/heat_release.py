"""What duration and course of the heat release do (3.6.5, Figures 53 to 57, Table 5)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from saleg.checks import SERIES, a, checked
from saleg.design import Design
from saleg.engine import Engine
from saleg.laws import DoubleWiebe, HeatRelease
from saleg.studies.sensitivity.parameter_study import Study, study

#: Combustion durations [s], from the shortest to the longest of Figures 53 to 55.
DURATIONS = tuple(
    1e-3 * ms for ms in (0.1, 0.2, 0.5, 1.0, 1.25, 2.0, 3.0, 4.0, 6.0, 8.0, 10, 15, 20, 25, 30)
)


def double_wiebe_late() -> DoubleWiebe:
    """Profile (1) of Figure 56: a little fuel burns at once, the most after a pause.

    The figure's numbers are not printed. Shape and efficiency parameters are those of the text
    (3, 0.5 and 1.2); duration, share and end of the premixed phase were fitted to row (1) of
    Table 5 within what the text says of the shape.

    Returns
    -------
    DoubleWiebe
        Normalised, one phase after the other.

    Examples
    --------
    >>> round(double_wiebe_late().burnt_fraction(0.18), 2)
    0.2
    """
    return DoubleWiebe(
        combustion_duration=1.45e-3, premixed_share=0.2, premixed_end=0.18, diffusion_start=0.18
    )


def double_wiebe_early() -> DoubleWiebe:
    """Profile (2) of Figure 56: more than half of the fuel burns at once, the rest slowly.

    Fitted to row (2) of Table 5 as :func:`double_wiebe_late` is to row (1).

    Returns
    -------
    DoubleWiebe
        Normalised, one phase after the other.

    Examples
    --------
    >>> round(double_wiebe_early().burnt_fraction(0.14), 2)
    0.56
    """
    return DoubleWiebe(
        combustion_duration=1.75e-3, premixed_share=0.56, premixed_end=0.14, diffusion_start=0.14
    )


@checked(engine=a(Engine, Design), durations=SERIES)
def release_durations(engine: Engine | Design, durations: Iterable[float] = DURATIONS) -> Study:
    """Steady runs at several combustion durations, as Figures 53 to 55.

    Parameters
    ----------
    engine : Engine or Design
    durations : iterable of float
        Combustion durations [s].

    Returns
    -------
    Study
    """
    return study(engine, "heat_release.combustion_duration", durations)


@checked(engine=a(Engine, Design), profiles=a(Mapping).optional)
def release_profiles(
    engine: Engine | Design, profiles: Mapping[str, HeatRelease] | None = None
) -> Study:
    """Steady runs under several courses of the heat release, as Figures 56, 57 and Table 5.

    Parameters
    ----------
    engine : Engine or Design
    profiles : mapping of str to HeatRelease, optional
        Laws by name; unless given the engine's own beside :func:`double_wiebe_late` and
        :func:`double_wiebe_early`, under the names of Table 5.

    Returns
    -------
    Study
    """
    if profiles is None:
        profiles = {
            "single Wiebe (base)": engine.get("heat_release"),
            "double Wiebe (1)": double_wiebe_late(),
            "double Wiebe (2)": double_wiebe_early(),
        }
    return study(engine, "heat_release", profiles)
