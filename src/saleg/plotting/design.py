"""Figures of the component design: 62, 63, 65 and 66."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design import formulas
from saleg.design.geometry import Geometry
from saleg.plotting.docstrings import documented
from saleg.plotting.labels import axis_label
from saleg.plotting.machine import BEARING, WALL, housing, mover, piston, springs
from saleg.plotting.style import (
    COLOURS,
    LEFT_COLOUR,
    RIGHT_COLOUR,
    TRANSLATOR_COLOUR,
    axes_or_new,
    finish,
    from_zero,
    panels_or_new,
)
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import Panels, ShownAxes

#: Most of a drawing's size, and the least width its title needs [inch].
WIDEST, HIGHEST, NARROWEST = 10.6, 6.4, 4.5
STROKE, BORE = readable("stroke", "m"), readable("bore", "m")
STIFFNESS = readable("stiffness", "N/m", "spring stiffness")
POWER = readable("power", "W")


@documented()
def engine_drawing(geometry: Geometry, ax: Axes | None = None) -> ShownAxes:
    """Draw the engine to scale with the translator at its midpoint (Figure 62) [mm].

    Springs and walls are schematic, a mover of unknown diameter is left out; all else that Table 7
    names is to scale and dimensioned.

    Parameters
    ----------
    geometry : Geometry
    """
    mm = {name: 1e3 * value for name, value in geometry.to_dict().items()}
    depth = 0.5 * np.fmax(mm["mover_outer_diameter"], mm["bore"]) + 3.0 * WALL
    step = 0.035 * mm["head"] + 6.0
    bottom, top, end = -depth - 6.0 * step, depth + 2.2 * step, mm["head"] + 8.0 * WALL
    scale = min(WIDEST / (2.0 * end), HIGHEST / (top - bottom))
    width, height = max(2.0 * end * scale, NARROWEST), (top - bottom) * scale
    ax = axes_or_new(ax, width=width + 0.4, height=height + 1.0)
    for side, colour in zip((-1.0, 1.0), COLOURS.values(), strict=True):
        housing(ax, mm, side)
        springs(ax, mm, side)
        piston(ax, mm, side, colour=colour)
    if math.isfinite(mm["mover_outer_diameter"]):
        mover(ax, mm)
    _lengths(ax, mm, depth, step)
    _diameters(ax, mm, bottom)
    _parts(ax, mm, depth, step)
    ax.axhline(0.0, color="0.6", linewidth=0.6, linestyle=(0, (12, 3, 2, 3)), zorder=5)
    ax.set_aspect("equal")
    ax.set_xlim(-end, end)
    ax.set_ylim(bottom, top)
    ax.set_xlabel("distance from the midpoint [mm]")
    ax.set_yticks([])
    finish(ax, f"Engine to scale: {2.0 * mm['head']:.0f} mm from head to head", None)
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)
    return ax


def _parts(ax: Axes, mm: dict[str, float], depth: float, step: float) -> None:
    """Names of parts in a row above the drawing, each with a line to its part."""
    radius, spring = 0.5 * mm["bore"], 0.5 * (mm["mover_end"] + mm["bearing"])
    rod = 0.5 * (mm["bearing"] + mm["crown"])
    points = {
        "head": (-mm["head"] - 0.5 * WALL, radius),
        "piston": (-mm["crown"] + 500.0 * formulas.SKIRT_LENGTH, 0.5 * radius),
        "ports": (-mm["port"] + 0.5 * WALL, radius + 0.5 * WALL),
        "mover": (0.0, 0.25 * (mm["mover_outer_diameter"] + mm["mover_inner_diameter"])),
        "spring": (spring, 0.5 * radius),
        "bearing": (mm["bearing"] + 0.5 * BEARING, 0.5 * radius),
        "rod": (rod, 0.0),
    }
    known = {name: at for name, at in points.items() if all(map(math.isfinite, at))}
    names = sorted(known, key=lambda name: known[name][0])
    for place, name in enumerate(names):
        x = mm["head"] * ((2.0 * place + 1.0) / len(names) - 1.0)
        arrow = {"arrowstyle": "-", "linewidth": 0.6, "shrinkB": 0.0, "shrinkA": 1.0}
        look: dict[str, Any] = {"ha": "center", "va": "bottom", "fontsize": "small"}
        ax.annotate(name, known[name], (x, depth + 0.7 * step), arrowprops=arrow, zorder=6, **look)


def _lengths(ax: Axes, mm: dict[str, float], depth: float, step: float) -> None:
    """Dimension lines from the midpoint, below the right half; the longest lowest."""
    names = {
        "L_A": "mover_end",
        "L_{po}": "port",
        "L_B": "bearing",
        "L_P": "crown",
        "L_C": "head",
    }
    for row, (label, name) in enumerate(sorted(names.items(), key=lambda item: mm[item[1]])):
        y, x = -depth - step * (row + 1), mm[name]
        ax.plot([x, x], [-0.5 * mm["rod_diameter"], y], color="0.75", linewidth=0.5, zorder=0)
        arrow = {"arrowstyle": "<->", "linewidth": 0.7, "shrinkA": 0.0, "shrinkB": 0.0}
        ax.annotate("", (0.0, y), (x, y), arrowprops=arrow)
        _label(ax, 0.5 * mm["mover_end"], y, f"${label}$ = {x:.1f} mm")
    ax.plot([0.0, 0.0], [-depth, -depth - 5.5 * step], color="0.75", linewidth=0.5, zorder=0)


def _diameters(ax: Axes, mm: dict[str, float], bottom: float) -> None:
    """Diameters, below the left half."""
    texts = {
        "D_o": mm["mover_outer_diameter"],
        "D_i": mm["mover_inner_diameter"],
        "D_R": mm["rod_diameter"],
        "b": mm["bore"],
    }
    known = {name: value for name, value in texts.items() if math.isfinite(value)}
    lines = [f"${name}$ = {value:.1f} mm" for name, value in known.items()]
    ax.text(-mm["head"], 0.95 * bottom, "\n".join(lines), va="bottom", fontsize="small")


def _label(ax: Axes, x: float, y: float, text: str) -> None:
    look = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    ax.text(x, y, text, ha="center", va="center", fontsize="x-small", bbox=look)


@documented()
def alternator_map(
    powers: Sequence[float] = (1e3, 10e3, 100e3),
    ax: Sequence[Axes] | np.ndarray | None = None,
) -> Panels:
    """Draw the alternator diameter [m] over stroke [mm] and frequency [Hz] (Figure 63, Eq. 60).

    Two poles, pole pitch equal to the stroke; one panel per power.

    Parameters
    ----------
    powers : sequence of float
        Electrical powers [W].
    ax : array of matplotlib.axes.Axes, optional
        One per power; new ones unless given.

    Returns
    -------
    Panels
    """
    from matplotlib.colors import LogNorm

    panels = panels_or_new(ax, (1, len(powers)), 4.0 * len(powers) + 0.6, 3.9, sharey=True)
    stroke, frequency = np.meshgrid(np.geomspace(0.02, 0.3, 80), np.linspace(10.0, 100.0, 80))
    norm, levels = LogNorm(1e-3, 20.0), np.geomspace(1e-3, 20.0, 44)
    for panel, power in zip(panels, powers, strict=True):
        speed = formulas.mean_speed(stroke, frequency)  # type: ignore[arg-type]
        diameter = formulas.alternator_diameter(power, stroke, speed)  # type: ignore[arg-type]
        plane = STROKE.of(stroke), frequency
        filled = panel.contourf(*plane, diameter, levels, norm=norm, extend="both")
        lines = panel.contour(
            *plane,
            diameter,
            [0.01, 0.1, 1.0, 10.0],
            colors="white",
            linewidths=1.0,
        )
        panel.clabel(lines, fmt="%g m", fontsize="small")
        panel.set_xlabel(axis_label(STROKE))
        finish(panel, f"{POWER.of(power):g} {POWER.unit}", None)
    panels[0].set_ylabel("frequency [Hz]")
    bar = panels[0].figure.colorbar(filled, ax=list(panels), ticks=[1e-3, 0.01, 0.1, 1.0, 10.0])
    bar.set_label("outer diameter of the mover [m]")
    bar.ax.set_yticklabels(["0.001", "0.01", "0.1", "1", "10"])
    return panels


@documented()
def piston_mass(ax: Axes | None = None) -> ShownAxes:
    """Draw the mass of both piston heads [kg] over bore [mm] (Figure 65, Eq. 65)."""
    ax = axes_or_new(ax)
    bore = np.linspace(0.01, 0.1, 91)
    ax.plot(BORE.of(bore), [formulas.piston_mass(b) for b in bore], color=TRANSLATOR_COLOUR)
    ax.set_xlabel(axis_label(BORE))
    ax.set_ylabel("mass of both piston heads [kg]")
    from_zero(ax)
    return finish(ax, "Piston heads (Eq. 65)", None)


@documented()
def natural_frequency(rest: float = 1.5, ax: Axes | None = None) -> ShownAxes:
    """Draw the natural frequency [Hz] over spring stiffness [kN/m] (Figure 66, Eq. 67).

    ``sqrt(2 k / m) / (2 pi)``, with the springs' share of the moving mass growing and without; both
    begin with the mass of the least stiff springs.

    Parameters
    ----------
    rest : float
        Moving mass of all that is no spring [kg].
    """
    ax = axes_or_new(ax)
    stiffness = np.linspace(5e3, 300e3, 200)
    growing = rest + np.array([formulas.spring_mass(k) for k in stiffness])
    cases: dict[str, tuple[Any, str]] = {
        "springs as heavy as the softest": (np.full_like(stiffness, growing[0]), RIGHT_COLOUR),
        "mass grows with stiffness (Eq. 67)": (growing, LEFT_COLOUR),
    }
    for label, (mass, colour) in cases.items():
        frequency = np.sqrt(2.0 * stiffness / mass) / (2.0 * math.pi)
        ax.plot(STIFFNESS.of(stiffness), frequency, color=colour, label=label)
    ax.set_xlabel(axis_label(STIFFNESS))
    ax.set_ylabel("natural frequency [Hz]")
    from_zero(ax)
    return finish(ax, f"Springs and {rest:g} kg", "upper left")
