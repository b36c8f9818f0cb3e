"""From an engine of the numeric model to the dimensionless groups of Chapter 2."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from saleg.checks import a, checked
from saleg.engine import Chamber, CombustionChamber, Engine
from saleg.engine.start import burning_share, standard_charge
from saleg.errors import InvalidEngine, OutsideModel
from saleg.fundamental.balance import at_equilibrium
from saleg.fundamental.checks import SCALAR
from saleg.fundamental.gas import Isentropic
from saleg.fundamental.loads import ConstantLoad, Load
from saleg.fundamental.scales import Scales
from saleg.fundamental.system import System
from saleg.laws import Motion
from saleg.quantities import Problem


@dataclass(frozen=True)
class Groups:
    """An engine in the terms of Chapter 2 and of Appendix C.

    Attributes
    ----------
    scales : Scales
        What turns its quantities dimensionless.
    gamma : float
        Ratio of specific heats [-].
    midpoint_pressure : float
        P_mp* [-] (Eq. 9): on the isentrope of the closed chamber, even where ports are open.
    intake_pressure : float
        Dimensionless intake pressure [-] (Appendix C).
    heat : float
        Dimensionless heat addition Q_in* of a stroke [-] (Eq. 27, Appendix C).
    stroke_to_bore : float
        Maximum stroke over bore [-] (Appendix C).
    """

    scales: Scales
    gamma: float
    midpoint_pressure: float
    intake_pressure: float
    heat: float
    stroke_to_bore: float

    def system(self, load: Load | None = None) -> System:
        """The engine as an isentropic system, burning at dead centre.

        Parameters
        ----------
        load : Load, optional
            Work force; none unless given, as the engine's own is no function of position.

        Returns
        -------
        System
        """
        return System(
            pressure=self.midpoint_pressure,
            heat=self.heat,
            load=ConstantLoad() if load is None else load,
            gas=Isentropic(self.gamma),
        )

    def equilibrium(self, stroke: float, load: Load | None = None) -> System:
        """The engine as a system that keeps a stroke by its load (Eq. 32).

        Parameters
        ----------
        stroke : float
            Stroke S [m].
        load : Load, optional
            Kind and shape of the load; constant unless given.

        Returns
        -------
        System

        Raises
        ------
        OutsideModel
            If the stroke is not between zero and the maximum one.
        """
        return at_equilibrium(self.system(load), -0.5 * stroke / self.scales.length)

    def frequency_ratio(self, frequency: float) -> float:
        """A frequency [Hz] over sqrt(k/m) [-], the last group of Appendix C.

        As printed, without the 2 pi and the two springs of the fundamental frequency: springs
        alone give sqrt(2) / (2 pi) = 0.225.
        """
        return frequency / self.scales.frequency


@checked(engine=a(Engine), chamber=a(Chamber).optional, gamma=SCALAR.optional)
def from_engine(
    engine: Engine, chamber: Chamber | None = None, *, gamma: float | None = None
) -> Groups:
    """Dimensionless groups of an engine.

    Parameters
    ----------
    engine : Engine
    chamber : Chamber, optional
        The chamber taken for both sides, as Chapter 2 is symmetric; the engine's first one that
        burns fuel unless given.
    gamma : float, optional
        Ratio of specific heats [-]; that of the chamber's gas as it enters (cold, as Eq. 31
        assumes) unless given.

    Returns
    -------
    Groups

    Raises
    ------
    InvalidEngine
        If the engine is not valid, or has no springs to make the groups with.
    OutsideModel
        If `gamma` is not above 1.

    Examples
    --------
    >>> import saleg
    >>> groups = from_engine(saleg.machines.thesis_base())
    >>> round(groups.stroke_to_bore, 3), round(groups.intake_pressure, 4)
    (3.125, 0.1126)
    """
    engine.validate()
    if chamber is None:
        chamber = next(
            (c for c in engine.chambers if isinstance(c, CombustionChamber)), engine.left
        )
    if gamma is not None and not gamma > 1.0:
        raise OutsideModel([Problem("gamma", gamma, "-", "must be > 1")])
    return groups_of(engine, chamber, gamma)


def groups_of(engine: Engine, chamber: Any, gamma: float | None = None) -> Groups:
    """The same of a valid engine, or of one of columns.

    Raises
    ------
    InvalidEngine
        If it has no springs to make the groups with.
    """
    scales = Scales(
        half_stroke=chamber.half_stroke,
        bore=chamber.bore,
        stiffness=_stiffness(engine, chamber.half_stroke),
        mass=engine.translator.mass,
    )
    pressure, temperature, closing = chamber.reference_state
    if gamma is None:
        gamma = chamber.gas_properties.gamma(temperature)
    intake = pressure / scales.pressure
    return Groups(
        scales=scales,
        gamma=gamma,
        midpoint_pressure=intake * (closing / chamber.half_stroke) ** gamma,
        intake_pressure=intake,
        heat=_heat(chamber) / scales.energy,
        stroke_to_bore=2.0 * chamber.half_stroke / chamber.bore,
    )


def _stiffness(engine: Engine, length: float) -> float:
    """Rate of each of two springs, around the midpoint [N/m] (Eq. 42)."""
    way = 1e-3 * length
    ahead, behind = (engine.springs.force(Motion(0.0, x, 0.0, 0.0)) for x in (way, -way))
    stiffness = (behind - ahead) / (4.0 * way)
    if not stiffness > 0.0:
        allowed = "must be > 0 at the midpoint: the groups of Chapter 2 are made with the springs"
        raise InvalidEngine([Problem("springs", stiffness, "N/m", allowed)])
    return stiffness


def _heat(chamber: Chamber) -> float:
    """Heat released in a stroke of a cylinder that runs steadily [J]; none in a bounce chamber."""
    if not isinstance(chamber, CombustionChamber):
        return 0.0
    _, fuel, air, _ = standard_charge(chamber)
    burning = min(fuel, air / chamber.fuel.air_fuel_ratio)
    return burning * burning_share(chamber) * chamber.fuel.lower_heating_value
