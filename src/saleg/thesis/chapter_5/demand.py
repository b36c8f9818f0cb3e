"""Power on demand: by load, intake temperature or fuel (5.2, Figures 100 to 105)."""

from __future__ import annotations

import math
from collections.abc import Callable

from saleg import control
from saleg.control.experiments import EQUIVALENCE_RATIOS, INTAKE_TEMPERATURES
from saleg.engine import Engine
from saleg.plotting import control as draw
from saleg.simulation.run import Run
from saleg.steady.solver import steady_state
from saleg.thesis.experiment import Experiment, Line, Result, kilowatts, state_at

#: When a demand changes, when a ramp is over [s]; by how much power falls [W] (Fig. 100 to 103).
CHANGES, RAMP_ENDS, STEP, RAMP = 2.0, 6.0, 2000.0, 3000.0
#: Intake temperature of the map over the equivalence ratio (Fig. 104) [K].
WARM = 370.0


def _rated_power(engine: Engine) -> float:
    return steady_state(engine).performance.power


def _falls(engine: Engine) -> control.Demand:
    """A step down from rated power."""
    power = _rated_power(engine)
    return control.Demand.step(CHANGES, power, max(power - STEP, 0.0))


def _ramps(engine: Engine) -> control.Demand:
    """A ramp down from rated power."""
    power = _rated_power(engine)
    return control.Demand.ramp(CHANGES, RAMP_ENDS, power, max(power - RAMP, 0.0))


Follows = Callable[..., Run]
Wanted = Callable[[Engine], control.Demand]


def _follow(follows: Follows, wanted: Wanted, lasts: float) -> Callable[..., Result]:
    """An experiment in which something follows a demand."""

    def perform(
        engine: Engine, demand: control.Demand | None = None, duration: float = lasts
    ) -> Result:
        demand = demand or wanted(engine)
        run = follows(engine, demand, duration=duration)
        return Result(run=run, also={"demand": demand})

    return perform


def _report_demand(efficiency: str, meets: str) -> Callable[[Result], list[Line]]:
    """Report of a demand followed, beside what the dissertation says."""

    def report(result: Result) -> list[Line]:
        run, demand = result.one, result.also["demand"]
        before, last = state_at(run, demand.times[0]), state_at(run, math.inf)
        return [
            Line("power before", kilowatts(before.power)),
            Line("demand at last", kilowatts(demand.powers[-1])),
            Line("power at last", kilowatts(last.power), meets),
            Line("compression ratio at last", f"{last.compression_ratio:.4g}"),
            Line("load weight at last", f"{last.load_weight:.3f}"),
            Line("intake temperature at last", f"{last.intake_temperature:.1f} K"),
            Line("equivalence ratio at last", f"{last.equivalence_ratio:.3f}"),
            Line("efficiency at last", f"{100.0 * run.performance.efficiency:.1f} %", efficiency),
        ]

    return report


def _intake_map(engine: Engine) -> Result:
    known = control.operating_map(engine, "intake.temperature", INTAKE_TEMPERATURES)
    return Result(table=known.table, also={"map": known})


def _fuel_map(engine: Engine) -> Result:
    warm = engine.replace(**{"intake.temperature": WARM})
    known = control.operating_map(warm, "equivalence_ratio", EQUIVALENCE_RATIOS)
    return Result(table=known.table, also={"map": known})


def _report_map(said: str) -> Callable[[Result], list[Line]]:
    """Report of an operating map."""

    def report(result: Result) -> list[Line]:
        known = result.also["map"]
        powers, ratios = known.powers, known.compression_ratios
        return [
            Line("stable steady states", f"{len(powers)} of {len(result.many)}"),
            Line("least power", kilowatts(powers[0]), said),
            Line("greatest power", kilowatts(powers[-1])),
            Line("compression ratios", f"{min(ratios):.2f} to {max(ratios):.2f}"),
        ]

    return report


def _map(engine: Engine) -> Result:
    return Result(table=control.operating_grid(engine, INTAKE_TEMPERATURES, EQUIVALENCE_RATIOS))


def _report_grid(result: Result) -> list[Line]:
    table = result.many
    good = table[(table["status"] == "steady") & table["stable"]]
    return [
        Line("stable steady states", f"{len(good)} of {len(table)}", "a significant space"),
        Line("least power", kilowatts(good["power"].min())),
        Line("greatest power", kilowatts(good["power"].max())),
    ]


DEMANDS = ("duration", "demand")
DRAW_DEMAND = {"demand.png": lambda result: draw.demand(result.one, result.also["demand"])}
DRAW_MAP = {"map.png": lambda result: draw.operating_map(result.also["map"])}

#: Experiments by name.
EXPERIMENTS = {
    "load-step": Experiment(
        "let the load alone answer a step in demand: it runs away (Fig. 100)",
        _follow(control.demand_by_load, _falls, 6.0),
        DRAW_DEMAND,
        _report_demand("", "runs away"),
        DEMANDS,
    ),
    "intake-map": Experiment(
        "steady states over the intake temperature (Fig. 101)",
        _intake_map,
        DRAW_MAP,
        _report_map(""),
        (),
        is_run=False,
    ),
    "fuel-map": Experiment(
        f"steady states over the equivalence ratio at {WARM:g} K (Fig. 104)",
        _fuel_map,
        DRAW_MAP,
        _report_map("below 1 kW"),
        (),
        is_run=False,
    ),
    "map": Experiment(
        "steady states over intake temperature and equivalence ratio (Fig. 105)",
        _map,
        {"map.png": lambda result: draw.operating_grid(result.many)},
        _report_grid,
        (),
        is_run=False,
    ),
    "intake-step": Experiment(
        "let the intake temperature answer a step in demand (Fig. 102)",
        _follow(control.demand_by_intake, _falls, 6.0),
        DRAW_DEMAND,
        _report_demand("22 %", "meets the demand"),
        DEMANDS,
    ),
    "intake-ramp": Experiment(
        "let the intake temperature answer a ramp in demand (Fig. 103)",
        _follow(control.demand_by_intake, _ramps, 8.0),
        DRAW_DEMAND,
        _report_demand("15 %", "follows until outside the map"),
        DEMANDS,
    ),
    "fuel-step": Experiment(
        "let the equivalence ratio answer a step in demand (5.2)",
        _follow(control.demand_by_fuel, _falls, 6.0),
        DRAW_DEMAND,
        _report_demand("", "proposed, not shown"),
        DEMANDS,
    ),
}
