"""What Chapter 5 says of Figures 92 to 108."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from saleg import control
from saleg.thesis.chapter_5 import misfire, start_up
from saleg.thesis.claims.claim import Claim, Shown, near
from saleg.thesis.experiment import state_at


def _performance(name: str, factor: float = 1.0) -> Any:
    return lambda run: float(factor * getattr(run.performance, name))


def _resonance(table: Any) -> float:
    return float(table["motor_frequency"].iloc[int(np.nanargmax(table["stroke"]))])


def _last(name: str, factor: float = 1.0) -> Any:
    return lambda found: float(factor * state_at(found.run, math.inf)[name])


def _efficiency(found: Any) -> float:
    return float(100.0 * found.run.performance.efficiency)


def _fired(frequency: float) -> Any:
    return lambda found: float(found.table.set_index("base_frequency")["fired_at"][frequency])


def _never(frequency: float) -> Any:
    return lambda found: float(math.isnan(_fired(frequency)(found)))


SHOWN = (
    Shown(
        (92,),
        "Engine of Chapter 5: motion and pressure",
        "Motion and peak are those of Table 13.",
        (
            near("stroke [mm]", _performance("stroke", 1e3), 83.5, 0.005),
            near("compression ratio [-]", _performance("compression_ratio"), 17.9, 0.03),
            near("peak pressure [bar]", _performance("peak_pressure", 1e-5), 102, 0.035),
            near("peak velocity [m/s]", _performance("peak_velocity"), 11.2, 0.02),
        ),
    ),
    Shown(
        (93,),
        "Engine of Chapter 5: forces and energy",
        "Power and mean force of the alternator are those of Table 13.",
        (
            near("power [kW]", _performance("power", 1e-3), 3.81, 0.035),
            near("mean alternator force [N]", _performance("mean_alternator_force"), 449, 0.025),
            near("efficiency [%]", _performance("efficiency", 100.0), 38.2, 0.02),
        ),
    ),
    Shown(
        (94,),
        "Motored at several amplitudes",
        "Linear with a small step where the ports open, as printed.",
        (
            Claim(
                "greatest compression ratio [-]",
                lambda table: float(table["compression_ratio"].max()),
                "no significant change",
                1.0,
                1.6,
            ),
        ),
    ),
    Shown(
        (95,),
        "Motored at several frequencies",
        "The resonance is where the text has it.",
        (Claim("resonance [Hz]", _resonance, "just above 40", 40.0, 40.5),),
    ),
    Shown(
        (97,),
        "Start-up: commands, pressure and temperature",
        "Ports open and the engine is fired at the printed times.",
        (
            near("ports first open [s]", lambda run: control.ports_opened_at(run), 1, 0.1),
            Claim("fired [s]", lambda run: control.fired_at(run), "just before 2", 1.9, 2.0),
        ),
    ),
    Shown(
        (98,),
        "Start-up: compression ratio and stroke",
        "Running within the printed time, as Table 13 has it.",
        (
            Claim("settled [s]", start_up.settled_at, "under 2.5", 1.9, 2.5),
            near("compression ratio at last [-]", _performance("compression_ratio"), 17.9, 0.03),
        ),
    ),
    Shown(
        (99,),
        "Start-ups from several base frequencies",
        "As printed, it starts from below the resonance, sooner from nearer, and never from it.",
        (
            Claim("fired from 30 Hz [s]", _fired(30.0), "fires", 1.9, 2.0),
            Claim("fired from 38 Hz [s]", _fired(38.0), "sooner", 0.1, 1.9),
            Claim("never fired from 40 Hz [-]", _never(40.0), "never", 1.0, 1.0),
            Claim("never fired from 50 Hz [-]", _never(50.0), "never", 1.0, 1.0),
        ),
    ),
    Shown(
        (100,),
        "Step in demand answered by the load alone",
        "The load alone ends in a runaway, as printed.",
        (
            Claim(
                "greatest compression ratio [-]",
                lambda found: float(found.run.dead_centres["compression_ratio"].max()),
                "runaway",
                100.0,
                1e9,
            ),
        ),
    ),
    Shown(
        (101,),
        "Map over the intake temperature",
        "A hotter intake lowers power and compression ratio, down to a limit, as printed.",
        (
            Claim(
                "least power over greatest [-]",
                lambda known: float(min(known.powers) / max(known.powers)),
                "a specific range",
                0.0,
                0.6,
            ),
        ),
    ),
    Shown(
        (102,),
        "Step in demand answered by the intake temperature",
        "The demand is met, as printed; efficiency falls less.",
        (
            near(
                "power at last over demand [-]",
                lambda f: _last("power")(f) / f.demand.powers[-1],
                1,
                0.01,
            ),
            Claim("efficiency at last [%]", _efficiency, "22", 20.0, 27.0),
        ),
    ),
    Shown(
        (103,),
        "Ramp in demand answered by the intake temperature",
        "Power follows the demand, at the printed efficiency.",
        (near("efficiency at last [%]", _efficiency, 15, 0.05),),
    ),
    Shown(
        (104,),
        "Map over the equivalence ratio with a warm intake",
        "Stable below one kilowatt, as printed.",
        (
            Claim(
                "least power [W]",
                lambda known: float(min(known.powers)),
                "below 1000",
                0.0,
                1000.0,
            ),
        ),
    ),
    Shown(
        (105,),
        "Map over both",
        "A large part of the map is stable, as printed.",
        (
            Claim(
                "stable points of all [%]",
                lambda t: float(100.0 * ((t["status"] == "steady") & t["stable"]).mean()),
                "a significant amount",
                40.0,
                100.0,
            ),
        ),
    ),
    Shown(
        (106,),
        "Start, operation, fuel cut",
        "Compression falls very steeply after the cut, as printed.",
        (
            Claim(
                "least compression ratio within two cycles of the cut [-]",
                lambda run: float(
                    run.dead_centres[run.dead_centres["t"] > misfire.CUT]["compression_ratio"]
                    .iloc[:4]
                    .min()
                ),
                "very steep",
                1.0,
                12.0,
            ),
        ),
    ),
    Shown(
        (107,),
        "Overload until misfire",
        "It misfires near the printed time; late ignitions follow, more than the one of the text.",
        (
            near("first misfire [s]", lambda run: control.first_misfire(run), 3, 0.1),
            Claim(
                "late ignitions [-]",
                lambda run: float(len(control.late_ignitions(run))),
                "1",
                1.0,
                1e3,
            ),
        ),
    ),
    Shown(
        (108,),
        "Recovery from a misfire",
        "The motor brings it back within the printed time.",
        (
            Claim(
                "recovered after [s]",
                lambda run: control.recovery_time(run, misfire.CUT),
                "within 0.5",
                0.0,
                0.5,
            ),
        ),
    ),
)
