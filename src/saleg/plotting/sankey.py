"""The energy balance as a Sankey diagram."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from saleg.plotting.cycle import NoCycle, titled
from saleg.plotting.docstrings import documented
from saleg.plotting.energy import (
    FLOW_COLOURS,
    VISIBLE,
    alone,
    balance_of,
    joules,
    named,
    visible_flows,
)
from saleg.plotting.overlay import sign
from saleg.plotting.style import TRANSLATOR_COLOUR, axes_or_new

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes
    from saleg.simulation.performance import EnergyBalance
    from saleg.simulation.run import Run

TRUNK_COLOUR = "#D9DDE3"
#: Distance of neighbouring ends, in parts of the fuel energy.
GAP = 0.075
#: Distance from one node to the next, and from the last to the ends.
STEP = 1.0
BAR = 0.025


class _Node(NamedTuple):
    """A place where the trunk splits: its energy [J] and what leaves (or joins) after it."""

    name: str
    energy: float
    branches: tuple[str, ...]


@documented()
def energy_sankey(run: Run, ax: Axes | None = None, *, label: str | None = None) -> ShownAxes:
    """Draw the energy balance of the last full cycle as a Sankey diagram [J, %].

    Widths and percentages are parts of the energy of the fresh fuel. Energy that comes from
    elsewhere in a cycle that is not steady (out of springs and gas, say) joins from above. Flows
    below 0.1 % are left out. Adverse work is no term of the balance, since the gas gets it back,
    and stands in a note.

    Raises
    ------
    NoCycle
        If the run completed no full cycle after its first stroke, if that had no fresh fuel or its
        balance does not close to 1 %, or if the alternator drove the engine in it.
    """
    balance = balance_of(run)
    delivered = (balance.electrical, balance.alternator_loss, balance.friction)
    if min(delivered) < -VISIBLE * balance.fuel:
        raise NoCycle("no Sankey diagram to draw: the alternator drove the engine in this cycle")
    ax = axes_or_new(ax, 8.6, 4.6)
    alone(ax)
    lowest, highest = _Diagram(ax, balance).draw(_nodes(balance))
    adverse = run.performance.adverse_work
    if math.isfinite(adverse) and adverse > 0.0:
        share = 100.0 * adverse / balance.fuel
        note = (
            f"Adverse work, {adverse:.2g} J ({share:.2g} %), goes back into the gas around dead "
            "centre: no term of the balance."
        )
        lowest -= 0.1
        ax.text(-BAR, lowest, note, va="bottom", fontsize="small", color="0.35")
    ax.set_xlim(-0.1, 5.5 * STEP)
    ax.set_ylim(lowest - 0.02, highest)
    ax.set_axis_off()
    ax.set_title(titled(run, named("Energy balance of a cycle", label)), fontsize="medium")
    sign(ax, run)
    return ax


#: The energy balance as it is drawn unless a pie is asked for.
energy_balance = energy_sankey


def _nodes(balance: EnergyBalance) -> tuple[_Node, ...]:
    work = balance.friction + balance.alternator
    return (
        _Node("fuel", balance.fuel, ("stored fuel", "unburnt fuel")),
        _Node(
            "heat released",
            balance.released,
            ("stored energy", "port work", "heat transfer", "exhaust"),
        ),
        _Node("piston work", work, ("friction",)),
        _Node("alternator", balance.alternator, ("alternator loss",)),
    )


class _Diagram:
    """Draws in units of the fuel energy; the trunk runs along the top, branches bend down."""

    def __init__(self, ax: Axes, balance: EnergyBalance):
        self.ax = ax
        self.fuel = balance.fuel
        self.flows = visible_flows(balance)
        self.out = {name: flow for name, flow in self.flows.items() if flow > 0.0}

    def draw(self, nodes: tuple[_Node, ...]) -> tuple[float, float]:
        """Draw everything; returns the lowest and the highest place used."""
        end = len(nodes) * STEP
        tops = self._tops(nodes)
        low = self._ends(nodes, tops, end)
        high = tops[-1]
        for k, node in enumerate(nodes):
            x, top, thickness = k * STEP, tops[k], node.energy / self.fuel
            bottom, joined, height = top - thickness, top, top + 0.2
            for name in node.branches:
                flow = self.flows.get(name, 0.0) / self.fuel
                if flow > 0.0:
                    self._ribbon(name, x, bottom, low[name], flow, FLOW_COLOURS[name], end)
                    bottom += flow
                elif flow < 0.0:
                    self._source(name, x, height, joined, -flow)
                    joined -= flow
                    high = max(high, height - flow)
                    height += 0.2 - flow
            onward = nodes[k + 1].name if k + 1 < len(nodes) else "electrical output"
            colour = TRUNK_COLOUR if k + 1 < len(nodes) else FLOW_COLOURS[onward]
            self._ribbon(onward, x, bottom, bottom, top - bottom, colour, x + STEP)
            self._bar(x, top - thickness, thickness)
            words = f"{node.name}\n{joules(node.energy)}"
            place: dict[str, Any] = {"ha": "left", "va": "bottom", "fontsize": "small"}
            self.ax.text(x - BAR, top + 0.02, words, **place)
        return min(low.values()), high + 0.18

    def _tops(self, nodes: tuple[_Node, ...]) -> list[float]:
        """Upper edge of the trunk at every node and at the end; what joins raises it."""
        tops = [1.0]
        for node in nodes:
            joining = [min(self.flows.get(name, 0.0), 0.0) for name in node.branches]
            tops.append(tops[-1] - sum(joining) / self.fuel)
        return tops

    def _ends(self, nodes: tuple[_Node, ...], tops: list[float], x: float) -> dict[str, float]:
        """Lower edges of the branches at their ends, with labels there, from the top down."""
        order = ["electrical output"]
        for node in reversed(nodes):
            order += [name for name in reversed(node.branches) if name in self.out]
        low, edge = {}, tops[-1]
        for name in order:
            thickness = self.out.get(name, 0.0) / self.fuel
            low[name] = edge - thickness
            words = f"{name}  {joules(self.out.get(name, 0.0))}, {100.0 * thickness:.1f} %"
            bold = "bold" if name == "electrical output" else "normal"
            self.ax.text(
                x + 3 * BAR, low[name] + thickness / 2, words, va="center", fontweight=bold
            ).set_fontsize("small")
            edge = low[name] - GAP
        return low

    def _source(self, name: str, x: float, height: float, top: float, flow: float) -> None:
        """Energy that joins the trunk from above."""
        start, colour = x + 0.55 * STEP, FLOW_COLOURS[name]
        self._ribbon(name, start, height, top, flow, colour, x + STEP, bend=0.45 * STEP)
        words = f"{name}\n{joules(flow * self.fuel)}, {100.0 * flow:.1f} %"
        self.ax.text(start, height + flow + 0.02, words, va="bottom", fontsize="small")

    def _bar(self, x: float, bottom: float, height: float) -> None:
        from matplotlib.patches import Rectangle

        self.ax.add_patch(
            Rectangle((x - BAR, bottom), 2 * BAR, height, color=TRANSLATOR_COLOUR, linewidth=0)
        )

    def _ribbon(
        self,
        name: str,
        x: float,
        start: float,
        stop: float,
        thickness: float,
        colour: str,
        end: float,
        bend: float = STEP,
    ) -> None:
        """A band of constant thickness from its lower edge `start` to `stop`, then level."""
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path

        half, to = x + bend / 2, x + bend
        lower = [(x, start), (half, start), (half, stop), (to, stop), (end, stop)]
        upper = [(a, b + thickness) for a, b in reversed(lower)]
        codes = [Path.MOVETO, *[Path.CURVE4] * 3, Path.LINETO]
        codes += [Path.LINETO, Path.LINETO, *[Path.CURVE4] * 3, Path.CLOSEPOLY]
        # The upper edge runs back: level first, then the same bend.
        path = Path([*lower, *upper, lower[0]], codes)
        self.ax.add_patch(PathPatch(path, facecolor=colour, linewidth=0, label=name))
