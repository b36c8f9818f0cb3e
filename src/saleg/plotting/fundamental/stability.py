"""Equilibria in pictures: the way to them, and the band of loads that has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from saleg.fundamental.band import equilibrium_branch, tolerance_band
from saleg.fundamental.equilibrium import equilibria
from saleg.fundamental.history import History, return_map
from saleg.fundamental.system import System
from saleg.plotting.docstrings import documented
from saleg.plotting.style import (
    ALTERNATOR_COLOUR,
    LEFT_COLOUR,
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    axes_or_new,
    finish,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes


@documented()
def cobweb(history: History, ax: Axes | None = None) -> ShownAxes:
    """Draw the next dead centre over the last one, with the way an engine takes."""
    ax = axes_or_new(ax, 5.4, 5.0)
    system = cast(System, history.strokes[0].system)
    centres = np.abs(history.dead_centres)
    depth = np.linspace(0.02, 0.98, 241)
    ax.plot((0, 1), (0, 1), color="0.7", linewidth=1.0, label="the same again")
    ax.plot(depth, return_map(system, depth), color=LEFT_COLOUR, linewidth=1.8, label="next stroke")
    steps = np.repeat(centres, 2)
    ax.plot(steps[:-1], steps[1:], color=RIGHT_COLOUR, linewidth=0.9, label="the engine's way")
    for found in equilibria(system):
        face = TRANSLATOR_COLOUR if found.attracting else "white"
        label = "attracting" if found.attracting else "repelling"
        look: dict[str, Any] = {"marker": "o", "linestyle": "none", "color": TRANSLATOR_COLOUR}
        ax.plot([found.depth], [found.depth], **look, markerfacecolor=face, zorder=4, label=label)
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(0.0, 1.0)
    ax.set_aspect("equal")
    ax.set_xlabel("depth of the last dead centre, |x*| [-]")
    ax.set_ylabel("depth of the next one [-]")
    return finish(ax, f"From stroke to stroke: {history.outcome}", "upper left")


@documented()
def tolerance(gamma: float = 1.4, ax: Axes | None = None) -> ShownAxes:
    """Draw the work force an equilibrium asks for, the fold, and the tolerance band (Eq. 32).

    Parameters
    ----------
    gamma : float
        Ratio of specific heats [-].
    """
    ax = axes_or_new(ax)
    band = tolerance_band(gamma)
    ratio, force = equilibrium_branch(gamma)
    fold = (1.0 + band.fold) / (1.0 - band.fold)
    ax.axhspan(band.lowest, band.highest, color=ALTERNATOR_COLOUR, alpha=0.12, linewidth=0.0)
    attracting, repelling = ratio <= fold, ratio >= fold
    ax.semilogx(ratio[attracting], force[attracting], color=TRANSLATOR_COLOUR, label="attracting")
    dashes: dict[str, Any] = {"color": TRANSLATOR_COLOUR, "linestyle": "--", "label": "repelling"}
    ax.semilogx(ratio[repelling], force[repelling], **dashes)
    ax.plot([fold], [band.lowest], "o", color=RIGHT_COLOUR, label=f"fold, CR {fold:.2f}")
    ax.text(
        30.0,
        0.5 * (band.lowest + band.highest),
        "tolerance band",
        fontsize="small",
        ha="center",
        va="center",
    )
    ax.set_xticks([1, 2, 5, 10, 20, 50], labels=["1", "2", "5", "10", "20", "50"])
    ax.minorticks_off()
    ax.set_xlabel("compression ratio [-]")
    ax.set_ylabel("work force over heat, $F_W$*/$Q_{in}$* [-]")
    return finish(ax, f"Equilibria of the basic system, gamma {gamma:g}", "upper left")
