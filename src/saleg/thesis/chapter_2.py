"""Figures 9 to 19 of the thesis.

The thesis prints no parameters for them, except that Figure 16 burns at 20 % of the pressure at
the start. Those chosen here are close to its base case (see :func:`saleg.fundamental.from_engine`)
and show what the text says of each figure. Every figure is a case, which computes, and a drawing.

Examples
--------
>>> from saleg.thesis import chapter_2
>>> print(chapter_2.excess().outcome)
rising
>>> ax = chapter_2.figure_9()
>>> ax.figure.savefig("figure_9.png")  # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.fundamental import (
    AtPressure,
    ConstantLoad,
    CosineLoad,
    Gas,
    History,
    Isentropic,
    Load,
    OttoLoad,
    Polytropic,
    Profile,
    System,
    at_equilibrium,
    cycle_balance,
    march,
)
from saleg.plotting import fundamental as plots
from saleg.plotting.docstrings import documented
from saleg.plotting.style import panels_or_new
from saleg.thesis.figure import Figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels, ShownAxes

#: Midpoint pressure and heat of all figures [-]: about those of the base case.
PRESSURE, HEAT = 0.17, 2.2
#: Work force over heat with an equilibrium that attracts [-].
BALANCED = 0.37
#: Left dead centre of the figures at equilibrium [-]: a compression ratio of 19.
DEEP = -0.9


def basic(load: Load) -> System:
    """System of 2.3, with a load of one's choice.

    Parameters
    ----------
    load : Load

    Returns
    -------
    System
    """
    return System(pressure=PRESSURE, heat=HEAT, load=load)


def excess() -> History:
    """Figure 9: more energy comes in than goes out, and the compression ratio runs away."""
    return march(basic(ConstantLoad(0.33 * HEAT)), -0.5, 12)


def deficit() -> History:
    """Figure 10: less comes in than goes out, and the oscillation decays."""
    return march(basic(ConstantLoad(0.43 * HEAT)), -0.9, 12)


def from_below() -> History:
    """Figure 11: from a short stroke up to the equilibrium."""
    return march(basic(ConstantLoad(BALANCED * HEAT)), -0.1, 400)


def from_above() -> History:
    """Figure 12: the same load and heat, from a long stroke down to the same equilibrium."""
    return march(basic(ConstantLoad(BALANCED * HEAT)), -0.6, 400)


def held() -> History:
    """Figure 13: the load of Eq. 32 repeats the first stroke."""
    return march(at_equilibrium(basic(ConstantLoad()), DEEP), DEEP, 8)


def profiles() -> dict[str, Profile]:
    """Figure 14: a constant force and the cosine that takes the same work."""
    work = 2.0 * -DEEP
    shapes = {"constant": ConstantLoad(), "cosine": CosineLoad()}
    return {name: shape.with_work(work, -DEEP) for name, shape in shapes.items()}


def both_loads() -> dict[str, History]:
    """Figure 15: the engine under either force, at the same equilibrium."""
    return {
        name: march(at_equilibrium(basic(profile), DEEP), DEEP, 2)
        for name, profile in profiles().items()
    }


def early() -> History:
    """Figure 16: combustion at 20 % of the first pressure lowers the compression ratio."""
    gas = Isentropic()
    ignition = AtPressure.share_of_start(0.2, DEEP, gas)
    load = OttoLoad(CosineLoad())
    return march(
        System(pressure=PRESSURE, heat=HEAT, load=load, gas=gas, ignition=ignition), DEEP, 80
    )


def lossy() -> dict[str, History]:
    """Figure 17: one cycle without and with heat transfer, both burning before dead centre."""
    gases: dict[str, Gas] = {
        "adiabatic": Isentropic(),
        "polytropic": Polytropic(1.4, compression=1.35, expansion=1.47),
    }
    return {name: _combined(gas, start=-0.86, share=0.5) for name, gas in gases.items()}


def combined() -> History:
    """Figures 18 and 19: everything together, at a high compression ratio."""
    return _combined(Polytropic(1.4, compression=1.35, expansion=1.47), start=-0.94, share=0.35)


def _combined(gas: Gas, start: float, share: float) -> History:
    """Cosine load, early combustion and a second-law efficiency that holds x* = -0.9."""
    ignition = AtPressure.share_of_start(share, start, gas)
    load = OttoLoad(CosineLoad())
    system = System(pressure=PRESSURE, heat=HEAT, load=load, gas=gas, ignition=ignition)
    return march(at_equilibrium(system, DEEP), start, 60)


# ---- drawings ----------------------------------------------------------------------------------


@documented()
def figure_9(ax: Axes | None = None) -> ShownAxes:
    """Draw the runaway: velocity over position."""
    return plots.phase_portrait(excess(), ax)


@documented()
def figure_10(ax: Axes | None = None) -> ShownAxes:
    """Draw the decay: velocity over position."""
    return plots.phase_portrait(deficit(), ax)


@documented()
def figure_11(ax: Axes | None = None) -> ShownAxes:
    """Draw the rise to the equilibrium: velocity over position."""
    return plots.phase_portrait(from_below(), ax)


@documented()
def figure_12(ax: Axes | None = None) -> ShownAxes:
    """Draw the fall to the equilibrium: velocity over position."""
    return plots.phase_portrait(from_above(), ax)


@documented()
def figure_13(ax: Axes | None = None) -> ShownAxes:
    """Draw the equilibrium of Eq. 32: velocity over position."""
    return plots.phase_portrait(held(), ax)


@documented()
def figure_14(ax: Axes | None = None) -> ShownAxes:
    """Draw the constant and the cosine work force over position."""
    return plots.load_profiles(profiles(), DEEP, ax)


@documented(axes=2)
def figure_15(ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw velocity and acceleration under either work force."""
    return _compared(both_loads(), ax)


@documented(axes=2)
def figure_16(ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw velocity and acceleration with early combustion."""
    return _motion(early(), ax)


@documented()
def figure_17(ax: Axes | None = None) -> ShownAxes:
    """Draw the pressure loops without and with heat transfer, and their inversion."""
    return plots.pressure_loops(lossy(), ax)


@documented(axes=2)
def figure_18(ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw velocity and acceleration with all effects together."""
    return _motion(combined(), ax)


@documented(axes=2)
def figure_19(ax: Sequence[Axes] | np.ndarray | None = None) -> Panels:
    """Draw how the compression ratio settles, and where the heat goes."""
    return _settling(combined(), ax)


#: Drawing of every figure, by its number in the thesis.
FIGURES: dict[int, Callable[..., Any]] = {
    9: figure_9,
    10: figure_10,
    11: figure_11,
    12: figure_12,
    13: figure_13,
    14: figure_14,
    15: figure_15,
    16: figure_16,
    17: figure_17,
    18: figure_18,
    19: figure_19,
}


def _motion(history: History, ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4)
    plots.phase_portrait(history, panels[0])
    plots.acceleration_portrait(history, panels[1], "Acceleration")
    return panels


def _compared(histories: dict[str, History], ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4)
    plots.compare_velocities(histories, panels[0], "Velocity")
    plots.compare_accelerations(histories, panels[1], "Acceleration")
    return panels


def _settling(history: History, ax: Any = None) -> Panels:
    panels = panels_or_new(ax, (1, 2), 10.0, 4.4)
    plots.compression_ratios(history, panels[0])
    plots.energy_pie(cycle_balance(history), panels[1])
    return panels


#: Case and drawing of every figure, by its number.
CASES = {
    9: Figure(excess, plots.phase_portrait),
    10: Figure(deficit, plots.phase_portrait),
    11: Figure(from_below, plots.phase_portrait),
    12: Figure(from_above, plots.phase_portrait),
    13: Figure(held, plots.phase_portrait),
    14: Figure(profiles, partial(plots.load_profiles, start=DEEP)),
    15: Figure(both_loads, _compared),
    16: Figure(early, _motion),
    17: Figure(lossy, plots.pressure_loops),
    18: Figure(combined, _motion),
    19: Figure(combined, _settling),
}
