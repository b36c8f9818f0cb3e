"""Engines that follow a demand for power: one function, and a law for each way (5.2)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from saleg.checks import NUMBER, POSITIVE, a, checked
from saleg.control.demand import Demand
from saleg.control.experiments import RAPID, rapid_start, start_up
from saleg.control.maps import OperatingMap, fuel_map, intake_map
from saleg.control.part_load import PartLoadMap
from saleg.engine import Engine
from saleg.errors import InvalidController
from saleg.laws.control.base import FuelControl, IntakeControl, LoadControl
from saleg.laws.control.fuel import FuelOnDemand, MappedFuel
from saleg.laws.control.intake import HeatedIntake, MappedIntake
from saleg.laws.control.load import PowerDemand
from saleg.quantities import Problem
from saleg.simulation.run import Run
from saleg.steady.solver import steady_state

Law = TypeVar("Law")


@checked(
    engine=a(Engine),
    load_control=a(LoadControl).optional,
    intake_control=a(IntakeControl).optional,
    fuel_control=a(FuelControl).optional,
    duration=POSITIVE,
)
def follow_demand(
    engine: Engine,
    *,
    load_control: LoadControl | None = None,
    intake_control: IntakeControl | None = None,
    fuel_control: FuelControl | None = None,
    duration: float = 6.0,
    **settings: Any,
) -> Run:
    """Start an engine up rapidly and let laws that know a demand follow it (5.2).

    Parameters
    ----------
    engine : Engine
    load_control, intake_control, fuel_control : law, optional
        Such as :class:`saleg.laws.PowerDemand`; those of :class:`saleg.Controller` unless given.
    duration : float
        Time to simulate [s].
    **settings
        Further settings of :func:`saleg.control.simulate`.

    Returns
    -------
    Run
    """
    laws = {
        "load_control": load_control,
        "intake_control": intake_control,
        "fuel_control": fuel_control,
    }
    controller = rapid_start(**{slot: law for slot, law in laws.items() if law is not None})
    return start_up(engine, RAPID, duration=duration, controller=controller, **settings)


@checked(
    engine=a(Engine),
    demand=a(Demand),
    share=NUMBER,
    proportional_gain=NUMBER,
    integral_gain=NUMBER,
)
def demand_by_load(
    engine: Engine,
    demand: Demand,
    *,
    share: float = 0.5,
    proportional_gain: float = 0.1,
    integral_gain: float = 1.0,
    **settings: Any,
) -> Run:
    """Start an engine up and let its load alone follow a demand: P+PI (5.2, Fig. 100).

    Parameters
    ----------
    engine : Engine
    demand : Demand
        Power over time.
    share, proportional_gain, integral_gain : float
        Of :class:`saleg.laws.PowerDemand` [-, -, 1/s]; the dissertation gives none of them.
    **settings
        Duration and further settings of :func:`follow_demand`.

    Returns
    -------
    Run
    """
    law = PowerDemand(
        share=share,
        proportional_gain=proportional_gain,
        integral_gain=integral_gain,
        rated_power=steady_state(engine).performance.power,
        times=demand.times,
        demands=demand.powers,
    )
    return follow_demand(engine, load_control=law, **settings)


@checked(
    engine=a(Engine),
    demand=a(Demand),
    gain=NUMBER,
    known=a(OperatingMap).optional,
    load_control=a(LoadControl).optional,
)
def demand_by_intake(
    engine: Engine,
    demand: Demand,
    *,
    gain: float = 100.0,
    known: OperatingMap | None = None,
    load_control: LoadControl | None = None,
    **settings: Any,
) -> Run:
    """Start an engine up and let its intake temperature follow a demand (5.2, Fig. 102, 103).

    Parameters
    ----------
    engine : Engine
    demand : Demand
        Power over time.
    gain : float
        Of :class:`saleg.laws.HeatedIntake` [K/s]; the dissertation does not give it.
    known : OperatingMap, optional
        Power and compression ratio over the intake temperature; :func:`intake_map` unless given.
    load_control : LoadControl, optional
        What controls the load; the stroke regulator alone unless given.
    **settings
        Duration and further settings of :func:`follow_demand`.

    Returns
    -------
    Run
    """
    law = _on_map(HeatedIntake, known or intake_map(engine), demand, gain)
    return follow_demand(engine, intake_control=law, load_control=load_control, **settings)


@checked(engine=a(Engine), demand=a(Demand), gain=NUMBER, known=a(OperatingMap).optional)
def demand_by_fuel(
    engine: Engine,
    demand: Demand,
    *,
    gain: float = 0.3,
    known: OperatingMap | None = None,
    **settings: Any,
) -> Run:
    """Start an engine up and let its equivalence ratio follow a demand (5.2).

    Parameters
    ----------
    engine : Engine
    demand : Demand
        Power over time.
    gain : float
        Of :class:`saleg.laws.FuelOnDemand` [1/s].
    known : OperatingMap, optional
        Power and compression ratio over the equivalence ratio; :func:`fuel_map` unless given.
    **settings
        Duration and further settings of :func:`follow_demand`.

    Returns
    -------
    Run
    """
    law = _on_map(FuelOnDemand, known or fuel_map(engine), demand, gain)
    return follow_demand(engine, fuel_control=law, **settings)


@checked(engine=a(Engine), demand=a(Demand), known=a(PartLoadMap), gain=NUMBER, lag=NUMBER)
def demand_by_map(
    engine: Engine,
    demand: Demand,
    known: PartLoadMap,
    *,
    gain: float = 0.3,
    lag: float = 0.05,
    **settings: Any,
) -> Run:
    """Start an engine up and let fuel and intake temperature follow a demand on one map.

    Parameters
    ----------
    engine : Engine
    demand : Demand
        Power over time.
    known : PartLoadMap
        Over equivalence ratio, intake temperature or both; what it does not vary stays rated.
    gain, lag : float
        Of :class:`saleg.laws.MappedFuel` [1/s, s].
    **settings
        Duration and further settings of :func:`follow_demand`.

    Returns
    -------
    Run

    Raises
    ------
    InvalidController
        If the map varies what a controller does not command.
    """
    commanded = ("equivalence_ratio", "intake.temperature")
    for path in known.paths:
        if path not in commanded:
            allowed = f"a controller commands {' and '.join(commanded)} alone"
            raise InvalidController([Problem("known", path, "", allowed)])
    wanted: dict[str, Any] = {
        "times": demand.times,
        "demands": demand.powers,
        "powers": known.column("power"),
    }
    laws: dict[str, Any] = {}
    if "equivalence_ratio" in known.paths:
        ratios = known.column("equivalence_ratio")
        wanted_fuel = wanted | {"lowest": min(ratios), "highest": max(ratios)}
        laws["fuel_control"] = MappedFuel(
            gain=gain, lag=lag, equivalence_ratios=ratios, **wanted_fuel
        )
    if "intake.temperature" in known.paths:
        temperatures = known.column("intake.temperature")
        laws["intake_control"] = MappedIntake(temperatures=temperatures, **wanted)
    return follow_demand(engine, **laws, **settings)


def _on_map(kind: Callable[..., Law], known: OperatingMap, demand: Demand, gain: float) -> Law:
    """Law that follows a demand on a map."""
    return kind(
        gain=gain,
        powers=known.powers,
        compression_ratios=known.compression_ratios,
        lowest=known.lowest,
        highest=known.highest,
        times=demand.times,
        demands=demand.powers,
    )
