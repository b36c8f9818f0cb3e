"""Power on demand: by load, intake temperature or fuel (5.2, Figures 100 to 105)."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from saleg import Engine, Run, control, steady_state
from saleg.control import Demand, OperatingMap
from saleg.plotting import control as plots
from saleg.thesis.experiment import Experiment, Line, kilowatts, state_at

if TYPE_CHECKING:
    import pandas as pd

#: When a demand changes, when a ramp is over [s]; by how much power falls [W] (Fig. 100 to 103).
CHANGES, RAMP_ENDS, STEP, RAMP = 2.0, 6.0, 2000.0, 3000.0
#: Time simulated after a step and after a ramp [s].
STEP_LASTS, RAMP_LASTS = 6.0, 12.0
#: Intake temperature of the map over the equivalence ratio (Fig. 104) [K].
WARM = 370.0


class Followed(NamedTuple):
    """Run in which something followed a demand."""

    run: Run
    demand: Demand


def step_down(engine: Engine) -> Demand:
    """Demand that steps down from rated power."""
    power = steady_state(engine).performance.power
    return Demand.step(CHANGES, power, max(power - STEP, 0.0))


def ramp_down(engine: Engine) -> Demand:
    """Demand that falls evenly from rated power."""
    power = steady_state(engine).performance.power
    return Demand.ramp(CHANGES, RAMP_ENDS, power, max(power - RAMP, 0.0))


def load_step(
    engine: Engine, demand: Demand | None = None, duration: float = STEP_LASTS
) -> Followed:
    """Step in demand answered by the load alone (Fig. 100)."""
    wanted = demand or step_down(engine)
    return Followed(control.demand_by_load(engine, wanted, duration=duration), wanted)


def intake_step(
    engine: Engine, demand: Demand | None = None, duration: float = STEP_LASTS
) -> Followed:
    """Step in demand answered by the intake temperature (Fig. 102)."""
    wanted = demand or step_down(engine)
    return Followed(control.demand_by_intake(engine, wanted, duration=duration), wanted)


def intake_ramp(
    engine: Engine, demand: Demand | None = None, duration: float = RAMP_LASTS
) -> Followed:
    """Ramp in demand answered by the intake temperature (Fig. 103)."""
    wanted = demand or ramp_down(engine)
    return Followed(control.demand_by_intake(engine, wanted, duration=duration), wanted)


def fuel_step(
    engine: Engine, demand: Demand | None = None, duration: float = STEP_LASTS
) -> Followed:
    """Step in demand answered by the equivalence ratio (5.2)."""
    wanted = demand or step_down(engine)
    return Followed(control.demand_by_fuel(engine, wanted, duration=duration), wanted)


def draw_demand(found: Followed) -> object:
    """Power beside the demand, and how it was met (Fig. 100, 102, 103)."""
    return plots.demand(found.run, found.demand)


def report_demand(found: Followed, power: str, efficiency: str = "") -> list[Line]:
    """State before the demand changed and at last; what the dissertation says of the last."""
    run, demand = found
    before, last = state_at(run, demand.times[0]), state_at(run, math.inf)
    return [
        Line("power before", kilowatts(before.power)),
        Line("demand at last", kilowatts(demand.powers[-1])),
        Line("power at last", kilowatts(last.power), power),
        Line("compression ratio at last", f"{last.compression_ratio:.4g}"),
        Line("load weight at last", f"{last.load_weight:.3f}"),
        Line("intake temperature at last", f"{last.intake_temperature:.1f} K"),
        Line("equivalence ratio at last", f"{last.equivalence_ratio:.3f}"),
        Line("efficiency at last", f"{100.0 * run.performance.efficiency:.1f} %", efficiency),
    ]


def intake_map(engine: Engine) -> OperatingMap:
    """Steady states over the intake temperature (Fig. 101)."""
    return control.intake_map(engine)


def fuel_map(engine: Engine) -> OperatingMap:
    """Steady states over the equivalence ratio, with a warm intake (Fig. 104)."""
    return control.fuel_map(engine.replace(**{"intake.temperature": WARM}))


def report_map(known: OperatingMap, least: str = "") -> list[Line]:
    """How far a map reaches; what the dissertation says of the least power."""
    powers, ratios = known.powers, known.compression_ratios
    return [
        Line("stable steady states", f"{len(powers)} of {len(known.table)}"),
        Line("least power", kilowatts(powers[0]), least),
        Line("greatest power", kilowatts(powers[-1])),
        Line("compression ratios", f"{min(ratios):.2f} to {max(ratios):.2f}"),
    ]


def grid(engine: Engine) -> pd.DataFrame:
    """Steady states over intake temperature and equivalence ratio (Fig. 105)."""
    maps = control.intake_map(engine), control.fuel_map(engine)
    temperatures, ratios = (known.table[known.path].tolist()[::2] for known in maps)
    return control.operating_grid(engine, temperatures, ratios)


def report_grid(table: pd.DataFrame) -> list[Line]:
    """How much of the grid can be reached."""
    good = table[(table["status"] == "steady") & table["stable"]]
    return [
        Line("stable steady states", f"{len(good)} of {len(table)}", "a significant space"),
        Line("least power", kilowatts(good["power"].min())),
        Line("greatest power", kilowatts(good["power"].max())),
    ]


def _followed(
    summary: str, run: Callable[..., Followed], power: str, efficiency: str = ""
) -> Experiment:
    """Experiment with a demand, and what the dissertation says of how it ends."""
    report = partial(report_demand, power=power, efficiency=efficiency)
    return Experiment(summary, run, {"demand.png": draw_demand}, report)


#: Experiments by name.
EXPERIMENTS = {
    "load-step": _followed(
        "let the load alone answer a step in demand: it runs away (Fig. 100)",
        load_step,
        power="runs away",
    ),
    "intake-map": Experiment(
        "steady states over the intake temperature (Fig. 101)",
        intake_map,
        {"map.png": plots.operating_map},
        report_map,
        is_run=False,
    ),
    "fuel-map": Experiment(
        f"steady states over the equivalence ratio at {WARM:g} K (Fig. 104)",
        fuel_map,
        {"map.png": plots.operating_map},
        partial(report_map, least="below 1 kW"),
        is_run=False,
    ),
    "map": Experiment(
        "steady states over intake temperature and equivalence ratio (Fig. 105)",
        grid,
        {"map.png": plots.operating_grid},
        report_grid,
        is_run=False,
    ),
    "intake-step": _followed(
        "let the intake temperature answer a step in demand (Fig. 102)",
        intake_step,
        power="meets the demand",
        efficiency="22 %",
    ),
    "intake-ramp": _followed(
        "let the intake temperature answer a ramp in demand (Fig. 103)",
        intake_ramp,
        power="follows until outside the map",
        efficiency="15 %",
    ),
    "fuel-step": _followed(
        "let the equivalence ratio answer a step in demand (5.2)",
        fuel_step,
        power="proposed, not shown",
    ),
}
