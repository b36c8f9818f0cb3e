"""The experiments of ``saleg control``: what each does, how it is drawn, how it is reported."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg import control
from saleg.control.experiments import RECOVERED, SETTLING
from saleg.engine import Engine
from saleg.engine.controller import Controller
from saleg.laws.control.motor import ResonanceSearch
from saleg.simulation.run import Run
from saleg.steady.solver import steady_state

if TYPE_CHECKING:
    import pandas as pd

#: Amplitudes [N] at one frequency [Hz] (Fig. 94), frequencies at one amplitude (Fig. 95).
AMPLITUDES, AT_FREQUENCY = np.arange(20.0, 661.0, 20.0).tolist(), 35.0
FREQUENCIES = np.unique(np.r_[30.0:50.01:0.5, 39.0:42.01:0.1].round(6)).tolist()
AT_AMPLITUDE = 66.0
#: Base frequencies of the start-ups that are compared [Hz].
BASE_FREQUENCIES = (30.0, 35.0, 38.0, 40.0, 50.0)
#: When a demand changes, when a ramp is over [s]; by how much power falls [W] (Fig. 100 to 103).
CHANGES, RAMP_ENDS, STEP, RAMP = 2.0, 6.0, 2000.0, 3000.0
#: Phases of the motor; the force sin(2 pi f t) keeps the dates of Fig. 97, the integral does not.
PHASES = {"literal": 1.0, "integrated": 0.0}
#: When the fuel is cut [s], and the time shown before and after a misfire [s].
CUT, BEFORE, AFTER = 1.5, 0.1, 0.6
#: Numbers of strokes without fuel.
STROKES = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
#: Intake temperature of the map over the equivalence ratio (Fig. 104) [K].
WARM = 370.0


class Line(NamedTuple):
    """One line of a report: what, as seen here, and as the dissertation says, if it does."""

    what: str
    here: str
    dissertation: str = ""


@dataclass
class Done:
    """What an experiment gave.

    Attributes
    ----------
    run : Run, optional
        If it was a single run.
    table : DataFrame, optional
        If it was many.
    also : dict
        What else its drawing and report go by.
    """

    run: Run | None = None
    table: pd.DataFrame | None = None
    also: dict[str, Any] = field(default_factory=dict)

    @property
    def moved(self) -> bool:
        """Whether there is anything to draw and report; not after a run without a full cycle."""
        return self.run is None or len(self.run.cycles) > 0

    @property
    def one(self) -> Run:
        """The run of an experiment that is one."""
        assert self.run is not None
        return self.run

    @property
    def many(self) -> pd.DataFrame:
        """The table of an experiment that is many."""
        assert self.table is not None
        return self.table


@dataclass(frozen=True)
class Experiment:
    """An experiment of the command line.

    Attributes
    ----------
    summary : str
        One line on what it does.
    perform : callable
        Does it with an engine and the options below as keywords.
    pictures : dict of str to callable
        Figures by file name, each drawn from what was done.
    report : callable
        Lines on what was done.
    options : tuple of str
        Keywords it takes.
    is_run : bool
        Whether it is a single run.
    """

    summary: str
    perform: Callable[..., Done]
    pictures: dict[str, Callable[[Any, Done], Any]]
    report: Callable[[Done], list[Line]]
    options: tuple[str, ...] = ("duration",)
    is_run: bool = True


def _seconds(value: float) -> str:
    return "never" if math.isnan(value) else f"{value:.3f} s"


def _kilowatts(value: float) -> str:
    return f"{round(1e-3 * value, 2) + 0.0:.2f} kW"


def _state_at(run: Run, t: float) -> pd.Series:
    """Row of the last dead centre up to a time [s]."""
    table = run.dead_centres
    return table.iloc[max(int(np.searchsorted(table["t"], t, side="right")) - 1, 0)]


def _settled(run: Run) -> float:
    """Time from which on the compression ratio stays near its last one [s]; NaN if never fired."""
    table = run.dead_centres
    ratio = table["compression_ratio"].to_numpy()
    away = np.flatnonzero(np.abs(ratio / ratio[-1] - 1.0) > RECOVERED)
    if math.isnan(control.fired_at(run)) or not len(away):
        return math.nan
    return float(table["t"].iloc[away[-1] + 1])


# Resonance (Fig. 94, 95)


def _amplitude(engine: Engine, duration: float = SETTLING) -> Done:
    return Done(table=control.motored(engine, [AT_FREQUENCY], AMPLITUDES, duration=duration))


def _report_amplitude(done: Done) -> list[Line]:
    table = done.many
    opened = table["opened_ports"].to_numpy(dtype=bool)
    first = int(opened.argmax()) if opened.any() else -1
    amplitudes = table["motor_amplitude"]
    where = f"{amplitudes[first - 1]:g} to {amplitudes[first]:g} N" if first > 0 else "nowhere"
    greatest = 100.0 * float(table["relative_stroke"].max())
    return [
        Line("stroke over maximum, at most", f"{greatest:.1f} %", "no significant change"),
        Line("ports begin to open", where, "a small step in the curve"),
    ]


def _resonance(engine: Engine, duration: float = SETTLING) -> Done:
    return Done(table=control.motored(engine, FREQUENCIES, [AT_AMPLITUDE], duration=duration))


def _report_resonance(done: Done) -> list[Line]:
    best = done.many.iloc[int(np.nanargmax(done.many["stroke"]))]
    return [
        Line("resonance", f"{best.motor_frequency:.1f} Hz", "just above 40 Hz"),
        Line("stroke over maximum there", f"{100.0 * best.relative_stroke:.1f} %"),
        Line("compression ratio there", f"{best.compression_ratio:.2f}"),
    ]


# Start-up (Fig. 97 to 99)


def _search(phase: str) -> Controller:
    """The dissertation's controller with a phase of its motor."""
    return Controller(motor_control=ResonanceSearch(literal_phase=PHASES[phase]))


def _start_up(
    engine: Engine, base_frequency: float = 30.0, duration: float = 3.5, phase: str = "literal"
) -> Done:
    run = control.start_up(engine, base_frequency, duration=duration, controller=_search(phase))
    return Done(run=run)


def _report_start_up(done: Done) -> list[Line]:
    run, fired = done.one, control.fired_at(done.one)
    reached, opened = run.performance, control.ports_opened_at(run)
    return [
        Line("ports first open", _seconds(opened), "near 1 s, from 30 Hz"),
        Line("fired", _seconds(fired), "just before 2 s, from 30 Hz"),
        Line("settled", _seconds(_settled(run)), "under 2.5 s"),
        Line("motor came back", f"{control.motor_returns(run)} times"),
        Line("compression ratio", f"{reached.compression_ratio:.2f}", "17.9"),
        Line("frequency", f"{reached.frequency:.2f} Hz", "44.8 Hz"),
        Line("power", _kilowatts(reached.power), "3.81 kW"),
    ]


def _start_ups(engine: Engine, duration: float = 3.5, phase: str = "literal") -> Done:
    import pandas as pd

    runs = {f: _start_up(engine, f, duration, phase).one for f in BASE_FREQUENCIES}
    table = pd.DataFrame(
        {
            "base_frequency": list(runs),
            "fired_at": [control.fired_at(run) for run in runs.values()],
            "compression_ratio": [run.performance.compression_ratio for run in runs.values()],
            "status": [str(run.status) for run in runs.values()],
        }
    )
    table.attrs["units"] = {name: "-" for name in table} | {"base_frequency": "Hz", "fired_at": "s"}
    return Done(table=table, also={"runs": runs})


def _report_start_ups(done: Done) -> list[Line]:
    said = {30.0: "fires", 40.0: "never", 50.0: "never"}
    return [
        Line(f"fired from {frequency:g} Hz", _seconds(at), said.get(frequency, ""))
        for frequency, at in zip(done.many["base_frequency"], done.many["fired_at"], strict=True)
    ]


# Demand (Fig. 100 to 105)


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


def _follow(follows: Follows, wanted: Wanted, lasts: float) -> Callable[..., Done]:
    """An experiment in which something follows a demand."""

    def perform(
        engine: Engine, demand: control.Demand | None = None, duration: float = lasts
    ) -> Done:
        demand = demand or wanted(engine)
        run = follows(engine, demand, duration=duration)
        return Done(run=run, also={"demand": demand})

    return perform


def _report_demand(efficiency: str, meets: str) -> Callable[[Done], list[Line]]:
    """Report of a demand followed, beside what the dissertation says."""

    def report(done: Done) -> list[Line]:
        run, demand = done.one, done.also["demand"]
        before, last = _state_at(run, demand.times[0]), _state_at(run, math.inf)
        return [
            Line("power before", _kilowatts(before.power)),
            Line("demand at last", _kilowatts(demand.powers[-1])),
            Line("power at last", _kilowatts(last.power), meets),
            Line("compression ratio at last", f"{last.compression_ratio:.4g}"),
            Line("load weight at last", f"{last.load_weight:.3f}"),
            Line("intake temperature at last", f"{last.intake_temperature:.1f} K"),
            Line("equivalence ratio at last", f"{last.equivalence_ratio:.3f}"),
            Line("efficiency at last", f"{100.0 * run.performance.efficiency:.1f} %", efficiency),
        ]

    return report


def _intake_map(engine: Engine) -> Done:
    known = control.intake_map(engine)
    return Done(table=known.table, also={"map": known})


def _fuel_map(engine: Engine) -> Done:
    warm = engine.replace(**{"intake.temperature": WARM})
    known = control.fuel_map(warm)
    return Done(table=known.table, also={"map": known})


def _report_map(said: str) -> Callable[[Done], list[Line]]:
    """Report of an operating map."""

    def report(done: Done) -> list[Line]:
        known = done.also["map"]
        powers, ratios = known.powers, known.compression_ratios
        return [
            Line("stable steady states", f"{len(powers)} of {len(done.many)}"),
            Line("least power", _kilowatts(powers[0]), said),
            Line("greatest power", _kilowatts(powers[-1])),
            Line("compression ratios", f"{min(ratios):.2f} to {max(ratios):.2f}"),
        ]

    return report


def _map(engine: Engine) -> Done:
    maps = control.intake_map(engine), control.fuel_map(engine)
    temperatures, ratios = (known.table[known.path].tolist()[::2] for known in maps)
    return Done(table=control.operating_grid(engine, temperatures, ratios))


def _report_grid(done: Done) -> list[Line]:
    table = done.many
    good = table[(table["status"] == "steady") & table["stable"]]
    return [
        Line("stable steady states", f"{len(good)} of {len(table)}", "a significant space"),
        Line("least power", _kilowatts(good["power"].min())),
        Line("greatest power", _kilowatts(good["power"].max())),
    ]


# Misfire (Fig. 106 to 108)


def _fuel_cut(engine: Engine, duration: float = 3.0) -> Done:
    return Done(run=control.fuel_cut(engine, at=CUT, duration=duration))


def _report_fuel_cut(done: Done) -> list[Line]:
    run = done.one
    before, after = _state_at(run, CUT), _state_at(run, CUT + 0.1)
    last = _state_at(run, math.inf)
    return [
        Line("fired", _seconds(control.fired_at(run)), "rapidly, from 38 Hz"),
        Line("compression ratio before the cut", f"{before.compression_ratio:.2f}"),
        Line("0.1 s later", f"{after.compression_ratio:.2f}", "falls very steeply"),
        Line("at last", f"{last.compression_ratio:.2f}", "rings down"),
    ]


def _overload(engine: Engine, duration: float = 8.0) -> Done:
    return Done(run=control.overload(engine, duration=duration))


def _report_overload(done: Done) -> list[Line]:
    run, missed = done.one, control.first_misfire(done.one)
    late = control.late_ignitions(run)
    ratio = "-" if math.isnan(missed) else f"{_state_at(run, missed).compression_ratio:.2f}"
    return [
        Line("first charge that does not light", _seconds(missed), "near 3 s"),
        Line("compression ratio there", ratio, "below 10"),
        Line("late ignitions", f"{len(late)}", "one, with the ports closed"),
        Line("last of them", _seconds(late[-1] if len(late) else math.nan)),
    ]


def _misfire(engine: Engine, strokes: int = 1, motor: bool = True, duration: float = 3.0) -> Done:
    run = control.misfire(engine, strokes=strokes, motor=motor, at=CUT, duration=duration)
    return Done(run=run)


def _report_misfire(done: Done) -> list[Line]:
    run, table = done.one, done.one.dead_centres
    after = table[table["t"] > CUT]
    return [
        Line("least compression ratio", f"{after['compression_ratio'].min():.2f}"),
        Line("recovered after", _seconds(control.recovery_time(run, CUT)), "within half a second"),
        Line("compression ratio at last", f"{_state_at(run, math.inf).compression_ratio:.2f}"),
    ]


def _survival(engine: Engine, duration: float = 4.0) -> Done:
    return Done(table=control.misfires(engine, STROKES, at=CUT, duration=duration))


def _report_survival(done: Done) -> list[Line]:
    lines = []
    for motor, text in ((True, "with the motor"), (False, "without the motor")):
        rows = done.many[done.many["motor"] == motor]
        alive = rows[rows["survives"]]
        most = int(alive["strokes"].max()) if len(alive) else 0
        here = f"up to {most} (of {rows['strokes'].max()} tried)"
        lines.append(Line(f"strokes survived {text}", here, "1, no other tried" if motor else ""))
    return lines


def _window(done: Done) -> tuple[float, float]:
    return CUT - BEFORE, min(CUT + AFTER, done.one.duration)


DEMANDS = ("duration", "demand")
DRAW_DEMAND = {"demand.png": lambda draw, done: draw.demand(done.run, done.also["demand"])}
DRAW_MAP = {"map.png": lambda draw, done: draw.operating_map(done.also["map"])}

#: All experiments by name.
EXPERIMENTS = {
    "amplitude": Experiment(
        "motor the engine at several amplitudes (Fig. 94)",
        _amplitude,
        {"amplitude.png": lambda draw, done: draw.motored_amplitudes(done.table)},
        _report_amplitude,
        is_run=False,
    ),
    "resonance": Experiment(
        "motor the engine at several frequencies (Fig. 95)",
        _resonance,
        {"resonance.png": lambda draw, done: draw.motored_resonance(done.table)},
        _report_resonance,
        is_run=False,
    ),
    "start-up": Experiment(
        "start from rest by motored resonance (Fig. 97, 98)",
        _start_up,
        {
            "start_up.png": lambda draw, done: draw.start_up(done.run),
            "approach.png": lambda draw, done: draw.approach(done.run),
        },
        _report_start_up,
        ("duration", "base_frequency", "phase"),
    ),
    "start-ups": Experiment(
        "start from several base frequencies (Fig. 99)",
        _start_ups,
        {"start_ups.png": lambda draw, done: draw.start_ups(done.also["runs"])},
        _report_start_ups,
        ("duration", "phase"),
        is_run=False,
    ),
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
        {"map.png": lambda draw, done: draw.operating_grid(done.table)},
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
        _follow(control.demand_by_intake, _ramps, 10.0),
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
    "fuel-cut": Experiment(
        "start, run, and cut the fuel for good (Fig. 106)",
        _fuel_cut,
        {"duty_cycle.png": lambda draw, done: draw.duty_cycle(done.run)},
        _report_fuel_cut,
    ),
    "overload": Experiment(
        "load the engine ever more until it misfires (Fig. 107)",
        _overload,
        {"duty_cycle.png": lambda draw, done: draw.duty_cycle(done.run, gas=True)},
        _report_overload,
    ),
    "misfire": Experiment(
        "cut the fuel for some strokes; the motor brings the engine back (Fig. 108)",
        _misfire,
        {
            "duty_cycle.png": lambda draw, done: draw.duty_cycle(done.run),
            "recovery.png": lambda draw, done: draw.duty_cycle(done.run, window=_window(done)),
        },
        _report_misfire,
        ("duration", "strokes", "motor"),
    ),
    "survival": Experiment(
        "how many strokes without fuel the engine survives (5.3)",
        _survival,
        {"survival.png": lambda draw, done: draw.survival(done.table)},
        _report_survival,
        is_run=False,
    ),
}
