"""The eight independent parameters of Table 8."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.quantities import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class Parameters(Quantities):
    """What defines a design (Table 8); the defaults are the base case of Table 1.

    Parameters
    ----------
    bore : float
        Cylinder bore b [m].
    half_stroke : float
        Neutral clearance length L, half the maximum stroke [m].
    port_location : float
        Port location L_po% as a share of the maximum stroke, 0 farthest from the head [-].
    spring_stiffness : float
        Stiffness k of one spring [N/m].
    intake_pressure : float
        Intake pressure [Pa].
    intake_temperature : float
        Intake temperature [K].
    equivalence_ratio : float
        Equivalence ratio phi [-].
    egr : float
        Share of exhaust gas retained [-].

    Lengths of metres and pressures of a few pascal are refused: they are millimetres and bar.

    Examples
    --------
    >>> Parameters(bore=0.07).half_stroke
    0.1
    """

    bore: float = quantity("m", default=0.064, low=0, high=2.0, open_low=True)
    half_stroke: float = quantity("m", default=0.100, low=0, high=5.0, open_low=True)
    port_location: float = quantity(
        "-", default=0.335, low=0, high=1, open_low=True, open_high=True
    )
    spring_stiffness: float = quantity("N/m", default=30e3, low=0)
    intake_pressure: float = quantity("Pa", default=1.05e5, low=1e3, high=1e8)
    intake_temperature: float = quantity("K", default=325.05, low=100.0, high=1500.0)
    equivalence_ratio: float = quantity("-", default=0.6, low=0, high=10)
    egr: float = quantity("-", default=0.12, low=0, high=1, open_high=True)
