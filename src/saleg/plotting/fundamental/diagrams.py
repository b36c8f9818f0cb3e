"""Forces, pressures, energies and equilibria in pictures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from saleg.fundamental.energy import EnergyBalance
from saleg.fundamental.history import History
from saleg.fundamental.loads import Profile
from saleg.plotting.docstrings import documented
from saleg.plotting.fundamental.portraits import POSITION, TOGETHER
from saleg.plotting.style import (
    ALTERNATOR_COLOUR,
    axes_or_new,
    finish,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes

SHARES = {
    "work": ALTERNATOR_COLOUR,
    "rejected": "#8A8F98",
    "heat transfer": "#CC6677",
    "adverse work": "#882255",
}


@documented()
def load_profiles(
    profiles: Mapping[str, Profile], start: float, ax: Axes | None = None
) -> ShownAxes:
    """Draw work forces over position, between mirrored dead centres (Figure 14).

    Parameters
    ----------
    profiles : mapping of str to Profile
        By the name in the legend.
    start : float
        Left dead centre x_l* [-].
    """
    ax = axes_or_new(ax)
    s = np.linspace(start, -start, 201)
    for (name, profile), look in zip(profiles.items(), TOGETHER, strict=False):
        force = profile.force(s)
        ax.plot(s, force, label=name, **look)
        ax.fill_between(s, force, color=look["color"], alpha=0.12, linewidth=0.0)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel(POSITION)
    ax.set_ylabel("work force $F_W$* [-]")
    return finish(ax, "Work force: equal areas, equal work", "upper right")


@documented()
def pressure_loops(histories: Mapping[str, History], ax: Axes | None = None) -> ShownAxes:
    """Draw the pressure in the left chamber over its volume, and the loops' inversion (Figure 17).

    Parameters
    ----------
    histories : mapping of str to History
        By the name in the legend; the left chamber is compressed in a stroke and expands in the
        next one, the last in the history that goes to the right. Three strokes will do.
    """
    ax = axes_or_new(ax, 6.4, 5.0)
    inset = ax.inset_axes((0.4, 0.36, 0.58, 0.58))
    for (name, history), look in zip(histories.items(), TOGETHER, strict=False):
        volume, pressure = _left_loop(history)
        ax.plot(volume, pressure, label=name, **look)
        near = volume <= _burning_volume(history)
        inset.plot(volume[near], pressure[near], **look)
        inset.fill(volume[near], pressure[near], color=look["color"], alpha=0.25, linewidth=0.0)
    inset.set_title("between ignition and dead centre", fontsize="small")
    inset.tick_params(labelsize="x-small")
    ax.set_xlim(left=0.0)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("volume of the left chamber, 1 + x* [-]")
    ax.set_ylabel("pressure P* [-]")
    return finish(ax, "Pressure and volume", "below", columns=2)


@documented()
def energy_pie(balance: EnergyBalance, ax: Axes | None = None) -> ShownAxes:
    """Draw where the heat of a cycle goes [%] (Figure 19).

    Parameters
    ----------
    balance : EnergyBalance
        At equilibrium, so that nothing is stored.
    """
    ax = axes_or_new(ax, 5.6, 4.4)
    terms = {
        "work": balance.work,
        "rejected": balance.rejected,
        "heat transfer": balance.heat_transfer - balance.adverse_work,
        "adverse work": balance.adverse_work,
    }
    seen = {name: part for name, part in terms.items() if part > 1e-6 * balance.heat}
    ax.pie(
        list(seen.values()),
        labels=[f"{name}\n{100.0 * part / balance.heat:.1f} %" for name, part in seen.items()],
        colors=[SHARES[name] for name in seen],
        startangle=90.0,
        counterclock=False,
        wedgeprops={"edgecolor": "white", "linewidth": 1.2},
        textprops={"fontsize": "small"},
    )
    ax.set_title("Heat of a cycle", fontsize="medium")
    return ax


def _burning_volume(history: History) -> float:
    """Volume at which the charge burns under way [-]."""
    system = history.strokes[0].system
    return 1.0 - system.ignition.position(system.gas)


def _left_loop(history: History) -> tuple[np.ndarray, np.ndarray]:
    """Volume and pressure of the left chamber: compressed, burning, expanding, blown down."""
    strokes = history.strokes if history.strokes[-1].direction > 0.0 else history.strokes[:-1]
    compressing, expanding = strokes[-2:]
    x, y = compressing.positions(401), expanding.positions(401)
    blown_down = expanding.next().pressures(y[-1:])[0]
    pressure = [compressing.pressures(x)[0], expanding.pressures(y)[0], blown_down]
    return 1.0 + np.concatenate([x, y, y[-1:]]), np.concatenate(pressure)
