"""What Chapter 2 says of Figures 9 to 19."""

from __future__ import annotations

import numpy as np

from saleg.fundamental import History, cycle_balance
from saleg.thesis.claims.claim import Claim, Shown, near

X = np.linspace(-0.9, 0.9, 2001)


def _growth(history: History) -> float:
    return float(history.compression_ratios[-1] / history.compression_ratios[0])


def _last_ratio(history: History) -> float:
    return float(history.compression_ratios[-1])


def _peaks(histories: dict[str, History], name: str) -> float:
    """Greatest value under the cosine over that under the constant force."""
    constant, cosine = (getattr(h.strokes[0], name)(X).max() for h in histories.values())
    return float(cosine / constant)


def _works(profiles: dict[str, object]) -> float:
    constant, cosine = (float(of.work(-0.9, 1.8)) for of in profiles.values())  # type: ignore[attr-defined]
    return cosine / constant


SHOWN = (
    Shown(
        (9,),
        "More heat than work",
        "As printed, every stroke is longer than the one before.",
        (Claim("compression ratio after 12 strokes over the first [-]", _growth, "rises", 1.5, 9),),
    ),
    Shown(
        (10,),
        "More work than heat",
        "As printed, every stroke is shorter than the one before.",
        (Claim("compression ratio after 12 strokes over the first [-]", _growth, "falls", 0, 0.5),),
    ),
    Shown(
        (11,),
        "Rise to an equilibrium",
        "As printed, the compression ratio rises to the one that is left at last in Figure 12.",
        (Claim("compression ratio at last [-]", _last_ratio, "that of Figure 12", 1.6, 1.7),),
    ),
    Shown(
        (12,),
        "Fall to the same equilibrium",
        "As printed, the same heat and load end at the same compression ratio from above.",
        (Claim("compression ratio at last [-]", _last_ratio, "that of Figure 11", 1.6, 1.7),),
    ),
    Shown(
        (13,),
        "Equilibrium held by the efficiency of the Otto cycle",
        "As printed, both dead centres are equally far from the midpoint from the first stroke on.",
        (
            Claim(
                "difference of the distances of both dead centres [-]",
                lambda history: float(np.ptp(np.abs(history.dead_centres))),
                "equal",
                0.0,
                1e-9,
            ),
        ),
    ),
    Shown(
        (14,),
        "Constant and cosine work force",
        "Both take the same work, as the text demands.",
        (near("work of the cosine over that of the constant force [-]", _works, 1.0, 1e-12),),
    ),
    Shown(
        (15,),
        "Motion under either work force",
        "As printed, the cosine raises the peaks a little.",
        (
            Claim(
                "peak velocity, cosine over constant [-]",
                lambda found: _peaks(found, "velocity"),
                "slightly increases",
                1.01,
                1.05,
            ),
            Claim(
                "peak acceleration, cosine over constant [-]",
                lambda found: _peaks(found, "acceleration"),
                "slightly increases",
                1.0,
                1.1,
            ),
        ),
    ),
    Shown(
        (16,),
        "Combustion before dead centre",
        "As printed, combustion at 20 % of the first pressure lowers the compression ratio until "
        "it is at dead centre.",
        (
            Claim(
                "compression ratio at last over the first [-]",
                _growth,
                "decreases towards combustion at dead centre",
                0.1,
                0.9,
            ),
        ),
    ),
    Shown(
        (17,),
        "Pressure with and without heat transfer",
        "As printed, only early combustion and heat transfer together invert the loop.",
        (
            Claim(
                "adverse work without heat transfer [-]",
                lambda found: cycle_balance(found["adiabatic"]).adverse_work,
                "not present",
                -1e-9,
                1e-9,
            ),
            Claim(
                "adverse work with it [-]",
                lambda found: cycle_balance(found["polytropic"]).adverse_work,
                "an inversion of the pressure curve",
                1e-3,
                1.0,
            ),
        ),
    ),
    Shown(
        (18,),
        "Motion with all effects together",
        "Ours settles at a high compression ratio too; that of the print is not given.",
        (Claim("compression ratio at last [-]", _last_ratio, "high", 18.9, 19.1),),
    ),
    Shown(
        (19,),
        "How it settles, and where the heat goes",
        "With a tenth of the work as friction the efficiency is that of the text; adverse work is "
        "no term of our balance ([why](fundamental.md)).",
        (
            Claim(
                "efficiency less a tenth for friction [%]",
                lambda history: 90.0 * cycle_balance(history).efficiency,
                "just under 50",
                48.0,
                50.0,
            ),
        ),
    ),
)
