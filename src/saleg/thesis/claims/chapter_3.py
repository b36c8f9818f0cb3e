"""What Chapter 3 says of Figures 36 to 61."""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.thesis.claims.claim import Claim, Shown, near


def _row(found: Any, value: Any) -> Any:
    """Row of a study or a table by its value; the nearest if that is a number."""
    table = getattr(found, "table", found)
    if isinstance(value, str):
        return table[table["value"] == value].iloc[0]
    return table.iloc[int((table["value"].astype(float) - value).abs().argmin())]


def _spread(found: Any, figure: str) -> float:
    """Greatest deviation from the first row of a study [%]."""
    values = found.table[figure].to_numpy(dtype=float)
    return float(100.0 * np.abs(values / values[0] - 1.0).max())


def _at_greatest_velocity(run: Any) -> float:
    """Position [mm] of the greatest velocity to the right: where the acceleration passes zero."""
    history = run.orbit.history
    highest = int(np.argmax(history["v"]))
    around = history[highest - 1 : highest + 2]
    return float(1e3 * np.interp(0.0, -around["a"], around["x"]))


def _heat_lost(run: Any) -> float:
    energy = run.energy
    return float(100.0 * (energy.heat_transfer + energy.exhaust) / energy.fuel)


def _performance(name: str, factor: float = 1.0) -> Any:
    return lambda run: float(factor * getattr(run.performance, name))


def _change(figure: str, first: Any, last: Any) -> Any:
    """Change of a figure between two rows [%]."""
    return lambda found: float(
        100.0 * (_row(found, last)[figure] / _row(found, first)[figure] - 1.0)
    )


def _response(table: Any, parameter: str, figure: str) -> float:
    """Range of a figure over the rows of one parameter that stayed stable, over the least [%]."""
    rows = table[(table["parameter"] == parameter) & table["stable"]]
    return float(100.0 * (rows[figure].max() / rows[figure].min() - 1.0))


BASE = (
    Shown(
        (36,),
        "Base case: velocity over position",
        "Stroke as printed; the velocity is greatest before the midpoint, as the text says.",
        (
            near("stroke [mm]", _performance("stroke", 1e3), 181, 0.005),
            Claim(
                "position of the greatest velocity [mm]",
                _at_greatest_velocity,
                "before the midpoint",
                -60.0,
                -1.0,
            ),
        ),
    ),
    Shown(
        (37,),
        "Base case: acceleration over velocity",
        "The peak is Table 1's less what its step of 5 µs adds ([studies](studies.md)).",
        (near("peak acceleration [km/s²]", _performance("peak_acceleration", 1e-3), 16.3, 0.02),),
    ),
    Shown(
        (38,),
        "Base case: pressure over position",
        "The peak is that of the finest step of Table 2; Table 1's 106 bar carry its step's error.",
        (near("peak pressure [bar]", _performance("peak_pressure", 1e-5), 103.3, 0.015),),
    ),
    Shown(
        (39,),
        "Base case: pressure and heat flow over time",
        "Walls take less than the 16 % of the text with the coefficient it prints "
        "([physics](physics.md)).",
        (
            Claim(
                "heat to the walls [% of the fuel]",
                lambda run: 100.0 * run.energy.heat_transfer / run.energy.fuel,
                "16",
                11.4,
                12.0,
            ),
        ),
    ),
    Shown(
        (40,),
        "Base case: power and efficiency over time",
        "Mean power is that of Table 1, the efficiency that of its finest step.",
        (
            near("mean power [kW]", _performance("power", 1e-3), 22.7, 0.01),
            near(
                "efficiency, finest row of Table 2 [%]",
                _performance("efficiency", 100),
                34.38,
                0.015,
            ),
        ),
    ),
    Shown(
        (41,),
        "Base case: energy balance",
        "Walls and exhaust take two points less than printed.",
        (near("heat to walls and exhaust [% of the fuel]", _heat_lost, 55, 0.04),),
    ),
    Shown(
        (42,),
        "Base case: settling",
        "Settled within the first second, as printed.",
        (
            Claim(
                "stroke at 1 s over that at last [-]",
                lambda run: float(
                    run.cycles["stroke"][run.cycles["t"] <= 1.0].iloc[-1] / run.performance.stroke
                ),
                "steady",
                0.9999,
                1.0001,
            ),
        ),
    ),
)

MODELS = (
    Shown(
        (43,),
        "Parameters of Hohenberg's correlation",
        "As printed, every parameter changes the heat and the frequency.",
        (
            Claim(
                "change of the heat to the walls over exponent c [%]",
                lambda table: _response(table, "heat_transfer.c", "heat_transfer_share"),
                "significant",
                100.0,
                2000.0,
            ),
        ),
    ),
    Shown(
        (44,),
        "Heat flow under four heat-transfer laws",
        "At equal heat the laws differ in when they take it, as printed, and little in pressure.",
        (
            Claim(
                "greatest change of the peak pressure [%]",
                lambda found: _spread(found, "peak_pressure"),
                "subtle difference",
                0.5,
                5.0,
            ),
        ),
    ),
    Shown(
        (45,),
        "Motion under four heat-transfer laws",
        "The motion hardly feels the law, as printed.",
        (
            Claim(
                "greatest change of the stroke [%]",
                lambda found: _spread(found, "stroke"),
                "subtle difference",
                0.0,
                0.6,
            ),
        ),
    ),
    Shown(
        (46,),
        "CFR ignition: leading coefficient A",
        "A small A lights early and costs adverse work, as printed.",
        (
            Claim(
                "adverse work at the least A [J]",
                lambda found: float(found.table["adverse_work"].iloc[0]),
                "adverse work",
                5.0,
                40.0,
            ),
            Claim(
                "adverse work at the greatest A [J]",
                lambda found: float(found.table["adverse_work"].iloc[-1]),
                "late pressure rise",
                -0.01,
                0.5,
            ),
        ),
    ),
    Shown(
        (47,),
        "CFR ignition: motion over the temperature coefficient b",
        "The smallest b gives no stable engine, as printed.",
        (
            Claim(
                "stable engines at the least b [-]",
                lambda found: float(found.table["stable"].iloc[0]),
                "will eventually stall",
                0.0,
                0.0,
            ),
        ),
    ),
    Shown(
        (48,),
        "CFR ignition: pressure over the temperature coefficient b",
        "Engines with a full stroke peak above 80 bar, as printed.",
        (
            Claim(
                "peak pressure at the printed b [bar]",
                lambda found: 1e-5 * float(_row(found, 16909.0)["peak_pressure"]),
                "above 80",
                80.0,
                110.0,
            ),
        ),
    ),
    Shown(
        (49,),
        "Equivalence ratio under CFR ignition",
        "Less fuel means less stroke and pressure without adverse work, as printed.",
        (
            Claim(
                "greatest adverse work [J]",
                lambda found: float(found.table["adverse_work"].max()),
                "negligible",
                0.0,
                2.0,
            ),
        ),
    ),
    Shown(
        (50,),
        "Parameters of the CFR correlation",
        "b and n are those that reach the end of operation, as printed.",
        (
            Claim(
                "unstable points over b and n [-]",
                lambda table: float(
                    (~table["stable"] & table["parameter"].str.contains("b$|n$")).sum()
                ),
                "greatest impact, unstable points",
                1.0,
                40.0,
            ),
            Claim(
                "unstable points over A [-]",
                lambda table: float(
                    (~table["stable"] & table["parameter"].str.endswith("A")).sum()
                ),
                "none",
                0.0,
                0.0,
            ),
        ),
    ),
    Shown(
        (51,),
        "CFR and RCM ignition",
        "Ours contradicts the print: RCM lights later, so compression ratio and peak rise "
        "([sensitivity](sensitivity.md)).",
        (
            Claim(
                "change of the compression ratio with RCM [%]",
                lambda found: float(
                    100.0
                    * (
                        found.table["compression_ratio"].iloc[1]
                        / found.table["compression_ratio"].iloc[0]
                        - 1.0
                    )
                ),
                "smaller",
                5.0,
                20.0,
            ),
        ),
    ),
    Shown(
        (52,),
        "Retained exhaust gas under RCM ignition",
        "Peak pressure falls and efficiency hardly moves, as printed; power falls with the fuel.",
        (
            Claim(
                "change of the efficiency from 0 to 40 % [%]",
                _change("efficiency", 0.0, 0.4),
                "little effect",
                -2.0,
                2.0,
            ),
            Claim(
                "change of the peak pressure [%]",
                _change("peak_pressure", 0.0, 0.4),
                "reducing",
                -50.0,
                -20.0,
            ),
        ),
    ),
    Shown(
        (53,),
        "Combustion duration: motion",
        "Durations that are too long are unstable, as printed.",
        (
            Claim(
                "stable engines beyond 12 ms [-]",
                lambda found: float(found.table["stable"][found.table["value"] > 0.012].sum()),
                "unstable behaviour",
                0.0,
                0.0,
            ),
        ),
    ),
    Shown(
        (54,),
        "Combustion duration: pressure",
        "Long combustion lowers the peak; the base case's inferred 1.25 ms give that of Table 5.",
        (
            near(
                "peak pressure at 1.25 ms [bar]",
                lambda found: 1e-5 * float(_row(found, 1.25e-3)["peak_pressure"]),
                103.2,
                0.01,
            ),
        ),
    ),
    Shown(
        (55,),
        "Combustion duration: trends",
        "Frequency and heat loss fall as printed; compression ratio and efficiency do not change "
        "less than the frequency.",
        (
            Claim(
                "change of the frequency from 0.1 to 10 ms [%]",
                _change("frequency", 1e-4, 0.01),
                "significant decrease",
                -30.0,
                -10.0,
            ),
            Claim(
                "change of the heat to the walls [%]",
                _change("heat_transfer_share", 1e-4, 0.01),
                "reduced",
                -90.0,
                -40.0,
            ),
            Claim(
                "change of the efficiency from 0.1 to 4 ms [%]",
                _change("efficiency", 1e-4, 0.004),
                "relatively smaller",
                20.0,
                70.0,
            ),
        ),
    ),
    Shown(
        (56,),
        "Single and double Wiebe functions",
        "The profiles of the print are not given and were fitted to Table 5.",
        (
            near(
                "frequency under the single Wiebe function [Hz]",
                lambda found: float(_row(found, "single Wiebe (base)")["frequency"]),
                47.02,
                0.005,
            ),
        ),
    ),
    Shown(
        (57,),
        "Pressure under either",
        "Stroke and peak of all three are those of Table 5.",
        tuple(
            near(
                f"peak pressure, {name} [bar]",
                lambda found, name=name: 1e-5 * float(_row(found, name)["peak_pressure"]),  # type: ignore[misc]
                printed,
                0.01,
            )
            for name, printed in (
                ("single Wiebe (base)", 103.2),
                ("double Wiebe (1)", 105.9),
                ("double Wiebe (2)", 96.94),
            )
        ),
    ),
    Shown(
        (58,),
        "Gain of the stroke regulator",
        "Over a range of gains nothing of significance changes, as printed; from 14 on ours is "
        "unstable.",
        (
            Claim(
                "change of the power from a gain of 2 to 10 [%]",
                _change("power", 2.0, 10.0),
                "no significant effect",
                -3.0,
                3.0,
            ),
        ),
    ),
    Shown(
        (59,),
        "Target stroke of the regulator",
        "Stroke and velocity grow with the target, as printed.",
        (
            Claim(
                "change of the stroke from a target of 0.8 to 0.95 [%]",
                _change("stroke", 0.8, 0.95),
                "increase",
                8.0,
                20.0,
            ),
        ),
    ),
)

PROTOTYPES = (
    Shown(
        (60,),
        "Prototype of Ulsan",
        "The measured curves are printed as a picture only; load, friction and walls are open, so "
        "ours shows what Table 6 leads to; nothing of it is validated.",
        (
            Claim(
                "stroke over the maximum [-]",
                lambda run: run.performance.stroke / 0.031,
                "not printed as a number",
                0.88,
                0.95,
            ),
        ),
    ),
    Shown(
        (61,),
        "Prototype of West Virginia",
        "As for Ulsan; the equivalence ratio is chosen to release the heat of Table 6.",
        (
            near(
                "heat released per stroke [J]",
                lambda run: 0.5 * 0.95 * run.performance.fuel_energy_per_cycle,
                25.0,
                0.01,
            ),
        ),
    ),
)

SHOWN = (*BASE, *MODELS, *PROTOTYPES)
