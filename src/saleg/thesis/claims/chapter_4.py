"""What Chapter 4 and Appendix C say of Figures 63 to 91 and 115 to 124."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from saleg.design import formulas
from saleg.thesis import optimisation
from saleg.thesis.claims.claim import Claim, Shown, near


def _stable(table: Any) -> Any:
    return table[table["stable"]]


def _border(name: str, factor: float, last: bool = False) -> Callable[[Any], float]:
    """Least value of an input, or the greatest, from which the engine is stable."""
    return lambda table: float(factor * _stable(table)[name].iloc[-1 if last else 0])


def _at(name: str, value: float, figure: str, factor: float = 1.0) -> Callable[[Any], float]:
    """Figure at a value of the input."""
    return lambda table: float(factor * np.interp(value, table[name], table[figure]))


def _change(figure: str) -> Callable[[Any], float]:
    """Change of a figure from the first to the last stable point [%]."""

    def change(table: Any) -> float:
        values = _stable(table)[figure]
        return float(100.0 * (values.iloc[-1] / values.iloc[0] - 1.0))

    return change


def _pair(first: int, title: str, says: str, *claims: Claim) -> Shown:
    return Shown((first, first + 1), title, says, claims)


EQUATIONS = (
    Shown(
        (63,),
        "Diameter of the alternator",
        "Eq. 60 as printed; power, stroke and speed of the 20 m of the text are not given; "
        "10 kW at a short stroke and a low speed come near.",
        (
            Claim(
                "diameter at 10 kW, 20 mm and 10 Hz [m]",
                lambda _: float(
                    formulas.alternator_diameter(1e4, 0.02, formulas.mean_speed(0.02, 10.0))
                ),
                "20",
                15.0,
                17.0,
            ),
        ),
    ),
    Shown(
        (65,),
        "Mass of the piston heads",
        "Eq. 65 as printed.",
        (
            near(
                "mass of both heads at 64 mm [kg]",
                lambda _: formulas.piston_mass(0.064),
                82.3 * 0.064**2 + 0.0136 * 0.064 - 8.16e-5,
                1e-9,
            ),
        ),
    ),
    Shown(
        (66,),
        "Natural frequency over spring stiffness",
        "As printed, the mass of the springs takes back part of what stiffness gives.",
        (
            near(
                "mass of springs of 350 kN/m [kg]",
                lambda _: formulas.spring_mass(350e3),
                10.0,
                1e-9,
            ),
        ),
    ),
)

SWEEPS = (
    _pair(
        67,
        "Sweep of the bore",
        "Stable from nearly the printed bore on; the runaway from 80 mm has no orbit of ours "
        "([sweeps](sweeps.md)).",
        near("least stable bore [mm]", _border("bore", 1e3), 50, 0.08),
        Claim(
            "compression ratio at 80 mm [-]",
            _at("bore", 0.08, "compression_ratio"),
            "50",
            25.0,
            35.0,
        ),
    ),
    _pair(
        69,
        "Sweep of the neutral clearance length",
        "All falls as printed and a beat sets in, 30 mm later; stable down to 40 mm, not 50.",
        near(
            "length at which the beat sets in [mm]",
            lambda table: 1e3 * float(table["half_stroke"][~table["stable"]].iloc[0]),
            250,
            0.14,
        ),
        Claim(
            "efficiency at 50 mm [%]",
            _at("half_stroke", 0.05, "efficiency", 100.0),
            "greater than 40",
            40.0,
            50.0,
        ),
        Claim(
            "length of the greatest power density [mm]",
            lambda table: 1e3 * float(table["half_stroke"][table["power_density"].idxmax()]),
            "135",
            135.0,
            175.0,
        ),
    ),
    _pair(
        71,
        "Sweep of the port location",
        "Bounded on both sides, and efficiency hardly moves in between, as printed.",
        Claim(
            "range of the efficiency from 0.1 to 0.5 [points]",
            lambda table: float(
                100.0 * np.ptp(table["efficiency"][table["port_location"].between(0.1, 0.5)])
            ),
            "negligible",
            0.0,
            2.0,
        ),
    ),
    _pair(
        73,
        "Sweep of the intake pressure",
        "All rises as printed; the limit at two bar is not ours ([sweeps](sweeps.md)).",
        Claim(
            "greatest stable pressure, of up to 2.5 [bar]",
            _border("intake_pressure", 1e-5, True),
            "2",
            2.4,
            2.6,
        ),
        Claim(
            "change of the power density [%]", _change("power_density"), "increases", 50.0, 400.0
        ),
    ),
    _pair(
        75,
        "Sweep of the intake temperature",
        "All falls but the frequency, as printed.",
        Claim("change of the efficiency [%]", _change("efficiency"), "decreases", -80.0, -5.0),
        Claim("change of the frequency [%]", _change("frequency"), "higher frequency", 0.0, 30.0),
    ),
    _pair(
        77,
        "Sweep of the spring stiffness",
        "Power density loses most, as printed; ours is stable below 50 kN/m too.",
        Claim(
            "least stable stiffness, of 5 on [kN/m]",
            _border("spring_stiffness", 1e-3),
            "50",
            4.9,
            5.1,
        ),
        Claim("change of the power density [%]", _change("power_density"), "most", -90.0, -50.0),
        Claim("change of the efficiency [%]", _change("efficiency"), "small losses", -15.0, 0.0),
    ),
    _pair(
        79,
        "Sweep of the equivalence ratio",
        "Stable from the printed ratio on, and all rises.",
        near("least stable equivalence ratio [-]", _border("equivalence_ratio", 1.0), 0.2, 0.08),
        Claim("change of the power density [%]", _change("power_density"), "rises", 100.0, 2000.0),
    ),
    _pair(
        81,
        "Sweep of the exhaust gas retained",
        "It acts as less fuel, as printed, and nothing fails.",
        Claim(
            "stable points of all [%]",
            lambda table: float(100.0 * table["stable"].mean()),
            "stable",
            100.0,
            100.0,
        ),
        Claim("change of the power density [%]", _change("power_density"), "falls", -80.0, -20.0),
    ),
)


def _table_9(_: Any) -> float:
    return float(optimisation.printed_scores(9)["printed"].min())


def _best(figure: str, factor: float = 1.0) -> Callable[[Any], float]:
    return lambda found: float(factor * found.best[figure])


OPTIMISATION = (
    Shown(
        (85,),
        "Terms of the score",
        "With these terms all printed designs of Table 9 score as the text says.",
        (Claim("least score of Table 9 as printed [-]", _table_9, "0.998", 0.998, 1.0),),
    ),
    Shown(
        (86,),
        "Course of the optimisation",
        "2000 designs reach the score at which the dissertation stops.",
        (Claim("best score [-]", _best("score"), "0.999", 0.995, 1.0),),
    ),
    Shown(
        (87,),
        "Design map: stroke to bore, compression ratio, efficiency",
        "The best lie near an efficiency of 40 %, as printed.",
        (Claim("efficiency of the best [%]", _best("efficiency", 100.0), "40", 38.0, 46.0),),
    ),
    Shown(
        (88,),
        "Design map: stroke to bore, frequency, power density",
        "Good designs have a low ratio and about the printed frequency; of the second zone of the "
        "print see [optimisation](optimisation.md).",
        (Claim("frequency of the best [Hz]", _best("frequency"), "60", 40.0, 90.0),),
    ),
    Shown(
        (89,),
        "Design map: equivalence ratio, intake temperature, compression ratio",
        "The best compression ratios are about the printed ones.",
        (Claim("compression ratio of the best [-]", _best("compression_ratio"), "20", 14.0, 25.0),),
    ),
    Shown(
        (90,),
        "Design map: equivalence ratio, efficiency, peak pressure",
        "The best design stays below the pressure that the score allows.",
        (
            Claim(
                "peak pressure of the best [bar]",
                _best("peak_pressure", 1e-5),
                "below 250",
                50.0,
                250.0,
            ),
        ),
    ),
    Shown(
        (91,),
        "Design map: intake temperature, frequency, power",
        "Good designs lie along the target power, as printed.",
        (near("power of the best [kW]", _best("power", 1e-3), 4, 0.1),),
    ),
)


def _correlation(x: str, figure: str) -> Callable[[Any], float]:
    """Rank correlation over the steady designs."""

    def correlation(table: Any) -> float:
        steady = table[table["status"] == "steady"]
        return float(steady[[x, figure]].rank().corr().iloc[0, 1])

    return correlation


APPENDIX = (
    _pair(
        115,
        "Exhaust gas retained with RCM ignition",
        "As printed, the trends are those with CFR but for the efficiency, which hardly moves.",
        Claim(
            "change of the efficiency [%]", _change("efficiency"), "negligible increase", -3.0, 3.0
        ),
    ),
    _pair(
        117,
        "Designs over maximum stroke to bore",
        "Nothing is said of it in words; long strokes are slow.",
        Claim(
            "rank correlation with the frequency [-]",
            _correlation("stroke_to_bore", "frequency"),
            "not said",
            -1.0,
            -0.6,
        ),
    ),
    _pair(
        119,
        "Designs over dimensionless intake pressure",
        "Nothing is said of it in words; more pressure against the springs means more compression.",
        Claim(
            "rank correlation with the compression ratio [-]",
            _correlation("dimensionless_pressure", "compression_ratio"),
            "not said",
            0.0,
            1.0,
        ),
    ),
    _pair(
        121,
        "Designs over dimensionless heat",
        "Nothing is said of it in words; more heat against the springs means more compression.",
        Claim(
            "rank correlation with the compression ratio [-]",
            _correlation("dimensionless_heat", "compression_ratio"),
            "not said",
            0.0,
            1.0,
        ),
    ),
    _pair(
        123,
        "Designs over the frequency ratio",
        "Nothing is said of it in words; gas that lifts the frequency above the springs' is gas at "
        "high pressure.",
        Claim(
            "rank correlation with the compression ratio [-]",
            _correlation("frequency_ratio", "compression_ratio"),
            "not said",
            0.0,
            1.0,
        ),
    ),
)

SHOWN = (*EQUATIONS, *SWEEPS, *OPTIMISATION, *APPENDIX)
